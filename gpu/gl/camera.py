"""The camera that orbits a face or a cloud of markers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.face.face import Face

_MARGIN = 1.06
_MAX_ELEVATION_DEG = 89.0


@dataclass(frozen=True)
class Camera:
    """An orbiting perspective camera that keeps a box in view, whatever the shape of the window.

    target_mm : the point looked at, world space (x to the character's left, y up, z forward)
    half_mm : half the box's width and height as seen from the front, and its depth; at zoom 1 the box fills the view
    azimuth_deg : 0 looks at the face from the front; 90 from the character's left
    elevation_deg : positive from above
    zoom : 2 shows everything twice as large
    fov_deg : vertical field of view; small, as a portrait lens has
    """

    target_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    half_mm: tuple[float, float, float] = (100.0, 100.0, 100.0)
    azimuth_deg: float = 0.0
    elevation_deg: float = 0.0
    zoom: float = 1.0
    fov_deg: float = 22.0

    @classmethod
    def front(cls, bounds_mm: np.ndarray) -> Camera:
        """Look from the front at a box; ``bounds_mm`` has shape (2, 3), lowest and highest corner."""
        low, high = np.asarray(bounds_mm, float)
        half = np.maximum((high - low) / 2, 1e-3)
        return cls(tuple((low + high) / 2), tuple(half))

    @classmethod
    def side(cls, bounds_mm: np.ndarray) -> Camera:
        """Look at the same box from the character's left, so that the face points to the left of the picture."""
        return replace(cls.front(bounds_mm), azimuth_deg=90.0)

    def orbited(self, azimuth_deg: float, elevation_deg: float) -> Camera:
        """Return this camera turned further; it never tips over the pole."""
        elevation = float(np.clip(self.elevation_deg + elevation_deg, -_MAX_ELEVATION_DEG, _MAX_ELEVATION_DEG))
        return replace(self, azimuth_deg=(self.azimuth_deg + azimuth_deg) % 360.0, elevation_deg=elevation)

    def zoomed(self, factor: float) -> Camera:
        """Return this camera with everything ``factor`` times as large, within 0.1 to 40."""
        return replace(self, zoom=float(np.clip(self.zoom * factor, 0.1, 40.0)))

    def panned(self, right: float, up: float) -> Camera:
        """Return this camera with its target moved by fractions of the picture's half height."""
        half = max(self.half_mm[:2]) / self.zoom
        rotation = self.view()[:3, :3]
        return replace(self, target_mm=tuple(self.target_mm + half * (right * rotation[0] + up * rotation[1])))

    def distance_mm(self, aspect: float) -> float:
        """Distance from eye to target at which the box fits a picture of ``aspect`` = width / height."""
        slope = np.tan(np.radians(self.fov_deg) / 2)
        half = max(self.half_mm[1], self.half_mm[0] / aspect)
        return float(_MARGIN * half / slope / self.zoom)

    def view(self, aspect: float = 1.0) -> np.ndarray:
        """Return the matrix from world to view space, float64, shape (4, 4), to be used as ``view @ column``."""
        a, e = np.radians([self.azimuth_deg, self.elevation_deg])
        back = np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])
        right = np.array([np.cos(a), 0.0, -np.sin(a)])
        matrix = np.eye(4)
        matrix[:3, :3] = right, np.cross(back, right), back
        matrix[:3, 3] = -matrix[:3, :3] @ np.asarray(self.target_mm)
        matrix[2, 3] -= self.distance_mm(aspect)
        return matrix

    def projection(self, aspect: float) -> np.ndarray:
        """Return the matrix from view to clip space, float64, shape (4, 4)."""
        distance = self.distance_mm(aspect)
        reach = 4.0 * float(np.linalg.norm(self.half_mm))
        far = distance + reach
        near = max(distance - reach, far / 500)
        focal = 1 / np.tan(np.radians(self.fov_deg) / 2)
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = focal / aspect, focal
        matrix[2, 2], matrix[2, 3] = (far + near) / (near - far), 2 * far * near / (near - far)
        matrix[3, 2] = -1
        return matrix


def portrait_bounds(face: Face) -> np.ndarray:
    """Return the box, shape (2, 3), mm, that a portrait of ``face`` shows: hair to neck, without the shoulders.

    The whole mesh where the landmarks are unknown.
    """
    low, high = face.positions.min(axis=0).astype(float), face.positions.max(axis=0).astype(float)
    needed = ("outer_eye_left", "outer_eye_right", "chin")
    if any(name not in face.landmarks for name in needed):
        return np.stack([low, high])
    left, right, chin = (face.positions[face.landmarks[name]].astype(float) for name in needed)
    eyes, apart = (left + right) / 2, face.outer_eye_distance
    wide = 1.02 * apart
    portrait = np.array(
        [[eyes[0] - wide, chin[1] - 0.42 * apart, low[2]], [eyes[0] + wide, eyes[1] + 1.45 * apart, high[2]]]
    )
    high[1] += face.look.hair_mm if "hair" in face.masks else 0.0
    return np.stack([np.maximum(portrait[0], low), np.minimum(portrait[1], high)])
