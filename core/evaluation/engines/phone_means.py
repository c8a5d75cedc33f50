"""What a phone looks like on average, and straight lines between: near the truth everywhere, and dull."""

from __future__ import annotations

import numpy as np

from core.evaluation.engines.static_face import PlainAnswer
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import EMOTION_INDEX, EMOTIONS, emotion_weights
from core.speech.phoneme import PAU, PHONEME_INDEX, PHONEMES, VISEME_OF_PHONEME
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion


class PhoneMeans:
    """Mean frames at phone middles, linearly joined.

    Means are taken of the frames in the middle of each captured phone, silences included, emotion by emotion. Where an
    emotion lacks a phone its mean over all emotions stands in, then that of its viseme class, then the rest pose. At
    the ends of the sentence the outermost frame is held.
    """

    name = "phone-means"

    def __init__(self, database: MotionDatabase) -> None:
        self._database = database
        self._means: np.ndarray | None = None

    def prepare(self, progress: Progress = SILENT) -> None:
        """Take the means."""
        if self._means is None:
            self._means = mean_poses(self._database)

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> PlainAnswer:
        """Pass through the means in time."""
        self.prepare()
        database, spoken = self._database, speech.transcript.phonemes
        starts_s, ends_s = (np.array([getattr(u, name) for u in spoken]) for name in ("start_s", "end_s"))
        mix = emotion_weights(starts_s, ends_s, speech.modifiers)
        phones = [PHONEME_INDEX[u.phone] for u in spoken]
        knots = np.einsum("pe,epd->pd", mix, self._means[:, phones])
        times_s = np.arange(max(1, round(speech.transcript.duration_s * database.rate_hz))) / database.rate_hz
        middles_s = (starts_s + ends_s) / 2
        track = np.stack([np.interp(times_s, middles_s, knot) for knot in knots.T], axis=1)
        positions = database.pca.positions(track).astype(np.float32)
        return PlainAnswer(MarkerMotion(positions, database.rate_hz, database.markers))


def mean_poses(database: MotionDatabase) -> np.ndarray:
    """Mean frame of each phone's middle by emotion; float64, shape (n_emotions, n_phonemes, n_dims)."""
    phoneme, emotion, frame = _middles(database)
    poses = database.frames[frame].astype(float)
    viseme = np.asarray(VISEME_OF_PHONEME)
    means = np.empty((len(EMOTIONS), len(PHONEMES), poses.shape[1]))
    for e in range(len(EMOTIONS)):
        for p in range(len(PHONEMES)):
            same, alike, felt = phoneme == p, viseme[phoneme] == viseme[p], emotion == e
            likely = (same & felt, same, alike & felt, alike)
            found = next((rows for rows in likely if rows.any()), None)
            means[e, p] = database.rest_coefficients if found is None else poses[found].mean(axis=0)
    return means


def _middles(database: MotionDatabase) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Phoneme, emotion and middle frame of every node and every silence."""
    nodes, pau = database.nodes, PHONEME_INDEX[PAU]
    silences = []
    for sentence in database.sentences:
        for utterance in sentence.transcript.phonemes:
            if utterance.phone == PAU:
                middle = round((utterance.start_s + utterance.end_s) / 2 * database.rate_hz)
                frame = min(sentence.start_frame + middle, sentence.stop_frame - 1)
                silences.append((pau, EMOTION_INDEX[sentence.emotion], frame))
    spoken = np.stack([nodes.phoneme, nodes.emotion, (nodes.start + nodes.stop - 1) // 2], axis=1)
    columns = np.concatenate([spoken.astype(int), np.array(silences, int).reshape(-1, 3)]).T
    return columns[0], columns[1], columns[2]
