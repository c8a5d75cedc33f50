"""What a face's surface is made of, vertex by vertex: materials, lips, brows, eyeball directions. Set once a face."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from core.face.face import PARTS, Face

# Shoulders fade away over this much of the outer eye distance.
FADE_WIDTH = 0.38

# Material numbers, as shaders/glsl/face.frag knows them.
SKIN, EYE, UPPER_TEETH, TONGUE, LASHES, SOCKET, LOWER_TEETH = range(7)
_MATERIAL_OF_PART = {
    "skin": SKIN, "eye_left": EYE, "eye_right": EYE, "upper_teeth": UPPER_TEETH, "lower_teeth": LOWER_TEETH,
    "tongue": TONGUE,
    "lashes_upper_left": LASHES, "lashes_upper_right": LASHES, "lashes_lower_left": LASHES,
    "lashes_lower_right": LASHES, "mouth_socket": SOCKET, "other": SKIN,
}  # fmt: skip


def materials(face: Face) -> np.ndarray:
    """Return the material number of each vertex, int, shape (n_vertices,)."""
    return np.array([_MATERIAL_OF_PART[part] for part in PARTS])[face.part]


def rest_places(face: Face) -> np.ndarray:
    """Return what each vertex keeps of its resting place, float32, shape (n_vertices, 3).

    Skin and the inside of the mouth: the place, mm. Eyeballs: the direction from the ball's centre, unit; the iris is
    painted around +z of it, so it turns with the ball. Lashes: 0..1 from the inner to the outer end, 0..1 from root to
    tip, and strength; lower lashes are shorter and thinner.
    """
    places = np.array(face.positions, np.float32)
    for side in ("left", "right"):
        ball = face.vertices_of(f"eye_{side}")
        if not len(ball):
            continue
        centre = eyeball_centre(places[ball])
        radius = max(np.ptp(places[ball][:, :2], axis=0).max() / 2, 1e-3)
        offset = places[ball] - centre
        places[ball] = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-6)
        for lid in ("upper", "lower"):
            lashes = face.vertices_of(f"lashes_{lid}_{side}")
            if len(lashes):
                at = face.positions[lashes]
                outwards = (at[:, 0] - at[:, 0].min()) / max(float(np.ptp(at[:, 0])), 1e-6)
                if centre[0] < 0:
                    outwards = 1.0 - outwards
                # roots lie on the lid, which hugs the ball; tips stand off
                from_root = np.linalg.norm(at - centre, axis=1) - radius
                low, high = np.quantile(from_root, [0.25, 0.98])
                tip = np.clip((from_root - low) / max(high - low, 1e-6), 0.0, 1.0)
                upper = lid == "upper"
                places[lashes] = np.column_stack(
                    [outwards, tip if upper else 0.35 + 0.65 * tip, np.full(len(tip), 0.85 if upper else 0.28)]
                )
    return places


def blush_weights(face: Face) -> np.ndarray:
    """Return where blood shows through, float32 0..1, shape (n_vertices,): cheeks, tip of the nose, chin, ears."""
    weights = np.zeros(len(face.positions), np.float32)
    at = {name: face.positions[vertex].astype(float) for name, vertex in face.landmarks.items()}
    if not {"outer_eye_left", "outer_eye_right"} <= set(at):
        return weights
    scale = face.outer_eye_distance
    spots = {"cheek_left": (1.0, 0.30), "cheek_right": (1.0, 0.30), "nose_tip": (0.9, 0.14), "chin": (0.35, 0.14)}
    for name, (strength, size) in spots.items():
        if name in at:
            away = np.linalg.norm(face.positions - at[name], axis=1) / (size * scale)
            weights = np.maximum(weights, strength * np.exp(-(away**2)))
    ears = (np.abs(face.positions[:, 0]) > 0.91 * scale) & (np.abs(face.positions[:, 1]) < scale)
    weights = np.maximum(weights, 0.7 * ears)
    return (weights * (face.part == PARTS.index("skin"))).astype(np.float32)


def beard_weights(face: Face) -> np.ndarray:
    """Return where a beard would grow, float32 0..1, shape (n_vertices,): jaw, chin, upper lip."""
    weights = np.zeros(len(face.positions), np.float32)
    needed = ("mouth_corner_left", "mouth_corner_right", "nose_tip", "chin", "outer_eye_left", "outer_eye_right")
    if any(name not in face.landmarks for name in needed):
        return weights
    scale = face.outer_eye_distance
    left, right, nose, chin = (face.positions[face.landmarks[name]].astype(float) for name in needed[:4])
    mouth = (left + right) / 2
    x, y, z = face.positions.T.astype(float)
    # the upper rim of a beard: from under the nose down past the mouth corners and up again to the ears
    side = np.abs(x) / scale
    under_nose = nose[1] - 0.17 * scale
    rim = np.where(side < 0.22, under_nose, under_nose - 0.10 * scale + 0.75 * scale * np.clip(side - 0.42, 0.0, 1.0))
    under = np.clip((rim - y) / (0.10 * scale), 0.0, 1.0)
    above_neck = np.clip((y - (chin[1] - 0.42 * scale) + 0.25 * (mouth[2] - z)) / (0.20 * scale), 0.0, 1.0)
    ahead_of_ear = np.clip((z - mouth[2] + 1.05 * scale) / (0.15 * scale), 0.0, 1.0)
    weights[:] = under * above_neck * ahead_of_ear
    return weights * (face.part == PARTS.index("skin"))


def hair_depth(face: Face) -> np.ndarray:
    """Return the mask ``hair`` of a face whose look has hair, float32, mm, shape (n_vertices,); else -99 all over."""
    if "hair" not in face.masks or face.look.hair_mm <= 0:
        return np.full(len(face.positions), -99.0, np.float32)
    return np.asarray(face.masks["hair"], np.float32)


def hair_lift(face: Face) -> np.ndarray:
    """Return how far hair lifts each vertex off the scalp, float32, mm, shape (n_vertices,)."""
    t = np.clip((hair_depth(face) + 1.0) / 16.0, 0.0, 1.0)
    # more on the crown than at the nape
    rise = np.clip((face.positions[:, 1] / max(float(face.positions[:, 1].max()), 1e-6) + 0.6) / 1.4, 0.15, 1.0)
    return (face.look.hair_mm * t * (2.0 - t) * rise).astype(np.float32)


def tooth_arch(face: Face) -> tuple[tuple[float, float, float], tuple[float, float]]:
    """Return the arch of the upper teeth (z of its middle, half width, depth) and y of both incisor edges, mm."""
    upper, lower = face.vertices_of("upper_teeth"), face.vertices_of("lower_teeth")
    if not len(upper):
        return (0.0, 25.0, 45.0), (0.0, 0.0)
    at = face.positions[upper].astype(float)
    half, depth = float(np.ptp(at[:, 0]) / 2), float(np.ptp(at[:, 2]))
    edge = float(at[at[:, 2] > at[:, 2].max() - 0.25 * depth, 1].min())
    below = face.positions[lower].astype(float)
    top = edge
    if len(lower):
        top = float(below[below[:, 2] > below[:, 2].max() - 0.25 * depth, 1].max())
    return (float(at[:, 2].max()) - depth, half, depth), (edge, top)


def edge_fade(face: Face) -> np.ndarray:
    """Return how far each vertex has faded into the backdrop, float32 0..1, shape (n_vertices,).

    1 along the edge at which neck or shoulders end, 0 from a third of the outer eye distance away. 0 all over where
    the landmarks are unknown.
    """
    from scipy.spatial import cKDTree

    fade = np.zeros(len(face.positions), np.float32)
    needed = ("outer_eye_left", "outer_eye_right", "chin")
    if any(name not in face.landmarks for name in needed):
        return fade
    edges = np.sort(
        np.concatenate([face.triangles[:, [0, 1]], face.triangles[:, [1, 2]], face.triangles[:, [2, 0]]]), 1
    )
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    rim = np.unique(unique[uses == 1])
    below = face.positions[face.landmarks["chin"], 1] - 0.3 * face.outer_eye_distance
    rim = rim[(face.part[rim] == PARTS.index("skin")) & (face.positions[rim, 1] < below)]
    skin = face.vertices_of("skin")
    if len(rim):
        gap = cKDTree(face.positions[rim]).query(face.positions[skin])[0]
        fade[skin] = np.clip(1.0 - gap / (FADE_WIDTH * face.outer_eye_distance), 0.0, 1.0)
    return fade


def eyeball_centre(ball: np.ndarray) -> np.ndarray:
    """Return the centre of an eyeball, shape (3,), mm, from its vertices (B, 3); the back may have been cut away."""
    low, high = ball.min(axis=0).astype(float), ball.max(axis=0).astype(float)
    centre, radius = (low + high) / 2, max(float((high - low)[:2].max()) / 2, 1e-3)
    centre[2] = high[2] - radius
    return centre


@lru_cache(maxsize=1)
def grain(size: int = 32, seed: int = 7) -> np.ndarray:
    """Return smooth noise that repeats, uint8, shape (size, size, size, 4), spread over 0..255; it is read-only."""
    smooth = np.random.default_rng(seed).standard_normal((size, size, size, 4))
    # a Gaussian of one voxel; scipy's would take a third of a second to import, before the window's first picture
    shares = np.exp(-0.5 * np.arange(-4, 5) ** 2)
    for axis in range(3):
        smooth = sum(share * np.roll(smooth, k, axis) for k, share in zip(range(-4, 5), shares / shares.sum()))
    noise = np.clip(128 + 52 * smooth / smooth.std(), 0, 255).astype(np.uint8)
    noise.setflags(write=False)
    return noise


def lip_weights(face: Face) -> np.ndarray:
    """Return how much each vertex is red of the lips, float32 0..1, shape (n_vertices,).

    Two arcs that meet in the corners of the mouth, as high as lips are for their width, or as the landmarks ask.
    All 0 where the corners are unknown.
    """
    weights = np.zeros(len(face.positions), np.float32)
    if "lips" in face.masks:
        return np.asarray(face.masks["lips"], np.float32)
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
