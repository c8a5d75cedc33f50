"""The same pairs as a table, which the keyboard reaches: captured marker, what it is, how that was told."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QAbstractTableModel, QModelIndex, Qt, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from app.panels.importing.choice_delegate import ChoiceDelegate
from app.panels.importing.sentence_table import dress
from app.texts import importing as texts
from app.theme import colour, theme

_FOUND, _WANTED, _HOW, _AWAY = range(4)
_WIDTHS_PX = (0, 0, 84, 80)
WEAK = 0.5


class MatchModel(QAbstractTableModel):
    """Captured markers, those without a match first.

    asked(found, wanted) : the table was edited; wanted is "" where a pair is taken apart
    """

    asked = Signal(str, str)

    def __init__(self) -> None:
        super().__init__()
        self._found: list[str] = []
        self._all: tuple[str, ...] = ()
        self.wanted: tuple[str, ...] = ()
        self._pairs: Mapping[str, str] = {}
        self._how: Mapping[tuple[str, str], tuple[str, float, float]] = {}
        self.own = False

    def show_pairs(self, found: tuple[str, ...], wanted: tuple[str, ...], pairs: Mapping[str, str], how, own: bool):
        """Show other pairs; how : (found, wanted) to (told by, confidence, distance in mm)."""
        self.beginResetModel()
        self.own, self.wanted, self._pairs, self._how = own, wanted, dict(pairs), how
        self._found = sorted(found, key=lambda name: (own == (name not in pairs), found.index(name)))
        self.endResetModel()

    @property
    def none(self) -> str:
        """What stands for no match."""
        return texts.KEPT_AS_IS if self.own else texts.NOT_USED

    def found(self, row: int) -> str:
        """Return the captured marker of a row."""
        return self._found[row]

    def row_of(self, found: str) -> int:
        """Return the row of a captured marker."""
        return self._found.index(found)

    # Qt

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(self._found)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(texts.MATCH_COLUMNS)

    def headerData(self, section: int, orientation, role: int):
        """See Qt."""
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return (texts.MATCH_COLUMNS_OWN if self.own else texts.MATCH_COLUMNS)[section]
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.ToolTipRole:
            return texts.MATCH_COLUMN_TIPS[section]
        return None

    def flags(self, index: QModelIndex):
        """See Qt."""
        flags = super().flags(index)
        return flags | Qt.ItemFlag.ItemIsEditable if index.column() == _WANTED else flags

    def data(self, index: QModelIndex, role: int):
        """See Qt."""
        found = self._found[index.row()]
        wanted = self._pairs.get(found)
        how, sure, away_mm = self._how.get((found, wanted), ("hand", 1.0, float("nan")))
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            told = wanted is not None and not (self.own and how == "hand")
            return {
                _FOUND: found, _WANTED: wanted or self.none, _HOW: texts.HOW[how] if told else "",
                _AWAY: f"{away_mm:.1f} mm" if told and away_mm == away_mm else "",
            }[index.column()]  # fmt: skip
        if role == Qt.ItemDataRole.ForegroundRole:
            if wanted is None:
                return colour(theme().dim if self.own else theme().emotion["anger"])
            if sure < WEAK and index.column() == _HOW:
                return colour(theme().accent)
            return colour(theme().dim) if index.column() in (_HOW, _AWAY) else None
        return None

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Ask for another pair."""
        if role == Qt.ItemDataRole.EditRole:
            self.asked.emit(self._found[index.row()], "" if value == self.none else str(value))
        return role == Qt.ItemDataRole.EditRole


class MatchTable(QTableView):
    """chosen(found) : the current row is another."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.pairs = MatchModel()
        self.setModel(self.pairs)
        dress(self)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.DoubleClicked | QAbstractItemView.EditTrigger.EditKeyPressed)
        self._delegate = ChoiceDelegate(lambda _: [(QIcon(), n) for n in (self.pairs.none, *self.pairs.wanted)], self)
        self.setItemDelegateForColumn(_WANTED, self._delegate)
        header = self.horizontalHeader()
        header.setStretchLastSection(False)
        for column, width in enumerate(_WIDTHS_PX):
            header.setSectionResizeMode(
                column, QHeaderView.ResizeMode.Fixed if width else QHeaderView.ResizeMode.Stretch
            )
            if width:
                self.setColumnWidth(column, width)
        self.selectionModel().currentRowChanged.connect(self._on_row)

    def choose(self, found: str) -> None:
        """Go to a captured marker."""
        self.setCurrentIndex(self.pairs.index(self.pairs.row_of(found), _WANTED))

    def _on_row(self, index: QModelIndex, _before) -> None:
        if index.isValid():
            self.chosen.emit(self.pairs.found(index.row()))

    def keyPressEvent(self, event) -> None:
        """Delete takes a pair apart."""
        if event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace) and self.currentIndex().isValid():
            self.pairs.asked.emit(self.pairs.found(self.currentIndex().row()), "")
        else:
            super().keyPressEvent(event)
