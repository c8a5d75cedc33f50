"""The figures below the faces: a row a measure, a column for who is held against whom."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QAbstractTableModel, QModelIndex, Qt
from PySide6.QtWidgets import QHeaderView, QTableView

from app.comparison_words import in_figures
from app.panels.importing.sentence_table import dress
from app.texts import compare as texts
from core.evaluation.side_by_side import CAPTURED, Agreement

_ROW_PX = 24


class _Model(QAbstractTableModel):
    def __init__(self) -> None:
        super().__init__()
        self.columns: tuple[str, ...] = ()
        self.agreements: tuple[Agreement, ...] = ()

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else len(texts.FIGURE_ROWS)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        """See Qt."""
        return 0 if parent is not None and parent.isValid() else 1 + len(self.columns)

    def headerData(self, section: int, orientation, role: int):
        """See Qt."""
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return "" if section == 0 else self.columns[section - 1]
        return None

    def data(self, index: QModelIndex, role: int):
        """See Qt."""
        measure = tuple(texts.FIGURE_ROWS)[index.row()]
        name, unit, tip = texts.FIGURE_ROWS[measure]
        if role == Qt.ItemDataRole.ToolTipRole:
            return tip
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        if index.column() == 0:
            return name
        return in_figures(getattr(self.agreements[index.column() - 1], measure), unit)


class FiguresTable(QTableView):
    """It is read, and can be reached by Tab."""

    def __init__(self) -> None:
        super().__init__()
        self._model = _Model()
        self.setModel(self._model)
        dress(self)
        self.verticalHeader().setDefaultSectionSize(_ROW_PX)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)

    def show_agreements(self, agreements: Sequence[Agreement], names: tuple[str, str]) -> None:
        """Show who agrees how well; ``names`` are those of A and B."""
        model = self._model
        model.beginResetModel()
        model.agreements = tuple(agreements)
        model.columns = tuple(
            texts.AGAINST.format(of=_short(found.of, names), standard=_short(found.standard, names))
            for found in agreements
        )
        model.endResetModel()
        header = self.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)

    @property
    def rows(self) -> dict[str, tuple[str, ...]]:
        """What is shown, by measure."""
        model = self._model
        return {
            measure: tuple(in_figures(getattr(found, measure), unit) for found in model.agreements)
            for measure, (_, unit, _) in texts.FIGURE_ROWS.items()
        }

    @property
    def columns(self) -> tuple[str, ...]:
        """Who is held against whom."""
        return self._model.columns


def _short(name: str, names: tuple[str, str]) -> str:
    if name == CAPTURED:
        return texts.CAPTURED_SHORT
    return (texts.ONE, texts.OTHER)[names.index(name)]
