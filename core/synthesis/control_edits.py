"""What an artist lays over the control curves: keys, stretches made smoother, controls muted.

The layer is kept by control name and time, never by frame or phoneme, so it stays when an engine answers anew; an empty
one changes nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

SHORTEST_REACH_S, LONGEST_REACH_S = 0.02, 2.0
# A key may do more than a control at full strength: principal components count in millimetres.
FARTHEST = 1000.0
SMOOTHING_S = 0.05


@dataclass(frozen=True, order=True)
class ControlKey:
    """A raised cosine on a curve: ``amount`` at ``time_s``, down to nothing ``reach_s`` on either side of it."""

    time_s: float
    amount: float
    reach_s: float

    def __post_init__(self) -> None:
        if not (SHORTEST_REACH_S <= self.reach_s <= LONGEST_REACH_S and abs(self.amount) <= FARTHEST):
            raise ValueError(f"{self} is no key of a control")

    def at(self, times_s: np.ndarray) -> np.ndarray:
        """Return what the key adds, shape of ``times_s``."""
        away = np.minimum(np.abs(times_s - self.time_s) / self.reach_s, 1.0)
        return self.amount * 0.5 * (1.0 + np.cos(np.pi * away))


@dataclass(frozen=True)
class CurveEdits:
    """All that is laid over one control.

    keys : in the order of time
    smoothed : stretches (start_s, end_s) whose curve is smoothed; one that is there twice is smoothed twice
    is_muted : the control stays at rest, and keys are added to that
    """

    keys: tuple[ControlKey, ...] = ()
    smoothed: tuple[tuple[float, float], ...] = ()
    is_muted: bool = False

    def applied(self, values: np.ndarray, rate_hz: float, rest: float) -> np.ndarray:
        """Return the curve under the edits; ``values``: shape (n_frames,)."""
        values = np.full(len(values), float(rest)) if self.is_muted else np.asarray(values, float)
        times_s = np.arange(len(values)) / rate_hz
        for start_s, end_s in self.smoothed:
            from scipy.ndimage import gaussian_filter1d

            soft = gaussian_filter1d(values, SMOOTHING_S * rate_hz, mode="nearest")
            # a stretch fades in and out within the smoothing itself, or its ends would jump
            inside = np.clip(np.minimum(times_s - start_s, end_s - times_s) / SMOOTHING_S + 1.0, 0.0, 1.0)
            values = values + inside * (soft - values)
        for key in self.keys:
            values = values + key.at(times_s)
        return values


NO_CURVE_EDITS = CurveEdits()


@dataclass(frozen=True)
class ControlEdits:
    """The layer: control name to what is laid over its curve; names that an engine's controls lack change nothing."""

    by_control: Mapping[str, CurveEdits] = field(default_factory=lambda: MappingProxyType({}))

    def of(self, control: str) -> CurveEdits:
        """Return what is laid over a control."""
        return self.by_control.get(control, NO_CURVE_EDITS)

    @property
    def changes_nothing(self) -> bool:
        """Whether curves come out as they went in."""
        return not self.by_control

    def with_control(self, control: str, edits: CurveEdits) -> ControlEdits:
        """Return the layer with other edits of one control."""
        kept = {name: of_it for name, of_it in self.by_control.items() if name != control}
        if edits != NO_CURVE_EDITS:
            kept[control] = edits
        return ControlEdits(MappingProxyType(kept))

    def with_keys(self, control: str, keys: tuple[ControlKey, ...]) -> ControlEdits:
        """Return the layer with other keys of one control."""
        return self.with_control(control, replace(self.of(control), keys=tuple(sorted(keys))))

    def smoothing(self, control: str, start_s: float, end_s: float) -> ControlEdits:
        """Return the layer with a stretch of one control smoother than before."""
        edits = self.of(control)
        return self.with_control(control, replace(edits, smoothed=(*edits.smoothed, (start_s, end_s))))

    def muting(self, control: str, is_muted: bool) -> ControlEdits:
        """Return the layer with one control at rest, or not."""
        return self.with_control(control, replace(self.of(control), is_muted=is_muted))


NO_CONTROL_EDITS = ControlEdits()
