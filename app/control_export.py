"""Controls of a synthesis to the files of other programs: Live Link Face, curves, glTF, USD."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.controlled_face import one_rig, rig_controls, rig_named
from core.animeme.controls import ControlTrack
from core.document.parts import FaceChoice
from core.pipeline.control_files import control_suffix, needs_rig, write_controls
from core.rig.key_poses import load_key_poses
from core.synthesis.marker_motion import MarkerMotion


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
