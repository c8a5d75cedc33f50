"""What can be done with one utterance: type its phone, split, merge, pin, lock."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCompleter, QLineEdit, QMenu

from app import texts
from core.speech.phoneme import PHONEMES

if TYPE_CHECKING:
    from app.panels.timeline.timeline import Timeline

_LEAST_WIDTH_PX = 48


class PhonemeEditor(QLineEdit):
    """Sits on a phoneme while its name is typed; Return takes it, Escape leaves it."""

    def __init__(self, timeline: Timeline) -> None:
        super().__init__(timeline)
        self._timeline, self._slot = timeline, 0
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.setToolTip(texts.RENAME_TIP.format(phones=" ".join(PHONEMES)))
        completer = QCompleter(list(PHONEMES), self)
        completer.setCompletionMode(QCompleter.CompletionMode.InlineCompletion)
        self.setCompleter(completer)
        self.returnPressed.connect(self._take)
        self.hide()

    def open(self, slot: int) -> None:
        """Ask for the phone of ``slot``."""
        self._slot = slot
        box = self._timeline.slot_box(slot)
        width = max(box.width(), _LEAST_WIDTH_PX)
        left = min(max(box.center().x() - width / 2, 0), self._timeline.width() - width)
        self.setGeometry(round(left), round(box.top()), round(width), round(box.height()))
        self.setText(self._timeline.authoring.document.speech.transcript.phonemes[slot].phone)
        self.selectAll()
        self.show()
        self.setFocus()

    def _take(self) -> None:
        self.hide()
        self._timeline.setFocus()
        phone = self.text().strip().lower()
        self._timeline.authoring.rename_phoneme(self._slot, phone)

    def keyPressEvent(self, event) -> None:
        """Escape leaves it."""
        if event.key() == Qt.Key.Key_Escape:
            self.hide()
            self._timeline.setFocus()
        else:
            super().keyPressEvent(event)

    def focusOutEvent(self, event) -> None:
        """What was not taken is forgotten."""
        super().focusOutEvent(event)
        self.hide()


def phoneme_menu(timeline: Timeline, slot: int, time_s: float) -> QMenu:
    """Return the menu of an utterance; ``time_s`` is where it was asked for."""
    authoring = timeline.authoring
    document = authoring.document
    phonemes = document.speech.transcript.phonemes
    menu = QMenu(timeline)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    phone = phonemes[slot].phone
    menu.addAction(texts.RENAME_PHONEME.format(phone=phone), lambda: timeline.rename(slot))
    menu.addAction(texts.SPLIT_PHONEME.format(phone=phone), lambda: authoring.split_phoneme(slot, time_s))
    merge = menu.addAction(texts.MERGE_PHONEME, lambda: authoring.merge_phoneme(slot))
    merge.setEnabled(slot + 1 < len(phonemes))
    menu.addSeparator()
    span = authoring.view.span
    if span is None or not span[0] <= slot <= span[1]:
        authoring.view.select_slot(slot)
    menu.addAction(texts.ACTION_UNPIN, authoring.unpin).setEnabled(slot in document.pins)
    menu.addAction(texts.ACTION_LOCK, authoring.lock)
    menu.addAction(texts.ACTION_UNLOCK, authoring.unlock).setEnabled(slot in document.locks)
    return menu
