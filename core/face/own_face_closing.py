"""Non-rigid closing: what the points leave between face and scan, drawn together smoothly.

In each round every vertex that a scan may pull looks for the nearest place of it; the displacement d minimises

    Σ_i a_i w_i |d_i - t_i|² + ℓ⁴ ∫ |Δd|² + Σ_k m |P_k d - q_k|² + Σ_pairs c |d_upper - d_lower - r|²
        + Σ_i a_i ε |d_i|²

t_i is the way to the scan's tangent plane there, a_i the vertex's area, Δ the cotangent Laplacian of the warped face,
and ℓ, a length in mm that falls from round to round, how far a pull reaches (the stiffness of Amberg, Romdhani and
Vetter, "Optimal Step Nonrigid ICP Algorithms for Surface Registration", 2007, as a length). w_i is Tukey's weight of
the distance, and 0 for places that are too far, look another way, or lie on the rim of a hole. P_k are the clicked
points, and r what brings lips that touch at rest as near together again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu

from core.face.own_face_protected import Protected
from core.face.own_face_surface import Surface, vertex_normals
from core.progress import SILENT, Progress

REACH_MM = (70.0, 50.0, 40.0, 32.0, 26.0, 21.0, 17.0, 14.0, 11.0, 9.0, 7.5, 6.0, 5.0, 4.2, 3.6, 3.0)
FARTHEST_MM = (30.0, 8.0)  # of the nearest place that pulls, in the first and in the last round
LOOKS_ALIKE = (0.2, 0.6)  # least cosine of both normals
POINT_AREA_MM2 = (60.0, 30.0)  # a clicked point pulls like so much of the skin: clicks are less sure than surfaces
PAIR_AREA_MM2 = 400.0
HOLD = 1e-4


@dataclass(frozen=True)
class Closed:
    """What the closing did; n surface vertices.

    displacement : float64, shape (n, 3), mm; weight : float64, shape (n,), 0..1, how much the scan pulled at the end
    """

    displacement: np.ndarray
    weight: np.ndarray


def close(
    warped: np.ndarray,
    protected: Protected,
    rest: np.ndarray,
    scan: Surface,
    anchors: csr_matrix,
    targets: np.ndarray,
    progress: Progress = SILENT,
) -> Closed:
    """Draw the warped face onto the scan.

    warped, rest : shape (n, 3), mm, the surface vertices as the points have brought them, and as they rest
    anchors : sparse, shape (n_points, n), the clicked points as mixtures of vertices; targets : shape (n_points, 3)
    """
    triangles = protected.triangles
    laplacian, areas = cotangent_laplacian(warped, triangles)
    bending = laplacian.T @ diags(1.0 / areas) @ laplacian
    upper, lower = protected.pairs.T
    rows = np.arange(len(upper))
    shape = len(upper), len(warped)
    contact = csr_matrix((np.ones(len(rows)), (rows, upper)), shape) - csr_matrix(
        (np.ones(len(rows)), (rows, lower)), shape
    )
    fixed = PAIR_AREA_MM2 * contact.T @ contact + HOLD * diags(areas)
    # lips that touch stay as near as they rest, whatever the points made of them
    together = PAIR_AREA_MM2 * contact.T @ (contact @ (rest - warped))
    clicked, pulled = anchors.T @ anchors, anchors.T @ (targets - anchors @ warped)
    moved, weight = np.zeros_like(warped), np.zeros(len(warped))
    may = np.flatnonzero(protected.share > 0)
    for r, reach in enumerate(REACH_MM):
        progress.step(r / len(REACH_MM), "closing the distance to the scan")
        along = r / (len(REACH_MM) - 1)
        now = warped + moved
        normals = vertex_normals(now, triangles)[may]
        near = scan.nearest(now[may])
        farthest = FARTHEST_MM[0] * (FARTHEST_MM[1] / FARTHEST_MM[0]) ** along
        alike = LOOKS_ALIKE[0] + (LOOKS_ALIKE[1] - LOOKS_ALIKE[0]) * along
        fits = ~near.at_rim & (near.distance < farthest) & (np.einsum("ij,ij->i", normals, near.normal) > alike)
        across = np.einsum("ij,ij->i", near.place - now[may], near.normal)
        weight[:] = 0.0
        weight[may] = protected.share[may] * fits * np.clip(1.0 - (across / farthest) ** 2, 0.0, 1.0) ** 2
        wanted = moved.copy()
        wanted[may] += across[:, None] * near.normal
        pull = areas * weight
        hold = POINT_AREA_MM2[0] * (POINT_AREA_MM2[1] / POINT_AREA_MM2[0]) ** along
        system = csc_matrix(diags(pull) + reach**4 * bending + fixed + hold * clicked)
        # symmetric and positive definite: no pivots are looked for, which halves the work
        factors = splu(system, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        moved = factors.solve(pull[:, None] * wanted + hold * pulled + together)
    progress.step(1.0)
    return Closed(moved, weight)


def cotangent_laplacian(positions: np.ndarray, triangles: np.ndarray) -> tuple[csr_matrix, np.ndarray]:
    """Return the cotangent Laplacian, sparse (n, n), each row times its vertex's area, and the areas, (n,), mm²."""
    n = len(positions)
    corners = positions[triangles]
    rows, columns, values = [], [], []
    for i in range(3):
        a, b, c = corners[:, i], corners[:, (i + 1) % 3], corners[:, (i + 2) % 3]
        cross = np.maximum(np.linalg.norm(np.cross(b - a, c - a), axis=1), 1e-9)
        # slivers would make a single edge as stiff as all others together
        cot = np.clip(np.einsum("ij,ij->i", b - a, c - a) / cross, -5.0, 5.0) / 2
        one, other = triangles[:, (i + 1) % 3], triangles[:, (i + 2) % 3]
        rows += [one, other, one, other]
        columns += [other, one, one, other]
        values += [cot, cot, -cot, -cot]
    made = csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (n, n))
    a, b, c = corners.transpose(1, 0, 2)
    third = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    areas = sum(np.bincount(triangles[:, i], third, n) for i in range(3))
    return made, np.maximum(areas, 1e-3 * areas.mean())
