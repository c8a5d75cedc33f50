"""Triangles on a grid of pixels: which one covers each, and where on it."""

from __future__ import annotations

import numpy as np


def covered_pixels(
    corners: np.ndarray, width: int, height: int, depth: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Lay triangles on a grid; pixel (row, column) is its middle at (column + 0.5, row + 0.5).

    corners : shape (T, 3, 2), pixels, x to the right and y down
    depth : shape (T, 3), of the corners; the smallest wins. None: the last one wins
    returns : int32, shape (height, width), the triangle of each pixel, -1 for none; float32, shape (height, width, 3),
        barycentric coordinates
    """
    owner = np.full((height, width), -1, np.int32)
    bary = np.zeros((height, width, 3), np.float32)
    nearest = np.full((height, width), np.inf, np.float32)
    a, b, c = corners.astype(float).transpose(1, 0, 2)
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    low = np.maximum(np.floor(corners.min(axis=1) - 0.5), 0).astype(int)
    high = np.minimum(np.ceil(corners.max(axis=1) + 0.5), (width, height)).astype(int)
    shown = np.flatnonzero((np.abs(area) > 1e-9) & (high > low).all(axis=1))
    for t in shown.tolist():
        (left, top), (right, bottom) = low[t], high[t]
        x = np.arange(left, right) + 0.5
        y = (np.arange(top, bottom) + 0.5)[:, None]
        u = ((b[t, 0] - x) * (c[t, 1] - y) - (b[t, 1] - y) * (c[t, 0] - x)) / area[t]
        v = ((c[t, 0] - x) * (a[t, 1] - y) - (c[t, 1] - y) * (a[t, 0] - x)) / area[t]
        w = 1.0 - u - v
        inside = (u >= -1e-9) & (v >= -1e-9) & (w >= -1e-9)
        window = np.s_[top:bottom, left:right]
        if depth is not None:
            far = u * depth[t, 0] + v * depth[t, 1] + w * depth[t, 2]
            inside &= far < nearest[window]
            nearest[window][inside] = far[inside]
        owner[window][inside] = t
        bary[window][inside] = np.stack([u, v, w], axis=-1)[inside]
    return owner, bary
