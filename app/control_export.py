"""Controls to the files of other programs (Live Link Face, curves, glTF, USD), and to films of the face they move."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.controlled_face import CAST, ControlledFace, one_rig, rig_controls, rig_named
from app.pictures import face_pictures
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.media.audio import Audio
from core.media.image_sequence import SUFFIX as IMAGE_SUFFIX
from core.media.image_sequence import numbered, write_images
from core.media.swap_in import check_target
from core.media.video import SUFFIXES as FILM_SUFFIXES
from core.media.video import write_video
from core.pipeline.control_files import SUFFIXES, check_control_suffix, control_suffix, needs_rig, write_controls
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.rig.key_poses import load_key_poses
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

_DRAWN = (*FILM_SUFFIXES, IMAGE_SUFFIX)


def write_motion_controls(
    outputs: Sequence[Path], motion: MarkerMotion, face: FaceChoice, key_poses: Path | None = None,
    start_frame: int = 0, plain_csv: bool = False,
) -> list[str]:  # fmt: skip
    """Write the controls that ``motion`` asks of ``face``, at the motion's rate; return sentences to warn with.

    key_poses : an artist's poses for the rig; plain_csv : see `core.pipeline.control_files.control_suffix`
    """
    rigs = [one_rig(face, key_poses, path) for path in outputs if needs_rig(control_suffix(path, plain_csv))]
    rig = rigs[0] if rigs else rig_named(face, key_poses) if key_poses is not None else None
    poses = None if key_poses is None else load_key_poses(key_poses)
    found = rig_controls(motion, rig, poses)
    track = ControlTrack(found.names, found.values, found.rate_hz, start_frame)
    warnings: list[str] = []
    for path in outputs:
        warnings += write_controls(path, control_suffix(path, plain_csv), track, rig)
    return warnings


def check_rigs(outputs: Sequence[Path], face: FaceChoice, key_poses: Path | None, plain_csv: bool) -> None:
    """Raise `UserFacingError`, before any work, when one of ``outputs`` would hold shapes that ``face`` has not.

    plain_csv : see `core.pipeline.control_files.control_suffix`
    """
    for path in outputs:
        if needs_rig(control_suffix(path, plain_csv)):
            one_rig(face, key_poses, path)


def check_control_outputs(outputs: Sequence[Path], face: str) -> None:
    """Raise `UserFacingError`, before any work, when controls alone cannot be written to one of ``outputs``."""
    for path in outputs:
        suffix = control_suffix(path, plain_csv=True)
        if suffix is not None:
            check_control_suffix(suffix)
        elif path.suffix.lower() not in _DRAWN:
            raise UserFacingError(f"'{path}' has no suffix that curves can be written to.",
                                  f"Known are .csv, {', '.join((*SUFFIXES, *_DRAWN))}.")  # fmt: skip
        check_target(numbered(path, 0) if path.suffix.lower() == IMAGE_SUFFIX else path)
    check_rigs(outputs, FaceChoice(face), None, plain_csv=True)


def write_track(
    outputs: Sequence[Path], track: ControlTrack, face: str, video, audio: Audio | None,
    progress: Progress = SILENT, tracks: PoseTracks | None = None,
) -> list[str]:  # fmt: skip
    """Write curves, at the rate of ``video`` (`app.export.VideoSettings`), to every one of ``outputs``.

    A plain .csv is Live Link Face's. ``tracks`` move head, eyes and tongue in films. Returns sentences to warn with.
    """
    warnings: list[str] = []
    for n, path in enumerate(outputs):
        stage = progress.part(n / len(outputs), (n + 1) / len(outputs))
        suffix = control_suffix(path, plain_csv=True)
        if suffix is None:
            _write_pictures(path, track, face, video, audio, stage, tracks or PoseTracks())
        else:
            rig = one_rig(FaceChoice(face), None, path) if needs_rig(suffix) else None
            warnings += write_controls(path, suffix, track, rig)
        stage.step(1.0, f"{path.name} written")
    return list(dict.fromkeys(warnings))


def _write_pictures(
    path: Path, track: ControlTrack, face: str, video, audio: Audio | None, progress: Progress, tracks: PoseTracks
) -> None:
    names = list(CHARACTERS) if face == CAST else [face]
    members = [ControlledFace(one_rig(FaceChoice(name), None, path)) for name in names]
    n_frames = len(track)
    poses = (
        tuple(positions for of_one in at_once for positions in of_one)
        for at_once in zip(*(member.controlled(track, tracks, 0, n_frames) for member in members))
    )
    faces = [member.rig.face for member in members]
    pictures = face_pictures(faces, poses, n_frames, video.style, video.width, video.height,
                             background=video.background)  # fmt: skip
    if path.suffix.lower() == IMAGE_SUFFIX:
        write_images(path, pictures, n_frames, progress, track.start_frame)
    else:
        write_video(path, pictures, n_frames, video.fps, audio, progress, track.start_frame)
