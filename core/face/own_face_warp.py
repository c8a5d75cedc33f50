"""From points to a first fit: a similarity, then radial basis functions that meet every point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.face.mesh_files import OUTER_EYES_MM, UNITS_MM
from core.face.own_face_points import feature_points
from core.face.similarity import Similarity, fit_similarity

# A unit is believed when eyes then lie apart as some head's do.
EYES_RATIO = 1.6
DEEP_ENOUGH = 0.12  # the points' depth to their width, below which they say nothing of how deep the head is
FEWEST_FOR_AFFINE = 10
ANOTHER_SCAN = "Were these points set on another scan?"
SAME_PLACE = 0.005  # of the points' spread
FAR_OFF = 0.02  # of the scan's size
MISPLACED, MISPLACED_SHARE = 3.0, 0.3  # of what the similarity misses the other points by, and of the eyes' distance


def place_scan(
    points: Mapping[str, np.ndarray], generic: Mapping[str, np.ndarray], needs_all: bool = True
) -> Similarity:
    """Turn and shift a scan onto the generic face, and bring it to mm.

    points : on the scan, key to shape (3,), in its unit; generic : on the generic face, mm

    needs_all : whether the points that are needed must all be there

    The unit is the one of mm, cm, inch, dm and m with which the outer corners of the eyes lie about 90 mm apart; of a
    scan in none of these, the size is the generic face's. Raises `UserFacingError` for points that are missing, lie in
    one place or on a line, or have left and right swapped.
    """
    if needs_all:
        check_points(points)
    keys = [key for key in generic if key in points]
    source = np.array([points[key] for key in keys])
    target = np.array([generic[key] for key in keys])
    middle = source - source.mean(axis=0)
    spread = np.linalg.svd(middle, compute_uv=False)
    for name, places in (("scan", middle), ("generic face", target - target.mean(axis=0))):
        longest, across = np.linalg.svd(places, compute_uv=False)[:2]
        if longest <= 0 or across < 0.05 * longest:
            raise UserFacingError(
                f"The points on the {name} lie in one place or on one line, so they tell no head's pose."
            )
    close = np.linalg.norm(source[:, None] - source[None], axis=2) + np.eye(len(source)) * spread[0]
    if close.min() < SAME_PLACE * spread[0]:
        a, b = (keys[k] for k in np.unravel_index(close.argmin(), close.shape))
        raise UserFacingError(f"The points {a} and {b} are at the same place of the scan.", "Click one of them again.")
    fit = fit_similarity(source, target)
    if _misfit(source, target) > 1.5 * _misfit(source, target[[keys.index(_other_side(key, keys)) for key in keys]]):
        raise UserFacingError(
            "Left and right of the points are swapped.", "The character's right side is at the left of the picture."
        )
    # as far apart as the corners of the eyes would be, whether these are among the points or not
    apart = float(np.linalg.norm(generic["outer_eye_left"] - generic["outer_eye_right"])) / fit.scale
    unit = min(UNITS_MM, key=lambda mm: abs(np.log(apart * mm / OUTER_EYES_MM)))
    if 1 / EYES_RATIO < apart * unit / OUTER_EYES_MM < EYES_RATIO:
        # turn about the points' middle, so that it stays where the generic face has it
        return Similarity(
            float(unit), fit.rotation, fit.shift + (fit.scale - unit) * fit.rotation @ source.mean(axis=0)
        )
    return fit


def check_points(points: Mapping[str, np.ndarray]) -> None:
    """Raise `UserFacingError` unless all points that are needed are there."""
    missing = [point.title for point in feature_points() if point.is_needed and point.key not in points]
    if missing:
        more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
        raise UserFacingError(
            f"The scan lacks needed points: {', '.join(name[0].lower() + name[1:] for name in missing[:3])}{more}."
        )


def check_on_surface(points: Mapping[str, np.ndarray], away: Mapping[str, float], size: float) -> None:
    """Raise `UserFacingError` for a point that lies off its scan; ``away`` and ``size`` in the same unit."""
    far = {key: distance for key, distance in away.items() if key in points and distance > FAR_OFF * size}
    if far:
        worst = max(far, key=far.get)
        raise UserFacingError(
            f"The point {worst} lies {far[worst] / size:.0%} of the scan's size off its surface.",
            ANOTHER_SCAN,
        )


def doubtful_points(points: Mapping[str, np.ndarray], generic: Mapping[str, np.ndarray]) -> list[str]:
    """Return the keys of points that lie far from where a similarity of all others has them; worst first.

    Faces differ by centimetres at the ears and less within the face, so a point is doubted from three tenths
    of the distance of the eyes' outer corners on, where it also stands out among the others.
    """
    keys = [key for key in generic if key in points]
    source = np.array([generic[key] for key in keys])
    target = np.array([points[key] for key in keys], float)
    miss = np.zeros(len(keys))
    for k in range(len(keys)):
        rest = np.arange(len(keys)) != k
        miss[k] = np.linalg.norm(fit_similarity(source[rest], target[rest])(source[k]) - target[k])
    apart = float(np.linalg.norm(generic["outer_eye_left"] - generic["outer_eye_right"]))
    limit = max(MISPLACED * float(np.median(miss)), MISPLACED_SHARE * apart)
    return [keys[k] for k in np.argsort(-miss) if miss[k] > limit]


@dataclass(frozen=True)
class LandmarkWarp:
    """A smooth displacement of space that meets every point exactly.

    d(x) = Σ_k w_k |x - c_k| + A [1, x]: in three dimensions |x| is the thin-plate kernel, whose bending energy is least
    (Duchon 1977). Where the points say nothing of the depth of the head, A is a shift only.
    """

    centres: np.ndarray
    weights: np.ndarray
    affine: np.ndarray

    @classmethod
    def of(cls, source: np.ndarray, target: np.ndarray) -> LandmarkWarp:
        """Bring ``source`` (n, 3) to ``target`` (n, 3), mm; the points all differ."""
        n = len(source)
        flat = np.linalg.svd(source - source.mean(axis=0), compute_uv=False)
        is_affine = n >= FEWEST_FOR_AFFINE and flat[2] > DEEP_ENOUGH * flat[0]
        basis = np.ones((n, 1)) if not is_affine else np.column_stack([np.ones(n), source])
        kernel = np.linalg.norm(source[:, None] - source[None], axis=2)
        k = basis.shape[1]
        system = np.block([[kernel, basis], [basis.T, np.zeros((k, k))]])
        answer = np.linalg.solve(system, np.vstack([target - source, np.zeros((k, 3))]))
        affine = np.zeros((4, 3))
        affine[:k] = answer[n:]
        return cls(np.asarray(source, float), answer[:n], affine)

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Return how points (m, 3) move, float64, shape (m, 3), mm."""
        points = np.asarray(points, float)
        kernel = np.linalg.norm(points[:, None] - self.centres[None], axis=2)
        return kernel @ self.weights + self.affine[0] + points @ self.affine[1:]


def _misfit(source: np.ndarray, target: np.ndarray) -> float:
    return float(np.linalg.norm(fit_similarity(source, target)(source) - target))


def _other_side(key: str, keys: list[str]) -> str:
    other = key.replace("_left", "_right") if "_left" in key else key.replace("_right", "_left")
    return other if other in keys else key
