"""A character that controls move: a neutral face and one displacement of its vertices for each control."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.rig.control_names import control_mixing
from core.rig.control_track import ControlTrack

BLOCK_BYTES = 32 * 2**20


@dataclass(frozen=True)
class Rig:
    """Blendshapes: vertices = neutral + Σ control · shape.

    face : the neutral face; millimetres, x to the character's left, y up, z forward, whatever the file's were
    names : of the U shapes, all different; they are the rig's controls, 0 at rest and 1 at full strength
    deltas : float32, shape (U, V, 3), mm
    """

    face: Face
    names: tuple[str, ...]
    deltas: np.ndarray

    @classmethod
    def of(cls, face: Face) -> Rig:
        """Take the units of ``face`` as controls; raises `UserFacingError` for a face without any."""
        if not face.units:
            raise UserFacingError(
                f"The face {face.name} has no shapes that controls could move.",
                "Give a glTF file with morph targets, a folder of OBJ files, or one of our characters.",
            )
        return cls(face, tuple(face.units), np.array(list(face.units.values()), np.float32))

    @property
    def neutral(self) -> np.ndarray:
        """The vertices at rest, float32, shape (V, 3), mm."""
        return self.face.positions

    def shape(self, name: str) -> np.ndarray:
        """Return one displacement, float32, shape (V, 3), mm; raises `UserFacingError` for one that there is not."""
        if name not in self.names:
            raise UserFacingError(f"The rig {self.face.name} has no control '{name[:60]}'.")
        return self.deltas[self.names.index(name)]

    def moved(self, values: np.ndarray) -> np.ndarray:
        """Return vertex displacements for controls (F, U) or (U,), in `names`' order: float32, (F, V, 3) or (V, 3)."""
        values = np.asarray(values, np.float32)
        flat = self.deltas.reshape(len(self.names), -1)
        return (values @ flat).reshape(*values.shape[:-1], -1, 3)


def fitted(rig: Rig, track: ControlTrack) -> tuple[ControlTrack, tuple[str, ...]]:
    """Return ``track`` as the rig's own controls, in its order, and a sentence for what it cannot show.

    Names are matched as `core.rig.control_names` says. Raises `UserFacingError` when not a single one fits.
    """
    mixing = control_mixing(track.names, rig.names)
    used = mixing.any(axis=1)
    if not used.any():
        raise UserFacingError(
            f"None of the controls {_listed(track.names)} is one of the rig {rig.face.name}, "
            f"which has {_listed(rig.names)}.",
            "Name the shapes as ARKit does, or pose the key lip shapes on the rig.",
        )
    moving = np.abs(track.values).max(axis=0) > 1e-3
    lost = [name for name, is_used, moves in zip(track.names, used, moving) if moves and not is_used]
    warnings = (f"The rig {rig.face.name} has no shape for {_listed(lost)}.",) if lost else ()
    return ControlTrack(rig.names, track.values @ mixing, track.rate_hz, track.start_frame), warnings


def posed(rig: Rig, track: ControlTrack) -> np.ndarray:
    """Return the rig's vertices for every frame of ``track``, mm; float32, shape (n_frames, V, 3).

    Controls are matched by name (see `fitted`). For long tracks `poses` keeps less in memory.
    """
    return np.concatenate(list(_blocks(rig, fitted(rig, track)[0].values)))


def poses(rig: Rig, track: ControlTrack) -> Iterator[np.ndarray]:
    """Yield the rig's vertices frame by frame, float32, shape (V, 3), mm; see `posed`."""
    for block in _blocks(rig, fitted(rig, track)[0].values):
        yield from block


def _blocks(rig: Rig, values: np.ndarray) -> Iterator[np.ndarray]:
    # controls that stay at rest cost as much as others in a product, and most do
    moving = np.abs(values).max(axis=0) > 0
    flat = np.ascontiguousarray(rig.deltas[moving].reshape(-1, rig.neutral.size))
    neutral = rig.neutral.reshape(1, -1)
    step = max(1, BLOCK_BYTES // neutral.nbytes)
    for first in range(0, len(values), step):
        block = values[first : first + step, moving] @ flat
        block += neutral
        yield block.reshape(len(block), -1, 3)


def _listed(names: tuple[str, ...] | list[str], most: int = 4) -> str:
    shown = ", ".join(f"'{name[:40]}'" for name in names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"
