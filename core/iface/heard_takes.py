"""What is heard and what is seen, frame by frame: what faces are trained on and measured against."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import UserFacingError
from core.iface.noisy_hearing import heard_in_noises
from core.iface.speech_features import RATE_HZ, speech_features
from core.media.audio import Audio, audio_from_bytes, load_audio
from core.motion.captured_sentence import CapturedSentence
from core.motion.database import MotionDatabase
from core.motion.head_space import in_head_space
from core.motion.recording import Recording
from core.motion.resample import resample
from core.progress import SILENT, Progress
from core.speech.transcript import Transcript


@dataclass(frozen=True, eq=False)
class HeardTake:
    """One sentence at 30 Hz; frame f stands at f / 30 seconds.

    features : float32, shape (n_frames, 70), see `core.iface.speech_features`
    displacements : float32, shape (n_frames, n_markers, 3), mm from the neutral pose, head space
    used : bool, shape (n_frames,); False for what is heard around the others, and neither learned nor measured
    in_noise : features of the same sound in noise, one array a noise; see `core.iface.noisy_hearing`
    """

    name: str
    emotion: str
    transcript: Transcript
    features: np.ndarray
    displacements: np.ndarray
    used: np.ndarray
    in_noise: tuple[np.ndarray, ...] = ()

    def __len__(self) -> int:
        return len(self.features)


def database_takes(database: MotionDatabase, progress: Progress = SILENT, n_noises: int = 0) -> list[HeardTake]:
    """Return the sentences that ``database`` is built of, each heard in ``n_noises`` noises besides.

    Raises `UserFacingError` for one without sound.
    """
    takes = []
    for s, sentence in enumerate(database.sentences):
        progress.step(s / len(database.sentences), f"listening to {sentence.name}")
        coefficients = database.frames[sentence.start_frame : sentence.stop_frame]
        if len(coefficients):
            audio = _kept_sound(database, sentence.name)
            take = _take(database, sentence, audio, coefficients, np.ones(len(coefficients), bool))
            takes.append(replace(take, in_noise=heard_in_noises(audio, len(take), n_noises, s)))
    return takes


def recorded_takes(
    database: MotionDatabase, recordings: Sequence[Recording], progress: Progress = SILENT, n_noises: int = 0
) -> list[HeardTake]:
    """Return ``recordings`` as they would be in ``database``: head motion out, at its rate, through its components.

    Long gaps are not used. The sound is that of the recording, or the one that the database keeps for it, heard in
    ``n_noises`` noises besides; raises `UserFacingError` when there is none, or a marker of the database is missing.
    """
    takes = []
    for r, recording in enumerate(recordings):
        progress.step(r / len(recordings), f"listening to {recording.sentence}")
        seen = in_head_space(recording, database.markers, database.with_scale)
        n_frames = max(1, round(recording.transcript.duration_s * database.rate_hz))
        n_frames = min(n_frames, round(len(seen.face) / recording.rate_hz * database.rate_hz))
        face = resample(seen.face, recording.rate_hz, database.rate_hz, n_frames)
        place = np.minimum(np.arange(n_frames) * recording.rate_hz / database.rate_hz, len(seen.face) - 1)
        is_lost = seen.masked[np.floor(place).astype(int)] | seen.masked[np.ceil(place).astype(int)]
        sound = recording.audio
        audio = _kept_sound(database, recording.sentence) if sound is None else load_audio(sound)
        take = _take(database, recording, audio, database.pca.coefficients(face), ~is_lost)
        takes.append(replace(take, in_noise=heard_in_noises(audio, len(take), n_noises, r)))
    return takes


def _kept_sound(database: MotionDatabase, sentence: str) -> Audio:
    flac = database.audio_bytes(sentence)
    if flac is None:
        raise UserFacingError(
            f"The database '{database.name}' has no sound of sentence '{sentence}'.",
            "Build it anew from a corpus with sound.",
        )
    return audio_from_bytes(flac, f"the sound of '{sentence}'")


def _take(
    database: MotionDatabase, said: CapturedSentence | Recording, audio: Audio, coefficients: np.ndarray,
    used: np.ndarray,
) -> HeardTake:  # fmt: skip
    place = np.arange(max(1, int((len(coefficients) - 1) * RATE_HZ / database.rate_hz + 1e-6) + 1))
    place = np.rint(place * database.rate_hz / RATE_HZ).astype(int)
    displacements = database.pca.positions(coefficients[place].astype(float)) - database.markers.rest
    features = speech_features(audio, len(place))
    name = said.name if isinstance(said, CapturedSentence) else said.sentence
    return HeardTake(name, said.emotion, said.transcript, features, displacements.astype(np.float32), used[place])
