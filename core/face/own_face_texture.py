"""A picture for the fitted face: the colours of the scan, or numbers of its vertices, laid on its unwrapped skin."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import map_coordinates

from core.face.face import PARTS, Face
from core.face.own_face_raster import covered_pixels
from core.face.own_face_scan import Scan
from core.face.own_face_surface import Surface, vertex_normals
from core.progress import SILENT, Progress

SIZE_PX = 1024
# The middle of the unwrapping: below and behind the eyes, in fractions of the outer eye distance.
CENTRE = (0.0, -0.55, -0.75)
FARTHEST_MM = 8.0
LOOKS_ALIKE = 0.2
_BLOCK = 65_536


def unwrapped(face: Face) -> np.ndarray:
    """Return texture coordinates without seams, float32, shape (V, 2), v up: the skin seen from inside the head.

    The direction from a place in the head to a vertex, equal areas on a disc: front in the middle, its rim at the back.
    One coordinate a vertex leaves no room for seams, along which the artists' own coordinates tear. What folds over
    (ears, nostrils, behind the jaw) shares its place in the picture with what lies before it.
    """
    eyes = face.positions[[face.landmarks["outer_eye_left"], face.landmarks["outer_eye_right"]]].mean(axis=0)
    away = face.positions - (eyes + face.outer_eye_distance * np.array(CENTRE))
    length = np.maximum(np.linalg.norm(away, axis=1), 1e-6)
    flat = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-6)
    radius = np.sin(np.arccos(np.clip(away[:, 2] / length, -1.0, 1.0)) / 2)
    return (0.5 + 0.495 * radius[:, None] * away[:, :2] / flat[:, None]).astype(np.float32)


class SkinTexels:
    """The pixels of a square picture that the skin of a face covers.

    rows, columns : int, shape (n,); triangle : int, shape (n,), into ``triangles``; bary : float32, shape (n, 3)
    """

    def __init__(self, face: Face, uv: np.ndarray, size_px: int = SIZE_PX) -> None:
        self.size_px = size_px
        self.triangles = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
        corners = np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)[self.triangles] * size_px
        (ax, ay), (bx, by), (cx, cy) = corners.transpose(1, 2, 0)
        # what is folded over is laid first, so that what lies in front of it wins
        order = np.argsort((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0, kind="stable")
        owner, bary = covered_pixels(corners[order], size_px, size_px)
        self.rows, self.columns = np.nonzero(owner >= 0)
        self.triangle = order[owner[self.rows, self.columns]]
        self.bary = bary[self.rows, self.columns]

    def mixed(self, values: np.ndarray) -> np.ndarray:
        """Return numbers given at the vertices, shape (V, c), at every pixel, shape (n, c)."""
        return np.einsum("nk,nkc->nc", self.bary, values[self.triangles[self.triangle]])

    def picture(self, colours: np.ndarray, sure: np.ndarray) -> np.ndarray:
        """Return the whole picture, uint8, (size, size, 3); where ``sure`` (n,) is 0 and round about it is filled.

        colours : shape (n, 3), 0..255
        """
        filled = np.zeros((self.size_px, self.size_px, 4))
        filled[self.rows, self.columns, :3] = colours * sure[:, None]
        filled[self.rows, self.columns, 3] = sure
        return np.clip(_filled(filled) + 0.5, 0, 255).astype(np.uint8)


def scan_texture(
    face: Face, uv: np.ndarray, scan: Scan, size_px: int = SIZE_PX, progress: Progress = SILENT
) -> np.ndarray:
    """Return the colours of the placed ``scan`` on the fitted ``face``, uint8, shape (size, size, 3).

    Every pixel of the skin takes the colour of the nearest place of the scan that looks the same way; holes are filled
    from around.
    """
    texels = SkinTexels(face, uv, size_px)
    surface = Surface(scan.positions, scan.triangles)
    normals = vertex_normals(face.positions.astype(float), face.triangles)
    places = texels.mixed(face.positions.astype(float))
    facing = _unit(texels.mixed(normals))
    colours, sure = np.zeros((len(places), 3)), np.zeros(len(places))
    inside_out = np.median(np.einsum("ij,ij->i", facing[::97], surface.nearest(places[::97]).normal)) < 0
    for first in range(0, len(places), _BLOCK):
        progress.step(first / len(places), "laying the scan's colours on the face")
        block = slice(first, first + _BLOCK)
        near = surface.nearest(places[block])
        alike = np.einsum("ij,ij->i", facing[block], near.normal) * (-1.0 if inside_out else 1.0)
        sure[block] = (near.distance < FARTHEST_MM) & (alike > LOOKS_ALIKE) & ~near.at_rim
        colours[block] = scan_colours(scan, near.triangle, near.bary)
    if not sure.any():
        sure[:] = 1.0
    return texels.picture(colours, sure)


def scan_colours(scan: Scan, triangle: np.ndarray, bary: np.ndarray) -> np.ndarray:
    """Return the colours of places on a scan that has some, shape (n, 3), 0..255."""
    if scan.picture is None or scan.corner_uv is None:
        return np.einsum("nk,nkc->nc", bary, scan.colours[scan.triangles[triangle]].astype(float))
    uv = np.nan_to_num(np.einsum("nk,nkc->nc", bary, scan.corner_uv[triangle].astype(float)))
    height, width = scan.picture.shape[:2]
    # coordinates beyond the picture repeat it
    at = [(1.0 - uv[:, 1] % 1.0) * height - 0.5, uv[:, 0] % 1.0 * width - 0.5]
    return sampled(scan.picture, np.array(at))


def sampled(picture: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return a picture (h, w, 3) between its pixels at rows and columns ``at`` (2, n): shape (n, 3)."""
    return np.stack([map_coordinates(picture[:, :, c], at, float, order=1, mode="nearest") for c in range(3)], axis=1)


