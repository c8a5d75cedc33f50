"""The bottom line: what was just done, and what is being done, with a cross to stop it."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QToolButton, QWidget

from app import texts
from app.icons import put_icon
from app.jobs import JobRunner
from app.panels.pane import ElidedLabel, label
from app.theme import STEP

_FULL = 1000
_BAR_PX = 160


class StatusLine(QWidget):
    """Shows the newest job that has a title; the others wait their turn to be seen."""

    def __init__(self, jobs: JobRunner) -> None:
        super().__init__()
        self._jobs = jobs
        self._titles: dict[str, str] = {}
        self.setFixedHeight(3 * STEP + 4)
        row = QHBoxLayout(self)
        row.setContentsMargins(STEP + 4, 0, STEP, 0)
        row.setSpacing(2 * STEP)
        self._note = ""
        self._shown = ElidedLabel()
        row.addWidget(self._shown, 1)
        self._job = label()
        self._bar = QProgressBar(maximum=_FULL, textVisible=False)
        self._bar.setFixedWidth(_BAR_PX)
        self.cancel_button = QToolButton(toolTip=texts.CANCEL_TIP)
        put_icon(self.cancel_button, "cross")
        self.cancel_button.clicked.connect(self.on_cancel_clicked)
        for widget in (self._job, self._bar, self.cancel_button):
            row.addWidget(widget)
        self._show_newest()
        jobs.started.connect(self.on_started)
        jobs.progressed.connect(self.on_progressed)
        jobs.ended.connect(self.on_ended)

    def say(self, sentence: str) -> None:
        """Show a note."""
        self._note = sentence
        self._shown.setText(sentence)

    def hint(self, text: str) -> None:
        """Show what can be done where the pointer is; nothing brings the note back."""
        self._shown.setText(text or self._note)

    @property
    def note(self) -> str:
        """The last note."""
        return self._note

    @property
    def job(self) -> str:
        """The job that is shown; nothing when all is done."""
        return self._job.text() if not self._job.isHidden() else ""

    def on_started(self, kind: str, title: str) -> None:
        """Show a job that began."""
        if title:
            self._titles.pop(kind, None)
            self._titles[kind] = title
            self._bar.setValue(0)
            self._show_newest()

    def on_progressed(self, kind: str, fraction: float, message: str) -> None:
        """Move the bar of the job on show."""
        if self._titles and kind == next(reversed(self._titles)):
            self._bar.setValue(round(_FULL * fraction))
            self._bar.setToolTip(message)

    def on_ended(self, kind: str) -> None:
        """Forget a job."""
        self._titles.pop(kind, None)
        self._show_newest()

    def on_cancel_clicked(self) -> None:
        """Cancel the job on show."""
        if self._titles:
            self._jobs.cancel(next(reversed(self._titles)))

    def _show_newest(self) -> None:
        titles = list(self._titles.values())
        if titles:
            self._job.setText(titles[-1] if len(titles) == 1 else f"{titles[-1]}  (+{len(titles) - 1})")
        for widget in (self._job, self._bar, self.cancel_button):
            widget.setVisible(bool(titles))
