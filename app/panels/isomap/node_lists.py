"""Lists of motion nodes beside the map: the suspects, and the removed ones."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QAbstractListModel, QModelIndex, Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QLabel, QListView, QVBoxLayout, QWidget

from app import texts
from app.theme import STEP, colour, small_font, theme
from core.motion.curation import Removal
from core.motion.database import MotionDatabase
from core.motion.node import NodeTable
from core.suspicion.ranking import Suspicion


class _Rows(QAbstractListModel):
    """Rows of text with a tooltip, some of them dim; each stands for a node."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.rows: list[tuple[int | None, str, str]] = []
        self.dim: frozenset[int] = frozenset()

    def show_rows(self, rows: list[tuple[int | None, str, str]]) -> None:
        """Show other rows: node (None if the database does not have it), text, tooltip."""
        self.beginResetModel()
        self.rows = rows
        self.endResetModel()

    def show_dim(self, nodes: frozenset[int]) -> None:
        """Show these nodes dim."""
        self.dim = nodes
        if self.rows:
            self.dataChanged.emit(self.index(0), self.index(len(self.rows) - 1))

    def rowCount(self, _parent: QModelIndex | None = None) -> int:
        """See `QAbstractListModel`."""
        return len(self.rows)

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """See `QAbstractListModel`."""
        node, text, tip = self.rows[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return text
        if role == Qt.ItemDataRole.ToolTipRole:
            return tip
        if role == Qt.ItemDataRole.ForegroundRole and node in self.dim:
            return colour(theme().dim, 0.6)
        return None


class NodeList(QWidget):
    """A list with a line above it that says what it is, or what to do while it is empty.

    chosen(row) : a node of the database was clicked or stepped to; activated(row) : Enter or double click
    removal_asked() : Delete
    """

    chosen = Signal(int)
    activated = Signal(int)
    removal_asked = Signal()
    play_asked = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(STEP // 2, 0, 0, 0)
        column.setSpacing(STEP // 2)
        self.heading = QLabel()
        self.heading.setProperty("role", "small")
        self.heading.setWordWrap(True)
        column.addWidget(self.heading)
        self._rows = _Rows(self)
        self.view = _KeyedList(self)
        self.view.setModel(self._rows)
        column.addWidget(self.view, 1)
        self.view.clicked.connect(self._say_chosen)
        self.view.activated.connect(self._on_activated)

    @property
    def nodes(self) -> list[int | None]:
        """Rows of the database's nodes, as listed."""
        return [node for node, _, _ in self._rows.rows]

    @property
    def node_texts(self) -> list[str]:
        """What the list says of them."""
        return [text for _, text, _ in self._rows.rows]

    @property
    def current(self) -> int | None:
        """The node that is chosen."""
        index = self.view.currentIndex()
        return self._rows.rows[index.row()][0] if index.isValid() else None

    def step(self, by: int, skipped: frozenset[int] = frozenset()) -> None:
        """Choose the next node (or the previous) that is not ``skipped``; the first one when none is chosen."""
        at = (
            self.view.currentIndex().row()
            if self.view.currentIndex().isValid()
            else (-1 if by > 0 else len(self.nodes))
        )
        at += by
        while 0 <= at < len(self.nodes) and self.nodes[at] in skipped:
            at += by
        if 0 <= at < len(self.nodes):
            self.view.setCurrentIndex(self._rows.index(at))
            self._say_chosen(self._rows.index(at))

    def _say_chosen(self, index: QModelIndex) -> None:
        node = self._rows.rows[index.row()][0]
        if node is not None:
            self.chosen.emit(node)

    def _on_activated(self, index: QModelIndex) -> None:
        node = self._rows.rows[index.row()][0]
        if node is not None:
            self.activated.emit(node)


class _KeyedList(QListView):
    """A list that steps by arrows, and lends N, Space and Delete to the map."""

    def __init__(self, owner: NodeList) -> None:
        super().__init__()
        self._owner = owner
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setUniformItemSizes(True)
        self.setFrameShape(QListView.Shape.NoFrame)
        self.setFont(small_font())

    def event(self, event) -> bool:
        """Keep Space and Delete from the menus."""
        if event.type() == event.Type.ShortcutOverride and event.key() in (
            Qt.Key.Key_Space, Qt.Key.Key_Delete, Qt.Key.Key_N, Qt.Key.Key_Return, Qt.Key.Key_Enter,
        ):  # fmt: skip
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event) -> None:
        """Step, play, ask to remove."""
        owner, key = self._owner, event.key()
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            owner.step(-1 if key == Qt.Key.Key_Up else 1)
        elif key == Qt.Key.Key_N:
            owner.step(-1 if shift else 1, owner._rows.dim)
        elif key == Qt.Key.Key_Space:
            owner.play_asked.emit(shift)
        elif key == Qt.Key.Key_Delete:
            owner.removal_asked.emit()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.currentIndex().isValid():
            owner._on_activated(self.currentIndex())
        else:
            super().keyPressEvent(event)


class SuspectList(NodeList):
    """Nodes that look contaminated, worst first; removed ones stay in it, dim."""

    def __init__(self) -> None:
        super().__init__()
        self.heading.setText(texts.SUSPECTS_WAIT)

    def show_suspects(self, nodes: NodeTable | None, suspects: tuple[Suspicion, ...]) -> None:
        """Show other suspects; None while they are looked for."""
        rows = []
        for suspicion in suspects:
            node = nodes[suspicion.row]
            fault = suspicion.fault.value
            why = texts.SUSPECT_TIPS[fault].format(marker=suspicion.marker or "a marker", size_mm=suspicion.size_mm)
            tip = f"{why}\n{texts.SUSPECT_SCORE.format(score=suspicion.score)}"
            rows.append((suspicion.row, texts.SUSPECT_ROW.format(node=node.name, phone=node.phone, fault=fault), tip))
        self._rows.show_rows(rows)
        found = texts.SUSPECTS_COUNT.format(count=len(rows)) if rows else texts.SUSPECTS_EMPTY
        self.heading.setText(texts.SUSPECTS_WAIT if nodes is None else found)

    def show_removed(self, removed: frozenset[int]) -> None:
        """Dim what is removed."""
        self._rows.show_dim(removed)


class RemovedList(NodeList):
    """Nodes that no search uses, who removed them and why."""

    def show_removals(self, database: MotionDatabase | None, removals: Mapping[str, Removal]) -> None:
        """Show other removals, the latest first."""
        rows = []
        for name, removal in sorted(removals.items(), key=lambda item: item[1].at, reverse=True):
            row = None if database is None else _row_of(database.nodes, name)
            phone = "?" if row is None else database.nodes[row].phone
            tip = texts.REMOVED_ROW_TIP.format(who=removal.who, at=removal.at)
            rows.append((row, texts.REMOVED_ROW.format(node=name, phone=phone, why=removal.why), tip))
        self._rows.show_rows(rows)
        self.heading.setText(texts.REMOVED_TIP if rows else texts.REMOVED_EMPTY)


def _row_of(nodes: NodeTable, name: str) -> int | None:
    from core.errors import UserFacingError

    try:
        return nodes.row(name)
    except UserFacingError:
        return None
