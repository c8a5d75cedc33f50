"""On which face."""

from __future__ import annotations

import re
from pathlib import Path

from PySide6.QtCore import Signal

from app import texts
from app.authoring import Authoring
from app.panels.control.section import Section, combo_box
from core.document.change import Change
from core.document.document import FaceChoice
from core.face.characters import CHARACTERS

_OPEN = "open"
_FACES = (
    *((re.split("[;:]", character.description)[0], FaceChoice(name)) for name, character in CHARACTERS.items()),
    (texts.FACE_NONE, None),
    (texts.OPEN_FACE, _OPEN),
)


class FaceSection(Section):
    """Chooses a bundled face, or markers alone.

    face_asked() : open a file of a face
    """

    face_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.FACE)
        self._authoring = authoring
        self.chosen = combo_box(texts.FACE_TIP)
        for text, data in _FACES:
            self.chosen.addItem(text, data)
        self.chosen.activated.connect(self.on_chosen)
        self.column.addWidget(self.chosen)
        authoring.document.changed.connect(self.on_document_changed)
        self._show()

    def on_chosen(self, row: int) -> None:
        """Show another face, or ask for a file."""
        what = self.chosen.itemData(row)
        self._show()  # until it is known to fit
        if what == _OPEN:
            self.face_asked.emit()
        else:
            self._authoring.set_face(what)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show another choice."""
        if change & Change.FACE:
            self._show()

    def _show(self) -> None:
        face = self._authoring.document.face
        while self.chosen.count() > len(_FACES):
            self.chosen.removeItem(0)
        if face not in [data for _, data in _FACES]:
            self.chosen.insertItem(0, Path(face.name).name, face)
        rows = [row for row in range(self.chosen.count()) if self.chosen.itemData(row) == face]
        self.chosen.setCurrentIndex(rows[0])
