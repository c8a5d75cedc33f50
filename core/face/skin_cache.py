"""Fitted skins kept on disk, named by all that went into them."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
from scipy.sparse import csr_matrix

from core.face.face import Face
from core.face.face_file import UNREADABLE, read_arrays, write_arrays
from core.face.jaw import JawHinge
from core.face.marker_weights import REACH, SIGMA
from core.face.skinning import MarkerSkin
from core.folders import cache_dir
from core.motion.marker_set import MarkerSet

VERSION = 2  # raise it when the fit changes, so that old files are not taken for new ones


def cached_skin(
    face: Face, marker_vertices: np.ndarray, marker_set: MarkerSet, sigma: float = SIGMA, reach: float = REACH
) -> MarkerSkin:
    """Do `MarkerSkin.fit`, or read its result from an earlier time; a damaged or unwritable cache only costs time."""
    path = skin_path(face, marker_vertices, marker_set, sigma, reach)
    skin = _read(path, len(face.positions), len(marker_set))
    if skin is None:
        skin = MarkerSkin.fit(face, marker_vertices, marker_set, sigma, reach)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_arrays(path, **_arrays(skin))
        except OSError:
            return skin
    return skin


def skin_path(face: Face, marker_vertices: np.ndarray, marker_set: MarkerSet, sigma: float, reach: float) -> Path:
    """Return the file of this fit in the cache; its name is a hash of face, markers and settings."""
    digest = hashlib.sha256(f"skin {VERSION} {sigma!r} {reach!r} {sorted(face.landmarks.items())}".encode())
    digest.update(marker_set.to_json().encode())
    for array in (face.positions, face.triangles, face.part, np.asarray(marker_vertices, np.int64), marker_set.rest):
        array = np.ascontiguousarray(array)
        digest.update(f"{array.dtype} {array.shape}".encode())
        digest.update(array.tobytes())
    return cache_dir() / "skins" / f"{digest.hexdigest()[:32]}.npz"


def _arrays(skin: MarkerSkin) -> dict[str, np.ndarray]:
    return {
        "data": skin.weights.data,
        "indices": skin.weights.indices,
        "indptr": skin.weights.indptr,
        "shape": np.array(skin.weights.shape),
        "drive": skin.drive,
        "scale": np.float64(skin.scale),
        "jaw_markers": skin.jaw_markers,
        "jaw_vertices": skin.jaw_vertices,
        "jaw_share": skin.jaw_share,
        "jaw_points": skin.jaw_points,
        "hinge": skin.hinge.hinge,
        "chin": skin.hinge.chin,
    }


def _read(path: Path, n_vertices: int, n_markers: int) -> MarkerSkin | None:
    try:
        a = read_arrays(path)
        weights = csr_matrix((a["data"], a["indices"], a["indptr"]), shape=tuple(a["shape"]))
        weights.check_format(full_check=True)
        jaw = (a["jaw_markers"], a["jaw_vertices"], a["jaw_share"], a["jaw_points"])
        skin = MarkerSkin(weights, a["drive"], float(a["scale"]), *jaw, JawHinge(a["hinge"], a["chin"]))
    except UNREADABLE:
        return None
    return skin if weights.shape == (n_vertices, n_markers) else None
