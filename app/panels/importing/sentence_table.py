"""The table of sentences: which files, what is said and felt, and what is wrong."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QSortFilterProxyModel, Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from app.icons import dot
from app.panels.importing.choice_delegate import ChoiceDelegate
from app.panels.importing.draft import ImportDraft
from app.texts import importing as texts
from app.theme import STEP, colour, theme
from core.importing.plan import SentencePlan
from core.speech.emotion import EMOTIONS

_NAME, _MOTION, _SOUND, _WORDS, _EMOTION, _RATE, _FRAMES, _PROBLEMS = range(8)
_WIDTHS_PX = (110, 120, 110, 160, 104, 64, 64, 0)
_SORTED = Qt.ItemDataRole.UserRole
_ROW_PX = 3 * STEP + 4


class SentenceModel(QAbstractTableModel):
    """The draft's sentences, one a row; words and emotion can be edited."""

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__()
        self._draft = draft
        self._rows: tuple[SentencePlan, ...] = ()

    def renew(self) -> None:
        """Show the draft as it is; rows keep their places, and with them the selection, while only cells change."""
        rows = self._draft.sentences
        if [s.name for s in rows] == [s.name for s in self._rows]:
            self._rows = rows
            if rows:
                self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, _PROBLEMS))
            return
        self.beginResetModel()
        self._rows = rows
        self.endResetModel()

    def sentence(self, row: int) -> SentencePlan:
        """Return what is planned for a row."""
        return self._rows[row]

    def problems(self, sentence: SentencePlan) -> tuple[list[str], bool]:
        """Return what is to be said of a sentence, and whether it cannot be imported."""
        facts = self._draft.facts.get(sentence.name)
        if facts is not None and facts.problem:
            # the row names the file already
            return [facts.problem.removeprefix(f"'{sentence.motion}' ")], True
        said = []
        if sentence.audio is None:
            said.append(texts.PROBLEM_NO_SOUND)
        elif sentence.transcript is None and not sentence.text:
            said.append(texts.PROBLEM_NO_WORDS)
        if facts is not None and facts.n_missing:
            share = facts.n_missing / max(facts.n_frames * len(facts.names), 1)
            said.append(texts.PROBLEM_MISSING.format(n=facts.n_missing, share=share))
        return said + list(facts.notes if facts is not None else ()), False

    # Qt

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(self._rows)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(texts.COLUMNS)

    def headerData(self, section: int, orientation, role: int):
        """See Qt."""
        if orientation == Qt.Orientation.Horizontal:
            if role == Qt.ItemDataRole.DisplayRole:
                return texts.COLUMNS[section]
            if role == Qt.ItemDataRole.ToolTipRole:
                return texts.COLUMN_TIPS[section]
        return None

    def flags(self, index: QModelIndex):
        """See Qt."""
        flags = super().flags(index)
        return flags | Qt.ItemFlag.ItemIsEditable if index.column() in (_WORDS, _EMOTION) else flags

    def data(self, index: QModelIndex, role: int):
        """See Qt."""
        sentence, column = self._rows[index.row()], index.column()
        if role in (Qt.ItemDataRole.DisplayRole, _SORTED):
            return self._cell(sentence, column, role == _SORTED)
        if role == Qt.ItemDataRole.EditRole:
            return sentence.text if column == _WORDS else sentence.emotion
        if role == Qt.ItemDataRole.DecorationRole and column == _EMOTION:
            return dot(theme().emotion[sentence.emotion])
        if role == Qt.ItemDataRole.ForegroundRole and column in (_MOTION, _SOUND, _RATE, _FRAMES):
            return colour(theme().dim)
        if role == Qt.ItemDataRole.ForegroundRole and column == _PROBLEMS:
            return colour(theme().emotion["anger"] if self.problems(sentence)[1] else theme().accent)
        if role == Qt.ItemDataRole.TextAlignmentRole and column in (_RATE, _FRAMES):
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if role == Qt.ItemDataRole.ToolTipRole:
            whole = {_MOTION: sentence.motion, _SOUND: sentence.audio, _WORDS: sentence.transcript or sentence.text}
            return "\n".join(self.problems(sentence)[0]) if column == _PROBLEMS else whole.get(column)
        return None

    def _cell(self, sentence: SentencePlan, column: int, sorting: bool):
        facts = self._draft.facts.get(sentence.name)
        known = facts is not None and not facts.problem
        if column == _RATE:
            return facts.rate_hz if known and sorting else texts.RATE.format(rate=facts.rate_hz) if known else ""
        if column == _FRAMES:
            return facts.n_frames if known else 0 if sorting else ""
        if column == _PROBLEMS:
            said, is_bad = self.problems(sentence)
            return f"{2 * is_bad + bool(said)}{said}" if sorting else " · ".join(said)
        return {
            _NAME: sentence.name, _EMOTION: sentence.emotion,
            _MOTION: Path(sentence.motion).name + (f" · {sentence.take}" if sentence.take else ""),
            _SOUND: Path(sentence.audio).name if sentence.audio else texts.NO_SOUND, _WORDS: _words(sentence),
        }[column]  # fmt: skip

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Change the plan by an edit."""
        if role != Qt.ItemDataRole.EditRole:
            return False
        name = self._rows[index.row()].name
        if index.column() == _EMOTION:
            self._draft.change_sentences([name], texts.EDIT_EMOTION, emotion=str(value))
        else:  # typed words replace the times of a file
            said = " ".join(str(value).split())
            if said != self._rows[index.row()].text:
                self._draft.change_sentences([name], texts.EDIT_WORDS, text=said, transcript=None)
        return True


def _words(sentence: SentencePlan) -> str:
    if sentence.text:
        return sentence.text
    if sentence.transcript:
        return texts.WORDS_FROM_FILE.format(file=Path(sentence.transcript).name)
    return texts.WORDS_RECOGNISED if sentence.audio else texts.WORDS_NONE


class SentenceTable(QTableView):
    """Many rows can be selected; keys 1 to 4 set their emotion, Delete leaves them out.

    emotion_asked(emotion), removal_asked() : for the selected rows
    """

    emotion_asked = Signal(str)
    removal_asked = Signal()

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__()
        self.sentences = SentenceModel(draft)
        self.sorted = QSortFilterProxyModel(self)
        self.sorted.setSourceModel(self.sentences)
        self.sorted.setSortRole(_SORTED)
        self.setModel(self.sorted)
        dress(self)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.DoubleClicked | QAbstractItemView.EditTrigger.EditKeyPressed)
        self.setSortingEnabled(True)
        self.horizontalHeader().setSortIndicator(-1, Qt.SortOrder.AscendingOrder)
        self.horizontalHeader().setSortIndicatorClearable(True)
        for column, width in enumerate(_WIDTHS_PX):
            if width:
                self.setColumnWidth(column, width)
        self._emotions = ChoiceDelegate(lambda _: [(dot(theme().emotion[e]), e) for e in EMOTIONS], self)
        self.setItemDelegateForColumn(_EMOTION, self._emotions)

    @property
    def chosen(self) -> list[str]:
        """Names of the selected sentences."""
        rows = {self.sorted.mapToSource(index).row() for index in self.selectionModel().selectedRows()}
        return [self.sentences.sentence(row).name for row in sorted(rows)]

    def keyPressEvent(self, event) -> None:
        """Set emotions, leave out, or move on."""
        number = event.key() - Qt.Key.Key_1
        if event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier):
            if 0 <= number < len(EMOTIONS):
                self.emotion_asked.emit(EMOTIONS[number])
                return
            if event.key() == Qt.Key.Key_Delete:
                self.removal_asked.emit()
                return
        super().keyPressEvent(event)


def dress(table: QTableView) -> None:
    """Give a table the workstation's looks: whole rows, thin lines, no grid; Tab leaves it."""
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    table.setShowGrid(False)
    table.setWordWrap(False)
    table.setTabKeyNavigation(False)
    table.setCornerButtonEnabled(False)
    table.verticalHeader().hide()
    table.verticalHeader().setDefaultSectionSize(_ROW_PX)
    table.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
    header = table.horizontalHeader()
    header.setStretchLastSection(True)
    header.setHighlightSections(False)
    header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
    header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    table.setStyleSheet(table_style())


def table_style() -> str:
    """Return the style sheet of a table in the theme in use."""
    t = theme()
    return (
        f"QTableView {{ background: {t.canvas}; border: 1px solid {t.line}; border-radius: 4px; outline: none;"
        f" selection-background-color: {t.line}; selection-color: {t.text}; }}"
        f"QTableView:focus {{ border-color: {t.dim}; }}"
        f"QTableView::item {{ padding: 0 6px; border: none; }}"
        f"QTableView::item:selected {{ background: {t.line}; }}"
        f"QHeaderView {{ background: {t.canvas}; }}"
        f"QHeaderView::section {{ background: {t.canvas}; color: {t.dim}; border: none;"
        f" border-bottom: 1px solid {t.line}; padding: 5px 6px; }}"
    )
