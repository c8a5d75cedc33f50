"""What a motion capture stage would see of the actress: markers on a moving head, with noise and gaps."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from core.actress.expression import Manner, accent_course
from core.actress.randomness import Chance
from core.face.marker_units import MarkerUnits
from core.speech.transcript import Transcript

# Where she stands: as far from the stage's origin and as turned as a real actor would be.
STAGE_POSITION_MM = (180.0, 1530.0, -240.0)
STAGE_YAW_DEG = 12.0
# The head turns about the top of the neck, below and behind the bridge of the nose.
NECK_MM = (0.0, -105.0, -85.0)
SWAY_MM = 2.5
# 3D root mean square of the noise of one marker, from the best seen to the worst seen.
NOISE_MM = (0.1, 0.3)
GAPS_AT_MOST = 4
GAP_FRAMES = (3, 10)
# Positions are kept to this fraction of a millimetre, so that machines whose last bits differ agree.
STEPS_PER_MM = 1024


def markers_of(activations: np.ndarray, units: MarkerUnits) -> np.ndarray:
    """Return where the markers are on a still head: rest plus the moves of all units.

    activations : float64, shape (n_frames, n_units)
    returns : float64, shape (n_frames, n_markers, 3), millimetres, head space
    """
    if activations.ndim != 2 or activations.shape[1] != len(units.names):
        raise ValueError(f"activations have shape {activations.shape}; there are {len(units.names)} units")
    return units.markers.rest + np.tensordot(activations, units.moves.astype(float), axes=1)


def head_motion(
    transcript: Transcript, manner: Manner, times_s: np.ndarray, chance: Chance
) -> tuple[np.ndarray, np.ndarray]:
    """Return rotation and shift of the head: slow sway, and a nod on stressed words.

    returns : float64, (n_frames, 3, 3) rotation matrices for column vectors, and (n_frames, 3) millimetres
    """
    nods = accent_course(transcript, times_s)
    pitch_deg = manner.pitch_deg + manner.nod_deg * (nods + 0.5 * chance.drift(times_s, 0.15, 0.8))
    yaw_deg = STAGE_YAW_DEG + manner.sway_deg * chance.drift(times_s, 0.1, 0.6)
    roll_deg = 0.6 * manner.sway_deg * chance.drift(times_s, 0.1, 0.6)
    turns = Rotation.from_euler("YXZ", np.stack([yaw_deg, pitch_deg, roll_deg], axis=1), degrees=True)
    shift_mm = np.stack([SWAY_MM * chance.drift(times_s, 0.1, 0.4) for _ in range(3)], axis=1)
    return turns.as_matrix(), shift_mm


def capture(markers: np.ndarray, rotations: np.ndarray, shifts_mm: np.ndarray, chance: Chance) -> np.ndarray:
    """Return the markers as recorded on the stage.

    markers : float64, shape (n_frames, n_markers, 3), millimetres, head space
    rotations, shifts_mm : of `head_motion`
    returns : float32, same shape, millimetres, stage space; NaN where a marker was lost
    """
    n_frames, n_markers, _ = markers.shape
    neck = np.array(NECK_MM)
    seen = np.einsum("fij,fkj->fki", rotations, markers - neck) + neck
    seen += shifts_mm[:, None] + STAGE_POSITION_MM
    seen += _noise(n_frames, n_markers, chance)
    seen = np.round(seen * STEPS_PER_MM) / STEPS_PER_MM
    for _ in range(chance.below(GAPS_AT_MOST + 1)):
        marker, start = chance.below(n_markers), chance.below(n_frames)
        length = GAP_FRAMES[0] + chance.below(GAP_FRAMES[1] - GAP_FRAMES[0] + 1)
        if start + length <= n_frames:
            seen[start : start + length, marker] = np.nan
    return seen.astype(np.float32)


def _noise(n_frames: int, n_markers: int, chance: Chance) -> np.ndarray:
    """Return noise in mm; neighbouring frames are correlated, as a capture system's own filter leaves them."""
    white = chance.normal(n_frames + 2, n_markers, 3)
    smooth = 0.25 * white[:-2] + 0.5 * white[1:-1] + 0.25 * white[2:]
    levels = np.array([chance.between(*NOISE_MM) for _ in range(n_markers)])
    return smooth / np.sqrt(0.375) * levels[:, None] / np.sqrt(3)
