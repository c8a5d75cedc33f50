"""A rig small enough to reckon by hand, and files that hold it."""

from __future__ import annotations

import numpy as np

from core.face.face import Face
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig


def small_rig(seed: int = 0, names: tuple[str, ...] = ("jawOpen", "mouthSmileLeft", "mouthSmileRight")) -> Rig:
    """A bent sheet of 5 x 4 vertices, as large as a head, with random shapes."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-75, 75, 5), np.linspace(-150, 150, 4))
    positions = np.stack([x, y, 80 - x**2 / 200], axis=-1).reshape(-1, 3).astype(np.float32)
    corner = np.arange(20).reshape(4, 5)
    a, b, c, d = (q.ravel() for q in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    units = {name: rng.normal(0, 5, (20, 3)).astype(np.float32) for name in names}
    return Rig.of(Face("sheet", positions, triangles, np.zeros(20, np.uint8), units=units))


def random_track(
    names: tuple[str, ...], n_frames: int = 7, rate_hz: float = 30.0, start_frame: int = 0
) -> ControlTrack:
    return ControlTrack(names, np.random.default_rng(5).uniform(size=(n_frames, len(names))), rate_hz, start_frame)
