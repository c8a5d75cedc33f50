"""`efase poses`: key lip shapes of a database, and a rig posed for them as well as names and markers allow."""

from __future__ import annotations

from pathlib import Path

from app.controlled_face import one_rig
from app.demo import open_named
from core.animeme.key_shapes import captured_keys
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.default_face import default_face
from core.media.swap_in import check_target
from core.progress import SILENT, Progress
from core.rig.key_poses import first_poses


def run(output: Path, database: Path | None, face: str, n_keys: int, progress: Progress = SILENT) -> dict[str, object]:
    """Write the poses and return the object of ``--json``; raises `UserFacingError`."""
    if output.suffix.lower() != ".json":
        raise UserFacingError(f"'{output}' is not a name for a file of poses.", "Let it end in .json.")
    check_target(output)
    rig = one_rig(FaceChoice(face), None, output)
    opened = open_named(database, progress.part(0.0, 0.3))
    lips, lips_mm = captured_keys(opened, n_keys, progress=progress.part(0.3, 0.6))
    poses = first_poses(rig, default_face(progress.part(0.6, 0.9)), opened.markers, lips, lips_mm)
    poses.save(output)
    at_rest = [key for key, row in zip(poses.keys, poses.values) if not row.any()]
    warnings = []
    if at_rest:
        warnings.append(f"{len(at_rest)} key lip shapes are at rest, for the rig's controls have other names than "
                        f"ARKit's: pose {', '.join(at_rest[:8])} in '{output}'.")  # fmt: skip
    return {
        "keys": list(poses.keys), "controls": list(poses.controls), "warnings": warnings, "outputs": [str(output)],
    }  # fmt: skip
