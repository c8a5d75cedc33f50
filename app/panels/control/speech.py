"""What is said: the sound, its transcript, and what was said against either."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QMenu, QPlainTextEdit, QPushButton, QSizePolicy

from app import texts
from app.authoring import Authoring
from app.emotion_colours import emotion_colours
from app.icons import dot
from app.loading import SpeechRequest
from app.panels.control.section import Section, quiet_button
from app.panels.pane import ElidedLabel
from app.theme import theme
from core.document.change import Change
from core.speech.emotion import EMOTIONS

_TRANSCRIPT_PX = 72


class SpeechSection(Section):
    """Chooses speech and fits its transcript.

    speech_asked(), transcript_asked() : open a file of that kind
    transcript_edited() : what is written is, or is no longer, what was aligned
    """

    speech_asked = Signal()
    transcript_asked = Signal()
    transcript_edited = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.SPEECH)
        self._authoring = authoring
        self.choose = QPushButton(texts.CHOOSE_SPEECH, toolTip=f"{texts.OPEN_SPEECH} (Ctrl+O)")
        self.choose.setProperty("role", "choose")
        self.choose.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        menu = QMenu(self.choose)
        self.open_action = menu.addAction(texts.OPEN_SPEECH, lambda: self.speech_asked.emit())
        menu.addSeparator()
        self._demos = {emotion: menu.addAction(texts.DEMO_SENTENCE.format(emotion=emotion)) for emotion in EMOTIONS}
        for emotion, action in self._demos.items():
            action.triggered.connect(lambda _=False, name=f"demo-{emotion}": authoring.open_demo_sentence(name))
        self.choose.setMenu(menu)
        self.facts, self.warning = ElidedLabel(), ElidedLabel("warning")
        self.transcript = QPlainTextEdit(placeholderText=texts.TRANSCRIPT_HINT, toolTip=texts.TRANSCRIPT_TIP)
        self.transcript.setFixedHeight(_TRANSCRIPT_PX)
        self.transcript.setTabChangesFocus(True)
        self.transcript.textChanged.connect(self.on_transcript_edited)
        for widget in (self.choose, self.facts, self.transcript, self.warning):
            self.column.addWidget(widget)
        self.open_transcript_button = quiet_button(
            texts.OPEN_TRANSCRIPT, texts.OPEN_TRANSCRIPT_TIP, self.transcript_asked.emit
        )
        self.align_button = quiet_button(texts.ALIGN, texts.ALIGN_TIP, self.align)
        self.add_row(self.open_transcript_button, self.align_button)
        authoring.document.changed.connect(self.on_document_changed)
        emotion_colours.changed.connect(self.show_colours)
        self.show_colours()
        self.on_document_changed(Change.ALIGNMENT, None)

    def align(self, then_synthesise: bool = False) -> None:
        """Fit the transcript that is written here to the sound."""
        speech = self._authoring.document.speech
        if speech is not None:
            text = self.transcript.toPlainText().strip() or None
            self._authoring.load_speech(SpeechRequest(speech.audio, text), then_synthesise)

    @property
    def transcript_is_new(self) -> bool:
        """Whether the transcript differs from the aligned one."""
        speech = self._authoring.document.speech
        return speech is not None and self.transcript.toPlainText().strip() != speech.text.strip()

    def on_transcript_edited(self) -> None:
        """Offer to align what was written."""
        self.align_button.setEnabled(self.transcript_is_new)
        self.transcript_edited.emit()

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other speech."""
        if not change & Change.ALIGNMENT:
            return
        speech = self._authoring.document.speech
        path = None if speech is None else speech.audio.path
        # the style leaves a button with a menu no padding
        self.choose.setText("  " + (texts.CHOOSE_SPEECH if path is None else Path(path).name))
        facts = ""
        if speech is not None:
            facts = texts.SPEECH_FACTS.format(
                seconds=speech.audio.duration_s, rate_khz=speech.audio.rate_hz / 1000,
                phonemes=len(speech.transcript.phonemes),
            )  # fmt: skip
        self.facts.setText(facts)
        warnings = () if speech is None else speech.transcript.warnings
        self.warning.setVisible(bool(warnings))
        self.warning.setText("  ·  ".join(warnings))
        self.transcript.blockSignals(True)
        self.transcript.setPlainText("" if speech is None else speech.text)
        self.transcript.blockSignals(False)
        self.transcript.setEnabled(speech is not None)
        self.open_transcript_button.setEnabled(speech is not None)
        self.on_transcript_edited()

    def show_colours(self) -> None:
        """Give each demo sentence the colour of its emotion."""
        for emotion, action in self._demos.items():
            action.setIcon(dot(theme().emotion[emotion]))
