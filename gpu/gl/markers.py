"""Markers drawn as lit balls, with optional faint links between them."""

from __future__ import annotations

import moderngl
import numpy as np

from gpu.gl.program import compile_program

DEFAULT_COLOUR = (0.93, 0.90, 0.84)
# where a missing marker goes: behind every far plane
_NOWHERE_MM = 1e9


class MarkerCloud:
    """K markers in a GL context. Made, used and released on the thread that owns the context.

    radius_mm : of each ball
    """

    def __init__(self, ctx: moderngl.Context, radius_mm: float = 1.9) -> None:
        self._ctx = ctx
        self.radius_mm = radius_mm
        self._balls = compile_program(ctx, "glsl/markers.vert", "glsl/markers.frag")
        self._lines = compile_program(ctx, "glsl/links.vert", "glsl/links.frag")
        self._n_markers = 0
        self._links = np.empty((0, 2), np.int32)
        self._held: list = []

    def set_markers(
        self, positions: np.ndarray, colours: np.ndarray | None = None, links: np.ndarray | None = None
    ) -> None:
        """Replace all markers.

        positions : shape (K, 3), mm, world space; a NaN marker is missing and not drawn
        colours : shape (K, 3) or (3,), 0..1 as on screen; None: as they were, a warm white for new ones
        links : int, shape (L, 2), rows of ``positions`` to join by a faint line
        """
        positions = np.asarray(positions, np.float32)
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise ValueError(f"positions have shape {positions.shape}; markers need (K, 3)")
        if len(positions) != self._n_markers or links is not None:
            self._allocate(len(positions), np.empty((0, 2), np.int32) if links is None else np.asarray(links, np.int32))
            colours = DEFAULT_COLOUR if colours is None else colours
        if colours is not None and self._n_markers:
            painted = np.broadcast_to(np.asarray(colours, np.float32), positions.shape)
            self._colours.write(np.ascontiguousarray(painted).tobytes())
        self.set_positions(positions)

    def set_positions(self, positions: np.ndarray) -> None:
        """Move the markers that are there; ``positions`` as in `set_markers`, with the same K."""
        positions = np.asarray(positions, np.float32)
        if positions.shape != (self._n_markers, 3):
            raise ValueError(f"positions have shape {positions.shape}; the cloud has {self._n_markers} markers")
        if not self._n_markers:
            return
        there = np.isfinite(positions).all(axis=1)
        placed = np.where(there[:, None], positions, np.float32(_NOWHERE_MM))
        self._positions.write(np.ascontiguousarray(placed, np.float32).tobytes())
        if len(self._links):
            kept = self._links[there[self._links].all(axis=1)]
            self._n_link_ends = kept.size
            if kept.size:
                self._link_ends.write(np.ascontiguousarray(kept).tobytes())

    def draw(self, view: np.ndarray, projection: np.ndarray, size_px: tuple[int, int]) -> None:
        """Draw into the bound framebuffer of ``size_px`` (width, height); matrices as `gpu.gl.camera.Camera` gives."""
        if not self._n_markers:
            return
        ctx = self._ctx
        ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE
        for program in (self._balls, self._lines):
            program["view"].write(np.ascontiguousarray(view.T, np.float32).tobytes())
            program["projection"].write(np.ascontiguousarray(projection.T, np.float32).tobytes())
        if len(self._links) and self._n_link_ends:
            self._line_array.render(moderngl.LINES, vertices=self._n_link_ends)
        self._balls["radius_mm"].value = self.radius_mm
        self._balls["viewport_px"].value = size_px
        self._ball_array.render(moderngl.POINTS)
        ctx.enable_only(moderngl.NOTHING)

    def release(self) -> None:
        """Free all GL objects."""
        self._free()
        self._balls.release()
        self._lines.release()

    def _allocate(self, n_markers: int, links: np.ndarray) -> None:
        self._free()
        self._n_markers, self._links, self._n_link_ends = n_markers, links.reshape(-1, 2), 0
        if not n_markers:
            return
        self._positions = self._ctx.buffer(reserve=12 * n_markers, dynamic=True)
        self._colours = self._ctx.buffer(reserve=12 * n_markers)
        self._ball_array = self._ctx.vertex_array(
            self._balls, [(self._positions, "3f", "in_position"), (self._colours, "3f", "in_colour")]
        )
        self._held = [self._ball_array, self._positions, self._colours]
        if self._links.size:
            self._link_ends = self._ctx.buffer(reserve=4 * self._links.size, dynamic=True)
            self._line_array = self._ctx.vertex_array(
                self._lines, [(self._positions, "3f", "in_position")], self._link_ends
            )
            self._held = [self._line_array, self._link_ends, *self._held]

    def _free(self) -> None:
        for thing in self._held:
            thing.release()
        self._held = []
        self._n_markers = 0
