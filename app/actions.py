"""Everything that can be done, once: each action has a name, a shortcut and a place in a menu."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QAbstractButton, QApplication, QComboBox, QMainWindow, QMenu, QWidget

from app import texts
from core.media.video import FRAME_RATES

_PRESS_KEYS = (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)


class Actions:
    """Makes the menus of a window; ``by_name`` finds an action again."""

    def __init__(self, window: QMainWindow) -> None:
        self._window = window
        self.by_name: dict[str, QAction] = {}

    def menu(self, title: str) -> QMenu:
        """Add a menu to the bar."""
        return self._window.menuBar().addMenu(title)

    def add(self, menu: QMenu, name: str, text: str, keys: str | list[str], done: Callable[[], None]) -> QAction:
        """Add an action; ``keys`` are its shortcuts as Qt spells them."""
        action = QAction(text, self._window)
        sequences = [keys] if isinstance(keys, str) else keys
        action.setShortcuts([QKeySequence(key) for key in sequences if key])
        action.triggered.connect(lambda: done())
        menu.addAction(action)
        self.by_name[name] = action
        return action

    def add_choice(
        self, menu: QMenu, title: str, options: dict[str, str], chosen: str, done: Callable[[str], None]
    ) -> QActionGroup:
        """Add a submenu of which one entry is chosen; options are key to text."""
        submenu = menu.addMenu(title)
        group = QActionGroup(self._window)
        for key, text in options.items():
            action = submenu.addAction(text)
            action.setCheckable(True)
            action.setChecked(key == chosen)
            action.triggered.connect(lambda _=False, key=key: done(key))
            group.addAction(action)
            self.by_name[f"{title}/{key}"] = action
        return group


def frame_rate_options() -> dict[str, str]:
    """Return the output rates as a menu shows them."""
    return {name: texts.FRAME_RATE_ITEM.format(name=name) for name in FRAME_RATES}


class ButtonKeys(QObject):
    """Leaves Space to a button or list that was reached by Tab; everywhere else it plays.

    It looks at the events of what has the focus alone: one that looks at all holds each of them up, as it has to wait
    for Python's lock.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        QApplication.instance().focusChanged.connect(self._on_focus_changed)

    def stop(self) -> None:
        """End."""
        QApplication.instance().focusChanged.disconnect(self._on_focus_changed)

    def _on_focus_changed(self, old: QWidget | None, new: QWidget | None) -> None:
        if old is not None:
            old.removeEventFilter(self)
        if isinstance(new, QAbstractButton | QComboBox):
            new.installEventFilter(self)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Take Space and Return from the shortcuts while a button or list has the focus."""
        is_key = event.type() == QEvent.Type.ShortcutOverride
        if is_key and event.key() in _PRESS_KEYS and not event.modifiers():
            event.accept()
            return True
        return False
