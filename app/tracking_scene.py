"""Videos of a face whose every spot is known: what the tracker is measured on, since no other video may be shipped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from core.actress.corpus import SpokenSentence, perform_details
from core.actress.performance import bundled_marker_units
from core.face.face import PARTS, Face
from core.face.moving_parts import MovingParts
from gpu.gl.camera import Camera, portrait_bounds

RATE_HZ = 30.0
WIDTH_PX, HEIGHT_PX = 640, 480
# tracking begins on a neutral face, and an expression is on the actress's face before she speaks
_NEUTRAL_FRAMES, _RISE_FRAMES = 3, 9


@dataclass(frozen=True)
class Scene:
    """A face that speaks and moves its head before a camera.

    face : who
    vertices : float32, shape (n_frames, n_vertices, 3), mm, world space; the first frame is neutral and frontal
    width, height : pixels
    """

    face: Face
    vertices: np.ndarray
    width: int = WIDTH_PX
    height: int = HEIGHT_PX

    @classmethod
    def of(cls, face: Face, spoken: SpokenSentence, head_gain: float = 1.0, n_frames: int | None = None,
           width: int = WIDTH_PX, height: int = HEIGHT_PX) -> Scene:  # fmt: skip
        """Let ``face`` perform a sentence of the synthetic actress at 30 frames a second.

        head_gain : how much larger than hers the head motion is, counted from the first frame
        n_frames : no more than these
        """
        done = perform_details(spoken, RATE_HZ)
        names = bundled_marker_units().names
        units = np.array([face.units[name] for name in names], np.float32).reshape(len(names), -1)
        n = min(len(done.activations), n_frames or len(done.activations))
        rise = np.clip((np.arange(n) - _NEUTRAL_FRAMES) / _RISE_FRAMES, 0.0, 1.0)
        rise = (rise * rise * (3.0 - 2.0 * rise))[:, None]
        moved = ((rise * done.activations[:n]) @ units).reshape(n, -1, 3)
        turns = Rotation.from_matrix(done.head_rotation[:n])
        turns = Rotation.from_rotvec(head_gain * (turns * turns[0].inv()).as_rotvec())
        shifts_mm = head_gain * (done.head_shift_mm[:n] - done.head_shift_mm[0])
        parts = MovingParts(face)
        return cls(face, np.array([
            parts.place(moved[f], (turns[f].as_rotvec(), shifts_mm[f]), rise[f] * done.gaze_deg[f]) for f in range(n)
        ], np.float32), width, height)  # fmt: skip

    @cached_property
    def camera(self) -> Camera:
        """The camera, which stands still."""
        return Camera.front(portrait_bounds(self.face))

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Project ``points``, shape (..., 3), mm, into the picture: x right, y down, the first pixel's middle at 0."""
        aspect = self.width / self.height
        clip = (
            np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1)
            @ (self.camera.projection(aspect) @ self.camera.view(aspect)).T
        )
        at = clip[..., :2] / clip[..., 3:]
        return np.stack([(at[..., 0] + 1) * self.width / 2, (1 - at[..., 1]) * self.height / 2], -1) - 0.5

    def tracks(self, points: np.ndarray) -> np.ndarray:
        """Return where the spots of skin at ``points`` of the first picture go: the truth.

        points : shape (n, 2), pixels; a point beside the face gets the nearest triangle's plane carried on
        returns : float64, shape (n_frames, n, 2), pixels
        """
        skin = self.face.part == PARTS.index("skin")
        triangles = self.face.triangles[skin[self.face.triangles].all(axis=1)]
        first = self.pixels(self.vertices[0].astype(float))
        corners, weights = _spots(first[triangles], self.vertices[0, triangles, 2].mean(axis=1), np.asarray(points))
        # the camera is far enough for weights of the picture to serve in space; their error is taken out
        spots = np.einsum("fnci,nc->fni", self.vertices[:, triangles[corners]].astype(float), weights)
        at = self.pixels(spots)
        return at + (points - at[0])

    def pictures(self) -> Iterator[np.ndarray]:
        """Draw the frames, uint8, shape (height, width, 3)."""
        from app.pictures import face_pictures

        yield from face_pictures([self.face], ((v,) for v in self.vertices), len(self.vertices), "face", self.width,
                                 self.height)  # fmt: skip


def _spots(corners: np.ndarray, depth: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The foremost triangle under each point (the nearest one beside the mesh), and the point's weights in it.

    corners : shape (T, 3, 2), pixels; depth : shape (T,), larger is nearer to the camera
    """
    a, b, c = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    # seen from the front they turn one way; in pixels, whose y runs down, that is the negative one
    facing = np.flatnonzero(area < -1e-6)
    p = points[:, None] - a[facing]
    v = (p[..., 0] * c[facing, 1] - p[..., 1] * c[facing, 0]) / area[facing]
    w = (b[facing, 0] * p[..., 1] - b[facing, 1] * p[..., 0]) / area[facing]
    outside = np.maximum(np.maximum(-v, -w), v + w - 1.0).clip(0.0)
    chosen = np.lexsort((np.broadcast_to(-depth[facing], outside.shape), outside.round(6)), axis=1)[:, 0]
    rows = np.arange(len(points))
    v, w = v[rows, chosen], w[rows, chosen]
    return facing[chosen], np.stack([1 - v - w, v, w], 1)


@dataclass(frozen=True)
class Trouble:
    """What a camera and a room do to pictures.

    noise : standard deviation of white noise, grey levels of 255; blur_px : standard deviation of a Gaussian
    light : how much a lamp that moves across the scene changes brightness, as a share; it also dims the whole
    """

    noise: float = 0.0
    blur_px: float = 0.0
    light: float = 0.0

    def of(self, pictures: Iterator[np.ndarray], seed: int = 1) -> Iterator[np.ndarray]:
        """Yield each picture, uint8, as the camera would give it."""
        import cv2

        chance = np.random.default_rng(seed)
        for f, picture in enumerate(pictures):
            seen = picture.astype(np.float32)
            if self.blur_px:
                seen = cv2.GaussianBlur(seen, (0, 0), self.blur_px)
            if self.light:
                across = np.linspace(-1.0, 1.0, picture.shape[1], dtype=np.float32)[None, :, None]
                swing = np.sin(2 * np.pi * f / 45.0)
                seen *= 1.0 - self.light * (0.5 - 0.5 * np.cos(2 * np.pi * f / 70.0)) + self.light * swing * across
            if self.noise:
                seen += self.noise * chance.standard_normal(picture.shape, np.float32)
            yield np.clip(np.rint(seen), 0, 255).astype(np.uint8)
