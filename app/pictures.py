"""From marker motion to pictures: a face with its skin, drawn frame by frame without a window."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.face.skinning import MarkerSkin
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress
from core.synthesis.marker_motion import MarkerMotion

DEFAULT_FACE = "default"
STYLES = ("face", "wireframe", "markers")


@dataclass(frozen=True)
class FaceRig:
    """A face that follows a marker set.

    vertices : int, shape (n_markers,), where each marker sits
    """

    face: Face
    vertices: np.ndarray
    skin: MarkerSkin

    @classmethod
    def of(cls, face: str, markers: MarkerSet, marker_file: Path | None = None, progress: Progress = SILENT) -> FaceRig:
        """Bind the face named ``face`` (``default``, or a mesh file) to ``markers``.

        Raises `UserFacingError` when the face is not there or has no place for the markers.
        """
        from core.face.binding import bind
        from core.face.default_face import default_face
        from core.face.marker_placement import load_marker_file

        if face == DEFAULT_FACE:
            shown = default_face(progress.part(0.0, 0.4))
        else:
            from core.face.mesh_files import load_face

            shown = load_face(Path(face), marker_file)
        progress.step(0.4, "binding markers to the face")
        placement = load_marker_file(marker_file) if marker_file is not None else None
        vertices = bind(shown, markers, placement)
        progress.step(0.5, "measuring the face's surface")
        return cls(shown, vertices, MarkerSkin.fit(shown, vertices, markers))

    def deform(self, displacements: np.ndarray) -> np.ndarray:
        """Return the vertices for marker displacements, shape (n_markers, 3), mm; float32, shape (n_vertices, 3)."""
        return self.face.positions + self.skin.deform(displacements)


def frames(
    motion: MarkerMotion, rig: FaceRig | None, style: str, width: int, height: int, progress: Progress = SILENT
) -> Iterator[np.ndarray]:
    """Yield one picture a frame of ``motion``, uint8, shape (height, width, 3).

    style : one of `STYLES`; without a rig only markers can be drawn
    Raises `UserFacingError` on a machine without GL.
    """
    from gpu.gl.camera import Camera, portrait_bounds
    from gpu.gl.face import FaceRenderer, Style
    from gpu.gl.offscreen import OffscreenRenderer

    if rig is None and style != "markers":
        raise UserFacingError("There is no face to draw.", "Draw the markers, with --style markers.")
    shown = {"face": Style.SHADED, "wireframe": Style.WIREFRAME, "markers": Style.MARKERS}[style]
    with OffscreenRenderer(width, height) as offscreen:
        renderer = FaceRenderer(offscreen.ctx)
        try:
            if rig is not None and style != "markers":
                renderer.set_face(rig.face)
                camera = Camera.front(portrait_bounds(rig.face))
            else:
                rest = motion.markers.rest
                camera = Camera.front(np.stack([rest.min(axis=0), rest.max(axis=0)]))
            n_frames = len(motion.positions)
            displacements = motion.displacements
            for f in range(n_frames):
                progress.step(f / n_frames, "drawing")
                if rig is not None and style != "markers":
                    renderer.set_positions(rig.deform(displacements[f]))
                else:
                    renderer.set_markers(motion.positions[f])
                yield offscreen.frame(lambda target: renderer.draw(target, camera, shown))
        finally:
            renderer.release()
