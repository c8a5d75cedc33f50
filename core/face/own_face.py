"""A face of one's own: a generic face fitted to a scan by points that were clicked on both (iFACE, figure 5).

First a similarity and radial basis functions bring the generic face to the points, then what is left between it and
the scan is closed smoothly; eyes, teeth, tongue, lashes, shapes and markers come along.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.face.face import Face
from core.face.look import Look
from core.face.own_face_closing import close
from core.face.own_face_parts import place_parts
from core.face.own_face_photo import PhotoCamera, fit_camera, photo_texture
from core.face.own_face_points import feature_points, generic_points
from core.face.own_face_protected import Protected
from core.face.own_face_scan import Scan
from core.face.own_face_shapes import carried_shapes
from core.face.own_face_surface import Surface, vertex_normals
from core.face.own_face_texture import SIZE_PX, scan_texture, unwrapped
from core.face.own_face_warp import (
    ANOTHER_SCAN,
    LandmarkWarp,
    check_on_surface,
    doubtful_points,
    place_scan,
)
from core.face.similarity import Similarity
from core.progress import SILENT, Progress

FEWEST_SURE = 7
SEEN = 0.5  # share of the scan's pull from which a vertex counts where distances are told
HEAD_REACH = 3.2  # of the outer eye distance from the points' middle: a scan may hold a whole body


@dataclass(frozen=True)
class FitDistance:
    """What is left between a fitted face and its scan, mm, over the skin that the scan shows.

    to_scan : float64, shape (V,), of each vertex to the scan, NaN where the scan shows nothing or may not pull
    median, p95, largest : of these; back_median, back_p95 : of places of the scan to the face
    covered : share of the skin that the scan shows; points : float64, of the clicked points, median and largest
    """

    to_scan: np.ndarray
    median: float
    p95: float
    largest: float
    back_median: float
    back_p95: float
    covered: float
    points: tuple[float, float]


@dataclass(frozen=True)
class OwnFace:
    """A fitted face.

    face : with the generic skin; scan : in mm, as it lies on the face; placement : how it came there
    uv : float32, shape (V, 2), coordinates without seams for a picture, see `core.face.own_face_texture.unwrapped`
    warped : the distance after the points alone; closed : at the end
    doubtful : keys of points that all others contradict, worst first; they are left out while enough others stay
    notes : sentences for the user
    """

    face: Face
    scan: Scan
    placement: Similarity
    uv: np.ndarray
    warped: FitDistance
    closed: FitDistance
    doubtful: tuple[str, ...]
    notes: tuple[str, ...]


def fit_own_face(
    generic: Face,
    scan: Scan,
    points: Mapping[str, np.ndarray],
    on_generic: Mapping[str, np.ndarray] | None = None,
    name: str = "",
    progress: Progress = SILENT,
) -> OwnFace:
    """Fit ``generic`` to ``scan``.

    points : on the scan, key (see `core.face.own_face_points.feature_points`) to shape (3,), in the scan's unit
    on_generic : the same on the generic face, mm; None: where our characters have them
    name : of the new face; the scan's when empty

    returns : the face keeps the generic one's vertices, triangles, parts, landmarks and masks
    Raises `UserFacingError` for points that are missing or off the scan, and for a scan that cannot be the same head.
    """
    progress.step(0.0, "placing the scan")
    known = generic_points(generic) if on_generic is None else dict(on_generic)
    placement = place_scan(points, known)
    doubtful = doubtful_points({key: placement(points[key]) for key in points}, known)
    if doubtful and len(points) - len(doubtful) >= FEWEST_SURE:
        points = {key: place for key, place in points.items() if key not in doubtful}
        placement = place_scan(points, known, needs_all=False)
    placed = scan.placed(placement.scale, placement.rotation, placement.shift)
    keys = [key for key in known if key in points]
    targets = placement([points[key] for key in keys])
    near = _near_head(placed, targets, generic)
    if len(near) == 0:
        raise UserFacingError("The points lie far off the scan's surface.", ANOTHER_SCAN)
    placed = replace(placed, triangles=near)
    surface = Surface(placed.positions, placed.triangles)
    away = dict(zip(keys, surface.nearest(targets).distance.tolist()))
    check_on_surface(points, away, placement.scale * scan.size)
    progress.step(0.15, "fitting the points")
    protected = Protected.of(generic)
    rest = generic.positions[protected.surface].astype(float)
    sources = np.array([known[key] for key in keys])
    anchors = _anchors(sources, rest, protected)
    warp = LandmarkWarp.of(sources, targets)
    warped = rest + warp.displacement(rest)
    if _looks_inside_out(warped, protected, surface):
        surface = surface.flipped()
    before = _distance(generic, warped, protected, surface, anchors, targets)
    closed = close(warped, protected, rest, surface, anchors, targets, progress.part(0.2, 0.8))
    progress.step(0.8, "placing eyes and teeth")
    fitted = warped + closed.displacement
    if not np.isfinite(fitted).all():
        raise UserFacingError("The face could not be fitted to these points.", "Look whether one of them is far off.")
    positions, frames = place_parts(generic, protected, fitted)
    progress.step(0.85, "carrying the shapes along")
    face = replace(
        generic, name=name or scan.name, positions=positions.astype(np.float32), units={},
        credit=f"{generic.credit}; fitted to {scan.name}", is_kin=generic.is_kin or generic.name in CHARACTERS,
    )  # fmt: skip
    face = replace(face, units=carried_shapes(generic, frames, face))
    progress.step(0.95, "measuring what is left")
    after = _distance(generic, positions[protected.surface], protected, surface, anchors, targets)
    notes = list(scan.notes)
    if doubtful:
        titles = {point.key: point.title for point in feature_points()}
        listed = ", ".join(titles.get(key, key) for key in doubtful[:3])
        left_out = "was left out" if doubtful[0] not in points else "is used all the same"
        notes.append(f"Far from where the other points would have it, it {left_out}: {listed}.")
    progress.step(1.0)
    return OwnFace(face, placed, placement, unwrapped(generic), before, after, tuple(doubtful), tuple(notes))


def painted(own: OwnFace, progress: Progress = SILENT, size_px: int = SIZE_PX) -> Face:
    """Return the fitted face with the colours of its scan, in a picture of ``size_px``; as it is, where it has none."""
    if not own.scan.has_colour:
        return own.face
    return _with_texture(own, scan_texture(own.face, own.uv, own.scan, size_px, progress))


def painted_by_photo(
    own: OwnFace, photo: np.ndarray, pixels: Mapping[str, np.ndarray], points: Mapping[str, np.ndarray],
    progress: Progress = SILENT,
) -> tuple[Face, PhotoCamera]:  # fmt: skip
    """Return the fitted face with the colours of a photo, and the camera that took it.

    photo : uint8, shape (h, w, 3), top row first; pixels : points on it, key to shape (2,), x to the right and y down
    points : the points on the scan, as they were given to `fit_own_face`

    Raises `UserFacingError` as `core.face.own_face_photo.fit_camera` does.
    """
    places = {key: own.placement(point) for key, point in points.items()}
    camera = fit_camera(places, pixels, (photo.shape[1], photo.shape[0]))
    return _with_texture(own, photo_texture(own.face, own.uv, photo, camera, progress=progress)), camera


def _with_texture(own: OwnFace, texture: np.ndarray) -> Face:
    # a picture of a head brings its own hair
    look = Look(**{**own.face.look.as_dict(), "hair_mm": 0.0})
    return replace(own.face, uv=own.uv, texture=texture, look=look)


def _anchors(sources: np.ndarray, rest: np.ndarray, protected: Protected) -> csr_matrix:
    """Return the clicked points of the generic face as mixtures of surface vertices, sparse (n_points, n)."""
    skin = protected.triangles
    found = Surface(rest, skin).nearest(sources)
    rows = np.repeat(np.arange(len(sources)), 3)
    return csr_matrix((found.bary.ravel(), (rows, skin[found.triangle].ravel())), (len(sources), len(rest)))


def _near_head(scan: Scan, targets: np.ndarray, generic: Face) -> np.ndarray:
    """Return the triangles of the scan that may belong to the head: of a body scan the rest would only cost time."""
    middle = targets.mean(axis=0)
    reach = HEAD_REACH * max(generic.outer_eye_distance, float(np.linalg.norm(targets - middle, axis=1).max()))
    near = (np.linalg.norm(scan.positions - middle, axis=1) < reach)[scan.triangles].any(axis=1)
    return scan.triangles[near]


def _looks_inside_out(warped: np.ndarray, protected: Protected, surface: Surface) -> bool:
    sure = protected.share > SEEN
    alike = np.einsum(
        "ij,ij->i", vertex_normals(warped, protected.triangles)[sure], surface.nearest(warped[sure]).normal
    )
    return bool(np.median(alike) < 0)


def _distance(
    generic: Face, fitted: np.ndarray, protected: Protected, surface: Surface, anchors: csr_matrix, targets: np.ndarray
) -> FitDistance:
    sure = protected.share > SEEN
    near = surface.nearest(fitted[sure])
    seen = ~near.at_rim & (near.distance < 0.25 * generic.outer_eye_distance)
    seen &= np.einsum("ij,ij->i", vertex_normals(fitted, protected.triangles)[sure], near.normal) > 0.2
    to_scan = np.full(len(generic.positions), np.nan)
    to_scan[protected.surface[np.flatnonzero(sure)[seen]]] = near.distance[seen]
    left = near.distance[seen] if seen.any() else np.array([np.nan])
    # places of the scan over which the face's own skin lies
    samples = surface.samples[:: max(1, len(surface.samples) // 20_000)]
    gap, owner = cKDTree(fitted).query(samples)
    back = samples[sure[owner] & (gap < 0.25 * generic.outer_eye_distance)]
    back_mm = Surface(fitted, protected.triangles).nearest(back).distance if len(back) else np.array([np.nan])
    off = np.linalg.norm(anchors @ fitted - targets, axis=1)
    return FitDistance(
        to_scan, float(np.median(left)), float(np.quantile(left, 0.95)), float(left.max()), float(np.median(back_mm)),
        float(np.quantile(back_mm, 0.95)), float(seen.mean()), (float(np.median(off)), float(off.max())),
    )  # fmt: skip
