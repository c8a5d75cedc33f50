"""`efase fit-face`: a scan and its points in, a face file out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError
from core.face.characters import DEFAULT
from core.face.default_face import character_face
from core.face.face import Face
from core.face.face_file import FACE_SUFFIX, save_face
from core.face.own_face import FitDistance, fit_own_face, painted, painted_by_photo
from core.face.own_face_points import generic_points, load_points
from core.face.own_face_scan import read_scan
from core.media.picture import read_picture
from core.media.swap_in import check_target, swapped_in
from core.progress import SILENT, Progress


@dataclass(frozen=True)
class FitJob:
    """What the verb was asked for.

    points : a file of `core.face.own_face_points`; generic : the character that is fitted
    texture : a picture for the scan's texture coordinates; photo : a photo whose points are in ``points``
    """

    scan: Path
    points: Path
    output: Path
    generic: str = DEFAULT
    texture: Path | None = None
    photo: Path | None = None


def run(job: FitJob, progress: Progress = SILENT) -> dict[str, object]:
    """Fit, paint and save; return the object of ``--json``. Raises `UserFacingError`, with nothing half-written."""
    check_face_target(job.output)
    file = load_points(job.points)
    if job.photo is not None and not file.photo:
        raise UserFacingError(f"{job.points} holds no points on the photo '{job.photo}'.")
    photo = None if job.photo is None else read_picture(job.photo)
    generic = character_face(job.generic, progress.part(0.0, 0.1))
    scan = read_scan(job.scan, job.texture)
    points = file.on(scan.positions, job.scan.name)
    own = fit_own_face(
        generic, scan, points, generic_points(generic, file.moved), job.output.stem, progress.part(0.1, 0.6)
    )
    notes = list(own.notes)
    stage = progress.part(0.6, 0.95)
    if photo is None:
        face = painted(own, stage)
    else:
        face, camera = painted_by_photo(own, photo, file.photo, points, stage)
        notes.append(f"The photo's camera misses the points by {camera.error_px:.1f} pixels.")
    save_own_face(face, job.output)
    return {
        "points": len(points), "after_points": distances(own.warped), "remaining": distances(own.closed),
        "doubtful": list(own.doubtful), "textured": face.texture is not None, "warnings": notes,
        "outputs": [str(job.output)],
    }  # fmt: skip


def check_face_target(path: Path) -> None:
    """Raise `UserFacingError` when a face file could not be written at ``path``."""
    if path.suffix.lower() != FACE_SUFFIX:
        raise UserFacingError(f"'{path}' is not a name for a face file.", f"Let it end in {FACE_SUFFIX}.")
    check_target(path)


def save_own_face(face: Face, path: Path) -> None:
    """Write a face file, whole or not at all; raises `UserFacingError`."""
    with swapped_in(path) as beside:
        save_face(face, beside)


def distances(distance: FitDistance) -> dict[str, float]:
    """Return the figures of a distance, mm, for reports."""
    return {
        "median_mm": round(distance.median, 3), "p95_mm": round(distance.p95, 3),
        "largest_mm": round(distance.largest, 3), "scan_to_face_median_mm": round(distance.back_median, 3),
        "scan_to_face_p95_mm": round(distance.back_p95, 3), "covered": round(distance.covered, 3),
        "points_median_mm": round(distance.points[0], 3), "points_largest_mm": round(distance.points[1], 3),
    }  # fmt: skip


def in_words(answer: dict[str, object]) -> str:
    """Return two lines that tell how near the face came."""
    left, before = answer["remaining"], answer["after_points"]
    return (
        f"Remaining distance: median {left['median_mm']:.2f} mm, 95 % within {left['p95_mm']:.2f} mm "
        f"(by the points alone {before['median_mm']:.2f} and {before['p95_mm']:.2f} mm).\n"
        f"The scan shows {left['covered']:.0%} of the skin; points are met to {left['points_median_mm']:.2f} mm."
    )
