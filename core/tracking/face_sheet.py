"""The face of one picture laid out as in the first: what is compared with how each point looked at the beginning."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_RING_POINTS = 16
_RING_SIZE = 1.4
# The map is worked out for every fourth pixel each way, and is smooth between.
_STEP = 4


@dataclass(frozen=True)
class FaceSheet:
    """A triangulation of the points in the first picture, and a ring around them.

    Laid out by it, an open mouth is closed again and a turned head looks ahead, so that small windows around points
    look as they did at the beginning, whatever the face does.

    start : float64, shape (K, 2), the points in the first picture, pixels; ring : shape (R, 2)
    corner : shape (2,), of the sheet in the first picture; width, height : of the sheet
    """

    start: np.ndarray
    ring: np.ndarray
    corner: np.ndarray
    width: int
    height: int
    _weights: object

    @classmethod
    def of(cls, start: np.ndarray, size_px: tuple[int, int]) -> FaceSheet:
        """Lay a sheet over the points of a first picture of ``size_px`` (width, height)."""
        from scipy.sparse import csr_matrix
        from scipy.spatial import Delaunay

        middle, half = (start.max(axis=0) + start.min(axis=0)) / 2, np.ptp(start, axis=0) / 2
        turn = 2 * np.pi * np.arange(_RING_POINTS) / _RING_POINTS
        ring = middle + _RING_SIZE * np.maximum(half, 1.0) * np.stack([np.cos(turn), np.sin(turn)], 1)
        corner = np.maximum(np.floor(ring.min(axis=0)).astype(int), 0)
        width, height = np.maximum(np.minimum(np.ceil(ring.max(axis=0)).astype(int) + 1, size_px) - corner, 1).tolist()
        # the middles of squares of pixels, as cv2.resize means them
        x, y = (np.arange(-(-n // _STEP)) * _STEP + (_STEP - 1) / 2 for n in (width, height))
        pixels = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2) + corner
        mesh = Delaunay(np.concatenate([start, ring]), qhull_options="QJ")  # points may coincide, as closed lips do
        found = mesh.find_simplex(pixels)
        frames = mesh.transform[found]
        two = np.einsum("nij,nj->ni", frames[:, :2], pixels - frames[:, 2])
        weights = np.column_stack([two, 1.0 - two.sum(axis=1)])
        weights[(found < 0) | ~np.isfinite(weights).all(axis=1)] = 0.0
        columns = mesh.simplices[found]
        places = (np.repeat(np.arange(len(pixels)), 3), columns.ravel())
        matrix = csr_matrix((weights.astype(np.float32).ravel(), places), (len(pixels), len(start) + len(ring)))
        return cls(start, ring, corner, width, height, matrix)

    @property
    def points(self) -> np.ndarray:
        """The points on the sheet, shape (K, 2), pixels of the sheet."""
        return self.start - self.corner

    def laid_out(self, look: np.ndarray, points: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Return the sheet of a picture whose points are at ``points``, shape (K, 2), uint8, shape (height, width).

        moved : shape (2, 3), the affine by which the ring around the face has moved
        """
        import cv2

        ring = self.ring @ moved[:, :2].T + moved[:, 2]
        at = self._weights @ np.concatenate([points, ring]).astype(np.float32)
        across, down = -(-self.width // _STEP), -(-self.height // _STEP)
        at = cv2.resize(at.reshape(down, across, 2), (across * _STEP, down * _STEP), interpolation=cv2.INTER_LINEAR)
        at = at[: self.height, : self.width]
        return cv2.remap(look, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)

    def hull(self) -> np.ndarray:
        """Return which pixels of the sheet are face, uint8 0 or 1."""
        import cv2

        mask = np.zeros((self.height, self.width), np.uint8)
        outline = cv2.convexHull(np.rint(self.points).astype(np.int32))
        return cv2.fillConvexPoly(mask, outline, 1)


def likeness(one: np.ndarray, other: np.ndarray, mask: np.ndarray) -> float:
    """Return the correlation of two sheets over a mask, -1..1; 0 where one of them is empty."""
    a, b = (sheet[mask > 0].astype(np.float32) for sheet in (one, other))
    a, b = a - a.mean(), b - b.mean()
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0 else 0.0
