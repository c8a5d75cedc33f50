"""The synthesised motion: every frame of it, on the face or as markers, played with sound."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSplitter

from app import texts
from app.authoring import Authoring
from app.panels.face_view import FaceView
from app.panels.marker_plot import MarkerPlot
from app.panels.pane import Choice, Pane, toggle
from app.panels.transport import Transport
from app.theme import STEP
from core.document.change import Change
from core.motion.capture import capture_of
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.synthesis.marker_motion import MarkerMotion
from gpu.gl.face import Style

_TRAILED = ("mouth_corner_left", "mouth_corner_right", "upper_lip", "lower_lip", "chin")
_TRAIL_S, _TRAIL_STEPS = 0.35, 24


class MotionPane(Pane):
    """Top left: what the search found."""

    def __init__(self, authoring: Authoring) -> None:
        self.face_view = FaceView()
        self.plot = MarkerPlot()
        self.plot.hide()
        both = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False, handleWidth=1)
        both.addWidget(self.face_view)
        both.addWidget(self.plot)
        both.setStretchFactor(0, 1)
        super().__init__(texts.MOTION, both, texts.WAITING_DATABASE)
        self._authoring = authoring
        self.captured: MarkerMotion | None = None
        self.plot_button = toggle(texts.PLOT, texts.PLOT_TIP, self.plot.setVisible)
        self.trails_button = toggle(texts.TRAILS, texts.TRAILS_TIP, self._show_now)
        self.captured_button = toggle(texts.PLOT_CAPTURED, texts.CAPTURED_TIP, self._show_now)
        for button in (self.plot_button, self.trails_button, self.captured_button):
            self.header.addWidget(button)
        self.header.addSpacing(STEP)
        self.style = Choice([
            (Style.MARKERS.value, texts.MARKERS, texts.MARKERS_TIP),
            (Style.WIREFRAME.value, texts.WIREFRAME, texts.WIREFRAME_TIP),
            (Style.SHADED.value, texts.SHADED, texts.SHADED_TIP),
            (Style.TEXTURED.value, texts.TEXTURED, texts.TEXTURED_TIP),
        ])  # fmt: skip
        self.style.group.idClicked.connect(lambda _: self.face_view.set_style(Style(self.style.key)))
        self.header.addWidget(self.style)
        self.transport = Transport(texts.PLAY_TIP)
        self.transport.play_asked.connect(authoring.play_or_pause)
        self.transport.step_asked.connect(authoring.step_frame)
        self.transport.end_asked.connect(lambda is_end: authoring.seek(authoring.player.duration_s if is_end else 0.0))
        self.transport.seek_asked.connect(authoring.seek)
        self.footer.addWidget(self.transport, 1)
        authoring.player.playing_changed.connect(self.transport.show_playing)
        authoring.rig_changed.connect(self.on_rig_changed)
        authoring.tracks_changed.connect(lambda: self.on_playhead_moved(authoring.view.playhead_s))
        authoring.jobs.started.connect(self._say_what_is_next)
        authoring.jobs.ended.connect(self._say_what_is_next)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)
        authoring.document.changed.connect(self.on_document_changed)
        self.plot.time_asked.connect(authoring.seek)
        self.on_document_changed(Change.NODES | Change.SPEECH | Change.ALIGNMENT | Change.PATH, None)

    @property
    def motion(self) -> MarkerMotion | None:
        """The motion on show."""
        return self._authoring.document.motion

    @property
    def frame(self) -> int:
        """The frame on show, at the database's rate."""
        motion = self.motion
        at = round(self._authoring.view.playhead_s * motion.rate_hz)
        return min(at, len(motion.positions) - 1)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other markers, or other motion."""
        document = self._authoring.document
        if change & Change.NODES:
            self.face_view.set_markers(None if document.database is None else document.database.markers)
        if change & Change.ALIGNMENT:
            self.transport.set_duration(0.0 if document.speech is None else document.speech.transcript.duration_s)
        if change & (Change.SPEECH | Change.NODES):
            self._find_capture()
        if change & (Change.MOTION | Change.ALIGNMENT | Change.NODES):
            self.plot.show_motion(self.motion, self.captured)
            if self.motion is None:
                self._say_what_is_next()
            else:
                self.show_content()
            self.on_playhead_moved(self._authoring.view.playhead_s)

    def on_rig_changed(self) -> None:
        """Show another face."""
        self.face_view.set_rig(self._authoring.rig)
        for key in (Style.WIREFRAME.value, Style.SHADED.value, Style.TEXTURED.value):
            self.style.button(key).setEnabled(self._authoring.rig is not None)

    def _find_capture(self) -> None:
        """Look for how the actor herself said it; not every sentence was captured."""
        document = self._authoring.document
        self._show_capture(None)
        if document.database is not None and document.speech is not None:
            transcript = document.speech.transcript
            text = document.speech.text or " ".join(word.word for word in transcript.words)
            request = (document.database, text, transcript.duration_s)
            self._authoring.jobs.start("capture", "", request, _capture, self._show_capture)

    def _show_capture(self, captured: MarkerMotion | None) -> None:
        self.captured = captured
        self.captured_button.setEnabled(captured is not None)
        self.captured_button.setToolTip(texts.CAPTURED_TIP if captured is not None else texts.CAPTURED_NONE_TIP)
        self.plot.show_motion(self.motion, captured)
        self._show_now()

    def _show_now(self, *_: object) -> None:
        self.on_playhead_moved(self._authoring.view.playhead_s)

    def on_playhead_moved(self, time_s: float) -> None:
        """Show the frame at the playhead."""
        self.plot.show_time(time_s)
        film = self._authoring.film
        self.transport.show_time(time_s, film.fps, film.fps_name)
        motion = self.motion
        if motion is not None:
            besides = self._authoring.tracks.at(self.frame)
            self.face_view.show_pose(motion.positions[self.frame] - motion.markers.rest, besides)
            self.face_view.show_beside(self._captured_at(time_s), self._trails())

    def _captured_at(self, time_s: float) -> np.ndarray | None:
        if self.captured is None or not self.captured_button.isChecked():
            return None
        frame = min(round(time_s * self.captured.rate_hz), len(self.captured.positions) - 1)
        return self.captured.positions[frame] - self.captured.markers.rest

    def _trails(self) -> np.ndarray | None:
        """Return where the markers around the mouth come from, shape (n_trails, n_steps, 3), mm."""
        motion = self.motion
        if not self.trails_button.isChecked():
            return None
        rows = [row for name in _TRAILED if (row := motion.markers.landmark(name)) is not None]
        before = self.frame - np.linspace(_TRAIL_S * motion.rate_hz, 0, _TRAIL_STEPS).round().astype(int)
        return motion.positions[np.maximum(before, 0)][:, rows].transpose(1, 0, 2)

    def _say_what_is_next(self, *_: object) -> None:
        if self.motion is not None:
            return
        authoring, jobs = self._authoring, self._authoring.jobs
        if jobs.is_running("database"):
            text = texts.WAITING_DATABASE
        elif jobs.is_running("speech"):
            text = texts.WAITING_SPEECH
        elif jobs.is_running("search"):
            text = texts.MOTION_WAITING
        elif authoring.document.database is None:
            text = texts.MOTION_NO_DATABASE
        else:
            text = texts.MOTION_EMPTY_READY if authoring.can_synthesise else texts.MOTION_EMPTY
        self.show_empty(text)


def _capture(request: tuple[MotionDatabase, str, float], _progress: Progress) -> MarkerMotion | None:
    database, text, duration_s = request
    return capture_of(database, text, duration_s)
