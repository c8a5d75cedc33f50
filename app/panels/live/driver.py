"""What the live window asks for: jobs that open things, and the session that speaks; answers come as signals."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from app.jobs import JobRunner
from app.live.command import open_outgoing
from app.live.microphone import InputDevice, Microphone, input_devices
from app.live.opening import speaking_face
from app.live.outgoing import Outgoing, StreamAddress
from app.live.session import LiveSession, TimedFrame
from app.live.source import FileSource, Source
from app.live.take import Take, save_take
from app.texts import live as texts
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.iface.live import NEUTRAL
from core.iface.speaking import SpeakingFace
from core.motion.database import MotionDatabase
from core.progress import Progress


class _Voice(QObject):
    """Carries what the session says to the main thread."""

    heard = Signal(object)
    ended = Signal(object, object)


class LiveDriver(QObject):
    """Runs one `LiveSession` for the window.

    source : what it listens to, or None; last_source : what it listened to last
    take : a recording that waits to be saved; records_at_once : whether sources are recorded from their first sample

    devices_found(devices) : the microphones of this machine; learned(face) : a face can speak
    heard(frame) : a `TimedFrame`; changed() : it began or ended to listen, to record or to send, or there is a take
    noted(sentence), failed(sentence, remedy) : what happened; saved(path) : the take is a project now
    """

    devices_found = Signal(object)
    learned = Signal(object)
    heard = Signal(object)
    changed = Signal()
    noted = Signal(str)
    failed = Signal(str, str)
    saved = Signal(object)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.jobs = jobs
        self.session: LiveSession | None = None
        self.source: Source | None = None
        self.last_source: Source | None = None
        self.take: Take | None = None
        self.records_at_once = False
        self._database: MotionDatabase | None = None
        self._taken_from: MotionDatabase | None = None
        self._asked = (NEUTRAL, 1.0)
        self._waiting: Source | None = None
        self._outgoing: Outgoing | None = None
        self._voice = _Voice()
        self._voice.heard.connect(self._on_heard, Qt.ConnectionType.QueuedConnection)
        self._voice.ended.connect(self._on_ended, Qt.ConnectionType.QueuedConnection)
        jobs.failed.connect(self.failed)
        jobs.ended.connect(self._on_job_ended)

    # Opening

    def find_devices(self) -> None:
        """Look for microphones."""
        self.jobs.start("devices", texts.LOOKING, None, input_devices, self.devices_found.emit)

    def use(self, database: MotionDatabase | None) -> None:
        """Speak as another database teaches; the session of the one before ends."""
        if database is not self._database:
            self.stop()
            self.jobs.cancel("face")
            self.stop_sending()
            self._database, self.session = database, None

    def listen(self, device: InputDevice | None = None, file: Path | None = None) -> None:
        """Listen to a device (None: the default) or a file, once the face has learned to speak."""
        self.stop()
        if self._database is None:
            self.failed.emit(texts.NO_DATABASE, "")
            return
        try:
            self._waiting = Microphone(device) if file is None else FileSource(file, repeats=True)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        if self.session is not None:
            self._begin()
        else:
            self.jobs.start("face", texts.LEARNING, self._database, speaking_face, self._on_learned)
            self.changed.emit()

    def _on_learned(self, face: SpeakingFace) -> None:
        self.session = LiveSession(face, self._voice.heard.emit, self._tell_ended)
        self.session.ask(*self._asked)
        self.session.send_to(self._outgoing)
        self.learned.emit(face)
        self._begin()

    def _on_job_ended(self, kind: str) -> None:
        # its answer, if there is one, is taken after this
        if kind in ("face", "stream"):
            QTimer.singleShot(0, self, self._on_job_over)

    def _on_job_over(self) -> None:
        if self.session is None and not self.jobs.is_running("face"):  # given up, or nothing could be learned
            self._waiting = None
        self.changed.emit()

    def _begin(self) -> None:
        self.source, self._waiting = self._waiting, None
        if self.source is not None:
            self.last_source = self.source
            self.session.start(self.source, self.records_at_once)
        self.changed.emit()

    def _tell_ended(self, failure: UserFacingError | None) -> None:
        self._voice.ended.emit(self.source, failure)

    # While it runs

    @property
    def is_listening(self) -> bool:
        """Whether it listens, or will once the face has learned."""
        return self.source is not None or self._waiting is not None

    def ask(self, emotion: str, intensity: float) -> None:
        """Let the face go to an emotion, now or when it comes to speak."""
        self._asked = emotion, intensity
        if self.session is not None:
            self.session.ask(emotion, intensity)

    def stop(self) -> None:
        """Listen no more; what was recorded is kept."""
        self.jobs.cancel("face")
        was_listening, self.source, self._waiting = self.is_listening, None, None
        if self.session is not None:
            self.session.stop()
            self.end_recording()
        if was_listening:
            self.changed.emit()

    def _on_heard(self, frame: TimedFrame) -> None:
        if self.source is not None:
            self.heard.emit(frame)

    def _on_ended(self, source: Source, failure: UserFacingError | None) -> None:
        if source is not self.source:
            return
        self.source = None
        self.end_recording()
        if failure is None:
            self.noted.emit(texts.ENDED.format(source=source.name))
        else:
            self.failed.emit(failure.message, failure.remedy)
        self.changed.emit()

    # Recording

    @property
    def recorded_s(self) -> float | None:
        """Length of the recording that runs, None when there is none."""
        return None if self.session is None else self.session.recorded_s

    def record(self) -> None:
        """Record from now on, in place of a take that was not saved."""
        if self.session is not None and self.source is not None:
            self.session.record()
            self.take = None if self.recorded_s is not None else self.take
            self.changed.emit()

    def end_recording(self) -> None:
        """Stop to record; the take waits to be saved."""
        if self.recorded_s is None:
            return
        try:
            self.take, self._taken_from = self.session.end_recording(), self._database
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
        self.changed.emit()

    def save(self, path: Path, face: FaceChoice | None) -> None:
        """Write the take as a project."""
        if self.take is not None:
            request = (self.take, path, self._taken_from, face)
            self.jobs.start("save", texts.SAVING, request, _save, lambda said: self._on_saved(path, said))

    def _on_saved(self, path: Path, said: tuple[str, ...]) -> None:
        self.take = None
        self.noted.emit(" ".join((texts.SAVED.format(path=path), *said)))
        self.saved.emit(path)
        self.changed.emit()

    # Streaming out

    @property
    def is_sending(self) -> bool:
        """Whether frames go to another program."""
        return self._outgoing is not None or self.jobs.is_running("stream")

    @property
    def n_sent(self) -> int:
        """How many packets left."""
        return 0 if self._outgoing is None else self._outgoing.n_sent

    def send_to(self, address: str) -> None:
        """Send each frame to ``udp://HOST:PORT`` or ``osc://HOST:PORT``."""
        self.stop_sending()
        try:
            parsed = StreamAddress.parsed(address)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        if self._database is None:
            self.failed.emit(texts.NO_DATABASE, "")
            return
        self.jobs.start("stream", texts.OPENING_STREAM, (parsed, self._database), _open_outgoing,
                        self._on_stream, discarded=Outgoing.close)  # fmt: skip
        self.changed.emit()

    def _on_stream(self, outgoing: Outgoing) -> None:
        self._outgoing = outgoing
        if self.session is not None:
            self.session.send_to(outgoing)
        self.changed.emit()

    def stop_sending(self) -> None:
        """Send no more."""
        self.jobs.cancel("stream")
        outgoing, self._outgoing = self._outgoing, None
        if self.session is not None:
            self.session.send_to(None)
        elif outgoing is not None:
            outgoing.close()
        if outgoing is not None:
            self.changed.emit()

    def shut_down(self) -> None:
        """End everything, for good."""
        self.stop()
        self.stop_sending()


def _save(request: tuple[Take, Path, MotionDatabase, FaceChoice | None], progress: Progress) -> tuple[str, ...]:
    return save_take(*request, progress)


def _open_outgoing(request: tuple[StreamAddress, MotionDatabase], _progress: Progress) -> Outgoing:
    return open_outgoing(*request)
