"""What was spoken live, kept as a project: the sound, and the emotions that were asked for while it ran.

The motion itself is not kept. The engine ``iface`` makes it again from the sound and the emotion spans, with the same
model, features and easing as live (`core.iface`), so that emotions, curves and engine can be edited like those of any
project. It is the motion that was seen, but for the first frames of a recording that began in mid-speech: live, the
face had heard what came before.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.texts import live as texts
from core.document.content import ProjectContent
from core.document.document import Document, ProjectState
from core.document.parts import DEFAULT_FACE, DatabaseReference, FaceChoice, Speech
from core.document.project_file import ProjectFile
from core.errors import UserFacingError
from core.iface.expression_ease import spans_of
from core.iface.live import LiveFrame
from core.iface.speech_features import RATE_HZ
from core.media.audio import LONGEST_S, SHORTEST_S, Audio
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PAU
from core.speech.transcript import PhonemeUtterance, Transcript

ENGINE = "iface"
# Windows of 10 ms and frames of 1/30 s begin together every so often, and only there can a recording begin.
_GRID_HZ = 10


@dataclass(frozen=True, eq=False)
class Take:
    """A recording.

    audio : at the rate of the device
    spans : the emotions that were asked for
    positions : float32, shape (n_frames, n_markers, 3), mm: the frames that were shown, from the start of ``audio`` on;
        the last tenth of a second was not on show yet
    """

    audio: Audio
    spans: tuple[EmotionModifier, ...]
    positions: np.ndarray


class Recorder:
    """Gathers a take while the session runs.

    is_full : an hour was recorded, and nothing more is taken
    """

    def __init__(self, rate_hz: int, n_heard: int) -> None:
        """Begin at the next tenth of a second after ``n_heard`` samples of the session."""
        tenth = -(-n_heard * _GRID_HZ // rate_hz)
        self._rate_hz = rate_hz
        self._first_frame = tenth * RATE_HZ // _GRID_HZ
        self._skip = round(tenth * rate_hz / _GRID_HZ) - n_heard
        self._pieces: list[np.ndarray] = []
        self._frames: list[LiveFrame] = []
        self._n_samples = 0

    @property
    def duration_s(self) -> float:
        """How much was recorded so far."""
        return self._n_samples / self._rate_hz

    @property
    def is_full(self) -> bool:
        """Whether there is no more room."""
        return self.duration_s > LONGEST_S - 1.0

    def accept(self, samples: np.ndarray, frames: list[LiveFrame]) -> None:
        """Take the next sound and the frames that it completed."""
        if self.is_full:
            return
        kept = np.clip(np.nan_to_num(samples[self._skip :], posinf=0.0, neginf=0.0), -1.0, 1.0)
        self._skip = max(0, self._skip - len(samples))
        if len(kept):
            self._pieces.append(kept)
            self._n_samples += len(kept)
        self._frames += [frame for frame in frames if frame.frame >= self._first_frame]

    def take(self) -> Take:
        """Return what was recorded; raises `UserFacingError` when that is next to nothing."""
        if self.duration_s < SHORTEST_S or not self._frames:
            raise UserFacingError(texts.NOTHING_RECORDED)
        audio = Audio(np.concatenate(self._pieces), self._rate_hz)
        n_frames = max(1, round(audio.duration_s * RATE_HZ))
        asked = [frame.asked for frame in self._frames][:n_frames]
        asked += asked[-1:] * (n_frames - len(asked))
        return Take(audio, spans_of(asked), np.stack([frame.positions for frame in self._frames]))


def save_take(
    take: Take,
    path: Path,
    database: MotionDatabase,
    face: FaceChoice | None = DEFAULT_FACE,
    progress: Progress = SILENT,
) -> tuple[str, ...]:
    """Write a take as a project that the window opens, in place of what is there; return sentences about it.

    What is said is recognised, so that lanes and other engines have phonemes; where nothing is recognised it is all
    one silence, which the engine ``iface`` does not mind. Raises `UserFacingError` when it cannot be written.
    """
    from app.speech import load_speech

    transcript = Transcript.covering([PhonemeUtterance(PAU, 0.0, take.audio.duration_s)], [], take.audio.duration_s)
    text, said = "", ()
    try:
        speech = load_speech(take.audio, progress=progress.part(0.0, 0.8))
        transcript, text = speech.transcript, speech.text
    except UserFacingError as error:
        said = (texts.NOT_RECOGNISED.format(why=error.message),)
    document = Document(face)
    document.load(ProjectState(
        database_reference=DatabaseReference.to(database), speech=Speech(take.audio, transcript, text),
        modifiers=take.spans, engine=ENGINE, face=face,
    ))  # fmt: skip
    progress.step(0.9, texts.SAVING)
    file = ProjectFile.create(path)
    try:
        file.save(ProjectContent.of(document), take.audio)
    finally:
        file.close()
    return said
