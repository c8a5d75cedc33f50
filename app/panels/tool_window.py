"""What the windows beside the main one have in common."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QLayout, QVBoxLayout, QWidget

from app.authoring import Authoring
from app.icons import icon
from app.jobs import JobRunner
from app.panels.message_bar import MessageBar
from app.panels.status import StatusLine
from app.settings import window_settings


class ToolWindow(QWidget):
    """Non-modal, with jobs, a message bar and a status line of its own; it wants ``size_px``, the screen allowing."""

    def __init__(
        self, authoring: Authoring, title: str, size_px: tuple[int, int], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.authoring = authoring
        self.jobs = JobRunner(self)
        self._size_px = size_px
        self._settings = window_settings()
        self.setWindowTitle(title)
        self.setWindowIcon(icon("workstation"))
        self.message = MessageBar()
        self.status = StatusLine(self.jobs)

    def fill(self, middle: QWidget | QLayout, *below: QWidget | QLayout) -> None:
        """Lay ``middle``, which takes all room there is, and ``below`` between the message bar and the status line."""
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for part in (self.message, middle, *below, self.status):
            add = column.addLayout if isinstance(part, QLayout) else column.addWidget
            add(part, 1 if part is middle else 0)

    def open_now(self) -> None:
        """Show the window, in front."""
        self.show()
        self.raise_()
        self.activateWindow()

    def sizeHint(self) -> QSize:
        """Ask for the room that it was made for, less than the screen has."""
        room = self.screen().availableSize()
        return QSize(min(self._size_px[0], room.width()), min(self._size_px[1], room.height()))
