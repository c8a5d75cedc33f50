"""The splat image of a phoneme Isomap, drawn by the graphics driver."""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np

from core.manifold.splat import CUT_SIGMAS, splat_inputs
from gpu.gl.program import compile_program

# A software driver takes some 15 ms for so many, and holds Python's lock meanwhile.
_PIXELS_AT_ONCE = 1_000_000


class SplatRenderer:
    """Answers as `core.manifold.splat.splat_image` does; made, used and released on the context's own thread.

    The sum is held in 32-bit floats: in 16 bits the tails of thousands of faint splats would be rounded away.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = compile_program(ctx, "glsl/splat.vert", "glsl/splat.frag")
        self._program["cut_sigmas"].value = CUT_SIGMAS
        self._target: moderngl.Framebuffer | None = None
        self._sum: moderngl.Texture | None = None

    def image(
        self,
        points: np.ndarray,
        colours: np.ndarray,
        sigma_px: float,
        rho: float,
        bounds: tuple[float, float, float, float],
        size: tuple[int, int],
        between: Callable[[float], None] | None = None,
    ) -> np.ndarray:
        """Return the picture, float32, shape (height, width, 3), 0..1, top row first; arguments as the reference's.

        between : called with the share that is drawn, 0..1, after each piece of work of some 15 ms; what it raises ends
            the drawing. Without it all is drawn at once
        """
        at_px, colours = splat_inputs(points, colours, sigma_px, rho, bounds, size)
        width, height = size
        bound_before = self._ctx.detect_framebuffer()
        target = self._sized_target(size)
        target.use()
        self._ctx.viewport = (0, 0, width, height)
        target.clear()
        if len(at_px):
            splats = np.hstack([at_px, colours]).astype(np.float32)
            covered_px = min((2 * CUT_SIGMAS * sigma_px) ** 2, width * height)
            at_once = len(splats) if between is None else max(1, round(_PIXELS_AT_ONCE / covered_px))
            for first in range(0, len(splats), at_once):
                self._add(splats[first : first + at_once], sigma_px, rho, size)
                if between is not None:
                    self._ctx.finish()
                    between(min(1.0, (first + at_once) / len(splats)))
        pixels = np.frombuffer(target.read(components=3, dtype="f4"), np.float32)
        bound_before.use()
        return np.minimum(pixels.reshape(height, width, 3), np.float32(1.0))

    def release(self) -> None:
        """Free all GL objects."""
        self._free_target()
        self._program.release()

    def _add(self, splats: np.ndarray, sigma_px: float, rho: float, size: tuple[int, int]) -> None:
        ctx = self._ctx
        held = ctx.buffer(splats.tobytes())
        array = ctx.vertex_array(self._program, [(held, "2f 3f/i", "in_at", "in_colour")])
        ctx.enable_only(moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._program["size_px"].value = size
        self._program["sigma_px"].value = sigma_px
        self._program["rho"].value = rho
        array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(splats))
        ctx.enable_only(moderngl.NOTHING)
        array.release()
        held.release()

    def _sized_target(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._target is None or self._target.size != size:
            self._free_target()
            self._sum = self._ctx.texture(size, 4, dtype="f4")
            self._target = self._ctx.framebuffer([self._sum])
        return self._target

    def _free_target(self) -> None:
        if self._target is not None and self._sum is not None:
            self._target.release()
            self._sum.release()
        self._target = self._sum = None
