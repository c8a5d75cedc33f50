"""From captured markers to a character's controls (Kuo et al. 2012, section 4): least squares within bounds."""

from __future__ import annotations

import numpy as np

from core.face.binding import bind
from core.face.face import Face
from core.face.skinning import scale_to
from core.motion.marker_set import MarkerSet

# What a control at full strength may cost, mm² a marker, before another that does the same better is taken: enough
# that units which markers hardly tell apart share what they see, and do not fight.
RIDGE_MM2 = 0.01
_SWEEPS, _ROUNDS, _BLOCK_FRAMES = 10, 25, 512
_TOLERANCE = 1e-9


def solve_controls(
    marker_displacements: np.ndarray, unit_displacements: np.ndarray, ridge_mm2: float = RIDGE_MM2
) -> np.ndarray:
    """Find controls in [0, 1] that move the markers as captured: min |V − V_C|² (section 4), and a small ridge.

    marker_displacements : shape (F, K, 3), mm from rest
    unit_displacements : shape (U, K, 3), mm at full strength; a unit that moves no marker stays at 0
    ridge_mm2 : see `RIDGE_MM2`
    returns : float64, shape (F, U)
    """
    units = np.reshape(unit_displacements, (len(unit_displacements), -1))
    frames = np.reshape(marker_displacements, (len(marker_displacements), units.shape[1]))
    return bounded_least_squares(units, frames, ridge_mm2 * units.shape[1] / 3.0)


def solve_shares(lip_displacements: np.ndarray, key_shapes: np.ndarray) -> np.ndarray:
    """Find α >= 0 that blend key lip shapes to captured lips: min |L − Σ α_k L_k|² (section 4).

    lip_displacements : shape (F, K, 3), mm from rest; key_shapes : shape (n_shapes, K, 3), mm from rest
    returns : float64, shape (F, n_shapes)
    """
    shapes = np.reshape(key_shapes, (len(key_shapes), -1))
    frames = np.reshape(lip_displacements, (len(lip_displacements), shapes.shape[1]))
    return bounded_least_squares(shapes, frames, 0.0, highest=np.inf)


def units_at_markers(face: Face, markers: MarkerSet) -> tuple[tuple[str, ...], np.ndarray]:
    """Return the units of ``face`` by name, and how they move the actor's markers: shape (U, K, 3), the actor's mm.

    Where the eyes look is no affair of markers: what ``eyeLook`` units do to the lids would be taken for lids that
    move, so these units are said to move nothing, and stay at 0.

    Raises `UserFacingError` when the markers cannot be laid on the face.
    """
    vertices = bind(face, markers)
    scale = scale_to(face, vertices, markers)
    moves = [unit[vertices] * (not name.startswith("eyeLook")) for name, unit in face.units.items()]
    return tuple(face.units), np.stack(moves).astype(float) / scale


def bounded_least_squares(
    basis: np.ndarray, targets: np.ndarray, ridge: float = 0.0, lowest: float = 0.0, highest: float = 1.0
) -> np.ndarray:
    """Minimise |target − x · basis|² + ridge |x|² with ``lowest`` <= x <= ``highest``, for many targets at once.

    Sweeps of coordinate descent guess which controls rest on a bound; then the others are solved for exactly, and the
    guess is mended until the conditions of optimality hold. A target that takes too long is left to scipy.

    basis : float64, shape (U, D); targets : shape (F, D)
    returns : float64, shape (F, U)
    """
    basis, targets = np.asarray(basis, float), np.asarray(targets, float)
    gram = basis @ basis.T
    gram[np.diag_indices_from(gram)] += ridge
    # scaled to a unit diagonal, so that one tolerance serves controls that move much and little
    size = np.sqrt(gram.diagonal())
    moves = np.flatnonzero(size > 1e-9 * size.max(initial=1e-300))
    x = np.zeros((len(targets), len(basis)))
    gram, size = gram[np.ix_(moves, moves)] / np.outer(size[moves], size[moves]), size[moves]
    for first in range(0, len(targets) if len(moves) else 0, _BLOCK_FRAMES):
        block = targets[first : first + _BLOCK_FRAMES]
        wanted = block @ basis[moves].T / size
        x[first : first + len(block), moves] = _solve_scaled(gram, wanted, lowest * size, highest * size) / size
    return x


def _solve_scaled(gram: np.ndarray, wanted: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Minimise xᵀ gram x / 2 − wanted · x within bounds; ``gram`` has a unit diagonal."""
    x = np.clip(np.zeros_like(wanted), low, high)
    open_rows = np.arange(len(x))
    slack = _TOLERANCE * (1.0 + np.abs(wanted).max(axis=1))
    for _ in range(_ROUNDS):
        goal = wanted[open_rows]
        part = _swept(gram, goal.T.copy(), x[open_rows].T.copy(), low, high).T
        inside = np.clip(_with_free_solved(gram, goal, part, low, high), low, high)
        pulls, small = goal - inside @ gram, slack[open_rows, None]
        wrong = ((pulls > small) & (inside < high)) | ((pulls < -small) & (inside > low))
        x[open_rows] = inside
        open_rows = open_rows[wrong.any(axis=1)]
        if len(open_rows) == 0:
            return x
    for row in open_rows:
        x[row] = _by_scipy(gram, wanted[row], low, high)
    return x


def _swept(gram: np.ndarray, goal: np.ndarray, x: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Let one control after the other go where it is best, the others held; shapes (U, F)."""
    for _ in range(_SWEEPS):
        for u, row in enumerate(gram):
            x[u] = np.clip(x[u] + goal[u] - row @ x, low[u], high[u])
    return x


def _with_free_solved(gram, goal, x, low, high) -> np.ndarray:
    """Solve exactly for what is off its bounds; what rests on one stays there."""
    free = (x > low) & (x < high)
    both = free[:, :, None] & free[:, None, :]
    system = np.where(both, gram, np.eye(len(gram)))
    # free shapes that cannot be told apart (more shapes than dimensions) would make the system singular
    system[:, np.arange(len(gram)), np.arange(len(gram))] += 1e-12
    bound = np.where(free, 0.0, x)
    right = np.where(free, goal - bound @ gram, x)
    return np.linalg.solve(system, right[:, :, None])[:, :, 0]


def _by_scipy(gram, goal, low, high) -> np.ndarray:
    from scipy.optimize import lsq_linear

    root, vectors = np.linalg.eigh(gram)
    kept = root > 1e-12 * root.max()
    half = vectors[:, kept] * np.sqrt(root[kept])
    return lsq_linear(half.T, (vectors[:, kept].T @ goal) / np.sqrt(root[kept]), (low, high), tol=1e-12).x
