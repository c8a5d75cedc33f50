"""A face to deform and draw: mesh parts, anatomical landmarks, optional blendshape units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from core.face.look import Look

PARTS = (
    "skin", "eye_left", "eye_right", "upper_teeth", "lower_teeth", "tongue",
    "lashes_upper_left", "lashes_upper_right", "lashes_lower_left", "lashes_lower_right", "mouth_socket", "other",
)  # fmt: skip


@dataclass(frozen=True)
class Face:
    """One character's head.

    name : what the user calls it
    positions : float32, shape (n_vertices, 3), millimetres; x to the character's left, y up, z forward
    triangles : int32, shape (n_triangles, 3)
    part : uint8, shape (n_vertices,), index into `PARTS`
    uv : float32, shape (n_vertices, 2), or None
    landmarks : anatomical name (see `core.motion.marker_set.LANDMARKS`) to vertex
    units : blendshape unit name (ARKit) to float32 displacements, shape (n_vertices, 3), millimetres
    credit : source and licence, for About
    look : colours and marks of age
    masks : what is painted where, name to float32, shape (n_vertices,): ``lips`` 0..1, ``hair`` the distance from the
        hairline in mm, positive under the hair. None of them where unknown
    is_kin : whether its vertices are those of our characters, so that the actress's markers sit on the same
    texture : uint8, shape (h, w, 3), sRGB, top row first, for ``uv``, or None
    """

    name: str
    positions: np.ndarray
    triangles: np.ndarray
    part: np.ndarray
    uv: np.ndarray | None = None
    landmarks: Mapping[str, int] = field(default_factory=dict)
    units: Mapping[str, np.ndarray] = field(default_factory=dict)
    credit: str = ""
    look: Look = field(default_factory=Look)
    masks: Mapping[str, np.ndarray] = field(default_factory=dict)
    is_kin: bool = False
    texture: np.ndarray | None = None

    def vertices_of(self, part: str) -> np.ndarray:
        """Return the vertices of ``part``, int, ascending; empty if the face has none."""
        return np.flatnonzero(self.part == PARTS.index(part))

    @property
    def outer_eye_distance(self) -> float:
        """Distance of the outer eye corners in mm, the scale by which faces of different size are compared."""
        left, right = self.landmarks["outer_eye_left"], self.landmarks["outer_eye_right"]
        return float(np.linalg.norm(self.positions[left] - self.positions[right]))
