"""A film strip of the speech on show: which moments, which rows, how large, to where. It stays open beside the work."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QGridLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app import texts as common
from app.authoring import Authoring
from app.export import video_size
from app.panels.pane import Choice, label
from app.panels.strip_work import StripRequest, draw_apart
from app.pictures import STYLES
from app.settings import last_folder, remember_folder
from app.strip_job import check_strip_path
from app.strips import MOST_MOMENTS, StripSettings, moments
from app.texts import strips as texts
from app.theme import STEP
from core.errors import UserFacingError
from core.speech.emotion import EMOTIONS

SIZES = ("128x160", "192x240", "256x320", "384x480")
_WIDTH_PX = 500
_FOLDER, _FILE = "strip", "strip.png"
_ROW_COLUMNS = 3
_WHITE = (1.0, 1.0, 1.0)


class StripDialog(QDialog):
    """Asks; the work is a job with progress and a cross in the status bar."""

    def __init__(self, authoring: Authoring, settings, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._authoring, self._settings = authoring, settings
        self.setWindowTitle(texts.TITLE)
        self.setMinimumWidth(_WIDTH_PX)
        form = QFormLayout()
        form.setHorizontalSpacing(2 * STEP)
        form.setVerticalSpacing(STEP)
        self._make_fields()
        rows = QGridLayout()
        for n, box in enumerate(self.rows.values()):
            rows.addWidget(box, n // _ROW_COLUMNS, n % _ROW_COLUMNS)
        browse = QPushButton(common.BROWSE)
        browse.clicked.connect(self.browse)
        for words, widgets in (
            (texts.MOMENTS, (self.when, self.count, self.times, self.add_button)), (texts.ROWS, rows),
            (texts.SHOWS, (self.style,)), (texts.FACE_SIZE, (self.size,)), (texts.GROUND, (self.ground,)),
            (texts.TO, (self.path, browse)),
        ):  # fmt: skip
            form.addRow(words, widgets if isinstance(widgets, QGridLayout) else _in_a_row(widgets))
        self.message = label("", "warning")
        self.message.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self.export_button = buttons.addButton(texts.EXPORT, QDialogButtonBox.ButtonRole.AcceptRole)
        self.export_button.setDefault(True)
        self.export_button.setProperty("role", "primary")
        buttons.button(QDialogButtonBox.StandardButton.Close).setIcon(QIcon())  # the platform's does not know our theme
        buttons.accepted.connect(self.export)
        buttons.rejected.connect(self.close)
        column = QVBoxLayout(self)
        column.setContentsMargins(2 * STEP, 2 * STEP, 2 * STEP, 2 * STEP)
        column.setSpacing(2 * STEP)
        column.addLayout(form)
        column.addWidget(self.message)
        column.addWidget(buttons)
        self._show_when()

    def _make_fields(self) -> None:
        self.when = Choice([texts.CHOSEN, texts.EVEN])
        self.when.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.when.group.idClicked.connect(lambda _: self._show_when())
        self.count = QSpinBox(minimum=1, maximum=MOST_MOMENTS, value=StripSettings.count, toolTip=texts.COUNT_TIP)
        self.count.setFixedWidth(6 * STEP)
        # the platform's arrows do not show on our ground
        self.count.setStyleSheet("QSpinBox::up-button, QSpinBox::down-button { width: 0; border: none; }")
        self.times = QLineEdit(placeholderText=texts.TIMES_HINT, toolTip=texts.TIMES_TIP)
        self.add_button = QToolButton(text=texts.ADD_PLAYHEAD, toolTip=texts.ADD_PLAYHEAD_TIP)
        self.add_button.clicked.connect(self.add_playhead)
        self.rows = {texts.ON_SHOW: QCheckBox(texts.ON_SHOW, checked=True)}
        self.rows |= {emotion: QCheckBox(emotion, toolTip=texts.ROW_TIP) for emotion in EMOTIONS}
        self.rows[texts.CAPTURE] = QCheckBox(texts.CAPTURE, toolTip=texts.CAPTURE_TIP)
        self.style, self.size, self.ground = QComboBox(), QComboBox(editable=True), QComboBox()
        for style in STYLES:
            self.style.addItem(common.EXPORT_STYLES[style], style)
        self.size.addItems(SIZES)
        self.size.setCurrentText(SIZES[1])
        for words, colour in ((texts.DARK, None), (texts.WHITE, _WHITE)):
            self.ground.addItem(words, colour)
        self.path = QLineEdit(str(Path(last_folder(self._settings, _FOLDER)) / _FILE))

    def open_for(self) -> None:
        """Show it for the motion on show."""
        has_motion = self._authoring.document.motion is not None
        self.export_button.setEnabled(has_motion)
        self.message.setText("" if has_motion else texts.NEEDS_MOTION)
        self.show()
        self.raise_()

    # Reactions

    def browse(self) -> None:
        """Choose where it goes."""
        name, _ = QFileDialog.getSaveFileName(self, texts.TITLE, self.path.text(), common.FILTER_ANY)
        if name:
            self.path.setText(str(Path(name).with_suffix(".png")))

    def add_playhead(self) -> None:
        """Name the moment at the playhead too."""
        self.times.setText(f"{self.times.text()} {self._authoring.view.playhead_s:.3f}".strip())

    def export(self) -> None:
        """Begin, or say here why not."""
        try:
            request = self._request()
            check_strip_path(request.path)
            moments(request.speech.transcript, request.settings)
        except UserFacingError as error:
            self.message.setText(str(error))
            return
        remember_folder(self._settings, _FOLDER, request.path)
        self.message.setText("")
        authoring = self._authoring
        authoring.jobs.start(
            "strip", texts.DRAWING, request, draw_apart,
            lambda path: authoring.noted.emit(texts.SAVED.format(path=path)),
            lambda error: authoring.failed.emit(error.message, error.remedy),
        )  # fmt: skip
        self.close()

    def _request(self) -> StripRequest:
        authoring, document = self._authoring, self._authoring.document
        asked = {name for name, box in self.rows.items() if box.isChecked()}
        if not asked:
            raise UserFacingError(texts.NEEDS_ROW)
        settings = StripSettings(self._times_s(), self.count.value(), video_size(self.size.currentText()),
                                 self.style.currentData(), self.ground.currentData())  # fmt: skip
        return StripRequest(
            Path(self.path.text()).expanduser(), document.speech_input(), settings, authoring.rig,
            document.database.path, document.engine, document.search_weights,
            document.motion if texts.ON_SHOW in asked else None, tuple(e for e in EMOTIONS if e in asked),
            document.speech.text if texts.CAPTURE in asked else None,
        )  # fmt: skip

    def _times_s(self) -> tuple[float, ...]:
        if self.when.key == texts.EVEN[0]:
            return ()
        times_s = []
        for text in self.times.text().replace(",", " ").split():
            try:
                times_s.append(float(text))
            except ValueError:
                raise UserFacingError(texts.NO_TIME.format(text=text[:20])) from None
        if not times_s:
            raise UserFacingError(texts.NO_TIME.format(text=""))
        return tuple(times_s)

    def _show_when(self) -> None:
        is_even = self.when.key == texts.EVEN[0]
        self.count.setVisible(is_even)
        self.times.setVisible(not is_even)
        self.add_button.setVisible(not is_even)

    def keyPressEvent(self, event) -> None:
        """Escape closes it."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)


def _in_a_row(widgets: tuple[QWidget, ...]) -> QHBoxLayout:
    """Side by side, what is left over at the right; a line to type into takes it while it is there."""
    row = QHBoxLayout()
    row.setSpacing(STEP)
    for widget in widgets:
        row.addWidget(widget, 1 if isinstance(widget, QLineEdit) else 0)
    row.addStretch(0)
    return row
