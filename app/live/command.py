"""`efase live` without a window: a face that speaks until the file is over, the time is up or it is interrupted."""

from __future__ import annotations

import queue
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from app.live.microphone import InputDevice, Microphone, input_devices
from app.live.opening import open_speaking_face
from app.live.outgoing import Outgoing, StreamAddress
from app.live.session import LiveSession
from app.live.source import FileSource, Source, SourceLost
from app.live.take import save_take
from app.terminal import note
from app.texts import live as texts
from core.document.project_file import SUFFIX
from core.errors import UserFacingError
from core.iface.live import NEUTRAL
from core.iface.speaking import SpeakingFace
from core.media.swap_in import check_target
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import emotion_named

_TELL_EVERY_S = 0.25
_RETRY_S = 2.0
_BAR_CELLS, _BAR_FLOOR_DB = 20, -60.0


@dataclass(frozen=True)
class LiveJob:
    """Everything that `efase live` was told; see its help."""

    file: Path | None = None
    device: str | None = None
    database: Path | None = None
    emotion: str = NEUTRAL
    intensity: float = 1.0
    stream: str | None = None
    seconds: float | None = None
    project: Path | None = None


@dataclass(frozen=True)
class Ready:
    """What a session needs opened."""

    database: MotionDatabase
    face: SpeakingFace
    source: Source
    outgoing: Outgoing | None


def checked(job: LiveJob) -> tuple[str, InputDevice | None]:
    """Return the emotion and the device that ``job`` names; raises `UserFacingError` for what cannot be."""
    if job.file is not None and job.device is not None:
        raise UserFacingError("A file and a device were named; one of them is listened to.")
    if job.project is not None:
        if job.project.suffix.lower() != SUFFIX:
            raise UserFacingError(f"'{job.project}' is no name of a project.", f"Let it end in {SUFFIX}.")
        check_target(job.project)
    if job.stream is not None:
        StreamAddress.parsed(job.stream)
    return emotion_named(job.emotion), named_device(job.device)


def made_ready(job: LiveJob, progress: Progress = SILENT) -> Ready:
    """Open what ``job`` needs; raises `UserFacingError` before anything listens."""
    emotion, device = checked(job)
    source = FileSource(job.file) if job.file is not None else Microphone(device)
    database, face = open_speaking_face(job.database, progress)
    if emotion != NEUTRAL and emotion not in face.expressions:
        raise UserFacingError(
            f"'{database.name}' taught the face no '{emotion}'.", f"It knows {', '.join((NEUTRAL, *face.expressions))}."
        )
    outgoing = None if job.stream is None else open_outgoing(StreamAddress.parsed(job.stream), database)
    return Ready(database, face, source, outgoing)


def open_outgoing(address: StreamAddress, database: MotionDatabase) -> Outgoing:
    """Open a stream of the default character's weights; raises `UserFacingError`."""
    from core.face.characters import DEFAULT
    from core.face.default_face import character_face

    return Outgoing(address, character_face(DEFAULT), database.markers)


def named_device(name: str | None) -> InputDevice | None:
    """Return the one device whose name holds ``name``, None for the default; `UserFacingError` for none and many."""
    if name is None:
        return None
    known = input_devices()
    exact = [device for device in known if device.name == name]
    found = exact or [device for device in known if name.lower() in device.name.lower()]
    if len(found) != 1:
        names = ", ".join(f"'{device.name}'" for device in known) or "none"
        raise UserFacingError(f"'{name}' names {len(found) or 'no'} devices that hear.", f"There are {names}.")
    return found[0]


def run(job: LiveJob, ready: Ready, progress: Progress = SILENT) -> dict[str, object]:
    """Listen to the end and return the object of ``--json``; raises `UserFacingError` when nothing could be heard.

    A device that goes away is tried again every two seconds, unless the session is recorded: a recording ends with it.
    """
    ends: queue.SimpleQueue[UserFacingError | None] = queue.SimpleQueue()
    session = LiveSession(ready.face, lambda _: None, ends.put)
    session.ask(emotion_named(job.emotion), job.intensity)
    session.send_to(ready.outgoing)
    warnings: list[str] = []
    killed: SystemExit | None = None
    began_s = time.perf_counter()
    session.start(ready.source, records=job.project is not None)
    try:
        while job.seconds is None or time.perf_counter() - began_s < job.seconds:
            _tell(session)
            try:
                failure = ends.get(timeout=_TELL_EVERY_S)
            except queue.Empty:
                continue
            if failure is None:
                break
            if session.n_frames == 0 or not isinstance(failure, SourceLost):
                raise failure
            warnings.append(failure.message)
            note(f"efase: {failure}")
            if job.project is not None:
                break
            time.sleep(_RETRY_S)
            session.start(Microphone(named_device(job.device)))
    except KeyboardInterrupt:
        pass  # the way to end a session
    except SystemExit as ended:  # a polite kill or a closed terminal costs nobody what was recorded
        killed = ended
    finally:
        session.stop()
        figures = session.figures()
        session.send_to(None)
    outputs = []
    take = session.end_recording()
    if take is not None:
        warnings += save_take(take, job.project, ready.database, progress=progress)
        outputs.append(str(job.project))
    if killed is not None:
        raise killed
    return {"source": ready.source.name, "rate_hz": ready.source.rate_hz, **figures, "warnings": warnings,
            "outputs": outputs}  # fmt: skip


def _tell(session: LiveSession) -> None:
    """Show level and delay in one line, on a terminal."""
    level, waits = session.level, session.waits
    if level is None or not sys.stderr.isatty():
        return
    cells = round(_BAR_CELLS * min(1.0, max(0.0, 1.0 - level.rms_db / _BAR_FLOOR_DB)))
    delay = f"{1000 * waits[-1][3]:4.0f} ms" if waits else ""
    clip = texts.CLIPPED if session.n_clipped else ""
    print(f"\r{'█' * cells:<{_BAR_CELLS}} {level.peak_db:6.1f} dB  {delay}  {clip:<8}", end="", file=sys.stderr)


def in_words(answer: dict[str, object]) -> str:
    """Return the figures of a session in words."""
    waits = answer["waits_ms"]
    lines = [f"{answer['frames']} frames from {answer['source']} at {answer['rate_hz']} Hz"]
    if waits:
        parts = ", ".join(f"{name.replace('_', '-')} {part['median']:.1f}" for name, part in waits.items())
        lines.append(f"delay in ms, medians: {parts}; compute at the 99th percentile {waits['compute']['p99']:.2f}")
    lines.append(f"drop-outs {answer['overflows'] + answer['dropouts']}, clipped samples {answer['clipped_samples']}, "
                 f"packets sent {answer['sent']}")  # fmt: skip
    return "\n".join((*lines, *answer["outputs"]))
