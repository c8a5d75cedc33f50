"""Pictures without a window: a GL context of its own and a framebuffer that is read back."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Callable

import moderngl
import numpy as np

from core.errors import UserFacingError
from gpu.gl.libraries import library_names

_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "lavapipe", "swiftshader", "gdi generic", "apple software")


class OffscreenRenderer:
    """A standalone GL context with a framebuffer of ``width`` by ``height`` pixels.

    Use it as a context manager and in one thread; any thread may be that one, also while Qt draws in another. Make
    renderers for its ``ctx`` right after it, or after `make_current` when another context came between.

    samples : multisampling; None: 4 on a graphics card, none on a software driver, where it would triple the time

    Raises `UserFacingError` where there is no OpenGL 3.3.
    """

    def __init__(self, width: int, height: int, samples: int | None = None) -> None:
        if width < 1 or height < 1:
            raise ValueError(f"a picture of {width} by {height} pixels has no pixels")
        self.width, self.height = width, height
        self.ctx = _standalone_context()
        self._driver = str(self.ctx.info["GL_RENDERER"])
        if samples is None:
            samples = 0 if self.is_software else 4
        try:
            samples = min(samples, self.ctx.max_samples)
            size = (width, height)
            self._colour = self.ctx.renderbuffer(size, 4)
            self._picture = self.ctx.framebuffer([self._colour], self.ctx.depth_renderbuffer(size))
            self._drawn = self._picture
            if samples:
                self._drawn = self.ctx.framebuffer(
                    [self.ctx.renderbuffer(size, 4, samples=samples)],
                    self.ctx.depth_renderbuffer(size, samples=samples),
                )
        except moderngl.Error as error:
            self.ctx.release()
            message = f"The OpenGL driver {self.driver} has no room for a picture of {width} by {height} pixels."
            raise UserFacingError(message, "Ask for a smaller picture.") from error

    @property
    def driver(self) -> str:
        """The renderer's name as the driver tells it."""
        return self._driver

    @property
    def is_software(self) -> bool:
        """Whether the processor draws, not a graphics card."""
        return any(name in self._driver.lower() for name in _SOFTWARE)

    def frame(self, draw: Callable[[moderngl.Framebuffer], None]) -> np.ndarray:
        """Let ``draw`` fill the framebuffer; return the picture, uint8, shape (height, width, 3), top row first."""
        self.make_current()
        draw(self._drawn)
        if self._drawn is not self._picture:
            self.ctx.copy_framebuffer(self._picture, self._drawn)
        rows = np.frombuffer(self._picture.read(components=3, alignment=1), np.uint8)
        return np.ascontiguousarray(rows.reshape(self.height, self.width, 3)[::-1])

    def make_current(self) -> None:
        """Make this context the one that GL calls of the thread go to, as it is after ``__init__`` and ``frame``."""
        # leaving it again would leave the thread without any, so it is only entered
        self.ctx.__enter__()

    def release(self) -> None:
        """Free the framebuffer and the context."""
        self.ctx.release()
        _leave_thread()

    def __enter__(self) -> OffscreenRenderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def _leave_thread() -> None:
    """Leave the thread without an EGL context: while it has one, released or not, Qt's GLX cannot enter its own."""
    if sys.platform.startswith("linux"):
        with contextlib.suppress(OSError):
            ctypes.CDLL("libEGL.so.1").eglReleaseThread()


def _standalone_context() -> moderngl.Context:
    if sys.platform.startswith("linux"):
        if not os.environ.get("DISPLAY") and not os.environ.get("WAYLAND_DISPLAY"):
            # without it EGL looks for a screen and fails
            os.environ.setdefault("EGL_PLATFORM", "surfaceless")
        settings = {"backend": "egl", **library_names("libgl", "libegl")}
    else:
        settings = {}
    try:
        return moderngl.create_context(require=330, standalone=True, **settings)
    except Exception as error:  # glcontext raises plain Exception; a missing library raises OSError or ImportError
        raise UserFacingError(
            "No OpenGL 3.3 driver was found, so no picture can be drawn.",
            "Install one (Debian: apt install libegl1 libgl1-mesa-dri), or export .csv or .c3d markers instead.",
        ) from error
