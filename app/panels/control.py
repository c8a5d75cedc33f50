"""The control panel: what is said, how it feels, on which face, from which motion; and the button that starts it."""

from __future__ import annotations

import re
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPlainTextEdit,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app import texts
from app.authoring import Authoring, whole_emotion
from app.icons import dot
from app.loading import SpeechRequest
from app.panels.pane import ElidedLabel, label
from app.panels.polish import PolishPage
from app.panels.weights import WeightsPage
from app.theme import STEP, theme
from core.document.change import Change
from core.document.document import FaceChoice
from core.face.characters import CHARACTERS
from core.speech.emotion import EMOTIONS

WIDTH_PX = 272
_TRANSCRIPT_PX = 72
_OPEN = "open"
_FACES = (
    *((re.split("[;:]", character.description)[0], FaceChoice(name)) for name, character in CHARACTERS.items()),
    (texts.FACE_NONE, None),
    (texts.OPEN_FACE, _OPEN),
)


class ControlPanel(QWidget):
    """Left: the wishes.

    speech_asked(), transcript_asked(), emotions_asked(), face_asked(), database_asked() : open a file of that kind
    """

    speech_asked = Signal()
    transcript_asked = Signal()
    emotions_asked = Signal()
    face_asked = Signal()
    database_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        self.setMinimumWidth(216)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        scroll = QScrollArea(widgetResizable=True, frameShape=QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inside = QWidget(objectName="scrolled")
        self._column = QVBoxLayout(inside)
        self._column.setContentsMargins(2 * STEP, STEP + 2, 2 * STEP, STEP)
        self._column.setSpacing(STEP)
        self._make_speech()
        self._make_emotion()
        self._make_face()
        self._make_database()
        self._make_engine()
        self._column.addStretch(1)
        scroll.setWidget(inside)
        outer.addWidget(scroll, 1)
        outer.addWidget(self._made_bottom())
        authoring.document.changed.connect(self.on_document_changed)
        authoring.view.slot_selected.connect(self._show_cost)
        authoring.backend_changed.connect(self.on_backend_changed)
        everything = Change.ALIGNMENT | Change.EMOTIONS | Change.FACE | Change.NODES | Change.PATH
        self.on_document_changed(everything, None)

    # What the animator asks

    def synthesise(self) -> None:
        """Align first if the transcript was changed, then synthesise."""
        if self.transcript_is_new:
            self.align(then_synthesise=True)
        elif self._authoring.can_synthesise:
            self._authoring.synthesise()

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

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show what the document says."""
        if change & Change.ALIGNMENT:
            self._show_speech()
        if change & (Change.EMOTIONS | Change.ALIGNMENT):
            self._show_emotion()
        if change & Change.FACE:
            self._show_face()
        if change & Change.NODES:
            self._show_database()
        self._show_cost()
        self._show_readiness()

    def on_backend_changed(self, name: str, sentence: str) -> None:
        """Show which backend computes."""
        self.engine.setText(texts.ENGINE_FACTS.format(backend=name))
        self.engine.setToolTip(texts.ENGINE_TIP.format(sentence=sentence))

    def on_transcript_edited(self) -> None:
        """Offer to align what was written."""
        self._show_readiness()

    def on_emotion_chosen(self, row: int) -> None:
        """Set the emotion of the whole sentence."""
        emotion = self.emotion.itemData(row)
        if emotion is not None:
            label_text = texts.EDIT_SET_EMOTION.format(emotion=emotion)
            self._authoring.set_emotion(whole_emotion(emotion), label_text)
        self._show_emotion()

    def on_face_chosen(self, row: int) -> None:
        """Show another face, or ask for a file."""
        what = self.face.itemData(row)
        if what == _OPEN:
            self._show_face()
            self.face_asked.emit()
        else:
            self._show_face()  # until it is known to fit
            self._authoring.set_face(what)

    # Making

    def _title(self, text: str) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(0, STEP, 0, 0)
        row.addWidget(label(text, "title"), 1)
        self._column.addLayout(row)
        return row

    def _quiet(self, text: str, tip: str, asked) -> QPushButton:
        button = QPushButton(text, toolTip=tip)
        button.setProperty("role", "quiet")
        button.clicked.connect(lambda: asked())
        return button

    def _make_speech(self) -> None:
        self._title(texts.SPEECH)
        self.speech = QPushButton(texts.CHOOSE_SPEECH, toolTip=f"{texts.OPEN_SPEECH} (Ctrl+O)")
        self.speech.setProperty("role", "choose")
        self.speech.setSizePolicy(self.sizePolicy().Policy.Ignored, self.sizePolicy().Policy.Fixed)
        self.speech_menu = QMenu(self.speech)
        self.open_speech_action = self.speech_menu.addAction(texts.OPEN_SPEECH, lambda: self.speech_asked.emit())
        self.speech_menu.addSeparator()
        for emotion in EMOTIONS:
            name = f"demo-{emotion}"
            self.speech_menu.addAction(
                dot(theme().emotion[emotion]), texts.DEMO_SENTENCE.format(emotion=emotion),
                lambda name=name: self._authoring.open_demo_sentence(name),
            )  # fmt: skip
        self.speech.setMenu(self.speech_menu)
        self._column.addWidget(self.speech)
        self.speech_facts = ElidedLabel()
        self._column.addWidget(self.speech_facts)
        self.transcript = QPlainTextEdit(placeholderText=texts.TRANSCRIPT_HINT, toolTip=texts.TRANSCRIPT_TIP)
        self.transcript.setFixedHeight(_TRANSCRIPT_PX)
        self.transcript.setTabChangesFocus(True)
        self.transcript.textChanged.connect(self.on_transcript_edited)
        self._column.addWidget(self.transcript)
        self.speech_warning = ElidedLabel("warning")
        self._column.addWidget(self.speech_warning)
        row = QHBoxLayout()
        self.align_button = self._quiet(texts.ALIGN, texts.ALIGN_TIP, self.align)
        self.open_transcript_button = self._quiet(
            texts.OPEN_TRANSCRIPT, texts.OPEN_TRANSCRIPT_TIP, self.transcript_asked.emit
        )
        row.addWidget(self.open_transcript_button)
        row.addStretch(1)
        row.addWidget(self.align_button)
        self._column.addLayout(row)

    def _make_emotion(self) -> None:
        self._title(texts.EMOTION)
        self.emotion = _combo(texts.EMOTION_TIP)
        for emotion in EMOTIONS:
            self.emotion.addItem(dot(theme().emotion[emotion]), emotion, emotion)
        self.emotion.activated.connect(self.on_emotion_chosen)
        self._column.addWidget(self.emotion)
        row = QHBoxLayout()
        self.open_emotions_button = self._quiet(texts.OPEN_EMOTIONS, texts.OPEN_EMOTIONS_TIP, self.emotions_asked.emit)
        row.addWidget(self.open_emotions_button)
        row.addStretch(1)
        self._column.addLayout(row)

    def _make_face(self) -> None:
        self._title(texts.FACE)
        self.face = _combo(texts.FACE_TIP)
        for text, data in _FACES:
            self.face.addItem(text, data)
        self.face.activated.connect(self.on_face_chosen)
        self._column.addWidget(self.face)

    def _make_database(self) -> None:
        row = self._title(texts.DATABASE)
        self.badge = label(texts.SYNTHETIC, "badge", texts.SYNTHETIC_TIP)
        row.addWidget(self.badge)
        self.database = ElidedLabel("plain")
        self._column.addWidget(self.database)
        self.database_facts = label()
        self._column.addWidget(self.database_facts)
        row = QHBoxLayout()
        self.open_database_button = self._quiet(texts.OPEN_DATABASE, "", self.database_asked.emit)
        row.addWidget(self.open_database_button)
        row.addStretch(1)
        self._column.addLayout(row)

    def _make_engine(self) -> None:
        self._title(texts.ENGINE)
        self._column.addWidget(QLabel(texts.ENGINE_NAME))
        self.engine = label(texts.BACKEND_WAITING)
        self.engine.setWordWrap(True)
        self._column.addWidget(self.engine)
        self.weights = WeightsPage(self._authoring)
        self._column.addWidget(self.weights)
        self.polish = PolishPage(self._authoring)
        self._column.addWidget(self.polish)

    def _made_bottom(self) -> QWidget:
        bottom = QWidget()
        column = QVBoxLayout(bottom)
        column.setContentsMargins(2 * STEP, STEP, 2 * STEP, STEP + 4)
        column.setSpacing(STEP)
        self.synthesise_button = QPushButton(texts.SYNTHESISE)
        self.synthesise_button.setProperty("role", "primary")
        self.synthesise_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.synthesise_button.clicked.connect(self.synthesise)
        column.addWidget(self.synthesise_button)
        self.cost = label("", "plain", texts.COST_TIP)
        self.slot_cost = label("", "small", texts.COST_SLOT_TIP)
        self.slot_cost.setMinimumHeight(4 * STEP)
        column.addWidget(self.cost)
        column.addWidget(self.slot_cost)
        return bottom

    # Showing

    def _show_speech(self) -> None:
        speech = self._authoring.document.speech
        path = None if speech is None else speech.audio.path
        # the style leaves a button with a menu no padding
        self.speech.setText("  " + (texts.CHOOSE_SPEECH if path is None else Path(path).name))
        facts = ""
        if speech is not None:
            facts = texts.SPEECH_FACTS.format(
                seconds=speech.audio.duration_s, rate_khz=speech.audio.rate_hz / 1000,
                phonemes=len(speech.transcript.phonemes),
            )  # fmt: skip
        self.speech_facts.setText(facts)
        warnings = () if speech is None else speech.transcript.warnings
        self.speech_warning.setVisible(bool(warnings))
        self.speech_warning.setText("  ·  ".join(warnings))
        self.transcript.blockSignals(True)
        self.transcript.setPlainText("" if speech is None else speech.text)
        self.transcript.blockSignals(False)
        self.transcript.setEnabled(speech is not None)
        self.open_transcript_button.setEnabled(speech is not None)

    def _show_emotion(self) -> None:
        modifiers = self._authoring.document.modifiers
        if self.emotion.count() > len(EMOTIONS):
            self.emotion.removeItem(len(EMOTIONS))
        shown = next((e for e in EMOTIONS if whole_emotion(e) == modifiers), None)
        if shown is None:
            self.emotion.addItem(texts.EMOTION_MIXED, None)
            self.emotion.setCurrentIndex(len(EMOTIONS))
        else:
            self.emotion.setCurrentIndex(EMOTIONS.index(shown))

    def _show_face(self) -> None:
        face = self._authoring.document.face
        while self.face.count() > len(_FACES):
            self.face.removeItem(0)
        if face not in [data for _, data in _FACES]:
            self.face.insertItem(0, Path(face.name).name, face)
        rows = [row for row in range(self.face.count()) if self.face.itemData(row) == face]
        self.face.setCurrentIndex(rows[0])

    def _show_database(self) -> None:
        database = self._authoring.document.database
        self.badge.setVisible(database is not None and database.synthetic)
        self.database_facts.setVisible(database is not None)
        self.database.setText(texts.NO_DATABASE if database is None else database.name)
        if database is not None:
            self.database_facts.setText(texts.DATABASE_FACTS.format(
                sentences=len(database.sentences), nodes=len(database.nodes), frames=len(database.frames),
                markers=len(database.markers), rate=database.rate_hz,
            ))  # fmt: skip
            self.database_facts.setToolTip(texts.DATABASE_TIP.format(
                coverage=database.pca.coverage, dims=database.pca.n_dims, path=database.path or ""
            ))  # fmt: skip

    def _show_cost(self) -> None:
        document, slot = self._authoring.document, self._authoring.view.slot
        if document.answer is None or document.database is None:
            self.cost.setText("")
            self.slot_cost.setText("")
            return
        path, unit = document.answer.path, (document.weights or document.database.weights).pnt
        self.cost.setText((texts.COST_PROVED if path.is_optimal else texts.COST).format(cost=path.cost / unit))
        if slot is None or slot >= len(path.nodes):
            self.slot_cost.setText("")
            return
        terms = path.observation[slot] / unit, path.transition[slot] / unit, path.emotion[slot] / unit
        self.slot_cost.setText(texts.COST_SLOT.format(
            phone=document.speech.transcript.phonemes[slot].phone, node=document.database.nodes.name(path.nodes[slot]),
            cost=sum(terms), observation=terms[0], transition=terms[1], emotion=terms[2],
        ))  # fmt: skip

    def _show_readiness(self) -> None:
        document = self._authoring.document
        tip = f"{texts.SYNTHESISE} (Ctrl+Return)"
        if document.database is None:
            tip = texts.SYNTHESISE_NEEDS_DATABASE
        elif document.speech is None:
            tip = texts.SYNTHESISE_NEEDS_SPEECH
        self.synthesise_button.setEnabled(self._authoring.can_synthesise)
        self.synthesise_button.setToolTip(tip)
        self.align_button.setEnabled(self.transcript_is_new)


def _combo(tip: str) -> QComboBox:
    """Make a list that is as wide as the panel, however long its longest entry is."""
    combo = QComboBox(toolTip=tip, minimumContentsLength=1)
    combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    return combo
