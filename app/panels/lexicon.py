"""The lexicon: how names and coined words are said."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
)

from app import texts
from app.jobs import JobRunner
from app.loading import lexicon_path
from app.panels.pane import label
from app.theme import STEP
from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.progress import Progress
from core.speech.aligner import said_as
from core.speech.lexicon import parse_lexicon
from core.speech.phoneme import PHONEMES

_SIZE_PX = (480, 420)
_CHECK_AFTER_MS = 300


class LexiconDialog(QDialog):
    """A text of lines ``word phone phone …``, checked while it is written; the next alignment knows the words."""

    def __init__(self, jobs: JobRunner, parent=None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self.setWindowTitle(texts.LEXICON_TITLE)
        self.resize(*_SIZE_PX)
        column = QVBoxLayout(self)
        column.setContentsMargins(2 * STEP, 2 * STEP, 2 * STEP, 2 * STEP)
        column.setSpacing(STEP)
        hint = label(texts.LEXICON_HINT, "small", " ".join(PHONEMES))
        hint.setWordWrap(True)
        column.addWidget(hint)
        row = QHBoxLayout()
        self.word = QLineEdit(placeholderText=texts.LEXICON_WORD)
        self.add_button = QPushButton(texts.LEXICON_ADD, toolTip=texts.LEXICON_ADD_TIP)
        self.add_button.setAutoDefault(False)
        row.addWidget(self.word, 1)
        row.addWidget(self.add_button)
        column.addLayout(row)
        self.lines = QPlainTextEdit()
        column.addWidget(self.lines, 1)
        self.message = label("", "warning")
        self.message.setWordWrap(True)
        column.addWidget(self.message)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.close)
        column.addWidget(buttons)
        self._soon = QTimer(self, singleShot=True, interval=_CHECK_AFTER_MS)
        self._soon.timeout.connect(self.keep)
        self.lines.textChanged.connect(self._soon.start)
        self.add_button.clicked.connect(self.add_word)
        self.word.returnPressed.connect(self.add_word)

    def open_now(self) -> None:
        """Show what is kept."""
        try:
            kept = lexicon_path().read_text(encoding="utf-8") if lexicon_path().is_file() else ""
        except (OSError, ValueError):
            kept = ""
            self.message.setText(texts.LEXICON_UNREADABLE.format(path=lexicon_path()))
        self.lines.blockSignals(True)
        self.lines.setPlainText(kept)
        self.lines.blockSignals(False)
        self.show()
        self.raise_()
        self.word.setFocus()

    def add_word(self) -> None:
        """Write a line for a word, as it would be guessed, to be put right."""
        word = self.word.text().strip()
        if word and " " not in word:
            self._jobs.start("pronounce", texts.LEXICON_GUESSING, word, _guessed, self._append)

    def _append(self, line: str) -> None:
        self.word.clear()
        self.lines.appendPlainText(line)

    def keep(self) -> None:
        """Keep the lines if all of them are sound; else say which is not, and keep what was sound before."""
        text = self.lines.toPlainText()
        try:
            parse_lexicon(text, texts.LEXICON_TITLE)
            lexicon_path().parent.mkdir(parents=True, exist_ok=True)
            with swapped_in(lexicon_path()) as beside:
                beside.write_text(text, encoding="utf-8")
        except UserFacingError as error:
            self.message.setText(str(error))
            return
        except OSError as error:
            self.message.setText(f"{lexicon_path()}: {error.strerror}")
            return
        self.message.setText("")

    def hideEvent(self, event) -> None:
        """Keep what was just written."""
        if self._soon.isActive():
            self._soon.stop()
            self.keep()
        super().hideEvent(event)


def _guessed(word: str, _progress: Progress) -> str:
    return f"{word} {' '.join(said_as(word))}"
