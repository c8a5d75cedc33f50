"""One film, where a hand said the face is, and what was tracked of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.jobs import JobRunner
from app.panels.tracking.work import ModelRequest, TrackJob, learn_model, open_video, save_capture, track
from app.texts import tracking as texts
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.tracking.face_model import CLICKED, FaceModel
from core.tracking.start import named_clicks
from core.tracking.start_file import TrackingStart, read_start, write_start
from core.tracking.track import Track, TrackingRequest, starting_points
from core.tracking.video_pictures import VideoFormat

NOTHING = TrackingStart({})


class TrackingDraft(QObject):
    """Every click and correction can be taken back; a job that is cancelled or fails changes nothing.

    start : clicks and corrections; laid : where they put the points of the first picture, shape (K, 2), or None
    track : what was found last, or None; it may be older than ``start``, see `is_behind`
    changed() : something else is to be shown; opened() : it is another film
    failed(sentence, remedy), noted(sentence) : for the window's lines; saved(paths) : a capture was written
    """

    changed = Signal()
    opened = Signal()
    failed = Signal(str, str)
    noted = Signal(str)
    saved = Signal(list)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.video: Path | None = None
        self.format: VideoFormat | None = None
        self.model: FaceModel | None = None
        self.start, self.laid = NOTHING, None
        self.track: Track | None = None
        self.saved_track: Track | None = None
        self.captures: list[Path] = []
        self.undo_stack = QUndoStack(self)
        self._jobs = jobs
        self._units_of: tuple[object, str] | None = None
        self._database: MotionDatabase | None = None
        jobs.failed.connect(self.failed)

    # The film

    def open(self, path: Path) -> None:
        """Look at another film; clicks and track of the last one are forgotten once it is open."""
        self._jobs.start("open", texts.OPENING, path, open_video, self._on_opened)

    def _on_opened(self, answer: tuple[Path, VideoFormat]) -> None:
        self._jobs.cancel("track")
        self.video, self.format = answer
        self.start, self.laid, self.track, self.saved_track, self.captures = (
            replace(NOTHING, expression=self.start.expression), None, None, None, []
        )  # fmt: skip
        self.undo_stack.clear()
        self.opened.emit()
        self.changed.emit()
        self._learn()

    def use_database(self, database: MotionDatabase | None) -> None:
        """Take the motion units of a database, or the demo's."""
        self._database = database
        self._learn()

    def _learn(self) -> None:
        wanted = (self._database, self.start.expression)
        if self.video is None or self._units_of == wanted:
            return
        self._units_of = wanted
        self._jobs.start("model", texts.LEARNING, ModelRequest(*wanted), learn_model, self._on_model, self._on_no_model)

    def _on_model(self, model: FaceModel) -> None:
        self.model = model
        self._lay()
        self.changed.emit()

    def _on_no_model(self, error: UserFacingError) -> None:
        self._units_of = None
        self.failed.emit(error.message, error.remedy)

    # Clicks and corrections

    def show(self, start: TrackingStart) -> None:
        """Take other clicks and corrections; without undo, for the commands on the stack."""
        self.start = start
        self._lay()
        self._learn()
        self.changed.emit()

    @property
    def next_click(self) -> str | None:
        """The landmark that is to be clicked next; None when all are."""
        return next((name for name in CLICKED if name not in self.start.clicks), None)

    def click(self, x: float, y: float) -> None:
        """Say where the next landmark is in the first picture."""
        name = self.next_click
        if name is None:
            return
        clicks = {**self.start.clicks, name: (x, y)}
        if set(clicks) == set(CLICKED):
            clicks = named_clicks([clicks[each] for each in CLICKED])
        self._push(replace(self.start, clicks=clicks), texts.EDIT_CLICK)

    def move_click(self, name: str, x: float, y: float) -> None:
        """Put a click elsewhere."""
        self._push(replace(self.start, clicks={**self.start.clicks, name: (x, y)}), texts.EDIT_MOVE_CLICK)

    def correct(self, frame: int, name: str, x: float, y: float) -> None:
        """Say where a point is in a picture, and go on tracking from there if that was done before."""
        places = {**self.start.corrections.get(frame, {}), name: (x, y)}
        text = texts.EDIT_CORRECT.format(name=name, frame=frame)
        self._push(replace(self.start, corrections={**self.start.corrections, frame: places}), text)
        if self.track is not None:
            self.run()

    def set_expression(self, expression: str) -> None:
        """Choose whose units may be used."""
        if expression != self.start.expression:
            self._push(replace(self.start, expression=expression), texts.EDIT_EXPRESSION)

    def click_anew(self) -> None:
        """Forget all clicks and corrections."""
        if self.start.clicks:
            self._push(replace(NOTHING, expression=self.start.expression), texts.EDIT_ANEW)

    def load(self, path: Path) -> None:
        """Go on with saved clicks and corrections."""
        try:
            self._push(read_start(path), texts.EDIT_LOAD)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)

    def save_start(self, path: Path) -> None:
        """Write clicks and corrections."""
        try:
            write_start(self.start, path)
            self.noted.emit(texts.SAVED_START.format(path=path))
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)

    def _push(self, start: TrackingStart, text: str) -> None:
        self.undo_stack.push(_Replace(self, start, text))

    def _lay(self) -> None:
        self.laid = None
        if self.model is None or self.format is None or self.next_click is not None:
            return
        try:
            self.laid = starting_points(self._request(), (self.format.width, self.format.height))[1]
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)

    # Tracking

    @property
    def is_behind(self) -> bool:
        """Whether clicks, corrections or units are not those of the track."""
        if self.track is None or self.model is None:
            return False
        request, mine = self.track.request, self._request()
        return (request.model is not mine.model or dict(request.clicks) != dict(mine.clicks)
                or _plain(request.corrections) != _plain(mine.corrections))  # fmt: skip

    @property
    def first_behind(self) -> int:
        """The first picture that the track shows otherwise than corrections now ask."""
        old, new = _plain(self.track.request.corrections), _plain(self.start.corrections)
        whole = dict(self.track.request.clicks) != dict(self.start.clicks) or self.track.request.model is not self.model
        return 0 if whole else min((f for f in {*old, *new} if old.get(f) != new.get(f)), default=0)

    @property
    def has_unsaved_track(self) -> bool:
        """Whether something was tracked that no capture holds."""
        return self.track is not None and self.track is not self.saved_track

    def run(self) -> None:
        """Track the film, from its beginning or from the first thing that changed."""
        if self.laid is None:
            self.failed.emit(texts.CLICKS_FIRST, "")
            return
        job = TrackJob(self._request(), self.track)
        self._jobs.start("track", texts.TRACKING, job, track, self._on_tracked)

    def _on_tracked(self, answer: tuple[Track, float]) -> None:
        self.track, rate = answer
        self.noted.emit(texts.DONE.format(n=len(self.track.points), rate=rate))
        self.changed.emit()

    def save(self, path: Path) -> None:
        """Write the track as a capture."""
        if self.track is None:
            self.failed.emit(texts.TRACK_FIRST, "")
            return
        written = self.track

        def applied(paths: list[Path]) -> None:
            self.saved_track, self.captures = written, paths
            self.noted.emit(texts.SAVED.format(files=", ".join(str(each) for each in paths)))
            self.changed.emit()
            self.saved.emit(paths)

        self._jobs.start("save", texts.SAVING, (written, path), save_capture, applied)

    def points(self, frame: int) -> np.ndarray | None:
        """Where the points are in a picture, shape (K, 2), pixels of the film; None where nothing is known."""
        if self.track is not None and frame < len(self.track.points) and not (frame == 0 and self.laid is not None):
            points = self.track.points[frame].copy()
        elif frame == 0 and self.laid is not None:
            return self.laid
        else:
            return None
        names = self.track.request.model.names
        for name, place in self.start.corrections.get(frame, {}).items():
            if name in names:
                points[names.index(name)] = place
        return points

    def _request(self) -> TrackingRequest:
        return TrackingRequest(self.video, self.model, self.start.clicks, self.start.corrections)


def _plain(corrections) -> dict[int, dict[str, tuple[float, float]]]:
    return {frame: dict(places) for frame, places in corrections.items() if places}


class _Replace(QUndoCommand):
    """Exchanges clicks and corrections as a whole."""

    def __init__(self, draft: TrackingDraft, start: TrackingStart, text: str) -> None:
        super().__init__(text)
        self._draft, self._before, self._after = draft, draft.start, start

    def redo(self) -> None:
        """Do it."""
        self._draft.show(self._after)

    def undo(self) -> None:
        """Take it back."""
        self._draft.show(self._before)
