"""Video playback: the composed film, with its sound."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, QTimer, QUrl
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QPushButton, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.pane import Pane
from app.panels.transport import Transport
from app.theme import colour

_FOLLOW_MS = 60
# what films are drawn on, in any theme
FILM_GROUND = "#121316"


class VideoView(QWidget):
    """Paints the frames that come, as large as they fit. (A native video widget cannot be grabbed or overlaid.)"""

    def __init__(self) -> None:
        super().__init__()
        self._image = None

    @property
    def has_frame(self) -> bool:
        """Whether a frame came."""
        return self._image is not None

    def show_frame(self, frame) -> None:
        """Show a QVideoFrame."""
        if frame.isValid():
            self._image = frame.toImage()
            self.update()

    def clear(self) -> None:
        """Forget the last frame."""
        self._image = None
        self.update()

    def paintEvent(self, _event) -> None:
        """Paint the frame."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), colour(FILM_GROUND))
        if self._image is None:
            return
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        size = self._image.size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        left, top = (self.width() - size.width()) / 2, (self.height() - size.height()) / 2
        painter.drawImage(QRectF(left, top, size.width(), size.height()), self._image)


class VideoPane(Pane):
    """Top right: what an export would look like, played by the platform's own player."""

    def __init__(self, authoring: Authoring) -> None:
        self.video_view = VideoView()
        super().__init__(texts.VIDEO, self.video_view, texts.VIDEO_EMPTY)
        self._authoring = authoring
        self._player = None
        self.compose_button = QPushButton(texts.COMPOSE, toolTip=texts.COMPOSE_TIP)
        self.save_button = QPushButton(texts.SAVE_AS, toolTip=texts.SAVE_AS_TIP)
        for button, asked in ((self.compose_button, authoring.film.compose), (self.save_button, None)):
            button.setProperty("role", "quiet")
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            if asked is not None:
                button.clicked.connect(asked)
            self.header.addWidget(button)
        self.transport = Transport(texts.VIDEO_PLAY_TIP, with_steps=False)
        self.transport.play_asked.connect(self.on_play_asked)
        self.transport.seek_asked.connect(self.seek)
        self.footer.addWidget(self.transport, 1)
        authoring.film.changed.connect(self.on_film_changed)
        authoring.film.failed.connect(self.on_failed)
        authoring.jobs.started.connect(self._say_what_is_next)
        authoring.jobs.ended.connect(self._say_what_is_next)
        authoring.player.playing_changed.connect(self.on_motion_playing)
        authoring.view.playhead_moved.connect(lambda _: self._follow_soon.start())
        self._failure = ""
        self._follow_soon = QTimer(self, singleShot=True, interval=_FOLLOW_MS)
        self._follow_soon.timeout.connect(self._follow)
        self.on_film_changed()

    def on_film_changed(self) -> None:
        """Show another film, from its start or from where the playhead stands."""
        film = self._authoring.film.path
        self._failure = ""
        self.save_button.setEnabled(film is not None)
        if film is None:
            if self._player is not None:
                self._player.stop()
                self._player.setSource(QUrl())
            self.video_view.clear()
            self.transport.set_duration(0.0)
            self._show_time(0)
        else:
            player = self._opened_player()
            player.setSource(QUrl.fromLocalFile(str(film)))
            player.pause()
        self._say_what_is_next()

    def on_play_asked(self) -> None:
        """Play or pause; two voices at once help nobody, so the other pane pauses."""
        if self._player is None:
            return
        if self._player.isPlaying():
            self._player.pause()
        else:
            self._authoring.player.pause()
            self._player.play()

    def on_motion_playing(self, playing: bool) -> None:
        """The motion pane plays: pause."""
        if playing and self._player is not None:
            self._player.pause()

    def seek(self, time_s: float) -> None:
        """Go to a time."""
        if self._player is not None:
            self._player.setPosition(round(1000 * time_s))

    def _follow(self) -> None:
        """Show the film where the playhead came to rest, unless something plays."""
        playing = self._authoring.player.is_playing or (self._player is not None and self._player.isPlaying())
        if not playing and self._authoring.film.path is not None:
            self.seek(self._authoring.view.playhead_s)

    def on_failed(self, why: str) -> None:
        """Say in the pane why there is no video."""
        self._failure = texts.VIDEO_FAILED.format(why=why)
        self._say_what_is_next()

    def release(self) -> None:
        """Let go of the film, so that its file can be removed."""
        if self._player is not None:
            self._player.stop()
            self._player.setSource(QUrl())

    def _opened_player(self):
        """Open the platform's player when there is first something to play; loading it takes a while."""
        if self._player is None:
            from PySide6.QtMultimedia import QAudioOutput, QMediaPlayer, QVideoSink

            self._player = QMediaPlayer(self)
            self._sink = QVideoSink(self)
            self._sink.videoFrameChanged.connect(self.video_view.show_frame)
            self._player.setVideoSink(self._sink)
            self._player.setAudioOutput(QAudioOutput(self))
            self._player.errorOccurred.connect(lambda _, text: self.on_failed(text))
            self._player.durationChanged.connect(lambda ms: self.transport.set_duration(ms / 1000))
            self._player.positionChanged.connect(self._show_time)
            self._player.playingChanged.connect(self.transport.show_playing)
            self._player.mediaStatusChanged.connect(self._on_status)
        return self._player

    def _on_status(self, status) -> None:
        from PySide6.QtMultimedia import QMediaPlayer

        if status == QMediaPlayer.MediaStatus.LoadedMedia:
            self.seek(self._authoring.view.playhead_s)

    def _show_time(self, position_ms: int) -> None:
        film = self._authoring.film
        self.transport.show_time(position_ms / 1000, film.fps, film.fps_name)

    def _say_what_is_next(self, *_: object) -> None:
        authoring = self._authoring
        composing = authoring.jobs.is_running("film")
        can_compose = authoring.document.answer is not None and authoring.film.path is None and not composing
        self.compose_button.setEnabled(can_compose)
        if self._failure:
            self.show_empty(self._failure)
        elif authoring.film.path is not None:
            self.show_content()
        elif composing:
            self.show_empty(texts.VIDEO_WAITING)
        else:
            self.show_empty(texts.VIDEO_CANCELLED if can_compose else texts.VIDEO_EMPTY)
