"""How open to light a face is: worked out on the graphics device once, then remembered in the cache."""

from __future__ import annotations

import contextlib
import hashlib
from functools import lru_cache
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.folders import cache_dir
from core.media.swap_in import swapped_in
from gpu.gl.face_arrays import FaceArrays

VERSION = 1  # raise it when `gpu.gl.face` shades otherwise


def light_path(face: Face) -> Path:
    """Return the file of a face's light; its name is a hash of the face."""
    digest = hashlib.sha256(f"light {VERSION}".encode())
    for array in (face.positions, face.triangles, face.part):
        digest.update(np.ascontiguousarray(array).tobytes())
    return cache_dir() / "light" / f"{digest.hexdigest()[:32]}.npy"


class FaceLight:
    """Light of the face on show, for the views that share it and the worker that prepares them."""

    def __init__(self) -> None:
        # replaced as a whole, as more threads than one look at it
        self._known: tuple[Face | None, np.ndarray | None] = None, None

    def of(self, face: Face) -> np.ndarray | None:
        """Return the light, 0..1, shape (n_vertices,); None where nobody has worked it out."""
        known, light = self._known
        if known is not face:
            light = _read(light_path(face), len(face.positions))
            self._known = face, light
        return light

    def keep(self, face: Face, light: np.ndarray) -> None:
        """Remember the light; a cache that cannot be written costs only time."""
        self._known = face, light
        path = light_path(face)
        with contextlib.suppress(OSError, UserFacingError):
            path.parent.mkdir(parents=True, exist_ok=True)
            with swapped_in(path) as beside, beside.open("wb") as file:
                np.save(file, light)

    def prepare(self, face: Face, arrays: FaceArrays) -> None:
        """Work the light out where nobody has, on a driver of this thread's own; without one the first view does."""
        from gpu.gl.offscreen import OffscreenRenderer

        if self.of(face) is None:
            with contextlib.suppress(UserFacingError), OffscreenRenderer(1, 1, samples=0) as offscreen:
                self.keep(face, arrays.light(offscreen.ctx))


@lru_cache(maxsize=1)
def face_light() -> FaceLight:
    """Return what all views share."""
    return FaceLight()


def _read(path: Path, n_vertices: int) -> np.ndarray | None:
    try:
        light = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError):
        return None
    fits = light.dtype == np.float32 and light.shape == (n_vertices,) and bool(((light >= 0) & (light <= 1)).all())
    return light if fits else None