def heat(values: np.ndarray, full: float) -> np.ndarray:
    """Return colours for distances, shape (n, 3), 0..255: green at 0, yellow, red at ``full``; grey for NaN."""
    stops = np.array([(58, 140, 92), (214, 196, 88), (206, 72, 58)], float)
    t = np.clip(np.nan_to_num(values) / full, 0.0, 1.0) * (len(stops) - 1)
    low = np.minimum(t.astype(int), len(stops) - 2)
    mixed = stops[low] + (t - low)[:, None] * (stops[low + 1] - stops[low])
    return np.where(np.isnan(values)[:, None], (92.0, 94.0, 98.0), mixed)


def distance_texture(face: Face, uv: np.ndarray, to_scan: np.ndarray, full_mm: float, size_px: int = 512) -> np.ndarray:
    """Return a map of the distances that a fit leaves, shape (V,), NaN unknown, as `heat` colours them."""
    texels = SkinTexels(face, uv, size_px)
    return texels.picture(texels.mixed(heat(to_scan, full_mm)), np.ones(len(texels.rows)))


def _filled(layers: np.ndarray) -> np.ndarray:
    """Fill what has no weight (last channel) from coarser and coarser means of what has; shape (h, w, 3)."""
    weight = layers[..., 3:]
    mean = layers[..., :3] / np.maximum(weight, 1e-9)
    if len(layers) <= 2 or (weight > 0.5).all():
        return np.where(weight > 0, mean, layers[..., :3].sum((0, 1)) / max(float(weight.sum()), 1e-9))
    half = layers[: len(layers) // 2 * 2, : layers.shape[1] // 2 * 2]
    half = half.reshape(len(half) // 2, 2, half.shape[1] // 2, 2, 4).sum(axis=(1, 3))
    # one vote a pixel, whatever it was made of: else large well-known parts would bleed far
    half /= np.maximum(half[..., 3:], 1.0)
    coarse = _filled(half)
    rows = np.clip((np.arange(len(layers)) + 0.5) / 2 - 0.5, 0, len(coarse) - 1)
    columns = np.clip((np.arange(layers.shape[1]) + 0.5) / 2 - 0.5, 0, coarse.shape[1] - 1)
    at = np.stack(np.meshgrid(rows, columns, indexing="ij")).reshape(2, -1)
    around = sampled(coarse, at).reshape(*layers.shape[:2], 3)
    known = np.clip(weight, 0.0, 1.0)
    return known * mean + (1.0 - known) * around


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
