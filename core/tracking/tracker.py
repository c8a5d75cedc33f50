"""A face followed from picture to picture: points one by one, then all together as motion units allow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.iface.affine_fit import AffineFit, PosedUnits
from core.tracking.constraint import constrained, fresh_start
from core.tracking.face_model import FaceModel
from core.tracking.face_sheet import FaceSheet, likeness
from core.tracking.optical_flow import Flow, followed, look_of, within
from core.tracking.searching import found_again
from core.tracking.start import Placement

# Variance of a point that is followed alone, square pixels: what parameters are weighed against their own variance by.
_NOISE_PX2 = 2.0
# The picture before is worth half the first one: its errors add up.
_TRUST_BEFORE = 0.5
# A corrected point outweighs all others around it.
_TRUST_HAND = 25.0
# Below these a picture does not show the face: points that agree, and likeness to the first picture.
_FEWEST_SEEN, _LEAST_LIKE = 0.12, 0.25
# A face does not grow or shrink by more between two pictures.
_LARGEST_GROWTH = 1.35
_NEAR_LEVELS, _FAR_LEVELS = 1, 3


@dataclass(frozen=True)
class Anchor:
    """How some points looked when a hand last put them: the first picture's sheet, or a corrected frame's.

    sheet : uint8, of `FaceSheet.laid_out`; points : rows
    """

    sheet: np.ndarray
    points: np.ndarray


@dataclass(frozen=True)
class TrackerState:
    """All that the next picture needs besides the last one; frozen, so that tracking can go on from any frame.

    base : float64, shape (K, 2), s_0 of this face, mm; anchors : see `Anchor`; fit : of the last picture
    """

    base: np.ndarray
    anchors: tuple[Anchor, ...]
    fit: AffineFit


@dataclass(frozen=True)
class TrackedFrame:
    """One picture.

    points : float64, shape (K, 2), pixels
    trust : shape (K,), 0..1, how sure each point is; 0 in a picture that does not show the face
    drift_px : shape (K,), how far each is from where it looks as it did at first; NaN where that is not seen
    is_lost : the face was not seen, and the last fit is held
    """

    points: np.ndarray
    trust: np.ndarray
    drift_px: np.ndarray
    is_lost: bool
    state: TrackerState


class FaceTracker:
    """Follows the points of one face. Give it the pictures one after the other.

    model : points and units; placement : of the face in the first picture
    first : grey, uint8, shape (height, width); start : float64, shape (K, 2), where the points are in it, pixels
    """

    def __init__(self, model: FaceModel, placement: Placement, first: np.ndarray, start: np.ndarray) -> None:
        self._units, self._n_own = model.flat_units, len(model.units)
        self._prior = _NOISE_PX2 / model.flat_variance
        self._sheet = FaceSheet.of(start, (first.shape[1], first.shape[0]))
        self._mask = self._sheet.hull()
        self._before = look_of(first)
        self._first = self._sheet.laid_out(self._before, start, np.eye(2, 3))
        affine = np.column_stack([placement.scale * placement.turn, placement.shift])
        self._placed = affine
        fit = AffineFit(np.zeros(len(self._units)), affine)
        anchor = Anchor(self._first, np.arange(len(start)))
        self.state = TrackerState(placement.millimetres(start), (anchor,), fit)

    def go_on_from(self, state: TrackerState, picture: np.ndarray) -> None:
        """Take up tracking after a frame: its state, and its grey picture."""
        self.state, self._before = state, look_of(picture)

    def accept(self, picture: np.ndarray, corrections: Mapping[int, np.ndarray] | None = None) -> TrackedFrame:
        """Find the face in the next picture, grey uint8 of the first one's size.

        corrections : row to x, y where a hand put that point in this picture
        """
        corrections = corrections or {}
        look = look_of(picture)
        face = PosedUnits(self.state.base, self._units)
        before = self.state.fit.points(face)
        step = followed(self._before, look, before, before)
        frame = self._fitted(look, face, step, self.state.fit, corrections)
        if frame.is_lost:
            found = self._by_hand(look, face, corrections) if corrections else self._searched(look, face)
            frame = found or frame
        if corrections:
            frame = self._corrected(look, frame, corrections)
        if not frame.is_lost:
            self._before = look
        self.state = frame.state
        return frame

    def _fitted(
        self, look: np.ndarray, face: PosedUnits, step: Flow | None, start: AffineFit,
        corrections: Mapping[int, np.ndarray], levels: int = _NEAR_LEVELS, is_sure: bool = False,
    ) -> TrackedFrame:  # fmt: skip
        """Constrain what the last picture says, then what the first one says of where that is.

        is_sure : a hand says that the face is there, however little of it is seen
        """
        fit, count = start, len(face.base)
        seen, trust = np.zeros((0, 2)), np.zeros(0)
        if step is not None:
            seen, trust = step.points, _TRUST_BEFORE * step.trust
            seen, trust = _with_hand(seen, trust, corrections)
            fit = constrained(face, seen, trust, fit, self._prior).fit
        anchored, anchor_trust, like = self._anchored(look, face, fit, levels)
        anchored, anchor_trust = _with_hand(anchored, anchor_trust, corrections)
        both = np.concatenate([seen, anchored]), np.concatenate([trust, anchor_trust])
        times = len(both[1]) // count
        twice = PosedUnits(np.tile(face.base, (times, 1)), np.tile(face.units, (1, times, 1)))
        answer = constrained(twice, *both, fit, self._prior)
        points = answer.fit.points(face)
        agreed = answer.weights.reshape(times, count)
        certain = np.clip(agreed / np.array([_TRUST_BEFORE, 1.0])[-times:, None], 0.0, 1.0).max(axis=0)
        certain = certain * within(points, look)
        drift = np.where(anchor_trust > 0.3, np.linalg.norm(anchored - points, axis=1), np.nan)
        is_seen = is_sure or (certain.mean() >= _FEWEST_SEEN and like >= _LEAST_LIKE)
        if not (is_seen and _is_possible(self.state.fit.affine, answer.fit.affine)):
            return self._held(face)
        return TrackedFrame(points, certain, drift, False, replace(self.state, fit=answer.fit))

    def _anchored(
        self, look: np.ndarray, face: PosedUnits, fit: AffineFit, levels: int
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """Where each point looks as it did when a hand last put it, near where ``fit`` has it; its trust; and how like
        the first picture all of the face looks there."""
        expected, moved, on_sheet = fit.points(face), self._moved(fit), self._sheet.points
        now = self._sheet.laid_out(look, expected, moved)
        found, trust = expected.copy(), np.zeros(len(expected))
        for anchor in self.state.anchors:
            rows = anchor.points
            flow = followed(anchor.sheet, now, on_sheet[rows], on_sheet[rows], levels)
            found[rows] += (flow.points - on_sheet[rows]) @ moved[:, :2].T
            trust[rows] = flow.trust
        return found, trust * within(found, look), likeness(self._first, now, self._mask)

    def _by_hand(self, look: np.ndarray, face: PosedUnits, corrections: Mapping[int, np.ndarray]) -> TrackedFrame:
        """Take the word of a hand for where a lost face is."""
        rows = list(corrections)
        away = np.mean([corrections[row] for row in rows], axis=0) - self.state.fit.points(face)[rows].mean(axis=0)
        start = _shifted(self.state.fit, away)
        return self._fitted(look, face, None, start, corrections, _FAR_LEVELS, is_sure=True)

    def _searched(self, look: np.ndarray, face: PosedUnits) -> TrackedFrame | None:
        """Look for the face in all of the picture; None where it is not there."""
        middle = found_again(self._first, self._mask, look)
        if middle is None:
            return None
        fit = self.state.fit
        shifted = _shifted(replace(fit, parameters=np.zeros_like(fit.parameters)), middle - self._middle_of_sheet(fit))
        anchored, trust, _ = self._anchored(look, face, shifted, _FAR_LEVELS)
        fresh = fresh_start(face, anchored, trust, self._n_own)
        starts = [shifted] if fresh is None else [shifted, fresh]
        frames = [self._fitted(look, face, None, start, {}, _FAR_LEVELS) for start in starts]
        return max(frames, key=lambda frame: frame.trust.mean())

    def _middle_of_sheet(self, fit: AffineFit) -> np.ndarray:
        moved = self._moved(fit)
        centre = self._sheet.corner + np.array([self._sheet.width, self._sheet.height]) / 2
        return moved[:, :2] @ centre + moved[:, 2]

    def _held(self, face: PosedUnits) -> TrackedFrame:
        points = self.state.fit.points(face)
        return TrackedFrame(points, np.zeros(len(points)), np.full(len(points), np.nan), True, self.state)

    def _corrected(self, look: np.ndarray, frame: TrackedFrame, corrections: Mapping[int, np.ndarray]) -> TrackedFrame:
        """Let the face be so that the points stand where the hand put them, and remember how they look there."""
        rows = np.array(sorted(corrections))
        points, base, affine = frame.points.copy(), frame.state.base.copy(), frame.state.fit.affine
        points[rows] = [corrections[row] for row in rows.tolist()]
        # what units and affine leave is the face's own
        base[rows] += (points[rows] - frame.points[rows]) @ np.linalg.inv(affine[:, :2]).T
        sheet = self._sheet.laid_out(look, points, self._moved(frame.state.fit))
        kept = tuple(Anchor(a.sheet, np.setdiff1d(a.points, rows)) for a in self.state.anchors)
        anchors = (*(a for a in kept if len(a.points)), Anchor(sheet, rows))
        trust, drift = frame.trust.copy(), frame.drift_px.copy()
        trust[rows], drift[rows] = 1.0, 0.0
        return TrackedFrame(points, trust, drift, frame.is_lost, TrackerState(base, anchors, frame.state.fit))

    def _moved(self, fit: AffineFit) -> np.ndarray:
        """The affine from the first picture to this one, shape (2, 3)."""
        linear = fit.affine[:, :2] @ np.linalg.inv(self._placed[:, :2])
        return np.column_stack([linear, fit.affine[:, 2] - linear @ self._placed[:, 2]])


def _with_hand(
    points: np.ndarray, trust: np.ndarray, corrections: Mapping[int, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    points, trust = points.copy(), trust.copy()
    for row, place in corrections.items():
        points[row], trust[row] = place, _TRUST_HAND
    return points, trust


def _shifted(fit: AffineFit, by_px: np.ndarray) -> AffineFit:
    return replace(fit, affine=fit.affine + np.column_stack([np.zeros((2, 2)), by_px]))


def _is_possible(before: np.ndarray, now: np.ndarray) -> bool:
    """Whether a head can have moved so between two pictures."""
    if not np.isfinite(now).all():
        return False
    change = np.linalg.svd(now[:, :2] @ np.linalg.inv(before[:, :2]), compute_uv=False)
    return change[0] < _LARGEST_GROWTH and change[1] > 1.0 / _LARGEST_GROWTH and np.linalg.det(now[:, :2]) > 0
