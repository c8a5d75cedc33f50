"""Control curves as plain JSON and CSV, for scripts and spreadsheets."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.rig.control_track import ControlTrack
from core.speech.text_file import read_text

FORMAT = "efase-curves"
VERSION = 1
_DIGITS = 6


def write_curves_json(path: str | Path, track: ControlTrack) -> None:
    """Write ``{format, version, rate_hz, start_frame, start_timecode, controls, frames}``; one row a frame.

    Values are written as they are, to six digits. Raises `UserFacingError` when the file cannot be written.
    """
    head = {"format": FORMAT, "version": VERSION, "rate_hz": track.rate_hz, "start_frame": track.start_frame,
            "start_timecode": track.start_timecode, "controls": list(track.names)}  # fmt: skip
    rows = ",\n".join(json.dumps([round(v, _DIGITS) for v in row]) for row in track.values.tolist())
    with swapped_in(path) as beside:
        beside.write_text(f'{json.dumps(head)[:-1]}, "frames": [\n{rows}\n]}}\n', encoding="utf-8", newline="\n")


def read_curves_json(path: str | Path) -> ControlTrack:
    """Read what `write_curves_json` wrote; raises `UserFacingError` that says what is wrong with it."""
    text = read_text(path, "file of curves")
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UserFacingError(f"'{path}' is no JSON.") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise UserFacingError(f"'{path}' holds no curves.")
    if data.get("version") != VERSION:
        raise UserFacingError(f"'{path}' was written by a newer workstation.")
    names, rows, rate_hz = data.get("controls"), data.get("frames"), data.get("rate_hz")
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        raise UserFacingError(f"'{path}' does not name its controls.")
    if len(set(names)) != len(names) or not all(names):
        raise UserFacingError(f"'{path}': two controls have the same name, or one has none.", "Name each differently.")
    if not isinstance(rate_hz, int | float) or not 0 < rate_hz < math.inf:
        raise UserFacingError(f"'{path}' does not say its frames a second.")
    if not isinstance(rows, list) or not rows:
        raise UserFacingError(f"'{path}' holds no frames.")
    for f, row in enumerate(rows):
        numbers = isinstance(row, list) and all(isinstance(v, int | float) and abs(v) < 1e6 for v in row)
        if not numbers or len(row) != len(names):
            raise UserFacingError(f"'{path}', frame {f}: a row of {len(names)} numbers is expected.")
    start = data.get("start_frame", 0)
    return ControlTrack(tuple(names), np.array(rows), float(rate_hz), start if isinstance(start, int) else 0)


def write_curves_csv(path: str | Path, track: ControlTrack) -> None:
    """Write columns ``frame``, ``time_s`` and one a control; `core.motion.readers.blendshape_files` reads it back.

    frame : counted from the start timecode; time_s : from 0. Raises `UserFacingError` when it cannot be written.
    """
    import csv

    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["frame", "time_s", *track.names])
        for f, row in enumerate(track.values.tolist()):
            table.writerow([track.start_frame + f, f"{f / track.rate_hz:.6f}", *(f"{v:.{_DIGITS}f}" for v in row)])
