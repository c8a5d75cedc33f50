"""The synthesised motion: every frame of it, on the face or as markers, played with sound."""

from __future__ import annotations

from app import texts
from app.authoring import Authoring
from app.panels.face_view import FaceView
from app.panels.pane import Choice, Pane
from app.panels.transport import Transport
from core.document.change import Change
from core.synthesis.marker_motion import MarkerMotion
from gpu.gl.face import Style


class MotionPane(Pane):
    """Top left: what the search found."""

    def __init__(self, authoring: Authoring) -> None:
        self.face_view = FaceView()
        super().__init__(texts.MOTION, self.face_view, texts.WAITING_DATABASE)
        self._authoring = authoring
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
        self.on_document_changed(Change.NODES | Change.ALIGNMENT | Change.PATH, None)

    @property
    def motion(self) -> MarkerMotion | None:
        """The motion on show."""
        answer = self._authoring.document.answer
        return None if answer is None else answer.motion

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
        if change & (Change.PATH | Change.ALIGNMENT | Change.NODES):
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

    def on_playhead_moved(self, time_s: float) -> None:
        """Show the frame at the playhead."""
        film = self._authoring.film
        self.transport.show_time(time_s, film.fps, film.fps_name)
        motion = self.motion
        if motion is not None:
            besides = self._authoring.tracks.at(self.frame)
            self.face_view.show_pose(motion.positions[self.frame] - motion.markers.rest, besides)

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
