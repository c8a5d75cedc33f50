"""Which vertex of a face every marker of a set belongs to."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.face.face import PARTS, Face
from core.face.geodesic import surface_distances
from core.face.marker_placement import ACTRESS_FILE, MarkerPlacement, load_marker_file
from core.face.similarity import fit_similarity
from core.motion.marker_set import MarkerSet

CANDIDATES = 16  # nearest vertices offered to each marker; enough for all to find one of their own


def bind(face: Face, marker_set: MarkerSet, placement: MarkerPlacement | None = None) -> np.ndarray:
    """Return the vertex of ``face`` under each marker; int, shape (K,), all different, all on the skin.

    placement : the user's own marker file for this face; its markers stay where it puts them. Without one, the
        actress's markers on our own characters and their kin, who share their vertices, come from their table.

    All other markers are carried over: a similarity fit on the points both sides know (landmarks, and markers of the
    file), refined by a thin-plate spline through them, then the nearest free vertex, with markers of the groups
    ``upper_lip`` and ``lower_lip`` kept on their own lip. Raises `UserFacingError` when fewer than four points
    are known on both sides, or a file names vertices that the face has not.
    """
    if placement is None and (face.name in CHARACTERS or face.is_kin):
        table = load_marker_file(ACTRESS_FILE)
        if set(marker_set.names) <= set(table.names):
            placement = table
    fixed = _fixed(face, marker_set, placement)
    free = np.array([k for k in range(len(marker_set)) if k not in fixed], int)
    vertices = np.full(len(marker_set), -1)
    vertices[list(fixed)] = list(fixed.values())
    if len(free):
        estimate = carry_over(face, marker_set, fixed)
        vertices[free] = _nearest_own(face, marker_set, estimate, free, set(fixed.values()))
    return vertices


def carry_over(face: Face, marker_set: MarkerSet, fixed: dict[int, int] | None = None) -> np.ndarray:
    """Return where the markers' rest pose comes to lie on ``face``; float64, shape (K, 3), mm.

    fixed : marker row to vertex, known beforehand besides the landmarks
    """
    known = {row: vertex for name, vertex in face.landmarks.items() if (row := marker_set.landmark(name)) is not None}
    known |= fixed or {}
    rows = np.array(sorted(known), int)
    target = face.positions[[known[row] for row in rows.tolist()]].astype(float)
    source = marker_set.rest[rows]
    if len(rows) < 4 or np.linalg.matrix_rank(source - source.mean(axis=0), tol=1.0) < 2:
        raise UserFacingError(
            f"The face {face.name} and the markers share only {len(rows)} known points, and four are needed.",
            "Give a marker file that names a vertex for every marker, or for the landmarks.",
        )
    moved = fit_similarity(source, target)(marker_set.rest)
    # in three dimensions the kernel of the thin-plate spline is the distance itself; a little smoothing lets
    # landmarks that are not quite the same place on both sides bend the rest less
    bend = RBFInterpolator(moved[rows], target - moved[rows], kernel="linear", smoothing=1.0, degree=0)
    return moved + bend(moved)


def _fixed(face: Face, marker_set: MarkerSet, placement: MarkerPlacement | None) -> dict[int, int]:
    if placement is None:
        return {}
    at = dict(zip(placement.names, placement.vertices.tolist()))
    fixed = {k: at[name] for k, name in enumerate(marker_set.names) if name in at}
    for k, vertex in fixed.items():
        if vertex >= len(face.positions):
            raise UserFacingError(
                f"Marker {marker_set.names[k]} sits on vertex {vertex}, "
                f"but the face {face.name} has only {len(face.positions)} vertices."
            )
    return fixed


def _nearest_own(
    face: Face, marker_set: MarkerSet, estimate: np.ndarray, free: np.ndarray, taken: set[int]
) -> np.ndarray:
    """Give each free marker a skin vertex of its own, with the smallest sum of squared distances."""
    used = np.zeros(len(face.positions), bool)
    used[face.triangles] = True
    open_to_all = used & (face.part == PARTS.index("skin"))
    open_to_all[list(taken)] = False
    lip = _lips(face)
    rows = [np.flatnonzero(open_to_all & (lip[name] if name else True)) for name in ("", "upper_lip", "lower_lip")]
    side = np.zeros(len(marker_set), int)
    side[marker_set.group("upper_lip")] = 1
    side[marker_set.group("lower_lip")] = 2
    choices: list[tuple[int, int, float]] = []
    for kind, vertices in enumerate(rows):
        markers = np.flatnonzero(side[free] == kind)
        if len(markers) == 0:
            continue
        if len(vertices) < len(free):
            raise UserFacingError(f"The face {face.name} has too few skin vertices for {len(marker_set)} markers.")
        gap, near = cKDTree(face.positions[vertices]).query(estimate[free[markers]], k=min(CANDIDATES, len(vertices)))
        choices += [
            (m, int(vertices[v]), float(g) ** 2)
            for m, gs, vs in zip(markers.tolist(), gap, near)
            for g, v in zip(gs, vs)
        ]
    offered = {vertex: column for column, vertex in enumerate(sorted({vertex for _, vertex, _ in choices}))}
    cost = np.full((len(free), len(offered)), 1e12)
    for marker, vertex, squared in choices:
        cost[marker, offered[vertex]] = squared
    _, columns = linear_sum_assignment(cost)
    return np.array(list(offered))[columns]


def _lips(face: Face) -> dict[str, np.ndarray]:
    """Return masks of the skin nearer, along the surface, to the one lip than to the other."""
    lips = [face.landmarks.get(name) for name in ("upper_lip", "lower_lip")]
    if None in lips:
        return {name: np.ones(len(face.positions), bool) for name in ("upper_lip", "lower_lip")}
    skin = face.part == PARTS.index("skin")
    triangles = face.triangles[skin[face.triangles].all(axis=1)]
    upper, lower = surface_distances(face.positions, triangles, np.array(lips))
    return {"upper_lip": upper <= lower, "lower_lip": lower <= upper}
