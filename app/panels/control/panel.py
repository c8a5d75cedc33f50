"""The control panel: its sections, and the button that starts it all."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QPushButton, QScrollArea, QVBoxLayout, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.control.cost import CostLines
from app.panels.control.database import DatabaseSection
from app.panels.control.emotion import EmotionSection
from app.panels.control.engine import EngineSection
from app.panels.control.face import FaceSection
from app.panels.control.speech import SpeechSection
from app.theme import STEP

WIDTH_PX = 272


class ControlPanel(QWidget):
    """Left: the wishes."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        self.setMinimumWidth(216)
        self.speech, self.emotion, self.face = (
            SpeechSection(authoring),
            EmotionSection(authoring),
            FaceSection(authoring),
        )
        self.database, self.engine, self.cost = (
            DatabaseSection(authoring),
            EngineSection(authoring),
            CostLines(authoring),
        )
        self.synthesise_button = QPushButton(texts.SYNTHESISE)
        self.synthesise_button.setProperty("role", "primary")
        self.synthesise_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.synthesise_button.clicked.connect(self.synthesise)
        self._arrange()
        self.speech.transcript_edited.connect(self.on_document_changed)
        authoring.document.changed.connect(self.on_document_changed)
        self.on_document_changed()

    def _arrange(self) -> None:
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        scroll = QScrollArea(widgetResizable=True, frameShape=QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inside, bottom = QWidget(objectName="scrolled"), QWidget()
        column = QVBoxLayout(inside)
        column.setContentsMargins(2 * STEP, STEP + 2, 2 * STEP, STEP)
        column.setSpacing(STEP)
        for section in (self.speech, self.emotion, self.face, self.database, self.engine):
            column.addWidget(section)
        column.addStretch(1)
        scroll.setWidget(inside)
        below = QVBoxLayout(bottom)
        below.setContentsMargins(2 * STEP, STEP, 2 * STEP, STEP + 4)
        below.setSpacing(STEP)
        below.addWidget(self.synthesise_button)
        below.addWidget(self.cost)
        outer.addWidget(scroll, 1)
        outer.addWidget(bottom)

    def synthesise(self) -> None:
        """Align first if the transcript was changed, then synthesise."""
        if self.speech.transcript_is_new:
            self.speech.align(then_synthesise=True)
        elif self._authoring.can_synthesise:
            self._authoring.synthesise()

    def on_document_changed(self, *_: object) -> None:
        """Say what is missing before anything can be synthesised."""
        document = self._authoring.document
        tip = f"{texts.SYNTHESISE} (Ctrl+Return)"
        if document.database is None:
            tip = texts.SYNTHESISE_NEEDS_DATABASE
        elif document.speech is None:
            tip = texts.SYNTHESISE_NEEDS_SPEECH
        self.synthesise_button.setEnabled(self._authoring.can_synthesise)
        self.synthesise_button.setToolTip(tip)
