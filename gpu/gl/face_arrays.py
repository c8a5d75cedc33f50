"""All that a renderer uploads of a face, worked out without a graphics driver, so that a worker can."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from core.face.face import Face
from gpu.gl import complexion
from gpu.gl.complexion import LOWER_TEETH, SKIN, SOCKET, TONGUE, UPPER_TEETH
from gpu.gl.normals import VertexNormals
from gpu.gl.occlusion import openness
from gpu.gl.surfaces import kind_of_triangles


@dataclass(frozen=True, eq=False)
class FaceArrays:
    """A face at rest, as buffers hold it; V vertices, T triangles.

    rest : float32, shape (V, 3), mm; material : int, shape (V,)
    triangles : int32, shape (T, 3), facing out, sorted by surface; kind : its number in `gpu.gl.surfaces.KINDS`
    normals : of moved vertices; lips, blush, hair_lift : float32, shape (V,); hair : float32, shape (V, 3)
    places : float32, shape (V, 3), see `complexion.rest_places`; diagonals : uint8, shape (T,)
    """

    rest: np.ndarray
    material: np.ndarray
    triangles: np.ndarray
    kind: np.ndarray
    normals: VertexNormals
    lips: np.ndarray
    blush: np.ndarray
    hair: np.ndarray
    hair_lift: np.ndarray
    places: np.ndarray
    diagonals: np.ndarray

    @classmethod
    def of(cls, face: Face) -> FaceArrays:
        """Work them out; some 30 ms for the default face."""
        rest = np.ascontiguousarray(face.positions, np.float32)
        triangles = _facing_out(np.asarray(face.triangles, np.int32), rest)
        kind = kind_of_triangles(face, triangles)
        order = np.argsort(kind, kind="stable")
        triangles = np.ascontiguousarray(triangles[order])
        growth = [complexion.hair_depth(face), complexion.beard_weights(face), complexion.edge_fade(face)]
        return cls(
            rest, complexion.materials(face), triangles, kind[order], VertexNormals(triangles, rest),
            complexion.lip_weights(face), complexion.blush_weights(face), np.column_stack(growth).astype(np.float32),
            complexion.hair_lift(face), complexion.rest_places(face), complexion.quad_diagonals(triangles, rest),
        )  # fmt: skip

    def light(self, ctx: moderngl.Context) -> np.ndarray:
        """Return how much light reaches each vertex at rest, float32 0..1, shape (V,); takes a tenth of a second.

        Of skin what its neighbours leave, inside the mouth less with depth.
        """
        throws = (self.material == SKIN) | (self.material == SOCKET)
        shadowing = self.triangles[throws[self.triangles].all(axis=1)]
        light = openness(ctx, self.rest, self.normals(self.rest), shadowing)
        inside = np.isin(self.material, (UPPER_TEETH, LOWER_TEETH, TONGUE))
        if inside.any():
            # the mouth is shut at rest, so depth behind the front teeth stands for the shadow of an open one
            front_mm = self.rest[inside, 2].max()
            light[inside] = np.clip(1.0 - (front_mm - self.rest[inside, 2]) / 36.0, 0.04, 1.0) ** 1.5
        socket = self.material == SOCKET
        light[socket] = np.clip(light[socket], 0.10, 0.5)
        return light


def _facing_out(triangles: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the triangles, all turned round if the mesh as a whole is inside out (a negative volume)."""
    a, b, c = (positions[triangles[:, i]].astype(float) - positions.mean(axis=0) for i in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c))
    return np.ascontiguousarray(triangles[:, ::-1] if volume < 0 else triangles)
