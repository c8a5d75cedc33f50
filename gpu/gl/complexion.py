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
    """Return what each vertex keeps of its resting place, float32, shape (n_vertices, 3).

    Skin and the inside of the mouth: the place, mm. Eyeballs: the direction from the ball's centre, unit; the iris is
    painted around +z of it, so it turns with the ball. Lashes: the direction around the middle of the eye's opening
    as (cos, sin), and 0 at the root to 1 at the tip; lower lashes are thinner, as if they began past half-way.
    """
    places = np.array(face.positions, np.float32)
    for side in ("left", "right"):
        ball = face.vertices_of(f"eye_{side}")
        if not len(ball):
            continue
        centre = (places[ball].min(axis=0) + places[ball].max(axis=0)) / 2
        # the back of a cut eyeball is missing: its true centre lies a radius behind the front
        radius = max(np.ptp(places[ball][:, :2], axis=0).max() / 2, 1e-3)
        centre[2] = places[ball][:, 2].max() - radius
        offset = places[ball] - centre
        places[ball] = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-6)
        for lid in ("upper", "lower"):
            lashes = face.vertices_of(f"lashes_{lid}_{side}")
            if len(lashes):
                offset = face.positions[lashes] - centre
                around = offset[:, :2] / np.maximum(np.linalg.norm(offset[:, :2], axis=1, keepdims=True), 1e-6)
                # roots lie on the lid, which hugs the ball; tips stand off
                from_root = np.linalg.norm(offset, axis=1) - radius
                low, high = np.quantile(from_root, [0.25, 0.98])
                tip = np.clip((from_root - low) / max(high - low, 1e-6), 0.0, 1.0)
                if lid == "lower":
                    tip = 0.6 + 0.4 * tip
                places[lashes] = np.column_stack([around, tip])
    return places


def lip_weights(face: Face) -> np.ndarray:
    """Return how much each vertex is red of the lips, float32 0..1, shape (n_vertices,).

    Two arcs that meet in the corners of the mouth, as high as lips are for their width, or as the landmarks ask.
    All 0 where the corners are unknown.
    """
    weights = np.zeros(len(face.positions), np.float32)
    if "mouth_corner_left" not in face.landmarks or "mouth_corner_right" not in face.landmarks:
        return weights
    left, right = (face.positions[face.landmarks[f"mouth_corner_{side}"]].astype(float) for side in ("left", "right"))
    middle, half = (left + right) / 2, max(np.linalg.norm(left - right) / 2, 1e-6)
    heights = {"upper_lip": 0.40, "lower_lip": -0.34}
    for name, least in heights.items():
        if name in face.landmarks:
            marked = (face.positions[face.landmarks[name]][1] - middle[1]) / half
            heights[name] = max(marked, least) if least > 0 else min(marked, least)
    x, y, z = (face.positions - middle).T / half
    side = np.minimum(np.abs(x), 1.0)
    bow = 1.0 - side**1.8 - 0.09 * np.exp(-((side / 0.12) ** 2))
    above, below = heights["upper_lip"] * bow - y, y - heights["lower_lip"] * (1.0 - side**2.6)
    inside = np.minimum(above, below)
    weights[:] = np.clip(inside / 0.07 + 0.5, 0.0, 1.0) * (np.abs(x) < 1.02) * (z > -0.35)
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
        arcs[row] = inner[0] - outward * 0.015 * scale, brow[1] - 0.040 * scale, brow[2]
        arcs[row + 1] = inner[0] + 0.66 * (outer[0] - inner[0]), brow[1] + 0.008 * scale, brow[2]
        arcs[row + 2] = outer[0] + outward * 0.055 * scale, brow[1] - 0.055 * scale, brow[2]
    return arcs, 0.078 * scale


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
