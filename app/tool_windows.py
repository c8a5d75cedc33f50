"""The windows beside the main one, each made when it is first asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from app.texts import live, own_face, poses, tracking

if TYPE_CHECKING:
    from app.panels.compare.window import CompareWindow
    from app.panels.importing.window import ImportWindow
    from app.panels.live.window import LiveWindow
    from app.panels.own_face.window import OwnFaceWindow
    from app.panels.poses.window import KeyPosesWindow
    from app.panels.tracking.window import TrackingWindow
    from app.panels.units.window import UnitsWindow
    from app.window import MainWindow

# Each window that can hold what is not on disk, how it says so, and the question before it is lost.
_UNSAVED = (
    ("key_poses", "has_unsaved_poses", poses.CLOSE_UNSAVED),
    ("live", "has_unsaved_take", live.CLOSE_UNSAVED),
    ("own_face", "has_unsaved_face", own_face.CLOSE_UNSAVED),
    ("tracking", "has_unsaved_track", tracking.CLOSE_UNSAVED),
)


class ToolWindows:
    """Made by the main window, and shut down with it; none is made by being looked for here at the end."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    @cached_property
    def importing(self) -> ImportWindow:
        """Takes captures in."""
        from app.panels.importing.window import ImportWindow

        return ImportWindow(self._window.authoring, self._window)

    @cached_property
    def key_poses(self) -> KeyPosesWindow:
        """Key lip shapes, and a character posed for each."""
        from app.panels.poses.window import KeyPosesWindow

        return KeyPosesWindow(self._window.authoring, self._window)

    @cached_property
    def compare(self) -> CompareWindow:
        """Two engines on the same speech."""
        from app.panels.compare.window import CompareWindow

        return CompareWindow(self._window.authoring, self._window)

    @cached_property
    def units(self) -> UnitsWindow:
        """Motion units as sliders on the face."""
        from app.panels.units.window import UnitsWindow

        return UnitsWindow(self._window.authoring, self._window)

    @cached_property
    def own_face(self) -> OwnFaceWindow:
        """Fits a face to a scan."""
        from app.panels.own_face.window import OwnFaceWindow

        return OwnFaceWindow(self._window.authoring, self._window)

    @cached_property
    def live(self) -> LiveWindow:
        """The face that speaks with a microphone; what it records opens in the main window."""
        from app.panels.live.window import LiveWindow

        made = LiveWindow(self._window.authoring, self._window)
        made.project_asked.connect(self._window.open_file)
        return made

    @cached_property
    def tracking(self) -> TrackingWindow:
        """Tracks a face in a video; what it writes goes on to the importing window."""
        from app.panels.tracking.window import TrackingWindow

        made = TrackingWindow(self._window.authoring, self._window)
        made.import_asked.connect(self._import)
        return made

    def _import(self, paths: list[Path]) -> None:
        self.importing.open_now()
        self.importing.draft.add_files(paths)

    def unsaved(self) -> list[str]:
        """Return the questions to be answered before the windows may close."""
        made = vars(self)
        return [sentence for name, says, sentence in _UNSAVED if name in made and getattr(made[name], says)]

    def shut_down(self) -> None:
        """Stop what the windows do, for good."""
        for name, made in vars(self).items():
            if name != "_window":
                made.shut_down()
