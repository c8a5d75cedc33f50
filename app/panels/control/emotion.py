"""How all of it feels; what is painted over parts of it is the timeline's."""

from __future__ import annotations

from PySide6.QtCore import Signal

from app import texts
from app.authoring import Authoring, whole_emotion
from app.emotion_colours import emotion_colours
from app.icons import dot
from app.panels.control.section import Section, combo_box, quiet_button
from app.theme import theme
from core.document.change import Change
from core.speech.emotion import EMOTIONS


class EmotionSection(Section):
    """Chooses one emotion for the whole sentence.

    emotions_asked() : open a file of emotions
    """

    emotions_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.EMOTION)
        self._authoring = authoring
        self.chosen = combo_box(texts.EMOTION_TIP)
        for emotion in EMOTIONS:
            self.chosen.addItem(emotion, emotion)
        self.chosen.activated.connect(self.on_chosen)
        self.column.addWidget(self.chosen)
        self.open_button = quiet_button(texts.OPEN_SHORT, texts.OPEN_EMOTIONS_TIP, self.emotions_asked.emit)
        self.title_row.addWidget(self.open_button)
        authoring.document.changed.connect(self.on_document_changed)
        emotion_colours.changed.connect(self.show_colours)
        self.show_colours()
        self._show()

    def on_chosen(self, row: int) -> None:
        """Set the emotion of the whole sentence."""
        emotion = self.chosen.itemData(row)
        if emotion is not None:
            label_text = texts.EDIT_SET_EMOTION.format(emotion=emotion)
            self._authoring.set_emotion(whole_emotion(emotion), label_text)
        self._show()

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other emotions."""
        if change & (Change.EMOTIONS | Change.ALIGNMENT):
            self._show()

    def show_colours(self) -> None:
        """Give each emotion its colour."""
        for row, emotion in enumerate(EMOTIONS):
            self.chosen.setItemIcon(row, dot(theme().emotion[emotion]))

    def _show(self) -> None:
        modifiers = self._authoring.document.modifiers
        if self.chosen.count() > len(EMOTIONS):
            self.chosen.removeItem(len(EMOTIONS))
        shown = next((e for e in EMOTIONS if whole_emotion(e) == modifiers), None)
        if shown is None:
            self.chosen.addItem(texts.EMOTION_MIXED, None)
            self.chosen.setCurrentIndex(len(EMOTIONS))
        else:
            self.chosen.setCurrentIndex(EMOTIONS.index(shown))
