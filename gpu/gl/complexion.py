"""What a face's surface is made of, vertex by vertex: materials, lips, brows, eyeball directions. Set once a face."""

from __future__ import annotations

import numpy as np

from core.face.face import PARTS, Face

# Material numbers, as shaders/glsl/face.frag knows them.
SKIN, EYE, TEETH, TONGUE, LASHES, SOCKET = range(6)
_MATERIAL_OF_PART = {
    "skin": SKIN, "eye_left": EYE, "eye_right": EYE, "upper_teeth": TEETH, "lower_teeth": TEETH, "tongue": TONGUE,
    "lashes_upper_left": LASHES, "lashes_upper_right": LASHES, "lashes_lower_left": LASHES,
    "lashes_lower_right": LASHES, "mouth_socket": SOCKET, "other": SKIN,
}  # fmt: skip


def materials(face: Face) -> np.ndarray:
    """Return the material number of each vertex, int, shape (n_vertices,)."""
    return np.array([_MATERIAL_OF_PART[part] for part in PARTS])[face.part]


def rest_places(face: Face) -> np.ndarray:
    """Return the resting place of each vertex, of eyeballs its direction from the ball's centre (float32, (V, 3)).

    The iris is painted around +z of that direction, so it turns with the eyeball's vertices.
    """
    places = np.array(face.positions, np.float32)
    for part in ("eye_left", "eye_right"):
        ball = face.vertices_of(part)
        if len(ball):
            centre = (places[ball].min(axis=0) + places[ball].max(axis=0)) / 2
            # the back of a cut eyeball is missing: its true centre lies a radius behind the front
            radius = np.ptp(places[ball][:, :2], axis=0).max() / 2
            centre[2] = places[ball][:, 2].max() - radius
            offset = places[ball] - centre
            places[ball] = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-6)
    return places


def lip_weights(face: Face) -> np.ndarray:
    """Return how much each vertex is red of the lips, float32 0..1, shape (n_vertices,).

    Drawn from the landmarks of mouth corners and lips: two arcs that meet in the corners. 0 where they are unknown.
    """
    weights = np.zeros(len(face.positions), np.float32)
    names = ("mouth_corner_left", "mouth_corner_right", "upper_lip", "lower_lip")
    if any(name not in face.landmarks for name in names):
        return weights
    left, right, upper, lower = (face.positions[face.landmarks[name]].astype(float) for name in names)
    middle, half = (left + right) / 2, np.linalg.norm(left - right) / 2
    x, y, z = (face.positions - middle).T / half
    height_up, height_down = (upper[1] - middle[1]) / half, (middle[1] - lower[1]) / half
    side = np.minimum(np.abs(x), 1.0)
    bow = 1.0 - side**1.7 - 0.10 * np.exp(-((side / 0.10) ** 2))
    outline_up, outline_down = height_up * bow, height_down * (1.0 - side**2.4)
    inside = np.where(y >= 0, outline_up - y, outline_down + y)
    soft = 0.06
    weights[:] = np.clip(inside / soft + 0.5, 0.0, 1.0) * (np.abs(x) < 1.02) * (z > -0.35)
    return weights * (face.part == PARTS.index("skin"))


def brow_arcs(face: Face) -> tuple[np.ndarray, float]:
    """Return both brows, float32, shape (6, 3): inner end, arch, outer end, mm at rest; and their width in mm.

    The width is 0 where the landmarks are unknown.
    """
    arcs = np.zeros((6, 3), np.float32)
    needed = [f"{name}_{side}" for side in ("left", "right") for name in ("brow", "inner_eye", "outer_eye")]
    if any(name not in face.landmarks for name in needed):
        return arcs, 0.0
    scale = face.outer_eye_distance
    for row, side in ((0, "left"), (3, "right")):
        brow, inner, outer = (face.positions[face.landmarks[f"{n}_{side}"]] for n in ("brow", "inner_eye", "outer_eye"))
        outward = np.sign(outer[0] - inner[0])
        for at, (x, y) in enumerate(
            (
                (inner[0] - outward * 0.02 * scale, brow[1] - 0.030 * scale),
                (inner[0] + 0.62 * (outer[0] - inner[0]), brow[1] + 0.018 * scale),
                (outer[0] + outward * 0.055 * scale, brow[1] - 0.070 * scale),
            )
        ):
            arcs[row + at] = x, y, brow[2]
    return arcs, 0.042 * scale


def quad_diagonals(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return bit i set where a triangle's edge opposite to corner i is longest in both its triangles, uint8, (T,).

    A quad cut in two has its diagonal there; the wireframe leaves it out and looks like the sculptor's mesh.
    """
    corners = positions[triangles]
    lengths = np.stack([np.linalg.norm(corners[:, (i + 1) % 3] - corners[:, (i + 2) % 3], axis=1) for i in range(3)], 1)
    longest = lengths.argmax(axis=1)
    rows = np.arange(len(triangles))
    ends = np.sort(np.stack([triangles[rows, (longest + 1) % 3], triangles[rows, (longest + 2) % 3]], 1), axis=1)
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    return np.where(count[edge.ravel()] == 2, 1 << longest, 0).astype(np.uint8)
