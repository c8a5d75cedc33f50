"""Measures over time as a CSV file, for spreadsheets and plots."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.evaluation.side_by_side import SideBySide
from core.media.swap_in import swapped_in
from core.motion.resample import frame_bounds


def column_name(measure: str, of: str) -> str:
    """Return what a column is called: ``lip_gap_search_mm``, ``difference_mm``."""
    return "_".join((*measure.split(), *(part for part in (of,) if part), "mm"))


def write_course_table(path: str | Path, compared: SideBySide) -> None:
    """Write columns ``frame``, ``time_s``, ``phone`` and one for each of ``compared.courses``, mm, a row a frame.

    A cell is empty where the capture cannot be used. Raises `UserFacingError` when the file cannot be written.
    """
    import csv

    courses = compared.courses
    phones = phones_of_frames(compared)
    values = np.stack([course.values_mm for course in courses], axis=1)
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["frame", "time_s", "phone", *(column_name(c.measure, c.of) for c in courses)])
        for f, row in enumerate(values.tolist()):
            cells = ("" if np.isnan(v) else f"{v:.4f}" for v in row)
            table.writerow([f, f"{f / compared.rate_hz:.6f}", phones[f], *cells])


def phones_of_frames(compared: SideBySide) -> list[str]:
    """Return which phone is said in each frame; nothing beyond the last one."""
    said = compared.transcript.phonemes
    phones = [""] * compared.n_frames
    bounds = frame_bounds([u.start_s for u in said], [u.end_s for u in said], compared.rate_hz)
    for utterance, start, stop in zip(said, *bounds):
        stop = min(stop, compared.n_frames)
        phones[start:stop] = [utterance.phone] * max(0, stop - start)
    return phones
