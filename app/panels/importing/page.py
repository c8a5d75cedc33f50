"""What all pages of the assistant share: a title, a sentence that says what is done here, and a body or a hint."""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QStackedWidget, QVBoxLayout, QWidget

from app.panels.importing.draft import ImportDraft
from app.panels.pane import label
from app.texts import importing as texts
from app.theme import STEP, colour, theme
from core.importing.plan import SentencePlan

_HEADING_PX = 18


class Page(QWidget):
    """One step.

    A page says by `state` how it stands, in a few words for the list of steps, and shows its body once there is
    something to show. Subclasses fill `body` and override `refresh`, which runs when the page is on show and the
    plan, or what is known of its files, has changed.
    """

    def __init__(self, draft: ImportDraft, title: str, explanation: str, empty: str) -> None:
        super().__init__()
        self.draft, self.title = draft, title
        column = QVBoxLayout(self)
        column.setContentsMargins(3 * STEP, 2 * STEP, 3 * STEP, STEP)
        column.setSpacing(STEP)
        heading = QLabel(title)
        font = heading.font()
        font.setPixelSize(_HEADING_PX)
        heading.setFont(font)
        column.addWidget(heading)
        hint = label(explanation, "empty")
        hint.setWordWrap(True)
        column.addWidget(hint)
        self.content = QWidget()
        self.body = QVBoxLayout(self.content)
        self.body.setContentsMargins(0, STEP, 0, 0)
        self.body.setSpacing(STEP)
        self._empty = label(empty, "empty")
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._empty.setWordWrap(True)
        self._stack = QStackedWidget()
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self.content)
        column.addWidget(self._stack, 1)
        self._stale = True
        draft.changed.connect(self.on_changed)
        draft.learnt.connect(self.on_changed)

    @property
    def is_ready(self) -> bool:
        """Whether there is something to show; by default once files were chosen."""
        return bool(self.draft.sentences)

    @property
    def state(self) -> str:
        """How it stands, in a few words; nothing while there is nothing to say."""
        return ""

    @property
    def is_empty(self) -> bool:
        """Whether it tells what to do first."""
        return self._stack.currentIndex() == 0

    def on_changed(self) -> None:
        """Refresh now, or when the page is shown next."""
        self._stale = True
        if self.isVisible():
            self._renew()

    def refresh(self) -> None:
        """Show the plan as it is now."""

    def on_theme(self) -> None:
        """Paint all anew in the theme in use."""
        self.on_changed()

    def _renew(self) -> None:
        self._stale = False
        self._stack.setCurrentIndex(int(self.is_ready))
        if self.is_ready:
            self.refresh()

    def showEvent(self, event) -> None:
        """Show what changed meanwhile."""
        super().showEvent(event)
        if self._stale:
            self._renew()


class SentenceBox(QComboBox):
    """Which sentence a page speaks of; the same on all pages.

    chosen(name) : the user chose another
    """

    chosen = Signal(str)

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__(toolTip=texts.TAKE_TIP)
        self._draft = draft
        self.setMinimumWidth(20 * STEP)
        self.currentTextChanged.connect(self._on_text)

    @property
    def sentence(self) -> SentencePlan | None:
        """The chosen sentence, as it is planned now."""
        return next((s for s in self._draft.sentences if s.name == self.currentText()), None)

    def renew(self) -> None:
        """Offer the draft's sentences."""
        names = [s.name for s in self._draft.sentences]
        self.blockSignals(True)
        if names != [self.itemText(i) for i in range(self.count())]:
            self.clear()
            self.addItems(names)
        wanted = self._draft.current if self._draft.current in names else next(iter(names), "")
        self.setCurrentText(wanted)
        self.blockSignals(False)

    def _on_text(self, name: str) -> None:
        self._draft.current = name
        self.chosen.emit(name)


def themed_plot(left: str, bottom: str = "") -> pg.PlotWidget:
    """Return an empty plot that looks like the workstation's others; ``left`` and ``bottom`` name its axes."""
    plot = pg.PlotWidget()
    plot.setMenuEnabled(False)
    plot.hideButtons()
    plot.setMouseEnabled(x=False, y=False)
    plot.setLabel("left", left)
    plot.getAxis("left").setWidth(7 * STEP)
    if bottom:
        plot.setLabel("bottom", bottom)
    for side in ("left", "bottom"):
        plot.getAxis(side).enableAutoSIPrefix(False)
    dress_plot(plot)
    return plot


def dress_plot(plot: pg.PlotWidget) -> None:
    """Give a plot the colours of the theme in use."""
    plot.setBackground(colour(theme().canvas))
    for side in ("left", "bottom"):
        plot.getAxis(side).setPen(colour(theme().line))
        plot.getAxis(side).setTextPen(colour(theme().dim))
