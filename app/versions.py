"""Named versions of the open project: kept, listed, gone back to, and held against each other with one key."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, Signal

from app import texts
from app.editing import new_gesture
from app.project_keeper import ProjectKeeper
from core.document.content import ProjectContent, View
from core.document.edits import RestoreVersion
from core.errors import UserFacingError


class Versions(QObject):
    """What can be done with named versions; `pair` are the two that the A/B key goes between.

    changed() : there are others, or another project is open
    """

    changed = Signal()

    def __init__(self, keeper: ProjectKeeper, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._keeper, self._authoring = keeper, keeper.authoring
        self.pair: tuple[str, str] | None = None
        self._gesture = new_gesture()
        keeper.opened.connect(self._on_opened)

    def names(self) -> list[str]:
        """Return the versions of the open project, oldest first."""
        if self._keeper.file is None:
            return []
        return [version.name for version in self._keeper.ask(lambda file: file.versions())]

    def keep(self, name: str) -> None:
        """Give what is on show a name."""

        def kept() -> None:
            self._keeper.save_now()
            self._keeper.ask(lambda file: file.save_version(name))

        if self._keeper.file is not None and self._attempt(kept):
            self._pair_with(name.strip())
            self._authoring.noted.emit(texts.VERSION_KEPT.format(name=name.strip()))
            self.changed.emit()

    def forget(self, name: str) -> None:
        """Drop a version; what is on show stays."""
        if self._attempt(lambda: self._keeper.ask(lambda file: file.forget_version(name))):
            self.pair = None if self.pair is not None and name in self.pair else self.pair
            self.changed.emit()

    def switch(self, name: str, gesture: int | None = None) -> None:
        """Make the project what it was in a version; it undoes."""
        ask, document = self._keeper.ask, self._authoring.document

        def restore() -> None:
            content = ask(lambda file: file.version(name))
            speech = document.speech
            same_sound = (
                speech is not None and content.sound is not None and speech.audio.digest == content.sound.digest
            )
            audio = speech.audio if same_sound else ask(lambda file: file.audio(content))
            same_database = document.database_reference == content.database
            state = content.state(audio, document.database if same_database else None)
            if same_sound and (content.transcript, content.text) == (speech.transcript, speech.text):
                state = replace(state, speech=speech)
            self._authoring.push(RestoreVersion.on(document, state, name, gesture))
            if not same_database:
                self._keeper.find_database(content)
            self._authoring.synthesise()

        if self._attempt(restore):
            self._pair_with(name)

    def toggle(self) -> None:
        """Go to the other of two versions; what is on show is kept as one first, if it is neither."""
        names = self.names()
        if not names:
            self._authoring.noted.emit(texts.NO_VERSION_YET)
            return
        shown = next((name for name in reversed(names) if self._shows(name)), None)
        if shown is None:
            before = names[-1] if names[-1] != texts.WORKING_VERSION or len(names) == 1 else names[-2]
            self.keep(texts.WORKING_VERSION)
            self.pair, shown = (before, texts.WORKING_VERSION), texts.WORKING_VERSION
        if self.pair is None or shown not in self.pair or self.pair[0] == self.pair[1]:
            others = [name for name in names if name != shown]
            if not others:
                self._authoring.noted.emit(texts.ONE_VERSION_ONLY)
                return
            self.pair = others[-1], shown
        self.switch(self.pair[0] if shown == self.pair[1] else self.pair[1], self._gesture)

    def _shows(self, name: str) -> bool:
        try:
            then = self._keeper.ask(lambda file: file.version(name))
        except UserFacingError:
            return False
        now = ProjectContent.of(self._authoring.document)
        bare = {"view": View(), "others": {}, "tied": {}}
        return replace(then, **bare).to_json() == replace(now, **bare).to_json()

    def _pair_with(self, name: str) -> None:
        if self.pair is None or name not in self.pair:
            others = [other for other in self.names() if other != name]
            last = self.pair[1] if self.pair is not None else (others[-1] if others else name)
            self.pair = last, name

    def _on_opened(self) -> None:
        self.pair = None
        self.changed.emit()

    def _attempt(self, do) -> bool:
        try:
            do()
        except UserFacingError as error:
            self._authoring.failed.emit(error.message, error.remedy)
            return False
        return True
