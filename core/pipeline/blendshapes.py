"""Between captured blendshape weights and control curves."""

from __future__ import annotations

import numpy as np

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack
from core.rig.control_names import control_mixing
from core.rig.control_track import ControlTrack


def controls_of(captured: BlendshapeTrack) -> ControlTrack:
    """Return weights as control curves; frames without a tracked face are bridged by lines.

    Raises `UserFacingError` for a take in which no face was tracked at all.
    """
    seen = np.isfinite(captured.weights).all(axis=1)
    if not seen.any():
        raise UserFacingError("No frame of the take shows a face.")
    values = captured.weights
    if not seen.all():
        frames = np.arange(len(values))
        values = np.stack([np.interp(frames, frames[seen], column[seen]) for column in values.T], axis=1)
    return ControlTrack(captured.names, values, captured.rate_hz, _frame_of(captured.start_timecode, captured.rate_hz))


def arkit_weights(track: ControlTrack) -> tuple[BlendshapeTrack, tuple[str, ...]]:
    """Return the controls that are ARKit's, in any spelling, within 0..1, and sentences for what that leaves out.

    Raises `UserFacingError` when none of them is.
    """
    mixing = control_mixing(track.names, ARKIT_UNITS)
    used = mixing.any(axis=1)
    if not used.any():
        raise UserFacingError(
            f"None of the controls is a unit of ARKit; the first is '{track.names[0][:60]}'.",
            "Write .curves.csv or .curves.json, which hold controls of any name.",
        )
    arkit = ControlTrack(ARKIT_UNITS, track.values @ mixing, track.rate_hz, track.start_frame)
    lost = [n for n, is_used, top in zip(track.names, used, np.abs(track.values).max(axis=0)) if not is_used and top]
    warnings = []
    if lost:
        warnings.append(f"{len(lost)} controls are no units of ARKit and were left out: {', '.join(lost[:5])}.")
    if arkit.beyond():
        warnings.append(f"Weights of {', '.join(arkit.beyond()[:5])} were limited to 0 and 1.")
    weights = arkit.clipped().values
    return BlendshapeTrack(weights, ARKIT_UNITS, track.rate_hz, track.start_timecode), tuple(warnings)


def _frame_of(code: str, rate_hz: float) -> int:
    """The frame, from midnight, that a timecode ``HH:MM:SS:FF.mmm`` names; 0 for none."""
    parts = code.replace(";", ":").split(":")
    if len(parts) != 4:
        return 0
    hours, minutes, seconds = (int(part) for part in parts[:3])
    return ((hours * 60 + minutes) * 60 + seconds) * max(1, round(rate_hz)) + round(float(parts[3]))
