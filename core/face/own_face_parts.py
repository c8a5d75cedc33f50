"""What does not lie on the skin goes where it belongs in the fitted face: eyeballs, teeth, tongue, lashes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.own_face_protected import Protected
from core.face.similarity import Similarity, fit_similarity

MOUTH_PARTS = ("upper_teeth", "lower_teeth", "tongue")
LASHES = tuple(part for part in PARTS if part.startswith("lashes"))
LID_CLEARANCE_MM = 0.4
LIDS_REACH = 1.35  # of the eyeball's radius: skin so near to its centre is lid
NEIGHBOURS = 64
ISOTROPY = 0.5  # how much a local frame would rather be a similarity


def local_frames(rest: np.ndarray, fitted: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return how the fit stretches and turns space around the places ``at``: float64, shape (m, 3, 3).

    rest, fitted : shape (n, 3), mm, of surface vertices; at : int, shape (m,), into them

    Each is the affine map that takes the neighbours of a vertex from one to the other, by least squares, drawn towards
    their similarity where they say nothing, as across the skin.
    """
    k = min(NEIGHBOURS, len(rest))
    gap, near = cKDTree(rest).query(rest[at], k=k)
    weights = np.exp(-((gap / np.maximum(gap[:, -1:], 1e-9)) ** 2) * 2.0)
    weights /= weights.sum(axis=1, keepdims=True)
    a = rest[near] - np.einsum("mk,mkx->mx", weights, rest[near])[:, None]
    b = fitted[near] - np.einsum("mk,mkx->mx", weights, fitted[near])[:, None]
    cross = np.einsum("mk,mkx,mky->mxy", weights, b, a)
    spread = np.einsum("mk,mkx,mky->mxy", weights, a, a)
    u, sizes, vt = np.linalg.svd(cross)
    mirror = np.ones_like(sizes)
    mirror[:, 2] = np.sign(np.linalg.det(u @ vt))
    trace = np.trace(spread, axis1=1, axis2=2)
    alike = (u * mirror[:, None]) @ vt * ((sizes * mirror).sum(axis=1) / np.maximum(trace, 1e-12))[:, None, None]
    ridge = (ISOTROPY * trace / 3)[:, None, None]
    return (cross + ridge * alike) @ np.linalg.inv(spread + ridge * np.eye(3))


def place_parts(face: Face, protected: Protected, fitted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Put all that is no skin where it belongs.

    fitted : shape (n, 3), mm, the surface vertices, changed: lids that would cut into an eyeball come out of it
    returns : positions float64, shape (V, 3), mm, of all vertices, and frames float64, shape (V, 3, 3), by which a
        displacement of the generic face becomes one of the fitted face

    Eyeballs stay balls: each is moved and scaled as its lids were, and turned not at all. Teeth and tongue move and
    scale as one with the lips and what surrounds them. Lashes go with the skin at their roots.
    """
    rest = face.positions.astype(float)
    positions, frames = rest.copy(), np.tile(np.eye(3), (len(rest), 1, 1))
    surface = rest[protected.surface]
    for side in ("left", "right"):
        ball = face.vertices_of(f"eye_{side}")
        if len(ball):
            scale, shift = _ball_fit(rest[ball], surface, fitted)
            positions[ball] = scale * rest[ball] + shift
            frames[ball] = scale * np.eye(3)
            _clear_ball(rest[ball], positions[ball], surface, fitted)
    positions[protected.surface] = fitted
    frames[protected.surface] = local_frames(surface, fitted, np.arange(len(surface)))
    inside = np.flatnonzero(np.isin(face.part, [PARTS.index(part) for part in MOUTH_PARTS]))
    if len(inside):
        fit = _mouth_fit(face, surface, fitted)
        positions[inside] = fit(rest[inside])
        frames[inside] = fit.scale * fit.rotation
    skin = face.part[protected.surface] == PARTS.index("skin")
    others = np.flatnonzero(np.isin(face.part, [PARTS.index(part) for part in (*LASHES, "other")]))
    others = np.setdiff1d(others, protected.surface)
    if len(others):
        roots = protected.surface[skin][cKDTree(surface[skin]).query(rest[others])[1]]
        frames[others] = frames[roots]
        positions[others] = positions[roots] + np.einsum("mxy,my->mx", frames[roots], rest[others] - rest[roots])
    return positions, frames


def _ball(ball: np.ndarray) -> tuple[np.ndarray, float]:
    low, high = ball.min(axis=0), ball.max(axis=0)
    centre, radius = (low + high) / 2, float((high - low)[:2].max()) / 2
    centre[2] = high[2] - radius
    return centre, radius


def _ball_fit(ball: np.ndarray, surface: np.ndarray, fitted: np.ndarray) -> tuple[float, np.ndarray]:
    """Return scale and shift of an eyeball, so that its lids lie as far off it as at rest, in its own measure."""
    centre, radius = _ball(ball)
    away = np.linalg.norm(surface - centre, axis=1)
    lids = np.flatnonzero((away < LIDS_REACH * radius) & (surface[:, 2] > centre[2] - 0.3 * radius))
    if len(lids) < 8:
        lids = np.argsort(away)[:32]
    a, b = surface[lids], fitted[lids]
    middle_a, middle_b = a.mean(axis=0), b.mean(axis=0)
    # in the plane of the face only: depth is what the lids' thickness blurs
    scale = float(np.sqrt(np.square((b - middle_b)[:, :2]).sum() / np.square((a - middle_a)[:, :2]).sum()))
    goal = scale * (centre - middle_a) + middle_b
    wanted = scale * away[lids]
    for _ in range(12):  # Gauss-Newton on Σ (|b - c| - s |a - c₀|)², held near the start
        off = goal - b
        length = np.maximum(np.linalg.norm(off, axis=1), 1e-9)
        slope = off / length[:, None]
        step = np.linalg.solve(
            slope.T @ slope + 0.2 * len(lids) * np.diag([1.0, 1.0, 0.1]), slope.T @ (wanted - length)
        )
        goal = goal + step
    return scale, goal - scale * centre


def _clear_ball(rest_ball: np.ndarray, ball: np.ndarray, surface: np.ndarray, fitted: np.ndarray) -> None:
    """Bring lids that lie deeper in the eyeball than at rest out of it, in place."""
    (rest_centre, rest_radius), (centre, radius) = _ball(rest_ball), _ball(ball)
    scale = radius / rest_radius
    before, off = np.linalg.norm(surface - rest_centre, axis=1), fitted - centre
    now = np.linalg.norm(off, axis=1)
    least = np.minimum(scale * before, radius + LID_CLEARANCE_MM)
    deep = (now < least) & (before < LIDS_REACH * rest_radius)
    fitted[deep] = centre + off[deep] * (least[deep] / np.maximum(now[deep], 1e-9))[:, None]


def _mouth_fit(face: Face, surface: np.ndarray, fitted: np.ndarray) -> Similarity:
    """Return the similarity of the lips and the skin around them."""
    corners = [face.landmarks[f"mouth_corner_{side}"] for side in ("left", "right")]
    left, right = face.positions[corners].astype(float)
    away = np.linalg.norm(surface - (left + right) / 2, axis=1) / np.linalg.norm(left - right)
    near = away < 0.75
    return fit_similarity(surface[near], fitted[near])
