"""The assistant's window: steps at the left, one page at a time, and what is going on below."""

from __future__ import annotations

from pathlib import Path

from pyqtgraph import PlotWidget
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QFileDialog,
    QFrame,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QStackedWidget,
    QTableView,
    QWidget,
)

from app.authoring import Authoring
from app.emotion_colours import emotion_colours
from app.panels.importing.build_page import BuildPage
from app.panels.importing.draft import ImportDraft
from app.panels.importing.files_page import FilesPage
from app.panels.importing.head_page import HeadPage
from app.panels.importing.markers_page import MarkersPage
from app.panels.importing.mend_page import MendPage
from app.panels.importing.page import Page, dress_plot
from app.panels.importing.review_page import ReviewPage
from app.panels.importing.sentence_table import table_style
from app.panels.importing.sound_page import SoundPage
from app.panels.importing.speech_work import SpeechWork
from app.panels.tool_window import ToolWindow
from app.player import Player
from app.settings import last_folder, remember_folder
from app.texts import importing as texts
from app.theme import STEP, theme

_STEPS_PX = 216
_SIZE = (1240, 780)
_FOLDER = "captures"


class ImportWindow(ToolWindow):
    """Non-modal; it keeps its plan while it is closed. Closing it does not stop a build that goes on."""

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.draft = ImportDraft(self.jobs, self)
        self.steps = QListWidget(toolTip=texts.STEPS_TIP)
        self.pages: tuple[Page, ...] = self._make_pages()
        self._stack = QStackedWidget()
        for page in self.pages:
            self._stack.addWidget(page)
            self.steps.addItem(QListWidgetItem(page.title))
        self._arrange()
        self.steps.currentRowChanged.connect(self.on_step)
        self.draft.changed.connect(self._show_states)
        self.draft.changed.connect(self.message.hide)  # what was wrong before the change is old
        self.draft.learnt.connect(self._show_states)
        self.draft.measured.connect(self._show_states)
        self.draft.failed.connect(self.message.say)
        self.draft.noted.connect(self.status.say)
        self.player.noted.connect(self.status.say)
        emotion_colours.changed.connect(self.on_theme)
        self._add_keys()
        self.steps.setCurrentRow(0)
        self._show_states()

    def _make_pages(self) -> tuple[Page, ...]:
        self.files = FilesPage(self.draft)
        self.markers = MarkersPage(self.draft, self.authoring)
        self.head = HeadPage(self.draft)
        self.mend = MendPage(self.draft)
        self.work = SpeechWork(self.draft)
        self.player = Player(self.jobs, self)
        self.sound = SoundPage(self.draft, self.work, self.player)
        self.review = ReviewPage(self.draft, self.work, self.player)
        self.build = BuildPage(self.draft, self.authoring)
        return self.files, self.markers, self.head, self.mend, self.sound, self.review, self.build

    def _arrange(self) -> None:
        self.steps.setFixedWidth(_STEPS_PX)
        self.steps.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._dress()
        self.load_button = QPushButton(texts.LOAD_PLAN, toolTip=texts.LOAD_PLAN_TIP)
        self.save_button = QPushButton(texts.SAVE_PLAN, toolTip=texts.SAVE_PLAN_TIP)
        self.over_button = QPushButton(texts.START_OVER, toolTip=texts.START_OVER_TIP)
        self.back_button = QPushButton(texts.BACK, toolTip=texts.BACK_TIP)
        self.next_button = QPushButton(texts.NEXT, toolTip=texts.NEXT_TIP)
        for button in (self.load_button, self.save_button, self.over_button):
            button.setProperty("role", "quiet")
        row = QHBoxLayout()
        row.setContentsMargins(2 * STEP, STEP, 3 * STEP, STEP)
        row.setSpacing(STEP)
        for button in (self.load_button, self.save_button, self.over_button):
            row.addWidget(button)
        row.addStretch(1)
        for button in (self.back_button, self.next_button):
            row.addWidget(button)
        self.load_button.clicked.connect(self.ask_load)
        self.save_button.clicked.connect(self.ask_save)
        self.over_button.clicked.connect(self.draft.start_over)
        self.back_button.clicked.connect(lambda: self.step(-1))
        self.next_button.clicked.connect(lambda: self.step(1))
        middle = QHBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(self.steps)
        middle.addWidget(self._stack, 1)
        self.fill(middle, _rule(), row, _rule())

    def _dress(self) -> None:
        t = theme()
        # the platform's arrows and empty check boxes do not show on our ground
        self.setStyleSheet(
            "QSpinBox::up-button, QSpinBox::down-button, QDoubleSpinBox::up-button, QDoubleSpinBox::down-button"
            " { width: 0; border: none; }"
            f"QListWidget::indicator {{ width: 11px; height: 11px; border: 1px solid {t.dim}; border-radius: 2px; }}"
            f"QListWidget::indicator:checked {{ background: {t.accent}; border-color: {t.accent}; }}"
        )
        self.steps.setStyleSheet(
            f"QListWidget {{ background: {t.ground}; border: none; border-right: 1px solid {t.line}; border-radius: 0;"
            f" padding-top: {STEP}px; }}"
            f"QListWidget::item {{ padding: {STEP}px {2 * STEP}px; border-left: 2px solid transparent; }}"
            f"QListWidget::item:selected {{ background: {t.raised}; border-left: 2px solid {t.accent}; }}"
        )

    def on_theme(self) -> None:
        """Dress all that keeps colours of its own."""
        self._dress()
        for table in self.findChildren(QTableView):
            table.setStyleSheet(table_style())
        for plot in self.findChildren(PlotWidget):
            dress_plot(plot)
        for page in self.pages:
            page.on_theme()

    def _add_keys(self) -> None:
        undo = self.draft.undo_stack
        keys = {
            "Alt+Left": lambda: self.step(-1), "Alt+Right": lambda: self.step(1), "Ctrl+O": self.ask_load,
            "Ctrl+S": self.ask_save, "Ctrl+Z": undo.undo, "Ctrl+Shift+Z": undo.redo, "Ctrl+W": self.close,
            "Ctrl+Return": self.build.on_build,
        }  # fmt: skip
        keys |= {f"Alt+{i + 1}": lambda i=i: self.steps.setCurrentRow(i) for i in range(len(self.pages))}
        for key, done in keys.items():
            QShortcut(QKeySequence(key), self, activated=done)

    # Reactions

    def on_step(self, row: int) -> None:
        """Show another page."""
        self._stack.setCurrentIndex(row)
        last = len(self.pages) - 1
        self.back_button.setEnabled(row > 0)
        self.next_button.setEnabled(row < last)
        following = texts.NEXT_STEP.format(title=self.pages[row + 1].title) if row < last else texts.NEXT
        self.next_button.setText(following)

    def step(self, by: int) -> None:
        """Go back or forth."""
        self.steps.setCurrentRow(min(max(self.steps.currentRow() + by, 0), len(self.pages) - 1))

    def ask_load(self) -> None:
        """Choose a plan to go on with."""
        name, _ = QFileDialog.getOpenFileName(self, texts.LOAD_PLAN, last_folder(self._settings, _FOLDER),
                                              texts.FILTER_PLAN)  # fmt: skip
        if name:
            remember_folder(self._settings, _FOLDER, Path(name))
            self.message.hide()
            self.draft.load(Path(name))

    def ask_save(self) -> None:
        """Choose where the plan is kept."""
        if self.draft.plan is None:
            self.message.say(texts.FILES_FIRST)
            return
        start = Path(last_folder(self._settings, _FOLDER)) / f"{self.draft.plan.name}.json"
        name, _ = QFileDialog.getSaveFileName(self, texts.SAVE_PLAN, str(start), texts.FILTER_PLAN)
        if name:
            self.draft.save(Path(name) if Path(name).suffix else Path(f"{name}.json"))

    def _show_states(self) -> None:
        for row, page in enumerate(self.pages):
            said = f"\n{page.state}" if page.state else ""
            self.steps.item(row).setText(f"{row + 1}  {page.title}{said}")
        self.save_button.setEnabled(self.draft.plan is not None)
        self.over_button.setEnabled(self.draft.plan is not None)

    def shut_down(self) -> None:
        """Stop all jobs, for good; the main window closes."""
        self.player.pause()
        self.jobs.shut_down()
        self.close()


def _rule() -> QFrame:
    rule = QFrame()
    rule.setProperty("role", "rule")
    return rule
