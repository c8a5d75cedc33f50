"""A synthesis laid over its capture: same markers, same space, same frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.evaluation import measures
from core.evaluation.measures import Roughness
from core.motion.database import MotionDatabase
from core.motion.head_space import in_head_space
from core.motion.marker_set import MarkerSet
from core.motion.recording import Recording
from core.motion.resample import frame_bounds, resample
from core.synthesis.marker_motion import MarkerMotion


@dataclass(frozen=True, eq=False)
class CapturedTruth:
    """A recording as a synthesis is measured against it.

    positions : float64, shape (n_frames, n_markers, 3), mm, head space, at the rate of the capture: the database's
        markers, normalised as the database was
    usable : bool, shape (n_frames,); False in long gaps and beyond the end of what is said
    joins : its roughness at phone boundaries, at the database's rate and through its principal components, which is all
        that an engine can show; None without such boundaries
    """

    recording: Recording
    markers: MarkerSet
    positions: np.ndarray
    usable: np.ndarray
    joins: Roughness | None

    @classmethod
    def of(cls, recording: Recording, database: MotionDatabase) -> CapturedTruth:
        """Normalise ``recording`` as ``database`` was; raises `UserFacingError` when it lacks one of the markers."""
        captured = in_head_space(recording, database.markers, database.with_scale)
        transcript, rate_hz = recording.transcript, database.rate_hz
        in_time = np.arange(len(captured.face)) <= transcript.duration_s * recording.rate_hz
        raised = resample(captured.face, recording.rate_hz, rate_hz, max(1, round(transcript.duration_s * rate_hz)))
        shown = database.pca.positions(database.pca.coefficients(raised))
        joins = measures.roughness_at_joins(shown, transcript, rate_hz)
        return cls(recording, database.markers, captured.face, in_time & ~captured.masked, joins)

    @property
    def rate_hz(self) -> float:
        """Frames a second of the capture."""
        return self.recording.rate_hz

    def gap_mm(self, positions: np.ndarray) -> np.ndarray | None:
        """Return the lip gap of ``positions``, shape (n_frames,); None when the markers do not show it."""
        upper, lower = self.markers.landmark("upper_lip"), self.markers.landmark("lower_lip")
        return None if upper is None or lower is None else measures.lip_gap_mm(positions, upper, lower)

    def width_mm(self, positions: np.ndarray) -> np.ndarray | None:
        """Return the lip width of ``positions``, shape (n_frames,); None when the markers do not show it."""
        left, right = self.markers.landmark("mouth_corner_left"), self.markers.landmark("mouth_corner_right")
        return None if left is None or right is None else measures.lip_width_mm(positions, left, right)


@dataclass(frozen=True, eq=False)
class Comparison:
    """One sentence of one engine beside its capture.

    synthesised : float64, like ``truth.positions``
    seconds : what the synthesis took
    joins : roughness at phone boundaries, at the rate of the motion; None without such boundaries
    """

    truth: CapturedTruth
    synthesised: np.ndarray
    seconds: float
    joins: Roughness | None

    @classmethod
    def of(cls, truth: CapturedTruth, motion: MarkerMotion, seconds: float) -> Comparison:
        """Bring ``motion`` to the frames of the capture, as `core.motion.resample` does."""
        synthesised = resample(motion.positions, motion.rate_hz, truth.rate_hz, len(truth.positions))
        joins = measures.roughness_at_joins(motion.positions, truth.recording.transcript, motion.rate_hz)
        return cls(truth, synthesised, seconds, joins)


@dataclass(frozen=True)
class Scores:
    """Measures of one engine over some sentences; None where markers or sentences do not allow one.

    error_mm2, lip_error_mm, lip_gap_r : means over sentences
    closure_rate : of the closures that the capture makes in p, b and m, the share that the synthesis makes
    *_variance_ratio : of the lip gap, its velocity and acceleration, against the lightly smoothed capture; both at the
        rate of video, if the capture is faster
    """

    error_mm2: float | None
    lip_error_mm: float | None
    lip_gap_r: float | None
    closure_rate: float | None
    gap_variance_ratio: float | None
    velocity_variance_ratio: float | None
    acceleration_variance_ratio: float | None


def scores(pairs: Sequence[tuple[CapturedTruth, np.ndarray]]) -> Scores:
    """Measure synthesised positions beside their captures."""
    lips = pairs[0][0].markers.group("lips")
    errors, lip_errors, correlations, closed = [], [], [], []
    tracks: list[list[tuple[np.ndarray, np.ndarray]]] = [[], [], []]
    for truth, synthesised in pairs:
        usable = truth.usable
        if not usable.any():
            continue
        errors.append(measures.error_mm2(synthesised[usable], truth.positions[usable]))
        if len(lips):
            lip_errors.append(
                measures.distance_mm(synthesised[np.ix_(usable, lips)], truth.positions[np.ix_(usable, lips)])
            )
        gap, captured_gap = truth.gap_mm(synthesised), truth.gap_mm(truth.positions)
        if gap is None:
            continue
        correlations.append(measures.correlation(gap[usable], captured_gap[usable]))
        closed.append(measures.closures(gap, captured_gap, truth.recording.transcript, truth.rate_hz))
        rate_hz, (gap, captured_gap, known) = _at_video_rate(truth, gap, captured_gap)
        smooth = measures.lightly_smoothed(captured_gap)
        for order, found in enumerate(tracks):
            kept = known[order:] & known[: len(known) - order]
            pair = (measures.derivative(track, rate_hz, order)[kept] for track in (gap, smooth))
            found.append(tuple(pair))
    n_closed = sum(c.captured for c in closed)
    ratios = [measures.variance_ratio(*zip(*found)) if found else None for found in tracks]
    return Scores(
        float(np.mean(errors)) if errors else None,
        float(np.mean(lip_errors)) if lip_errors else None,
        float(np.mean(correlations)) if correlations else None,
        sum(c.synthesised for c in closed) / n_closed if n_closed else None,
        *ratios,
    )


def _at_video_rate(
    truth: CapturedTruth, gap: np.ndarray, captured_gap: np.ndarray
) -> tuple[float, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Bring gaps and usable frames of a faster capture down to `measures.LIVELINESS_HZ`, both by `resample`."""
    rate_hz, slower_hz = truth.rate_hz, measures.LIVELINESS_HZ
    if rate_hz <= 1.01 * slower_hz:
        return rate_hz, (gap, captured_gap, truth.usable)
    n_frames = int((len(gap) - 1) / rate_hz * slower_hz) + 1
    place = np.arange(n_frames) * rate_hz / slower_hz
    known = truth.usable[np.floor(place).astype(int)] & truth.usable[np.ceil(place).astype(int)]
    return slower_hz, (*(resample(track, rate_hz, slower_hz, n_frames) for track in (gap, captured_gap)), known)


def by_phoneme(pairs: Sequence[tuple[CapturedTruth, np.ndarray]]) -> Mapping[str, dict[str, float]]:
    """Return, for each phone, how often it is said, and the mean error over its frames: all markers, and the lips."""
    lips = pairs[0][0].markers.group("lips")
    found: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {}
    for truth, synthesised in pairs:
        off = synthesised - truth.positions
        squared, lip_off = (off**2).sum(axis=2).mean(axis=1), np.linalg.norm(off[:, lips], axis=2)
        spoken = truth.recording.transcript.phonemes
        bounds = frame_bounds([u.start_s for u in spoken], [u.end_s for u in spoken], truth.rate_hz)
        for utterance, start, stop in zip(spoken, *bounds):
            frames = np.flatnonzero(truth.usable[start:stop]) + start
            if len(frames):
                found.setdefault(utterance.phone, []).append((squared[frames], lip_off[frames].ravel()))
    table = {}
    for phone in sorted(found):
        errors, lip_errors = (np.concatenate(parts) for parts in zip(*found[phone]))
        table[phone] = {"said": len(found[phone]), "error_mm2": float(errors.mean())}
        if len(lips):
            table[phone]["lip_error_mm"] = float(lip_errors.mean())
    return table
