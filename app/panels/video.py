"""Video playback: the composed film, or the film of the actor, at the one playhead."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QDoubleSpinBox, QPushButton, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.pane import Choice, Pane
from app.panels.transport import Transport
from app.theme import colour
from app.video_frames import VideoFrames
from core.document.change import Change
from core.document.parts import ReferenceVideo

COMPOSED, REFERENCE = "composed", "reference"
_LONGEST_OFFSET_S = 36_000.0
# what films are drawn on, in any theme
FILM_GROUND = "#121316"


class VideoView(QWidget):
    """Paints the pictures that come, as large as they fit. (A native video widget cannot be grabbed or overlaid.)"""

    def __init__(self) -> None:
        super().__init__()
        self._image: QImage | None = None

    @property
    def has_frame(self) -> bool:
        """Whether a picture came."""
        return self._image is not None

    def show_frame(self, image: QImage) -> None:
        """Show a picture."""
        self._image = image
        self.update()

    def clear(self) -> None:
        """Forget the last picture."""
        self._image = None
        self.update()

    def paintEvent(self, _event) -> None:
        """Paint the picture."""
        with QPainter(self) as painter:
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
        painter.fillRect(self.rect(), colour(FILM_GROUND))
        if self._image is None:
            return
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        size = self._image.size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        left, top = (self.width() - size.width()) / 2, (self.height() - size.height()) / 2
        painter.drawImage(QRectF(left, top, size.width(), size.height()), self._image)


class VideoPane(Pane):
    """Top right: what an export would look like, or how the actor said it; the motion pane's playhead drives it.

    reference_asked() : choose a film of the actor
    """

    reference_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        self.video_view = VideoView()
        super().__init__(texts.VIDEO, self.video_view, texts.VIDEO_EMPTY)
        self._authoring = authoring
        self._failure, self._shown = "", None
        self._frames = VideoFrames(authoring.jobs, "video", self)
        self._frames.arrived.connect(self.video_view.show_frame)
        self._frames.failed.connect(self.on_failed)
        self.source = Choice([(COMPOSED, texts.VIDEO_COMPOSED, texts.VIDEO_COMPOSED_TIP),
                              (REFERENCE, texts.VIDEO_REFERENCE, texts.VIDEO_REFERENCE_TIP)])  # fmt: skip
        self.source.choose(COMPOSED)
        self.compose_button = self._button(texts.COMPOSE, texts.COMPOSE_TIP)
        self.save_button = self._button(texts.SAVE_AS, texts.SAVE_AS_TIP)
        self.open_button = self._button(texts.OPEN_REFERENCE, texts.OPEN_REFERENCE_TIP)
        for widget in (self.source, self.compose_button, self.save_button, self.open_button):
            self.header.addWidget(widget)
        self.transport = Transport(texts.PLAY_TIP)
        self.transport.play_asked.connect(authoring.play_or_pause)
        self.transport.step_asked.connect(authoring.step_frame)
        self.transport.end_asked.connect(lambda is_end: authoring.seek(authoring.player.duration_s if is_end else 0.0))
        self.transport.seek_asked.connect(authoring.seek)
        self.footer.addWidget(self.transport, 1)
        self.offset = QDoubleSpinBox(decimals=3, singleStep=0.04, suffix=" s", toolTip=texts.OFFSET_TIP)
        self.offset.setRange(-_LONGEST_OFFSET_S, _LONGEST_OFFSET_S)
        self.offset.setPrefix(texts.OFFSET)
        self.offset.setKeyboardTracking(False)
        self.footer.addWidget(self.offset)
        self.source.group.idClicked.connect(lambda _: self._show_source())
        self.compose_button.clicked.connect(authoring.film.compose)
        self.open_button.clicked.connect(self.reference_asked)
        self.offset.valueChanged.connect(self.on_offset)
        authoring.film.changed.connect(self._show_source)
        authoring.film.failed.connect(self.on_failed)
        authoring.jobs.started.connect(self._say_what_is_next)
        authoring.jobs.ended.connect(self._say_what_is_next)
        authoring.player.playing_changed.connect(self.transport.show_playing)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)
        authoring.document.changed.connect(self.on_document_changed)
        self._show_source()

    def _button(self, text: str, tip: str) -> QPushButton:
        button = QPushButton(text, toolTip=tip)
        button.setProperty("role", "quiet")
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button

    @property
    def shows_reference(self) -> bool:
        """Whether it is the film of the actor that is looked at."""
        return self.source.key == REFERENCE

    @property
    def path(self) -> Path | None:
        """The film on show."""
        if not self.shows_reference:
            return self._authoring.film.path
        reference = self._authoring.document.reference_video
        return None if reference is None else Path(reference.path)

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Follow the length of the speech and the choice of a film."""
        document = self._authoring.document
        if change & Change.ALIGNMENT:
            self.transport.set_duration(0.0 if document.speech is None else document.speech.transcript.duration_s)
            self.on_playhead_moved(self._authoring.view.playhead_s)
        if change & Change.REFERENCE_VIDEO:
            reference = document.reference_video
            if reference is not None:
                self.offset.blockSignals(True)
                self.offset.setValue(reference.offset_s)
                self.offset.blockSignals(False)
            wanted = REFERENCE if reference is not None else COMPOSED
            if self.source.key != wanted:
                self.source.choose(wanted)
            elif self._shown != self.path:
                self._show_source()
            self.on_playhead_moved(self._authoring.view.playhead_s)

    def on_offset(self, offset_s: float) -> None:
        """Lay the film of the actor earlier or later."""
        reference = self._authoring.document.reference_video
        if reference is not None:
            moved = ReferenceVideo(reference.path, offset_s)
            self._authoring.set_reference_video(moved, id(self))

    def on_playhead_moved(self, time_s: float) -> None:
        """Show the picture at the playhead."""
        film = self._authoring.film
        self.transport.show_time(time_s, film.fps, film.fps_name)
        reference = self._authoring.document.reference_video
        offset_s = reference.offset_s if self.shows_reference and reference is not None else 0.0
        # a moment exactly between two pictures shows the later one, as the motion pane does
        self._frames.ask(time_s + offset_s + 1e-4)

    def on_failed(self, why: str) -> None:
        """Say in the pane why there is no video."""
        self._failure = texts.VIDEO_FAILED.format(why=why)
        self._say_what_is_next()

    def release(self) -> None:
        """Let go of the film, so that its file can be removed."""
        self._frames.set_video(None)

    def _show_source(self) -> None:
        self._failure, self._shown = "", self.path
        self.video_view.clear()
        self._frames.set_video(self.path)
        for widget, shown in ((self.compose_button, False), (self.save_button, False), (self.open_button, True),
                              (self.offset, True)):  # fmt: skip
            widget.setVisible(shown == self.shows_reference)
        self.save_button.setEnabled(self._authoring.film.path is not None)
        self.offset.setEnabled(self._authoring.document.reference_video is not None)
        self.on_playhead_moved(self._authoring.view.playhead_s)
        self._say_what_is_next()

    def _say_what_is_next(self, *_: object) -> None:
        authoring = self._authoring
        composing = authoring.jobs.is_running("film")
        can_compose = authoring.document.answer is not None and authoring.film.path is None and not composing
        self.compose_button.setEnabled(can_compose)
        if self._failure:
            self.show_empty(self._failure)
        elif self.path is not None:
            self.show_content()
        elif self.shows_reference:
            self.show_empty(texts.REFERENCE_EMPTY)
        elif composing:
            self.show_empty(texts.VIDEO_WAITING)
        else:
            self.show_empty(texts.VIDEO_CANCELLED if can_compose else texts.VIDEO_EMPTY)
