"""A textured sheet that is bent by known units before a camera: a face of which every point is known."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np

from core.media.audio import Audio
from core.media.video import write_video
from core.motion.marker_set import MarkerSet
from core.tracking.face_model import FaceModel

WIDTH, HEIGHT, SCALE = 320, 240, 1.5
MIDDLE = np.array([160.0, 120.0])
LANDMARKS = {
    "mouth_corner_left": (20.0, -25.0), "mouth_corner_right": (-20.0, -25.0),
    "outer_eye_left": (35.0, 25.0), "outer_eye_right": (-35.0, 25.0),
    "upper_lip": (0.0, -20.0), "lower_lip": (0.0, -30.0),
}  # fmt: skip
# where a unit moves the face most, which way, and how far around, mm
BUMPS = (((0.0, -30.0), (0.0, -1.0), 14.0), ((0.0, 20.0), (0.0, 1.0), 18.0), ((0.0, -20.0), (1.0, 0.3), 22.0))


def field_mm(points_mm: np.ndarray) -> np.ndarray:
    """Return the three units at any place, shape (3, ..., 2), mm for a parameter of 1."""
    away = [points_mm - np.array(at) for at, _, _ in BUMPS]
    return np.array([
        np.exp(-(off**2).sum(-1) / (2 * reach**2))[..., None] * (np.array(way) + 0.4 * off / reach)
        for off, (_, way, reach) in zip(away, BUMPS)
    ])  # fmt: skip


def sheet_markers() -> MarkerSet:
    """Return forty points on the sheet, among them the landmarks that are clicked."""
    chance = np.random.default_rng(5)
    places = chance.uniform([-42, -45], [42, 42], (34, 2))
    flat = np.vstack([list(LANDMARKS.values()), places])
    depth = 20.0 - 0.006 * (flat**2).sum(axis=1)
    names = (*LANDMARKS, *(f"m{k}" for k in range(len(places))))
    return MarkerSet(names, np.column_stack([flat, depth]), {}, {name: name for name in LANDMARKS})


@dataclass(frozen=True)
class Sheet:
    """A video to come: parameters, shape (F, 3), mm, and the similarity of every frame.

    turn : radians, shape (F,); grow : shape (F,); shift : pixels, shape (F, 2)
    """

    parameters: np.ndarray
    turn: np.ndarray
    grow: np.ndarray
    shift: np.ndarray
    noise: float = 0.0
    dark: frozenset[int] = field(default_factory=frozenset)

    def _camera(self, f: int) -> tuple[np.ndarray, np.ndarray]:
        cos, sin = np.cos(self.turn[f]), np.sin(self.turn[f])
        # millimetres are y up, pixels y down
        linear = SCALE * self.grow[f] * np.array([[cos, -sin], [sin, cos]]) @ np.diag([1.0, -1.0])
        return linear, MIDDLE + self.shift[f]

    def truth(self, points_mm: np.ndarray) -> np.ndarray:
        """Where points of the sheet at rest, shape (K, 2), mm, are in every frame, shape (F, K, 2), pixels."""
        units, at = field_mm(points_mm), []
        for f in range(len(self.parameters)):
            linear, shift = self._camera(f)
            at.append((points_mm + np.tensordot(self.parameters[f], units, 1)) @ linear.T + shift)
        return np.array(at)

    def pictures(self) -> list[np.ndarray]:
        """The frames, uint8, shape (HEIGHT, WIDTH, 3)."""
        chance = np.random.default_rng(11)
        texture = cv2.GaussianBlur(chance.normal(size=(400, 400)).astype(np.float32), (0, 0), 3.0)
        texture = np.clip(128 + 40 * texture / texture.std(), 0, 255)
        # the map is smooth, so that every fourth pixel will do; cv2.resize means the middles of squares of pixels
        across, down = (np.arange(n // 4) * 4 + 1.5 for n in (WIDTH, HEIGHT))
        pixels = np.stack(np.meshgrid(across, down), -1)
        drawn = []
        for f in range(len(self.parameters)):
            linear, shift = self._camera(f)
            bent = (pixels - shift) @ np.linalg.inv(linear).T
            rest = bent.copy()
            for _ in range(12):  # the unbent place of a bent one
                rest = bent - np.tensordot(self.parameters[f], field_mm(rest), 1)
            rest = cv2.resize(rest.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_LINEAR)
            at = rest * 2.0 + 200.0
            face = cv2.remap(texture.astype(np.float32), at, None, cv2.INTER_LINEAR, borderValue=60.0)
            off = (np.abs(rest) / [50.0, 55.0]) ** 2
            face = np.where(off.sum(-1) < 1.0, face, 60.0)
            seen = np.zeros_like(face) if f in self.dark else face + self.noise * chance.normal(size=face.shape)
            drawn.append(np.repeat(np.clip(np.rint(seen), 0, 255).astype(np.uint8)[..., None], 3, 2))
        return drawn


def bent_markers(parameters: np.ndarray) -> np.ndarray:
    """Return deformations of the markers for parameters (F, 3), shape (F, K, 3), mm, y up."""
    flat = np.tensordot(parameters, field_mm(sheet_markers().rest[:, :2]), 1)
    return np.concatenate([flat, 0.4 * flat[..., 1:]], axis=-1)


def speaking_sheet(n: int = 24, **other) -> Sheet:
    """Return a sheet that speaks, turns and drifts a little; anything can be said otherwise."""
    t = np.arange(n)[:, None] / 24.0
    parameters = 5.0 * np.sin(2 * np.pi * t * np.array([2.0, 1.3, 0.9])) * np.minimum(1.0, t * 6)
    shift = np.concatenate([9.0 * np.sin(2 * np.pi * t * 0.7), 6.0 * np.sin(2 * np.pi * t)], 1)
    usual = {"turn": 0.08 * np.sin(2 * np.pi * t[:, 0]), "grow": 1.0 + 0.04 * np.sin(3 * t[:, 0]), "shift": shift}
    return Sheet(parameters, **{**usual, **other})


def film_of(made: Sheet, path: Path, audio: Audio | None = None) -> Path:
    """Write a sheet to a file, with sound if asked."""
    drawn = made.pictures()
    write_video(path, drawn, len(drawn), Fraction(25), audio)
    return path


def clicks_on(model: FaceModel) -> dict[str, tuple[float, float]]:
    """Return where mouth and eye corners are in the first picture of any sheet."""
    flat = model.seen[:4] * SCALE + MIDDLE
    return {name: tuple(place) for name, place in zip(LANDMARKS, flat.tolist())}
