"""What an animator lays over the search's motion: more or less of it, by region and over time.

The layer only scales displacements from the rest pose, so it stays meaningful when the search finds another path, and
an empty one changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from core.motion.marker_set import MarkerSet
from core.synthesis.marker_motion import MarkerMotion

REGIONS = ("lips", "jaw", "cheeks", "brows")
_ANCHORS = {"cheeks": ("cheek_left", "cheek_right"), "brows": ("brow_left", "brow_right")}
# How far a region reaches beyond its anchors, as a share of the distance between the outer eye corners.
_REACH = 0.15
# Speech moves faster than this, expressions slower.
_EXPRESSION_S = 0.3
STRONGEST = 3.0
NO_CURVES: Mapping[str, tuple[tuple[float, float], ...]] = MappingProxyType({})

Curve = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Polish:
    """The layer; the default one changes nothing.

    articulation : 0..3, how far mouth and jaw go with each sound; 1 as found
    expression : 0..3, how strong the slow part of the motion is, everywhere; 1 as found
    curves : region (one of `REGIONS`) to keys (time_s, gain), gain 0..3, in the order of time; between keys the gain
        goes over smoothly, before the first and after the last it stays
    """

    articulation: float = 1.0
    expression: float = 1.0
    curves: Mapping[str, Curve] = field(default_factory=lambda: NO_CURVES)

    def __post_init__(self) -> None:
        for value in (self.articulation, self.expression, *(g for keys in self.curves.values() for _, g in keys)):
            if not 0.0 <= value <= STRONGEST:
                raise ValueError(f"a gain of {value} is not within 0..{STRONGEST:g}")
        unknown = set(self.curves) - set(REGIONS)
        if unknown:
            raise ValueError(f"there is no region {sorted(unknown)}")

    @property
    def changes_nothing(self) -> bool:
        """Whether motion comes out as it went in."""
        gains = [gain for keys in self.curves.values() for _, gain in keys]
        return self.articulation == self.expression == 1.0 and all(gain == 1.0 for gain in gains)

    def with_curve(self, region: str, keys: Curve) -> Polish:
        """Return the layer with other keys for a region; without any it has no curve."""
        curves = {name: curve for name, curve in self.curves.items() if name != region}
        if keys:
            curves[region] = tuple(sorted(keys))
        return replace(self, curves=MappingProxyType(curves))

    def gain(self, region: str, times_s: np.ndarray) -> np.ndarray:
        """Return the gain of a region's curve at ``times_s``; 1 without one."""
        keys = self.curves.get(region, ())
        if not keys:
            return np.ones(len(times_s))
        at_s, gains = np.array(keys).T
        if len(keys) == 1 or np.ptp(at_s) == 0:
            return np.full(len(times_s), gains[-1])
        from scipy.interpolate import PchipInterpolator

        at_s, first = np.unique(at_s, return_index=True)
        smooth = PchipInterpolator(at_s, gains[first])
        return smooth(np.clip(times_s, at_s[0], at_s[-1]))


NO_POLISH = Polish()


def region_weights(markers: MarkerSet) -> dict[str, np.ndarray]:
    """Return how much each marker belongs to each region, float64, shape (n_markers,), 0..1; together at most 1.

    Lips and jaw are the set's groups; cheeks and brows surround their landmarks. A region that the set does not know
    is left out.
    """
    size_mm = np.ptp(markers.rest, axis=0).max()
    corners = [markers.landmark(name) for name in ("outer_eye_left", "outer_eye_right")]
    if None not in corners:
        size_mm = np.linalg.norm(markers.rest[corners[0]] - markers.rest[corners[1]])
    found = {}
    for region in REGIONS:
        landmarks = [markers.landmark(name) for name in _ANCHORS.get(region, ())]
        anchors = markers.group(region) if region not in _ANCHORS else [row for row in landmarks if row is not None]
        if len(anchors):
            apart_mm = np.linalg.norm(markers.rest[:, None] - markers.rest[anchors][None], axis=-1).min(axis=1)
            found[region] = np.exp(-0.5 * (apart_mm / (_REACH * size_mm)) ** 2)
    total = np.maximum(sum(found.values(), np.zeros(len(markers))), 1.0)
    return {region: weights / total for region, weights in found.items()}


def polished(motion: MarkerMotion, polish: Polish) -> MarkerMotion:
    """Lay ``polish`` over ``motion``.

    A displacement d = slow + fast, where slow is d smoothed over 0.3 s, becomes

        expression · slow + (1 + mouth · (articulation - 1)) · fast,

    times ``1 + Σ_r w_r (gain_r - 1)`` with the gains of the regions' curves; ``mouth`` is how much a marker belongs to
    lips and jaw.
    """
    if polish.changes_nothing:
        return motion
    rest = motion.markers.rest
    moved = np.asarray(motion.positions, float) - rest
    weights = region_weights(motion.markers)
    nowhere = np.zeros(len(motion.markers))
    if polish.articulation != 1.0 or polish.expression != 1.0:
        from scipy.ndimage import gaussian_filter1d

        slow = gaussian_filter1d(moved, _EXPRESSION_S * motion.rate_hz, axis=0, mode="nearest")
        mouth = np.minimum(weights.get("lips", nowhere) + weights.get("jaw", nowhere), 1.0)
        articulation = 1.0 + mouth * (polish.articulation - 1.0)
        moved = polish.expression * slow + articulation[None, :, None] * (moved - slow)
    times_s = np.arange(len(moved)) / motion.rate_hz
    gains = np.ones((len(moved), len(motion.markers)))
    for region, share in weights.items():
        gains += share[None] * (polish.gain(region, times_s) - 1.0)[:, None]
    return MarkerMotion((rest + gains[:, :, None] * moved).astype(np.float32), motion.rate_hz, motion.markers)
