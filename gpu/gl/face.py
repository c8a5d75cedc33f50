"""Draws a face: textured or plainly shaded under studio lights, as a wireframe, or its markers alone."""

from __future__ import annotations

from enum import Enum

import moderngl
import numpy as np

from core.face.face import Face
from gpu.gl import complexion
from gpu.gl.camera import Camera
from gpu.gl.face_arrays import FaceArrays
from gpu.gl.markers import MarkerCloud
from gpu.gl.program import compile_program
from gpu.gl.surfaces import FaceSurfaces

# width of the texture that holds one byte a triangle
_EDGE_ROW = 2048


GHOST_RADIUS_MM = 1.1


class Style(Enum):
    """How a face is shown (figures 11 and 14 of the eFASE paper)."""

    MARKERS = "markers"
    WIREFRAME = "wireframe"
    SHADED = "shaded"
    TEXTURED = "textured"


class FaceRenderer:
    """A face and its markers in a GL context (3.3 core), on screen or off.

    Made, used and released on the thread that owns the context; in a QOpenGLWidget make it in ``initializeGL`` and
    draw in ``paintGL`` into ``ctx.detect_framebuffer(widget.defaultFramebufferObject())``.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._wire = compile_program(ctx, "glsl/face.vert", "glsl/wire.frag", "glsl/wire.geom")
        self._backdrop = compile_program(ctx, "glsl/background.vert", "glsl/background.frag")
        self._backdrop_array = ctx.vertex_array(self._backdrop, [])
        self.markers = MarkerCloud(ctx)
        self.ghosts = MarkerCloud(ctx, GHOST_RADIUS_MM)
        # made with the first face, as working it out takes a while
        self._grain: moderngl.Texture3D | None = None
        self._picture: moderngl.Texture | None = None
        self._own_picture: moderngl.Texture | None = None
        self._face: Face | None = None
        # how much light reaches each vertex of the face at rest, 0..1
        self.light: np.ndarray | None = None
        self._mesh: list = []

    def set_face(
        self,
        face: Face,
        lips: np.ndarray | None = None,
        light: np.ndarray | None = None,
        arrays: FaceArrays | None = None,
    ) -> None:
        """Show another face, at rest.

        lips : how red each vertex is, 0..1, shape (n_vertices,); None: guessed from the landmarks
        light : `light` of another renderer that shows the same face, which spares the tenth of a second it takes
        arrays : `FaceArrays.of` of the face, where somebody has worked them out
        """
        self._free_mesh()
        known = FaceArrays.of(face) if arrays is None else arrays
        rest, triangles = known.rest, known.triangles
        self._normals = known.normals
        normals = self._normals(rest)
        self.light = known.light(self._ctx) if light is None else light
        surface = np.empty((len(rest), 4), np.float32)
        surface[:, 0] = known.material
        surface[:, 1] = known.lips if lips is None else lips
        surface[:, 2] = self.light
        surface[:, 3] = known.blush
        uv = np.zeros((len(rest), 2), np.float32) if face.uv is None else np.ascontiguousarray(face.uv, np.float32)
        self._hair_lift = known.hair_lift
        self._haired = np.flatnonzero(self._hair_lift > 0)

        ctx = self._ctx
        if self._grain is None:
            grain = complexion.grain()
            self._grain = ctx.texture3d(grain.shape[:3], 4, grain.tobytes())
            self._grain.filter = moderngl.LINEAR, moderngl.LINEAR
        self._positions = ctx.buffer(rest.tobytes(), dynamic=True)
        self._normal_buffer = ctx.buffer(normals.tobytes(), dynamic=True)
        places, surfaces = ctx.buffer(known.places.tobytes()), ctx.buffer(surface.tobytes())
        hairs, uvs = ctx.buffer(known.hair.tobytes()), ctx.buffer(uv.tobytes())
        indices = ctx.buffer(triangles.tobytes())
        inputs = [
            (self._positions, "3f", "in_position"),
            (self._normal_buffer, "3f", "in_normal"),
            (places, "3f", "in_rest"),
            (surfaces, "4f", "in_surface"),
            (hairs, "3f", "in_hair"),
            (uvs, "2f", "in_uv"),
        ]
        self._surfaces = FaceSurfaces(ctx, face, inputs, indices, known.kind)
        self._wire_array = ctx.vertex_array(self._wire, inputs, indices, skip_errors=True)
        hidden = np.zeros((-(-max(len(triangles), 1) // _EDGE_ROW), _EDGE_ROW), np.uint8)
        hidden.ravel()[: len(triangles)] = known.diagonals
        self._hidden_edges = ctx.texture((_EDGE_ROW, len(hidden)), 1, hidden.tobytes(), dtype="u1", alignment=1)
        self._mesh = [self._surfaces, self._wire_array, self._positions, self._normal_buffer]
        self._mesh += [places, surfaces, hairs, uvs, indices, self._hidden_edges]

        self._face = face
        self._own_picture = None if face.texture is None else self._uploaded(face.texture)
        self.set_positions(rest)

    @property
    def face(self) -> Face | None:
        """The face that is shown, or None."""
        return self._face

    def set_positions(self, positions: np.ndarray) -> None:
        """Move the face's vertices; ``positions`` is float32, shape (n_vertices, 3), mm, world space."""
        if self._face is None:
            raise ValueError("set_face comes before set_positions")
        if positions.shape != self._face.positions.shape:
            raise ValueError(f"positions have shape {positions.shape}; the face has {self._face.positions.shape}")
        positions = np.ascontiguousarray(positions, np.float32)
        normals = self._normals(positions)
        if len(self._haired):
            away = normals[self._haired]
            length = np.maximum(np.sqrt(np.einsum("ij,ij->i", away, away)), 1e-9)
            positions = positions.copy()
            positions[self._haired] += away * (self._hair_lift[self._haired] / length)[:, None]
            normals = self._normals(positions)
        self._positions.write(positions)
        self._normal_buffer.write(np.ascontiguousarray(normals))

    def set_texture(self, picture: np.ndarray | None) -> None:
        """Paint the face of the style `Style.TEXTURED` with a picture by its texture coordinates.

        picture : uint8, shape (height, width, 3), sRGB, top row first; None: the face's own texture, else the
        procedural skin. It stays for other faces until it is replaced; a face without texture coordinates keeps its
        procedural skin
        """
        if self._picture is not None:
            self._picture.release()
            self._picture = None
        if picture is not None:
            self._picture = self._uploaded(picture)

    def set_markers(
        self, positions: np.ndarray, colours: np.ndarray | None = None, links: np.ndarray | None = None
    ) -> None:
        """Replace the markers; see `gpu.gl.markers.MarkerCloud.set_markers`."""
        self.markers.set_markers(positions, colours, links)

    def draw(
        self,
        framebuffer: moderngl.Framebuffer,
        camera: Camera,
        style: Style = Style.SHADED,
        *,
        show_markers: bool = False,
        background: tuple[float, float, float] | None = None,
        new_at_most: int | None = None,
    ) -> bool:
        """Clear the framebuffer and draw one picture that fills it; alpha is 1 everywhere. Tells whether it is whole.

        new_at_most : make no more shaders than so many; each takes a software driver some 20 ms, and a face has ten.
            While some are missing the picture has no face, and the next call goes on

        background : red, green, blue, 0..1, one colour instead of the studio's; None: the studio
        Without a face, wireframe and shaded show the markers as well. With the markers come the ghosts: `ghosts`, what
        they are compared with.
        """
        ctx = self._ctx
        width, height = framebuffer.size
        view, projection = camera.view(width / height), camera.projection(width / height)
        framebuffer.use()
        ctx.viewport = (0, 0, width, height)
        ctx.enable_only(moderngl.NOTHING)
        self._clear(framebuffer, background)
        has_mesh = self._face is not None and style is not Style.MARKERS
        if has_mesh and not self._draw_mesh(camera, (width, height), style, new_at_most):
            ctx.enable_only(moderngl.NOTHING)
            self._clear(framebuffer, background)
            return False
        if show_markers or not has_mesh:
            self.markers.draw(view, projection, (width, height))
            self.ghosts.draw(view, projection, (width, height))
        ctx.enable_only(moderngl.NOTHING)
        return True

    def draw_lines_over(
        self, framebuffer: moderngl.Framebuffer, camera: Camera, colour: tuple[float, float, float]
    ) -> None:
        """Draw the edges of the face alone over the picture that is there, which does not hide them; the face does.

        colour : red, green, blue, 0..1
        """
        if self._face is None:
            return
        ctx = self._ctx
        width, height = framebuffer.size
        framebuffer.color_mask = (False,) * 4
        framebuffer.use()
        ctx.viewport = (0, 0, width, height)
        framebuffer.clear(depth=1.0)
        ctx.enable_only(moderngl.DEPTH_TEST)
        self._prepare_wire(camera, (width, height), (*colour, 1.0))
        self._wire_array.render()  # first what hides
        framebuffer.color_mask = (True,) * 4
        framebuffer.use()  # which puts the mask on
        ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        ctx.depth_func = "<="
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE
        self._wire_array.render()
        ctx.depth_func = "<"
        ctx.enable_only(moderngl.NOTHING)

    def release(self) -> None:
        """Free all GL objects; the renderer is of no use afterwards."""
        self._free_mesh()
        self.markers.release()
        self.ghosts.release()
        self.set_texture(None)
        if self._grain is not None:
            self._grain.release()
        for thing in (self._backdrop_array, self._backdrop, self._wire):
            thing.release()

    def _clear(self, framebuffer: moderngl.Framebuffer, background: tuple[float, float, float] | None) -> None:
        framebuffer.clear(*(background or (0.07, 0.075, 0.085)), 1.0, depth=1.0)
        if background is None:
            self._backdrop_array.render(moderngl.TRIANGLES, vertices=3)

    def _draw_mesh(self, camera: Camera, size: tuple[int, int], style: Style, new_at_most: int | None) -> bool:
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        if style is Style.WIREFRAME:
            self._prepare_wire(camera, size, (0.0, 0.0, 0.0, 0.0))
            self._wire_array.render()
            return True
        self._grain.use(0)
        picture = self._picture or self._own_picture
        if picture is not None:
            picture.use(1)
        view, projection = _matrices(camera, size)
        return self._surfaces.draw(self._texture_mode(style), view, projection, size, new_at_most)

    def _prepare_wire(self, camera: Camera, size: tuple[int, int], alone: tuple[float, float, float, float]) -> None:
        view, projection = _matrices(camera, size)
        self._wire["view"].write(view.tobytes())
        self._wire["projection"].write(projection.tobytes())
        self._wire["viewport_px"].value = size
        self._wire["alone"].value = alone
        self._hidden_edges.use(0)

    def _texture_mode(self, style: Style) -> int:
        if style is not Style.TEXTURED:
            return 0
        return 1 if (self._picture or self._own_picture) is None or self._face.uv is None else 2

    def _uploaded(self, picture: np.ndarray) -> moderngl.Texture:
        if picture.ndim != 3 or picture.shape[2] != 3 or picture.dtype != np.uint8:
            raise ValueError(f"a texture is uint8 of shape (height, width, 3), not {picture.dtype} {picture.shape}")
        height, width = picture.shape[:2]
        # texture coordinates count upwards, pictures downwards
        made = self._ctx.texture((width, height), 3, picture[::-1].tobytes(), alignment=1)
        made.build_mipmaps()
        made.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        return made

    def _free_mesh(self) -> None:
        for thing in self._mesh:
            thing.release()
        if self._own_picture is not None:
            self._own_picture.release()
            self._own_picture = None
        self._mesh = []
        self._face = None


def _matrices(camera: Camera, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """View and projection as a program takes them: float32, column by column."""
    aspect = size[0] / size[1]
    return tuple(np.ascontiguousarray(m.T, np.float32) for m in (camera.view(aspect), camera.projection(aspect)))
