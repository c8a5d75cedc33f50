"""All commands in one list that can be searched."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QFrame, QLineEdit, QListWidget, QListWidgetItem, QMainWindow, QMenu, QVBoxLayout

from app import texts
from app.theme import STEP

_SIZE_PX = (460, 360)
_ACTION = Qt.ItemDataRole.UserRole


class CommandPalette(QFrame):
    """Type a few letters of a command, Return does it, Escape leaves."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(window, Qt.WindowType.Popup)
        self._window = window
        self.setProperty("role", "palette")
        column = QVBoxLayout(self)
        column.setContentsMargins(STEP, STEP, STEP, STEP)
        self.line = QLineEdit(placeholderText=texts.COMMANDS_HINT)
        self.list = QListWidget()
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column.addWidget(self.line)
        column.addWidget(self.list)
        self.line.textChanged.connect(self._fill)
        self.line.returnPressed.connect(self._do)
        self.list.itemClicked.connect(lambda _: self._do())
        self.resize(*_SIZE_PX)

    def open(self) -> None:
        """Show every command that can be done now."""
        self._commands = [(title, action) for title, action in _commands(self._window) if action.isEnabled()]
        self.line.clear()
        self._fill("")
        corner = self._window.mapToGlobal(QPoint((self._window.width() - self.width()) // 2, 5 * STEP))
        self.move(corner)
        self.show()
        self.line.setFocus()

    def _fill(self, wanted: str) -> None:
        self.list.clear()
        words = wanted.lower().split()
        for title, action in self._commands:
            if all(word in title.lower() for word in words):
                keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
                item = QListWidgetItem(f"{title}\t{keys}" if keys else title)
                item.setData(_ACTION, action)
                self.list.addItem(item)
        self.list.setCurrentRow(0)

    def _do(self) -> None:
        item = self.list.currentItem()
        self.hide()
        if item is not None:
            item.data(_ACTION).trigger()

    def keyPressEvent(self, event) -> None:
        """Up and down walk the list while one types."""
        row = self.list.currentRow() + {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(event.key(), 0)
        if row != self.list.currentRow():
            self.list.setCurrentRow(min(max(row, 0), self.list.count() - 1))
        else:
            super().keyPressEvent(event)


def _commands(window: QMainWindow) -> Iterable[tuple[str, QAction]]:
    """Yield all actions of the menu bar, each with the way to it: ``Motion › Play or pause``."""
    for top in window.menuBar().actions():
        if top.menu() is not None:
            yield from _commands_of(top.menu(), _plain(top.text()))


def _commands_of(menu: QMenu, way: str) -> Iterable[tuple[str, QAction]]:
    for action in menu.actions():
        title = f"{way} › {_plain(action.text())}"
        if action.menu() is not None:
            yield from _commands_of(action.menu(), title)
        elif not action.isSeparator():
            yield title, action


def _plain(text: str) -> str:
    return text.replace("&", "")
