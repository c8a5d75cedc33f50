"""Blendshape weights over time, and the names that ARKit gave to 52 of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
