"""Blendshape weights over time, and the names that ARKit gave to 52 of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError

_SIDES = ("Left", "Right")
_EYE = ("eyeBlink", "eyeLookDown", "eyeLookIn", "eyeLookOut", "eyeLookUp", "eyeSquint", "eyeWide")
# in the order of Live Link Face's columns
ARKIT_UNITS: tuple[str, ...] = (
    *(f"{unit}{side}" for side in _SIDES for unit in _EYE),
    "jawForward", "jawRight", "jawLeft", "jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRight",
    "mouthLeft", "mouthSmileLeft", "mouthSmileRight", "mouthFrownLeft", "mouthFrownRight", "mouthDimpleLeft",
    "mouthDimpleRight", "mouthStretchLeft", "mouthStretchRight", "mouthRollLower", "mouthRollUpper",
    "mouthShrugLower", "mouthShrugUpper", "mouthPressLeft", "mouthPressRight", "mouthLowerDownLeft",
    "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight", "browDownLeft", "browDownRight", "browInnerUp",
    "browOuterUpLeft", "browOuterUpRight", "cheekPuff", "cheekSquintLeft", "cheekSquintRight", "noseSneerLeft",
    "noseSneerRight", "tongueOut",
)  # fmt: skip
HEAD_AND_EYES: tuple[str, ...] = (
    "headYaw", "headPitch", "headRoll", "leftEyeYaw", "leftEyePitch", "leftEyeRoll", "rightEyeYaw", "rightEyePitch",
    "rightEyeRoll",
)  # fmt: skip
# beyond this a column is no weight, not even one that was pushed
_LARGEST_WEIGHT = 2.0
_PERCENT = 100.0
_LEFT_RIGHT = (("_left", "left"), ("_right", "right"), ("_l", "left"), ("_r", "right"))


def _plain(name: str) -> str:
    lower = name.strip().lower()
    for ending, side in _LEFT_RIGHT:
        if lower.endswith(ending):
            lower = lower.removesuffix(ending) + side
            break
    return lower.replace("_", "").replace(" ", "")


_BY_PLAIN = {_plain(name): name for name in (*ARKIT_UNITS, *HEAD_AND_EYES)}


def arkit_name(name: str) -> str | None:
    """Return ARKit's own spelling of a unit (``EyeBlinkLeft``, ``eyeBlink_L``, ``eye_blink_left``), or None."""
    return _BY_PLAIN.get(_plain(name))


def checked_weights(weights: np.ndarray, path: Path) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return weights as float32 in 0..1, and what is to be said of them; a frame that lacks one is NaN.

    Weights between 0 and 100, and beyond 2, are taken as per cent. Raises `UserFacingError` for what is no weight.
    """
    weights = np.array(weights, float)
    weights[np.isnan(weights).any(axis=1)] = np.nan
    seen = weights[np.isfinite(weights[:, :1].ravel())]
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 0.0)
    notes: tuple[str, ...] = ()
    if high > _LARGEST_WEIGHT and low >= -1.0 and high <= _PERCENT:
        weights /= _PERCENT
        low, high, notes = low / _PERCENT, high / _PERCENT, ("Weights are taken as per cent.",)
    if low < -_LARGEST_WEIGHT or high > _LARGEST_WEIGHT:
        raise UserFacingError(f"'{path}' holds weights from {low:.3g} to {high:.3g}; they should lie between 0 and 1.")
    if low < 0.0 or high > 1.0:
        notes += (f"Weights from {low:.3g} to {high:.3g} were limited to 0 and 1.",)
    return np.clip(weights, 0.0, 1.0).astype(np.float32), notes


@dataclass(frozen=True)
class BlendshapeTrack:
    """Weights of one take.

    weights : float32, shape (F, B), 0..1; a frame without a tracked face is NaN
    names : B unique names
    rate_hz : frames a second; frame f stands at f / rate_hz
    start_timecode : "HH:MM:SS:FF.mmm" of frame 0, "" if unknown
    rotations : float32, shape (F, 9), radians, columns as `HEAD_AND_EYES`; None if the file has none
    notes : one sentence for whatever the reader took for granted or left out
    """

    weights: np.ndarray
    names: tuple[str, ...]
    rate_hz: float
    start_timecode: str = ""
    rotations: np.ndarray | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.weights.ndim != 2 or self.weights.shape[1] != len(self.names):
            raise ValueError(f"weights have shape {self.weights.shape}; there are {len(self.names)} names")
        if len(set(self.names)) != len(self.names):
            raise ValueError("names of blendshapes repeat")
