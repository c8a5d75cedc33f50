"""From marker motion to pictures: a face with its skin, drawn frame by frame without a window."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.eyelids import Eyelids
from core.face.face import Face
from core.face.lip_contact import LipContact
from core.face.pose import Eyeballs, Head, TongueShape
from core.face.skinning import MarkerSkin
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

DEFAULT_FACE = "default"
STYLES = ("face", "shaded", "wireframe", "markers")


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
    def _head(self) -> Head:
        return Head.of(self.face)

    @cached_property
    def _eyeballs(self) -> Eyeballs:
        return Eyeballs.of(self.face)

    @cached_property
    def _tongue(self) -> TongueShape | None:
        return TongueShape.of(self.face)

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
        head : rotation vector (radians) and translation (mm); eyes and teeth go with the head, the base of the neck
            stays. None keeps it still
        gaze : yaw to the character's left and pitch up, degrees; the eyeballs turn about their centres
        tongue : tip, back and advance, as `core.face.tongue.tongue_track` gives them; None lets the jaw carry it
        """
        moved = self.skin.deform(displacements)
        self.eyelids.apply(moved, 0.0 if gaze is None else float(gaze[1]))
        if self.lips is not None:
            self.lips.apply(moved)
        if tongue is not None and self._tongue is not None:
            self._tongue.bend(moved, self.face.positions, *map(float, tongue))
        positions = self.face.positions + moved
        if gaze is not None:
            self._eyeballs.turn(positions, float(gaze[0]), float(gaze[1]))
        if head is not None:
            positions = self._head.move(positions, *head)
        return positions


def frames(
    motion: MarkerMotion,
    rig: FaceRig | None,
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
    from gpu.gl.camera import Camera, portrait_bounds
    from gpu.gl.face import FaceRenderer, Style
    from gpu.gl.offscreen import OffscreenRenderer

    if rig is None and style != "markers":
        raise UserFacingError("There is no face to draw.", "Draw the markers, with --style markers.")
    styles = (Style.TEXTURED, Style.SHADED, Style.WIREFRAME, Style.MARKERS)
    shown = dict(zip(STYLES, styles))[style]
    tracks = tracks or PoseTracks()
    with OffscreenRenderer(width, height) as offscreen:
        renderer = FaceRenderer(offscreen.ctx)
        try:
            if rig is not None and style != "markers":
                renderer.set_face(rig.face)
                renderer.set_texture(texture)
                camera = Camera.front(portrait_bounds(rig.face))
            else:
                rest = motion.markers.rest
                camera = Camera.front(np.stack([rest.min(axis=0), rest.max(axis=0)]))
            first, stop = span or (0, len(motion.positions))
            displacements = motion.displacements
            for f in range(first, stop):
                progress.step((f - first) / (stop - first), "drawing")
                if rig is not None and style != "markers":
                    renderer.set_positions(rig.pose(displacements[f], **tracks.at(f)))
                else:
                    renderer.set_markers(motion.positions[f])
                yield offscreen.frame(lambda target: renderer.draw(target, camera, shown, background=background))
        finally:
            renderer.release()
