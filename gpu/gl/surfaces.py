"""The surfaces of a face, each with a shader of its own: one for all would run every branch for every pixel."""

from __future__ import annotations

import moderngl
import numpy as np

from core.face.face import Face
from gpu.gl import complexion
from gpu.gl.complexion import EYE, LASHES, LOWER_TEETH, SKIN, SOCKET, TONGUE, UPPER_TEETH
from gpu.gl.program import compile_program

# In the order of drawing; lashes let light through, so they come after all that lies behind them.
_SKINS = {"skin": (), "brows": ("BROW",), "hair": ("HAIR",), "shoulders": ("FADE",)}
_PARTS = {"eyes": EYE, "upper teeth": UPPER_TEETH, "lower teeth": LOWER_TEETH, "tongue": TONGUE, "socket": SOCKET}
KINDS = (*_SKINS, *_PARTS, "lashes")

# Strands of the hairline reach down to here.
_HAIR_FROM_MM = -9.0


def kind_of_triangles(face: Face, triangles: np.ndarray) -> np.ndarray:
    """Return for each triangle the number of its surface in `KINDS`, int, shape (n_triangles,)."""
    # the last corner decides, as GL's own rule for flat values has it
    material = complexion.materials(face)[triangles[:, 2]]
    kind = np.zeros(len(triangles), int)
    for name, number in (*_PARTS.items(), ("lashes", LASHES)):
        kind[material == number] = KINDS.index(name)
    skin = material == SKIN
    corners = face.positions[triangles]
    kind[skin & (complexion.edge_fade(face)[triangles] > 0).any(axis=1)] = KINDS.index("shoulders")
    arcs, width_mm = complexion.brow_arcs(face)
    if width_mm > 0:
        low, high = arcs[:, 1].min() - 1.5 * width_mm, arcs[:, 1].max() + 1.5 * width_mm
        side = np.abs(arcs[:, 0]).max() + width_mm
        near = (corners[:, :, 1].max(axis=1) > low) & (corners[:, :, 1].min(axis=1) < high)
        near &= (np.abs(corners[:, :, 0]).min(axis=1) < side) & (corners[:, :, 2].max(axis=1) > arcs[:, 2].min() - 25)
        kind[skin & near] = KINDS.index("brows")
    kind[skin & (complexion.hair_depth(face)[triangles] > _HAIR_FROM_MM).any(axis=1)] = KINDS.index("hair")
    return kind


class FaceSurfaces:
    """Draws the surfaces of one face; made, used and released on the thread that owns the context.

    inputs, indices : as `moderngl.Context.vertex_array` takes them; triangles sorted by kind
    kind : int, shape (n_triangles,), ascending
    """

    def __init__(
        self, ctx: moderngl.Context, face: Face, inputs: list, indices: moderngl.Buffer, kind: np.ndarray
    ) -> None:
        self._ctx, self._face, self._inputs, self._indices = ctx, face, inputs, indices
        starts = np.searchsorted(kind, np.arange(len(KINDS) + 1))
        self._ranges = {name: (int(starts[k]), int(starts[k + 1])) for k, name in enumerate(KINDS)}
        self._arrays: dict[tuple[str, int], tuple[moderngl.Program, moderngl.VertexArray]] = {}

    def draw(
        self,
        texture: int,
        view: np.ndarray,
        projection: np.ndarray,
        size_px: tuple[int, int],
        new_at_most: int | None = None,
    ) -> bool:
        """Draw all surfaces; ``texture`` as TEXTURE in ``face.frag``, matrices float32 and column-major.

        new_at_most : make no more shaders than so many, and draw their surfaces alone, as a driver compiles a shader
            only once it draws; tells whether the picture is whole
        """
        shown = {name: texture if name in _SKINS else 0 for name, (start, stop) in self._ranges.items() if start < stop}
        missing = [name for name, number in shown.items() if (name, number) not in self._arrays]
        is_whole = new_at_most is None or not missing
        for name in shown if is_whole else missing[:new_at_most]:
            self._draw_one(name, shown[name], view, projection, size_px)
        return is_whole

    def _draw_one(
        self, name: str, texture: int, view: np.ndarray, projection: np.ndarray, size_px: tuple[int, int]
    ) -> None:
        start, stop = self._ranges[name]
        program, array = self._array(name, texture)
        _set(program, "view", view)
        _set(program, "projection", projection)
        _set(program, "viewport_px", size_px)
        if name == "lashes":
            self._ctx.enable(moderngl.BLEND)
            self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE
        array.render(vertices=3 * (stop - start), first=3 * start)

    def release(self) -> None:
        """Free the programs."""
        for program, array in self._arrays.values():
            array.release()
            program.release()
        self._arrays = {}

    def _array(self, name: str, texture: int) -> tuple[moderngl.Program, moderngl.VertexArray]:
        if (name, texture) not in self._arrays:
            part = SKIN if name in _SKINS else LASHES if name == "lashes" else _PARTS[name]
            switches = {switch: int(switch in _SKINS.get(name, ())) for switch in ("BROW", "HAIR", "FADE")}
            defines = {"PART": part, "TEXTURE": texture, **switches}
            program = compile_program(self._ctx, "glsl/face.vert", "glsl/face.frag", defines=defines)
            self._paint(program)
            array = self._ctx.vertex_array(program, self._inputs, self._indices, skip_errors=True)
            self._arrays[name, texture] = program, array
        return self._arrays[name, texture]

    def _paint(self, program: moderngl.Program) -> None:
        """Give a shader what the face's look and landmarks say."""
        face, look = self._face, self._face.look
        arcs, width_mm = complexion.brow_arcs(face)
        arch, edges = complexion.tooth_arch(face)
        _set(program, "grain", 0)
        _set(program, "picture", 1)
        _set(program, "brows", arcs)
        _set(program, "brow_width_mm", width_mm)
        _set(program, "brow_weight", look.brow_weight)
        for name, colour in (
            ("skin", look.skin), ("hair", look.hair), ("iris", look.iris), ("lip", look.lips), ("brow", look.brows)
        ):  # fmt: skip
            _set(program, f"{name}_colour", colour)
        _set(program, "marks", (look.lip_tint, look.blush, look.freckles, look.stubble))
        _set(program, "age_and_lash", (look.age, look.lash_weight))
        _set(program, "arch", arch)
        _set(program, "edges", edges)


def _set(program: moderngl.Program, name: str, value: object) -> None:
    # a compiler drops the uniforms that a variant does not use
    uniform = program.get(name, None)
    if uniform is None:
        return
    if isinstance(value, np.ndarray):
        uniform.write(np.ascontiguousarray(value, np.float32).tobytes())
    else:
        uniform.value = value
