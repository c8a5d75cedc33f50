"""From marker motion to pictures: a face with its skin, drawn frame by frame without a window."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from core.errors import UserFacingError
from core.face.eyelids import Eyelids
from core.face.face import Face
from core.face.lip_contact import LipContact
from core.face.moving_parts import MovingParts
from core.face.skinning import MarkerSkin
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

if TYPE_CHECKING:
    from gpu.gl.face_arrays import FaceArrays

DEFAULT_FACE = "default"
STYLES = ("face", "shaded", "wireframe", "markers")


class Drawable(Protocol):
    """One face or several that follow marker motion."""

    @property
    def faces(self) -> tuple[Face, ...]:
        """The faces, side by side in the picture."""

    def poses(
        self, motion: MarkerMotion, tracks: PoseTracks, first: int, stop: int
    ) -> Iterator[tuple[np.ndarray, ...]]:
        """Yield the vertices of every face, mm, for the frames ``first`` to ``stop``, the last one not included."""


@dataclass(frozen=True)
class FaceRig:
    """A face that follows a marker set.

    vertices : int, shape (n_markers,), where each marker sits
    skin : how markers move it; eyelids, lips : what keeps lids and lips from sliding through or missing each other
    """

    face: Face
    vertices: np.ndarray
    skin: MarkerSkin
    eyelids: Eyelids
    lips: LipContact | None

    @classmethod
    def of(cls, face: str, markers: MarkerSet, marker_file: Path | None = None, progress: Progress = SILENT) -> FaceRig:
        """Bind the face named ``face`` (a character, see `core.face.characters`, or a mesh file) to ``markers``.

        Raises `UserFacingError` when the face is not there or has no place for the markers.
        """
        from core.face.binding import bind
        from core.face.characters import CHARACTERS
        from core.face.default_face import character_face
        from core.face.marker_placement import load_marker_file
        from core.face.skin_cache import cached_skin

        if face in CHARACTERS:
            shown = character_face(face, progress.part(0.0, 0.4))
        else:
            from core.face.mesh_files import load_face

            shown = load_face(Path(face), marker_file)
        progress.step(0.4, "binding markers to the face")
        placement = load_marker_file(marker_file) if marker_file is not None else None
        vertices = bind(shown, markers, placement)
        progress.step(0.5, "measuring the face's surface")
        skin = cached_skin(shown, vertices, markers)
        return cls(shown, vertices, skin, Eyelids.of(shown, vertices, markers), LipContact.of(shown))

    @cached_property
    def arrays(self) -> FaceArrays:
        """What a renderer uploads of the face."""
        from gpu.gl.face_arrays import FaceArrays

        return FaceArrays.of(self.face)

    @cached_property
    def _parts(self) -> MovingParts:
        return MovingParts(self.face)

    def deform(self, displacements: np.ndarray) -> np.ndarray:
        """Return the vertices for marker displacements alone; see `pose`."""
        return self.pose(displacements)

    def pose(
        self,
        displacements: np.ndarray,
        head: tuple[np.ndarray, np.ndarray] | None = None,
        gaze: tuple[float, float] | np.ndarray | None = None,
        tongue: tuple[float, float, float] | np.ndarray | None = None,
    ) -> np.ndarray:
        """Return the vertices of one frame, mm, float32, shape (n_vertices, 3).

        displacements : shape (n_markers, 3), mm, of the markers from rest
        head, gaze, tongue : see `core.face.moving_parts.MovingParts.place`
        """
        moved = self.skin.deform(displacements)
        self.eyelids.apply(moved, 0.0 if gaze is None else float(gaze[1]))
        if self.lips is not None:
            self.lips.apply(moved)
        return self._parts.place(moved, head, gaze, tongue)

    @property
    def faces(self) -> tuple[Face, ...]:
        """See `Drawable`."""
        return (self.face,)

    def poses(
        self, motion: MarkerMotion, tracks: PoseTracks, first: int, stop: int
    ) -> Iterator[tuple[np.ndarray, ...]]:
        """See `Drawable`."""
        displacements = motion.displacements
        for f in range(first, stop):
            yield (self.pose(displacements[f], **tracks.at(f)),)


def frames(
    motion: MarkerMotion,
    rig: Drawable | None,
    style: str,
    width: int,
    height: int,
    progress: Progress = SILENT,
    tracks: PoseTracks | None = None,
    texture: np.ndarray | None = None,
    background: tuple[float, float, float] | None = None,
    span: tuple[int, int] | None = None,
) -> Iterator[np.ndarray]:
    """Yield one picture a frame of ``motion``, uint8, shape (height, width, 3).

    style : one of `STYLES`; without a rig only markers can be drawn
    tracks : head, gaze and tongue at the motion's rate; None keeps them still
    texture : uint8, shape (h, w, 3), for the style ``face`` of a mesh with texture coordinates
    background : red, green, blue, 0..1; None: the studio's
    span : first frame and the one after the last; None: all
    Raises `UserFacingError` on a machine without GL.
    """
    first, stop = span or (0, len(motion.positions))
    if style == "markers":
        yield from marker_pictures((motion,), width, height, progress, background, first, stop)
        return
    if rig is None:
        raise UserFacingError("There is no face to draw.", "Draw the markers, with --style markers.")
    poses = rig.poses(motion, tracks or PoseTracks(), first, stop)
    yield from face_pictures(rig.faces, poses, stop - first, style, width, height, progress, texture, background)


def face_pictures(
    faces: Sequence[Face], poses: Iterable[Sequence[np.ndarray]], n_frames: int, style: str, width: int, height: int,
    progress: Progress = SILENT, texture: np.ndarray | None = None,
    background: tuple[float, float, float] | None = None,
) -> Iterator[np.ndarray]:  # fmt: skip
    """Yield one picture for each of ``poses``: the vertices of every one of ``faces`` at that moment, mm.

    Several faces share the picture, row by row, and stand as large in it as they can; what is left over of its width
    and height is background. See `frames` for the rest.
    """
    from gpu.gl.camera import Camera, portrait_bounds
    from gpu.gl.face import FaceRenderer, Style
    from gpu.gl.offscreen import OffscreenRenderer

    shown = dict(zip(STYLES, (Style.TEXTURED, Style.SHADED, Style.WIREFRAME)))[style]
    columns = n_columns(len(faces), width, height)
    rows = -(-len(faces) // columns)
    cameras = [Camera.front(portrait_bounds(face)) for face in faces]
    with OffscreenRenderer(width // columns, height // rows) as offscreen:
        renderers = [FaceRenderer(offscreen.ctx) for _ in faces]
        try:
            for renderer, face in zip(renderers, faces):
                renderer.set_face(face)
                renderer.set_texture(texture)
            for f, at_once in enumerate(poses):
                progress.step(f / n_frames, "drawing")
                cells = []
                for renderer, camera, positions in zip(renderers, cameras, at_once):
                    renderer.set_positions(positions)
                    draw = functools.partial(_draw, renderer, camera, shown, background)
                    cells.append(offscreen.frame(draw))
                yield cells[0] if len(faces) == 1 else _tiled(cells, columns, width, height)
        finally:
            for renderer in renderers:
                renderer.release()


def n_columns(n_faces: int, width: int, height: int) -> int:
    """Return in how many columns faces stand largest; a portrait is four wide and five high."""

    def size(columns: int) -> float:
        return min(width / columns / 4, height / -(-n_faces // columns) / 5)

    return max(range(1, n_faces + 1), key=size)


def _draw(renderer, camera, shown, background, target) -> None:
    renderer.draw(target, camera, shown, background=background)


def _tiled(cells: list[np.ndarray], columns: int, width: int, height: int) -> np.ndarray:
    """Cells row by row; the last row stands in the middle."""
    high, wide = cells[0].shape[:2]
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = cells[0][0, 0]
    for first in range(0, len(cells), columns):
        row = cells[first : first + columns]
        top, left = first // columns * high, (width - len(row) * wide) // 2
        picture[top : top + high, left : left + len(row) * wide] = np.concatenate(row, axis=1)
    return picture


def marker_pictures(
    motions: Sequence[MarkerMotion], width: int, height: int, progress: Progress,
    background: tuple[float, float, float] | None, first: int, stop: int,
) -> Iterator[np.ndarray]:  # fmt: skip
    """Yield one picture for each of the frames ``first`` to ``stop`` of ``motions``, which share it as faces do."""
    from gpu.gl.camera import Camera
    from gpu.gl.face import FaceRenderer, Style
    from gpu.gl.offscreen import OffscreenRenderer

    columns = n_columns(len(motions), width, height)
    rests = [motion.markers.rest for motion in motions]
    cameras = [Camera.front(np.stack([rest.min(axis=0), rest.max(axis=0)])) for rest in rests]
    with OffscreenRenderer(width // columns, height // -(-len(motions) // columns)) as offscreen:
        renderer = FaceRenderer(offscreen.ctx)
        try:
            for f in range(first, stop):
                progress.step((f - first) / (stop - first), "drawing")
                cells = []
                for motion, camera in zip(motions, cameras):
                    renderer.set_markers(motion.positions[f])
                    draw = functools.partial(_draw, renderer, camera, Style.MARKERS, background)
                    cells.append(offscreen.frame(draw))
                yield cells[0] if len(motions) == 1 else _tiled(cells, columns, width, height)
        finally:
            renderer.release()
