"""How open to light each vertex is at rest: soft shadows in eye sockets, nostrils and under the chin."""

from __future__ import annotations

import moderngl
import numpy as np

from gpu.gl.program import compile_program

_SIZE = 256


def openness(
    ctx: moderngl.Context, positions: np.ndarray, normals: np.ndarray, triangles: np.ndarray, n_directions: int = 48
) -> np.ndarray:
    """Return the cosine-weighted fraction of directions from which a vertex is seen, float32 0..1, shape (V,).

    Depth pictures from directions spread over the sphere are compared with the vertices' own depths; this runs once
    a face. positions : mm, shape (V, 3); normals : any length, shape (V, 3); triangles : int, shape (T, 3), those
    that throw shadows. 48 directions serve the eye: the fraction is then right to about 0.1.
    """
    positions = np.asarray(positions, np.float32)
    unit = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    centre = (positions.min(axis=0) + positions.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(positions - centre, axis=1).max()), 1e-6)
    places = ((positions - centre) / radius).astype(np.float32)

    program = compile_program(ctx, "glsl/depth.vert", "glsl/depth.frag")
    vertices = ctx.buffer(places.tobytes())
    indices = ctx.buffer(np.ascontiguousarray(triangles, np.int32).tobytes())
    mesh = ctx.vertex_array(program, [(vertices, "3f", "in_position")], indices)
    depths = ctx.depth_texture((_SIZE, _SIZE))
    target = ctx.framebuffer(depth_attachment=depths)
    bound_before = ctx.detect_framebuffer()
    seen, whole = np.zeros(len(places)), np.zeros(len(places))
    try:
        target.use()
        ctx.enable_only(moderngl.DEPTH_TEST)
        for back in _sphere(n_directions):
            right = np.cross([0.3, 1.0, 0.1], back)
            right /= np.linalg.norm(right)
            turn = np.array([right, np.cross(back, right), back])
            program["turn"].write(np.ascontiguousarray(turn.T, np.float32).tobytes())
            target.clear(depth=1.0)
            mesh.render()
            depth = np.frombuffer(depths.read(), np.float32).reshape(_SIZE, _SIZE)
            at = places @ turn.T
            column, row = np.clip(((at[:, :2] + 1) / 2 * _SIZE).astype(int), 0, _SIZE - 1).T
            weight = np.maximum(unit @ back, 0.0)
            seen += weight * ((1 - at[:, 2]) / 2 <= depth[row, column] + 0.012)
            whole += weight
    finally:
        # a framebuffer that is released while bound would spoil the making of the next one
        bound_before.use()
        for thing in (target, depths, mesh, indices, vertices, program):
            thing.release()
    return (seen / np.maximum(whole, 1e-9)).astype(np.float32)


def _sphere(n: int) -> np.ndarray:
    """Return n unit directions spread evenly (Fibonacci's spiral), shape (n, 3)."""
    at = np.arange(n) + 0.5
    z, turn = 1 - 2 * at / n, np.pi * (1 + 5**0.5) * at
    flat = np.sqrt(1 - z**2)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
