"""One video tracked as the command line asks for it."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from app.demo import open_named
from core.progress import SILENT, Progress
from core.tracking.capture import check_capture_path, write_capture
from core.tracking.face_model import FaceModel
from core.tracking.start_file import TrackingStart
from core.tracking.track import Track, TrackingRequest, track_video
from core.tracking.video_pictures import format_of

_POOR = 0.5


def tracked(
    video: Path, start: TrackingStart, out: Path, db: Path | None, expression: str | None = None,
    progress: Progress = SILENT,
) -> dict[str, object]:  # fmt: skip
    """Track ``video`` with the units of a database (None: the demo's) and write the capture; returns what --json says.

    Raises `UserFacingError` for anything that cannot be used, before the work begins where that can be known.
    """
    check_capture_path(out)
    format_of(video)
    model = FaceModel.of_database(open_named(db, progress.part(0.0, 0.1)), expression or start.expression)
    request = TrackingRequest(video, model, start.clicks, start.corrections)
    began = time.perf_counter()
    track = track_video(request, progress.part(0.1, 0.95))
    seconds = time.perf_counter() - began
    outputs = write_capture(track, out)
    known = track.drift_px[np.isfinite(track.drift_px)]
    return {
        "outputs": [str(path) for path in outputs], "frames": len(track.points), "points": len(model.names),
        "rate_hz": track.format.rate_hz, "trust": round(float(track.trust.mean()), 3),
        "lost": int(track.lost.sum()), "drift_px": round(float(np.median(known)), 3) if len(known) else None,
        "frames_per_s": round(len(track.points) / seconds, 1), "notes": notes_on(track),
    }  # fmt: skip


def notes_on(track: Track) -> list[str]:
    """Say in sentences what is to be looked at in a track."""
    notes = []
    promised, there = track.format.n_frames, len(track.points)
    if promised > there + 2 and there < 0.98 * promised:
        notes.append(f"'{track.request.video}' breaks off after {there} of {promised} pictures.")
    lost = np.flatnonzero(track.lost)
    if len(lost):
        notes.append(
            f"The face was lost in {len(lost)} frames, first in frame {lost[0]}; they are gaps in the capture."
        )
    poor = np.flatnonzero((track.frame_trust < _POOR) & ~track.lost)
    if len(poor):
        notes.append(f"{len(poor)} frames are unsure, first frame {poor[0]}: look at them, and drag what is wrong.")
    return notes
