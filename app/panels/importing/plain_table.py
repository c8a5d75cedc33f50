"""A table that is only read: rows of texts, each with a key, sorted as they come."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QAbstractTableModel, QModelIndex, Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from app.panels.importing.sentence_table import dress
from app.theme import colour, theme


class _Rows(QAbstractTableModel):
    def __init__(self, columns: Sequence[str], tips: Sequence[str]) -> None:
        super().__init__()
        self.columns, self.tips = tuple(columns), tuple(tips)
        self.rows: list[tuple[str, ...]] = []
        self.warned: set[int] = set()

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(self.rows)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(self.columns)

    def headerData(self, section: int, orientation, role: int):
        """See Qt."""
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return self.columns[section]
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.ToolTipRole and self.tips:
            return self.tips[section]
        return None

    def data(self, index: QModelIndex, role: int):
        """See Qt."""
        text = self.rows[index.row()][index.column()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            return text
        if role == Qt.ItemDataRole.ForegroundRole and index.row() in self.warned and index.column() > 0:
            return colour(theme().accent)
        return None


class PlainTable(QTableView):
    """chosen(row) : the current row is another."""

    chosen = Signal(int)

    def __init__(self, columns: Sequence[str], tips: Sequence[str] = (), widths_px: Sequence[int] = ()) -> None:
        super().__init__()
        self._rows = _Rows(columns, tips)
        self.setModel(self._rows)
        dress(self)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        header = self.horizontalHeader()
        header.setStretchLastSection(False)
        for column, width in enumerate(widths_px):
            mode = QHeaderView.ResizeMode.Interactive if width else QHeaderView.ResizeMode.Stretch
            header.setSectionResizeMode(column, mode)
            if width:
                self.setColumnWidth(column, width)
        self.selectionModel().currentRowChanged.connect(self._on_row)

    def _on_row(self, index: QModelIndex, _before) -> None:
        if index.isValid():
            self.chosen.emit(index.row())

    def show_rows(self, rows: Sequence[tuple[str, ...]], warned: Sequence[int] = ()) -> None:
        """Show other rows; none is chosen."""
        self._rows.beginResetModel()
        self._rows.rows, self._rows.warned = list(rows), set(warned)
        self._rows.endResetModel()

    def choose(self, row: int) -> None:
        """Go to a row."""
        if 0 <= row < len(self._rows.rows):
            self.setCurrentIndex(self._rows.index(row, 0))

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """What is shown."""
        return list(self._rows.rows)
