"""What tuning asks: how far from the captures is what the search makes of their speech, under given weights?"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.evaluation.comparison import CapturedTruth
from core.motion.database import MotionDatabase
from core.motion.node import NodeTable
from core.motion.recording import Recording
from core.motion.resample import resample
from core.search.constraints import SearchRequest
from core.search.engine import usable_frames
from core.search.lip_weight import pose_metric
from core.search.terms import TransitionTerms
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX
from core.synthesis.concatenate import SlotFrames, concatenate
from core.synthesis.options import PAPER, SynthesisOptions
from core.synthesis.silence import INTERPOLATIONS, regenerate_silence
from core.synthesis.smoothing import smooth_joins

# What is compared: all markers as in the paper, those of the lips, or the lip gap alone.
OBJECTIVES = ("all", "lips", "gap")


@dataclass(frozen=True)
class TuningSentence:
    """A held-out sentence: the question to the search, and the capture that it is measured against.

    slots : at the database's rate
    truth : float32, shape (n_frames, n_outputs), mm, what `TuningProblem.judged` makes of the capture, at ``rate_hz``
    usable : bool, shape (n_frames,), frames without a gap in the capture
    """

    name: str
    request: SearchRequest
    slots: SlotFrames
    rate_hz: float
    truth: np.ndarray
    usable: np.ndarray

    @classmethod
    def of(cls, recording: Recording, database: MotionDatabase, judge: np.ndarray) -> TuningSentence:
        """Ask for the phonemes and the emotion of a held-out recording."""
        utterances = recording.transcript.phonemes
        emotions = np.zeros((len(utterances), len(EMOTIONS)))
        emotions[:, EMOTION_INDEX[recording.emotion]] = 1.0
        slots = SlotFrames.of([u.start_s for u in utterances], [u.end_s for u in utterances], database.rate_hz)
        request = SearchRequest(
            np.array([PHONEME_INDEX[u.phone] for u in utterances]), emotions, lengths=slots.stop - slots.start
        )
        captured = CapturedTruth.of(recording, database)
        known = np.where(captured.usable[:, None, None], captured.positions, 0.0)
        truth = (known.reshape(len(known), -1) @ judge).astype(np.float32)
        return cls(recording.sentence, request, slots, recording.rate_hz, truth, captured.usable)


@dataclass(frozen=True)
class TuningProblem:
    """Everything that an evaluation needs, and nothing that it does not, so that it travels light.

    frames : float32, shape (n_frames, n_dims), as the search sees them; ``compared`` : where nodes join
    nodes, rate_hz, rest : of the database; ``rest`` in PCA coefficients
    silence : how silence is interpolated
    sentences : held out, in an order in which the first few are of all emotions
    mean, basis : shape (n_outputs,) and (n_dims, n_outputs), from PCA coefficients to what is compared, mm
    n_points : how many markers, or gaps, that is
    key : hex digest of all this
    """

    frames: np.ndarray
    compared: np.ndarray
    nodes: NodeTable
    rate_hz: float
    rest: np.ndarray
    silence: str
    sentences: Sequence[TuningSentence]
    mean: np.ndarray
    basis: np.ndarray
    n_points: int
    key: str

    @classmethod
    def of(
        cls, database: MotionDatabase, recordings: Sequence[Recording], objective: str = "all",
        options: SynthesisOptions = PAPER,
    ) -> TuningProblem:  # fmt: skip
        """Pose the problem for held-out recordings and the best path alone, as the options of the search have it.

        Silence that is filled with captures, which no weight of the search chooses, is interpolated instead. Raises
        `UserFacingError` for an objective that there is not, or markers that the database lacks.
        """
        judge, n_points = _judge(database, objective)
        sentences = [TuningSentence.of(r, database, judge) for r in _mixed(recordings)]
        frames = usable_frames(database, options)
        metric = pose_metric(database.pca, database.markers, options.lip_weight)
        compared = frames if options.lip_weight == 1.0 else frames @ metric
        silence = options.silence if options.silence in INTERPOLATIONS else INTERPOLATIONS[0]
        key = hashlib.sha256(f"{database.content_hash} {objective} {silence} {len(sentences)}".encode())
        for s in sentences:
            for array in (s.request.phonemes, s.request.emotions, s.slots.stop, s.truth, s.usable):
                key.update(np.ascontiguousarray(array).tobytes())
        for array in (frames, compared):
            key.update(np.ascontiguousarray(array).tobytes())
        return cls(frames, compared, database.nodes, database.rate_hz, database.rest_coefficients, silence, sentences,
                   database.pca.mean @ judge, database.pca.basis.T @ judge, n_points, key.hexdigest())  # fmt: skip

    def terms(self) -> TransitionTerms:
        """Return the search's terms over the database."""
        return TransitionTerms(self.compared, self.nodes, self.rate_hz)

    def error(self, sentence: int, path: np.ndarray) -> float:
        """``Err_i = Σ_j Σ_k |SYN - ORI|² / (N_i · MrkNum)`` in mm² (Deng and Neumann 2008, equation 12).

        The synthesis is that of `core.search.engine`, brought to the frames of the capture as in
        `core.evaluation.comparison`; frames inside gaps of the capture do not count.
        """
        s = self.sentences[sentence]
        motion = concatenate(path, s.slots, self.frames, self.nodes)
        motion = smooth_joins(motion, path, s.request.phonemes, s.slots, self.nodes)
        motion = regenerate_silence(motion, s.request.phonemes, s.slots, self.rest, self.rate_hz, self.silence)
        made = resample(motion, self.rate_hz, s.rate_hz, len(s.truth))[s.usable] @ self.basis + self.mean
        return float(((made - s.truth[s.usable]) ** 2).sum(axis=1).mean() / self.n_points)


def _judge(database: MotionDatabase, objective: str) -> tuple[np.ndarray, int]:
    """Matrix from packed marker positions to what is compared, shape (3 n_markers, n_outputs), and how much that is."""
    markers = database.markers
    if objective == "gap":
        upper, lower = markers.landmark("upper_lip"), markers.landmark("lower_lip")
        if upper is None or lower is None:
            raise UserFacingError(f"The database '{database.name}' does not say which markers tell the lip gap.")
        judge = np.zeros((3 * len(markers), 1))
        judge[3 * upper + 1], judge[3 * lower + 1] = 1.0, -1.0
        return judge, 1
    if objective not in OBJECTIVES:
        raise UserFacingError(f"There is no tuning objective '{objective}'.", f"Choose one of {', '.join(OBJECTIVES)}.")
    rows = markers.group("lips") if objective == "lips" else np.arange(len(markers))
    if not len(rows):
        raise UserFacingError(f"The database '{database.name}' has no markers in the group 'lips'.")
    return np.eye(3 * len(markers))[:, (rows[:, None] * 3 + np.arange(3)).ravel()], len(rows)


def _mixed(recordings: Sequence[Recording]) -> list[Recording]:
    """Sort by name and take from each emotion in turn."""
    by_emotion: dict[str, list[Recording]] = {}
    for recording in sorted(recordings, key=lambda r: r.sentence):
        by_emotion.setdefault(recording.emotion, []).append(recording)
    turns = [(i, r) for group in by_emotion.values() for i, r in enumerate(group)]
    return [r for _, r in sorted(turns, key=lambda turn: turn[0])]
