"""Where hair begins on the default face; the other characters, who share her vertices, carry it along."""

from __future__ import annotations

import numpy as np

REACH_MM = 30.0

# The hair seen from the side, (z, y) in mm from the middle between the eyes: hairline, temple, around the ear, nape,
# and far out behind. Drawn by hand on the wireframe.
OUTLINE_MM = (
    (90.0, 130.0), (60.0, 74.0), (18.0, 66.0), (4.0, 56.0), (-9.0, 42.0), (-20.0, 28.0), (-33.0, 17.0), (-43.0, 9.0),
    (-50.0, 9.0), (-70.0, 13.0), (-86.0, 10.0), (-95.0, -8.0), (-96.0, -42.0),
    (-104.0, -66.0), (-128.0, -80.0), (-230.0, -80.0), (-230.0, 130.0),
)  # fmt: skip


def hairline_distance(positions: np.ndarray) -> np.ndarray:
    """Return how deep each place lies under the hair, mm; negative on bare skin; shape (V,), within ±`REACH_MM`.

    positions : shape (V, 3), mm, on the default face
    """
    at = positions[:, [2, 1]].astype(float)
    corners = np.array(OUTLINE_MM)
    nearest = np.full(len(at), np.inf)
    inside = np.zeros(len(at), bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        edge = b - a
        t = np.clip((at - a) @ edge / (edge @ edge), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(at - a - t[:, None] * edge, axis=1))
        crosses = (a[1] > at[:, 1]) != (b[1] > at[:, 1])
        slope = (at[:, 1] - a[1]) / (edge[1] if edge[1] else 1.0)
        inside ^= crosses & (at[:, 0] < a[0] + slope * edge[0])
    return np.clip(np.where(inside, nearest, -nearest), -REACH_MM, REACH_MM)
