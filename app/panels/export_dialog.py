"""Exporting: as what, how large, which part, to where. It stays open beside the work, and remembers."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QIcon
from PySide6.QtWidgets import (
    QColorDialog,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app import texts
from app.authoring import Authoring
from app.export import DRAWN_SUFFIXES, VideoSettings, check_outputs, video_size
from app.film_process import FilmRequest, compose_apart
from app.panels.pane import Choice, label
from app.pictures import STYLES
from app.settings import last_folder, remember_folder
from app.theme import STEP
from core.errors import UserFacingError
from core.media.video import FRAME_RATES

SIZES = ("640x480", "800x600", "1280x720", "1920x1080", "1080x1920")
_WIDTH_PX = 460
_ALL, _SELECTED, _FROM_TO = "all", "selected", "span"


class ExportDialog(QDialog):
    """Asks; the work is a job with progress and a cross in the status bar."""

    def __init__(self, authoring: Authoring, settings, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._authoring, self._settings = authoring, settings
        self._background: QColor | None = None
        self.setWindowTitle(texts.EXPORT_TITLE)
        self.setMinimumWidth(_WIDTH_PX)
        column = QVBoxLayout(self)
        column.setContentsMargins(2 * STEP, 2 * STEP, 2 * STEP, 2 * STEP)
        column.setSpacing(2 * STEP)
        form = QFormLayout()
        form.setHorizontalSpacing(2 * STEP)
        form.setVerticalSpacing(STEP)
        column.addLayout(form)
        self.kind = QComboBox()
        for suffix, text in texts.EXPORT_KINDS.items():
            self.kind.addItem(text, suffix)
        self.size = QComboBox(editable=True)
        self.size.addItems(SIZES)
        self.style = QComboBox()
        for style in STYLES:
            self.style.addItem(texts.EXPORT_STYLES[style], style)
        self.rate = QComboBox()
        self.rate.addItems(list(FRAME_RATES))
        self.background = QPushButton(texts.BACKGROUND_STUDIO, toolTip=texts.BACKGROUND_TIP)
        self.span = Choice([(_SELECTED, texts.SPAN_SELECTED, texts.SPAN_TIP), (_FROM_TO, texts.SPAN_FROM_TO,
                            texts.SPAN_TIP), (_ALL, texts.SPAN_ALL, texts.SPAN_TIP)])  # fmt: skip
        self.start, self.end = QDoubleSpinBox(decimals=3, suffix=" s"), QDoubleSpinBox(decimals=3, suffix=" s")
        times = QHBoxLayout()
        times.setSpacing(STEP)
        for widget in (self.span, self.start, label("–", "plain"), self.end):
            times.addWidget(widget)
        times.addStretch(1)
        self.path = QLineEdit()
        browse = QPushButton(texts.BROWSE)
        browse.clicked.connect(self.browse)
        where = QHBoxLayout()
        where.addWidget(self.path, 1)
        where.addWidget(browse)
        rows = (
            (texts.EXPORT_AS, self.kind), (texts.EXPORT_SIZE, self.size), (texts.EXPORT_SHOWS, self.style),
            (texts.EXPORT_BACKGROUND, self.background), (texts.EXPORT_RATE, self.rate), (texts.EXPORT_SPAN, times),
            (texts.EXPORT_TO, where),
        )  # fmt: skip
        for text, field in rows:
            form.addRow(text, field)
        self.message = label("", "warning")
        self.message.setWordWrap(True)
        column.addWidget(self.message)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self.export_button = buttons.addButton(texts.EXPORT, QDialogButtonBox.ButtonRole.AcceptRole)
        self.export_button.setDefault(True)
        self.export_button.setProperty("role", "primary")
        buttons.button(QDialogButtonBox.StandardButton.Close).setIcon(QIcon())  # the platform's does not know our theme
        column.addWidget(buttons)
        buttons.accepted.connect(self.export)
        buttons.rejected.connect(self.close)
        self.background.clicked.connect(self.choose_background)
        self.kind.currentIndexChanged.connect(self._on_kind)
        self.span.group.idClicked.connect(lambda _: self._show_span())
        self._recall()

    def open_for(self) -> None:
        """Show it for the motion on show."""
        document = self._authoring.document
        duration_s = 0.0 if document.speech is None else document.speech.transcript.duration_s
        for field in (self.start, self.end):
            field.setRange(0.0, duration_s)
        self.end.setValue(duration_s)
        self.rate.setCurrentText(document.output.frame_rate)
        self.span.button(_SELECTED).setEnabled(self._authoring.view.span is not None)
        self.export_button.setEnabled(document.answer is not None)
        self.message.setText("" if document.answer is not None else texts.EXPORT_NEEDS_MOTION)
        self._show_span()
        self.show()
        self.raise_()

    # Reactions

    def browse(self) -> None:
        """Choose where it goes."""
        name, _ = QFileDialog.getSaveFileName(self, texts.EXPORT_TITLE, self.path.text(), texts.FILTER_ANY)
        if name:
            self.path.setText(str(Path(name).with_suffix(self.kind.currentData())))

    def choose_background(self) -> None:
        """Choose one colour to stand behind the face; cancelled, it is the studio again."""
        chosen = QColorDialog.getColor(self._background or QColor("#00ff00"), self, texts.EXPORT_BACKGROUND)
        self._background = chosen if chosen.isValid() else None
        self.background.setText(chosen.name() if chosen.isValid() else texts.BACKGROUND_STUDIO)

    def export(self) -> None:
        """Begin, or say here why not."""
        try:
            request = self._request()
            check_outputs([request.path])
        except UserFacingError as error:
            self.message.setText(str(error))
            return
        self._remember(request.path)
        self.message.setText("")
        title = texts.EXPORTING.format(name=request.path.name)
        self._authoring.jobs.start("export", title, request, compose_apart, self._on_written, self._on_failed)
        self.close()

    def _request(self) -> FilmRequest:
        authoring, document = self._authoring, self._authoring.document
        size = video_size(self.size.currentText())
        is_bare = authoring.rig is None
        background = None if self._background is None else self._background.getRgbF()[:3]
        video = VideoSettings(
            FRAME_RATES[self.rate.currentText()], *size, "markers" if is_bare else self.style.currentData(),
            document.output.start_frame, document.output.head_moves, document.output.head_moves, None, background,
            self._span_s(),
        )  # fmt: skip
        path = Path(self.path.text()).expanduser()
        return FilmRequest(
            document.motion, document.speech.audio, document.speech.transcript, authoring.rig, video, path
        )

    def _span_s(self) -> tuple[float, float] | None:
        return None if self.span.key == _ALL else (self.start.value(), self.end.value())

    def _on_written(self, path: Path) -> None:
        self._authoring.noted.emit(texts.FILM_SAVED.format(path=path))

    def _on_failed(self, error: UserFacingError) -> None:
        self._authoring.failed.emit(error.message, error.remedy)

    def _on_kind(self) -> None:
        suffix = self.kind.currentData()
        for field in (self.size, self.style, self.background):
            field.setEnabled(suffix in DRAWN_SUFFIXES)
        self.rate.setEnabled(suffix != ".TextGrid")
        if self.path.text():
            self.path.setText(str(Path(self.path.text()).with_suffix(suffix)))

    def _show_span(self) -> None:
        span = self._authoring.view.span
        if self.span.key == _SELECTED and span is not None:
            phonemes = self._authoring.document.speech.transcript.phonemes
            self.start.setValue(phonemes[span[0]].start_s)
            self.end.setValue(phonemes[span[1]].end_s)
        for field in (self.start, self.end):
            field.setEnabled(self.span.key == _FROM_TO)

    # Memory

    def _remember(self, path: Path) -> None:
        remember_folder(self._settings, "export", path)
        values = {"kind": self.kind.currentData(), "size": self.size.currentText(), "style": self.style.currentData(),
                  "name": path.stem, "background": self._background.name() if self._background else ""}  # fmt: skip
        for name, value in values.items():
            self._settings.setValue(f"export/{name}", value)

    def _recall(self) -> None:
        def recalled(name: str, otherwise: str) -> str:
            return str(self._settings.value(f"export/{name}", otherwise))

        self.kind.setCurrentIndex(max(self.kind.findData(recalled("kind", ".avi")), 0))
        self.size.setCurrentText(recalled("size", "800x600"))
        self.style.setCurrentIndex(max(self.style.findData(recalled("style", "face")), 0))
        colour = QColor(recalled("background", ""))
        if colour.isValid():
            self._background = colour
            self.background.setText(colour.name())
        folder = Path(last_folder(self._settings, "export"))
        self.path.setText(str((folder / recalled("name", "synthesis")).with_suffix(self.kind.currentData())))
        self._on_kind()

    def keyPressEvent(self, event) -> None:
        """Escape closes it."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)
