"""The search's min-plus step in GLSL compute: a graphics card through EGL, or Mesa's llvmpipe and zink on lavapipe."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Iterator

import numpy as np

from core.errors import UserFacingError
from core.search.compute import DeviceFailed, DeviceReport
from gpu.sources import shader_error, shader_source

_ROW_THREADS = 64
_COLUMN_THREADS = 64
_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "lavapipe")
_MOST_PIECE_BYTES = 1 << 30  # element numbers within a piece are 32-bit


class GlslKernels:
    """`core.search.compute.SearchKernels` in OpenGL 4.3 compute.

    Reference: `NumpyKernels`; text: arrive.comp and leave.comp.

    The context is made current for each call, so calls may come from any thread, one at a time.
    """

    def __init__(self) -> None:
        import moderngl

        self._lock = threading.Lock()
        self._pieces: list[tuple[int, int, object]] = []
        self._maps: dict[str, object] = {}
        self._n_nodes = 0
        self._ctx = _context(moderngl)
        info = self._ctx.info
        if "GL_ARB_gpu_shader_fp64" not in self._ctx.extensions and self._ctx.version_code < 400:
            raise UserFacingError("The OpenGL driver has no double precision.")
        self._most_bytes = min(info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"], _MOST_PIECE_BYTES)
        self._arrive = self._compile(moderngl, "glsl/arrive.comp", _ROW_THREADS)
        self._leave = self._compile(moderngl, "glsl/leave.comp", _COLUMN_THREADS)
        renderer = info["GL_RENDERER"].strip()
        is_software = any(name in renderer.lower() for name in _SOFTWARE)
        version, _, driver = info["GL_VERSION"].partition(" ")
        self.report = DeviceReport("glsl", renderer, f"OpenGL {version}", is_software, driver.split(") ")[-1])

    def _compile(self, moderngl, name: str, threads: int):
        try:
            return self._ctx.compute_shader(shader_source(name, {"THREADS": threads}))
        except moderngl.Error as error:
            raise shader_error(name, str(error)) from error

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`; raises `DeviceFailed` when the device has not enough memory."""
        self.release()
        n_nodes = self._n_nodes = len(transition)
        rows = max(1, self._most_bytes // (4 * n_nodes))
        trouble = f"has no room for the transition matrix of {4 * n_nodes**2 >> 20} MiB"
        with self._lock, self._ctx, self._failing(trouble):
            for first in range(0, n_nodes, rows):
                piece = np.ascontiguousarray(transition[first : first + rows])
                self._pieces.append((first, len(piece), self._ctx.buffer(piece)))
            for name in ("PrevCostBufferMap", "CostValueMap", "LeavingValueMap"):
                self._maps[name] = self._ctx.buffer(reserve=n_nodes * 8)

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        with self._lock, self._ctx, self._failing("failed"):
            return self._arrived(front)

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `SearchKernels.min_plus_both`; two passes, as doubles have no atomic minimum."""
        with self._lock, self._ctx, self._failing("failed"):
            return self._arrived(front), self._left(behind)

    def _arrived(self, front: np.ndarray) -> np.ndarray:
        self._bind(front, "CostValueMap")
        self._arrive["n_nodes"] = self._n_nodes
        for first, n_rows, piece in self._pieces:
            piece.bind_to_storage_buffer(0)
            self._arrive["first_row"] = first
            self._arrive.run(n_rows)
        return self._read("CostValueMap")

    def _left(self, behind: np.ndarray) -> np.ndarray:
        self._bind(behind, "LeavingValueMap")
        self._leave["n_nodes"] = self._n_nodes
        for first, n_rows, piece in self._pieces:
            piece.bind_to_storage_buffer(0)
            self._leave["first_row"], self._leave["n_rows"] = first, n_rows
            self._leave.run(-(-self._n_nodes // _COLUMN_THREADS))
            self._ctx.memory_barrier()
        return self._read("LeavingValueMap")

    def _bind(self, costs: np.ndarray, result: str) -> None:
        self._maps["PrevCostBufferMap"].write(np.ascontiguousarray(costs, float))
        self._maps["PrevCostBufferMap"].bind_to_storage_buffer(1)
        self._maps[result].bind_to_storage_buffer(2)

    def _read(self, name: str) -> np.ndarray:
        self._ctx.memory_barrier()
        return np.frombuffer(self._maps[name].read(), float).copy()

    @contextlib.contextmanager
    def _failing(self, trouble: str) -> Iterator[None]:
        import moderngl

        try:
            yield
        except moderngl.Error as error:
            raise DeviceFailed(f"The OpenGL device {self.report.device} {trouble} ({error}).") from error
        # OpenGL does not stop at an error, as when its context is lost; it has to be asked
        error = self._ctx.error
        if error != "GL_NO_ERROR":
            raise DeviceFailed(f"The OpenGL device {self.report.device} {trouble} ({error}).")

    def release(self) -> None:
        """See `SearchKernels.release`."""
        with self._lock, self._ctx:
            for _, _, piece in self._pieces:
                piece.release()
            for buffer in self._maps.values():
                buffer.release()
        self._pieces, self._maps = [], {}


def _context(moderngl):
    settings = {}
    if sys.platform.startswith("linux"):
        settings["backend"] = "egl"
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            os.environ.setdefault("EGL_PLATFORM", "surfaceless")
    try:
        return moderngl.create_context(require=430, standalone=True, **settings)
    except Exception as error:  # glcontext raises plain Exception; a missing library raises OSError or ImportError
        raise UserFacingError("There is no OpenGL 4.3 driver with compute shaders on this machine.") from error
