"""Lists that can be searched: all commands, or whatever else there is too much of for a menu."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QFrame, QLineEdit, QListWidget, QListWidgetItem, QMainWindow, QMenu, QVBoxLayout

from app.theme import STEP

_SIZE_PX = (520, 380)
_DONE = Qt.ItemDataRole.UserRole
_MOST_SHOWN = 400


@dataclass(frozen=True)
class Choosable:
    """One line of the list; ``keys`` is its shortcut, ``done`` what choosing it does."""

    title: str
    done: Callable[[], None]
    keys: str = ""


class Chooser(QFrame):
    """Type a few letters of what is meant, Return takes it, Escape leaves."""

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(window, Qt.WindowType.Popup)
        self._window = window
        self._choosable: list[Choosable] = []
        self.setProperty("role", "chooser")
        column = QVBoxLayout(self)
        column.setContentsMargins(STEP, STEP, STEP, STEP)
        self.line = QLineEdit()
        self.list = QListWidget()
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column.addWidget(self.line)
        column.addWidget(self.list)
        self.line.textChanged.connect(self._fill)
        self.line.returnPressed.connect(self._do)
        self.list.itemClicked.connect(lambda _: self._do())
        self.resize(*_SIZE_PX)

    def open(self, hint: str, choosable: Iterable[Choosable]) -> None:
        """Show a list; ``hint`` says what is chosen."""
        self._choosable = list(choosable)
        self.line.setPlaceholderText(hint)
        self.line.clear()
        self._fill("")
        self.move(self._window.mapToGlobal(QPoint((self._window.width() - self.width()) // 2, 5 * STEP)))
        self.show()
        self.line.setFocus()

    def _fill(self, wanted: str) -> None:
        self.list.clear()
        words = wanted.lower().split()
        fitting = (each for each in self._choosable if all(word in each.title.lower() for word in words))
        for each, _ in zip(fitting, range(_MOST_SHOWN)):
            item = QListWidgetItem(f"{each.title}    {each.keys}" if each.keys else each.title)
            item.setData(_DONE, each.done)
            self.list.addItem(item)
        self.list.setCurrentRow(0)

    def _do(self) -> None:
        item = self.list.currentItem()
        self.hide()
        if item is not None:
            item.data(_DONE)()

    def keyPressEvent(self, event) -> None:
        """Up and down walk the list while one types."""
        step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(event.key())
        if step is not None:
            self.list.setCurrentRow(min(max(self.list.currentRow() + step, 0), self.list.count() - 1))
        else:
            super().keyPressEvent(event)


def commands(window: QMainWindow) -> Iterable[Choosable]:
    """Yield everything in the menus that can be done now, each with the way to it: ``Motion › Play or pause``."""
    for top in window.menuBar().actions():
        if top.menu() is not None:
            yield from _commands_of(top.menu(), _plain(top.text()))


def _commands_of(menu: QMenu, way: str) -> Iterable[Choosable]:
    for action in menu.actions():
        title = f"{way} › {_plain(action.text())}"
        if action.menu() is not None:
            yield from _commands_of(action.menu(), title)
        elif not action.isSeparator() and action.isEnabled():
            yield Choosable(title, action.trigger, _keys(action))


def _keys(action: QAction) -> str:
    return action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)


def _plain(text: str) -> str:
    return text.replace("&", "")
