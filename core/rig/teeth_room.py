"""Lower teeth that stay behind the skin of the chin while controls open the jaw.

The characters share one set of units, made on an adult head; on a small chin the teeth that they carry come through.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.face.face import PARTS, Face

JAW = "jawOpen"
# beside the jaw, what pulls the lower lip down draws the skin over the teeth tight
WITH = ("mouthLowerDownLeft", "mouthLowerDownRight", "mouthStretchLeft", "mouthStretchRight")
WITH_SHARE = 0.5
OPEN = (0.2, 0.4, 0.6, 0.8, 1.0)
MARGIN_MM = 1.0
_WINDOW_MM = 12.0  # skin further behind a point than this is another side of the head


def with_room_for_teeth(face: Face) -> Face:
    """Return ``face`` with its jaw's unit drawing the lower teeth back, all alike, as far as its skin needs.

    What lies in the mouth's socket goes back too, each vertex as far as it needs. A face whose teeth never come within
    a millimetre of the skin from behind stays as it is, and so does one without teeth or without a unit for the jaw.
    """
    teeth = face.vertices_of("lower_teeth")
    if JAW not in face.units or len(teeth) == 0:
        return face
    drawn = sum((face.units[name] * np.float32(WITH_SHARE) for name in WITH if name in face.units),
                np.zeros_like(face.positions))  # fmt: skip
    skin = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    socket = face.vertices_of("mouth_socket")
    inside = np.concatenate([teeth, socket])
    room_mm = np.zeros(len(inside))
    for share in OPEN:
        moved = face.positions + share * face.units[JAW] + drawn
        room_mm = np.maximum(room_mm, _excess_mm(moved[inside], moved, skin) / share)
    if not room_mm[: len(teeth)].any():
        return face
    room_mm[: len(teeth)] = room_mm[: len(teeth)].max()
    jaw = face.units[JAW].copy()
    jaw[inside, 2] -= room_mm.astype(np.float32)
    return replace(face, units={**face.units, JAW: jaw})


def _excess_mm(points: np.ndarray, positions: np.ndarray, skin: np.ndarray) -> np.ndarray:
    """How far each point must go back to stay behind the skin in front of it, mm; 0 where there is room."""
    low, high = points.min(axis=0) - (1.0, 1.0, _WINDOW_MM), points.max(axis=0) + 1.0
    corners = positions[skin]
    near = (corners.max(axis=1) >= low).all(axis=1) & (corners[:, :, :2].min(axis=1) <= high[:2]).all(axis=1)
    a, b, c = corners[near].astype(float).transpose(1, 0, 2)
    ab, ac = (b - a)[:, :2], (c - a)[:, :2]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    faces_front = area > 1e-9  # counter-clockwise from the front; the inside of the lips looks back
    a, b, c, ab, ac, area = (x[faces_front] for x in (a, b, c, ab, ac, area))
    excess = np.zeros(len(points))
    for n, point in enumerate(points.astype(float)):
        ap = point[:2] - a[:, :2]
        u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
        v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
        over = (u >= 0) & (v >= 0) & (u + v <= 1)
        depth = (a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2])[over]
        depth = depth[depth > point[2] - _WINDOW_MM]
        if len(depth):
            excess[n] = max(0.0, point[2] + MARGIN_MM - float(depth.max()))
    return excess
