"""A corpus of any length, made of a database by repeating its sentences with variation: to measure what size costs."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from core.motion.captured_sentence import CapturedSentence
from core.motion.corpus import Corpus
from core.motion.database import MotionDatabase
from core.motion.recording import Recording
from core.motion.resample import frame_bounds
from core.search.replicate import varied
from core.speech.transcript import PhonemeUtterance, Transcript

_NOISE_MM = 0.05


def repeated_corpus(database: MotionDatabase, n_frames: int, seed: int = 2008) -> Corpus:
    """Return a corpus of at least ``n_frames`` frames at the rate of ``database``, head motion and noise put back.

    The first round is the database's own sentences as its components show them; in later rounds they are varied (see
    `core.search.replicate.varied`). Each marker has noise of 0.05 mm. Positions are made whenever they are asked for,
    so that the corpus takes no memory; it is called synthetic.
    """
    deviation = database.frames.std(axis=0)
    recordings, made, take = [], 0, 0
    while made < n_frames:
        for s, sentence in enumerate(database.sentences):
            motion = _RepeatedMotion(database, sentence, deviation, take, seed + 7919 * take + s)
            recordings.append(motion.recording)
            made += len(motion)
            if made >= n_frames:
                break
        take += 1
    markers = database.markers
    return Corpus(f"{database.name}, repeated", recordings, markers.names, markers.groups, markers.landmarks,
                  rest=markers.rest, synthetic=True)  # fmt: skip


class _RepeatedMotion:
    """Marker positions of one sentence of one round, made anew for each `numpy.asarray`."""

    def __init__(
        self, database: MotionDatabase, sentence: CapturedSentence, deviation: np.ndarray, take: int, seed: int
    ) -> None:
        self._database, self._sentence, self._deviation = database, sentence, deviation
        self._take, self._seed = take, seed

    def __len__(self) -> int:
        return int(self._lengths.sum())

    def __array__(self, dtype=None, copy=None) -> np.ndarray:
        database, sentence = self._database, self._sentence
        rng = np.random.default_rng(self._seed)
        span = slice(sentence.start_frame, sentence.stop_frame)
        motion, lengths = database.frames[span].astype(float), self._captured_lengths
        if self._take:
            lengths, motion = varied(rng, lengths, motion, self._deviation, database.rate_hz)
        face = database.pca.positions(motion)
        face += rng.normal(scale=_NOISE_MM, size=face.shape)
        at = np.linspace(span.start, span.stop - 1, len(face)).astype(int)
        turn = Rotation.from_rotvec(database.head_rotation[at]).as_matrix()
        captured = face @ turn.transpose(0, 2, 1) + database.head_translation[at, None]
        return captured.astype(np.float32 if dtype is None else dtype)

    @property
    def recording(self) -> Recording:
        """The sentence with these positions, and its phonemes where the variation put them."""
        database, sentence = self._database, self._sentence
        ends_s = np.cumsum(self._lengths) / database.rate_hz
        starts_s = np.concatenate([[0.0], ends_s[:-1]])
        phonemes = tuple(PhonemeUtterance(u.phone, float(start), float(end)) for u, start, end
                         in zip(sentence.transcript.phonemes, starts_s, ends_s))  # fmt: skip
        return Recording(
            f"{sentence.name}-{self._take}", sentence.emotion, self, database.markers.names, database.rate_hz,
            Transcript(phonemes, (), float(ends_s[-1])), sentence.text,
        )  # fmt: skip

    @cached_property
    def _captured_lengths(self) -> np.ndarray:
        """Frames of each phoneme, silence too; all frames of the sentence belong to one."""
        phonemes = self._sentence.transcript.phonemes
        _, stops = frame_bounds([u.start_s for u in phonemes], [u.end_s for u in phonemes], self._database.rate_hz)
        stops[-1] = self._sentence.stop_frame - self._sentence.start_frame
        return np.diff(np.concatenate([[0], np.minimum(stops, stops[-1])]))

    @cached_property
    def _lengths(self) -> np.ndarray:
        if not self._take:
            return self._captured_lengths
        rng = np.random.default_rng(self._seed)
        no_motion = np.zeros((int(self._captured_lengths.sum()), 1))
        return varied(rng, self._captured_lengths, no_motion, np.ones(1), self._database.rate_hz)[0]
