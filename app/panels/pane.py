"""The frame of a pane: a quiet header, a body that is either its content or the one thing to do next, a footer."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.theme import STEP


def label(text: str = "", role: str = "small", tip: str = "") -> QLabel:
    """Return a line of text in one of the theme's roles: title, small, empty, badge, or plain."""
    made = QLabel(text)
    made.setProperty("role", role)
    made.setToolTip(tip)
    return made


class ElidedLabel(QLabel):
    """A line that gives way: what does not fit is cut, and shown whole in the tooltip."""

    def __init__(self, role: str = "small", mode: Qt.TextElideMode = Qt.TextElideMode.ElideRight) -> None:
        super().__init__()
        self.setProperty("role", role)
        self._whole, self._mode = "", mode
        self.setMinimumWidth(STEP)

    def setText(self, text: str) -> None:
        """Show ``text``, as much of it as fits."""
        self._whole = text
        self.updateGeometry()
        self._fit()

    @property
    def whole_text(self) -> str:
        """The text before it was cut."""
        return self._whole

    def _fit(self) -> None:
        shown = self.fontMetrics().elidedText(self._whole, self._mode, max(self.width(), STEP))
        super().setText(shown)
        self.setToolTip(f"<qt>{escape(self._whole)}</qt>" if shown != self._whole else "")

    def resizeEvent(self, event) -> None:
        """Cut the text anew."""
        super().resizeEvent(event)
        self._fit()

    def minimumSizeHint(self):
        """Give way to neighbours."""
        hint = super().minimumSizeHint()
        hint.setWidth(STEP)
        return hint

    def sizeHint(self):
        """Ask for room for the whole text."""
        hint = super().sizeHint()
        hint.setWidth(self.fontMetrics().horizontalAdvance(self._whole) + 2)
        return hint


def toggle(word: str, tip: str, toggled: Callable[[bool], None]) -> QToolButton:
    """Make a button of a header that stays down."""
    button = QToolButton(text=word, checkable=True, toolTip=tip)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    button.toggled.connect(toggled)
    return button


class Choice(QWidget):
    """A row of words of which one is chosen."""

    def __init__(self, options: list[tuple[str, str, str]]) -> None:
        """Take options as (key, word, tooltip); the last one is chosen."""
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.group = QButtonGroup(self)
        self._keys = [key for key, _, _ in options]
        for i, (_, word, tip) in enumerate(options):
            button = QToolButton(text=word, checkable=True, toolTip=tip)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)  # a word cut to dots tells nothing
            self.group.addButton(button, i)
            row.addWidget(button)
        self.group.button(len(options) - 1).setChecked(True)

    @property
    def key(self) -> str:
        """The chosen option."""
        return self._keys[self.group.checkedId()]

    def choose(self, key: str) -> None:
        """Choose ``key`` as a click would."""
        self.group.button(self._keys.index(key)).click()

    def button(self, key: str) -> QToolButton:
        """Return the button of an option."""
        return self.group.button(self._keys.index(key))


class Pane(QWidget):
    """Header, body, footer.

    header, footer : rows to add widgets to; the header already has the title, an info line and a stretch
    """

    def __init__(self, title: str, content: QWidget, empty: str) -> None:
        super().__init__()
        self.setMinimumSize(220, 160)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.header = QHBoxLayout()
        self.header.setContentsMargins(STEP + 4, 0, STEP, 0)
        self.header.setSpacing(STEP // 2)
        name = ElidedLabel("title")
        name.setText(title)
        self.header.addWidget(name)
        self.info = ElidedLabel()
        self.header.addWidget(self.info, 1)
        top = QWidget()
        top.setLayout(self.header)
        top.setFixedHeight(4 * STEP)
        column.addWidget(top)
        self._body = QStackedWidget()
        self._empty = label(empty, "empty")
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._empty.setWordWrap(True)
        self._body.addWidget(self._empty)
        self._body.addWidget(content)
        column.addWidget(self._body, 1)
        self.footer = QHBoxLayout()
        self.footer.setContentsMargins(STEP, 0, STEP, 0)
        self.footer.setSpacing(STEP // 2)
        self._bottom = QWidget()
        self._bottom.setLayout(self.footer)
        self._bottom.setFixedHeight(4 * STEP)
        column.addWidget(self._bottom)

    def hide_footer(self) -> None:
        """Leave the room to the content."""
        self._bottom.hide()

    def show_empty(self, text: str) -> None:
        """Show what to do next instead of the content."""
        self._empty.setText(text)
        self._body.setCurrentIndex(0)

    def show_content(self) -> None:
        """Show the content."""
        self._body.setCurrentIndex(1)

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to show."""
        return self._body.currentIndex() == 0

    @property
    def empty_text(self) -> str:
        """What an empty pane says."""
        return self._empty.text()
