"""Live Link Face's CSV: a timecode, a count and 61 columns, 52 blendshapes of ARKit and 9 angles of head and eyes.

Format: what Epic's phone application records, "Timecode,BlendShapeCount,EyeBlinkLeft,...,RightEyeRoll", timecodes
"HH:MM:SS:FF.mmm" with thousandths of a frame. The file does not say how many frames its timecode counts in a second;
the largest frame number before a new second tells.
"""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.blendshape_track import ARKIT_UNITS, HEAD_AND_EYES, BlendshapeTrack, arkit_name, checked_weights
from core.motion.frame_rate import check_rate_hz
from core.motion.motion_track import RateUnknown
from core.motion.readers.delimited import DelimitedText, read_delimited

_TIMECODE = re.compile(r"(\d{1,2}):(\d{2}):(\d{2})(?:[:;](\d{2,3}))?(?:\.(\d{1,9}))?")
_RATES_HZ = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0, 240.0)
_DAY_S = 86_400.0
# rows this far apart, in frames, are joined by a line; beyond it the frames between are missing
_LONGEST_DROP_FRAMES = 6.5
_EVEN_FRAMES = 0.05
_SPARSEST = 8


def is_live_link_face(text: DelimitedText) -> bool:
    """Tell whether a table has Live Link Face's first two columns."""
    return [cell.lower() for cell in text.cells(0)[:2]] == ["timecode", "blendshapecount"]


def read_live_link_face(path: str | Path, rate_hz: float | None = None) -> BlendshapeTrack:
    """Read a take; rows that stray from even steps are brought onto them by lines between neighbours.

    rate_hz : frames a second that the timecode counts, where the file is too short to tell

    A row without values, or with a count of 0, is a frame in which no face was tracked. Raises `UserFacingError` naming
    the line of what cannot be used, and `RateUnknown` for a take that crosses no full second.
    """
    path = Path(path)
    text = read_delimited(path)
    if not is_live_link_face(text):
        raise UserFacingError(f"'{path}', line 1: a Live Link Face file begins with Timecode,BlendShapeCount.")
    heads = text.cells(0)
    names = [arkit_name(head) or head[:1].lower() + head[1:] for head in heads[2:]]
    if not names or len(set(names)) != len(names):
        raise UserFacingError(f"'{path}', line 1: columns repeat, or there are none.")
    rows = [row for row in range(1, len(text.lines)) if not text.is_blank(row)]
    if len(rows) < 2:
        raise UserFacingError(f"'{path}' has {len(rows)} rows; at least 2 are needed.")
    codes = [_parts(text, row) for row in rows]
    values = _values(text, rows, len(names))
    base = _frames_a_second(path, codes) if rate_hz is None else float(round(check_rate_hz(rate_hz, path)))
    if base < 1:
        raise UserFacingError(f"'{path}': {rate_hz:g} frames a second is no rate.", "Give its rate in Hz.")
    times_s = _seconds(path, rows, codes, base) * (base / rate_hz if rate_hz else 1.0)
    table, step_hz, notes = _on_even_steps(path, times_s, values, rate_hz)
    is_angle = np.array([name in HEAD_AND_EYES for name in names])
    weights, more = checked_weights(table[:, ~is_angle], path)
    shapes = tuple(name for name in names if name not in HEAD_AND_EYES)
    if not shapes:
        raise UserFacingError(f"'{path}', line 1: there is no column of a blendshape.")
    rotations = None
    if set(HEAD_AND_EYES) <= set(names):
        rotations = table[:, [names.index(name) for name in HEAD_AND_EYES]].astype(np.float32)
    return BlendshapeTrack(weights, shapes, step_hz, text.cells(rows[0])[0], rotations, (*notes, *more))


def write_live_link_face(path: str | Path, track: BlendshapeTrack) -> None:
    """Write all 61 columns; units that the track lacks, and angles where it has none, are 0.

    An untracked frame is a row with a count of 0 and empty cells. The timecode counts ``rate_hz`` frames a second,
    rounded to a whole number, from ``start_timecode`` on. Raises `UserFacingError` when the file cannot be written.
    """
    columns = dict(zip(track.names, track.weights.T))
    rotations = np.zeros((len(track.weights), len(HEAD_AND_EYES))) if track.rotations is None else track.rotations
    absent = np.where(np.isnan(track.weights).all(axis=1), np.nan, 0.0)
    table = np.column_stack([*(columns.get(name, absent) for name in ARKIT_UNITS), rotations])
    heads = [name[:1].upper() + name[1:] for name in (*ARKIT_UNITS, *HEAD_AND_EYES)]
    base = max(1, round(track.rate_hz))
    whole, frame, fraction = _code_parts(track.start_timecode) or (0.0, 0.0, 0.0)
    start_s = whole + fraction if frame is None else whole + (frame + fraction) / base
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(["Timecode", "BlendShapeCount", *heads]) + "\n")
        for f, row in enumerate(table):
            tracked = bool(np.isfinite(row[: len(ARKIT_UNITS)]).all())
            cells = [f"{value:.8f}" for value in np.nan_to_num(row).tolist()] if tracked else [""] * len(heads)
            code = _timecode(start_s + f / track.rate_hz, base)
            file.write(",".join([code, str(len(heads) if tracked else 0), *cells]) + "\n")


def _timecode(time_s: float, base: int) -> str:
    thousandths = round(time_s * base * 1000)
    frames, sub = divmod(thousandths, 1000)
    seconds, frame = divmod(frames, base)
    hours, rest = divmod(seconds, 3600)
    return f"{hours % 24:02d}:{rest // 60:02d}:{rest % 60:02d}:{frame:02d}.{sub:03d}"


def _parts(text: DelimitedText, row: int) -> tuple[float, float | None, float]:
    code = text.lines[row].split(text.delimiter, 1)[0].strip(' "')
    parts = _code_parts(code)
    if parts is None:
        raise UserFacingError(f"'{text.path}', line {row + 1}: '{code[:30]}' is no timecode.")
    return parts


def _code_parts(code: str) -> tuple[float, float | None, float] | None:
    """Whole seconds, frame number (None: the code has none) and the fraction behind the point; None for no timecode."""
    match = _TIMECODE.fullmatch(code)
    if match is None:
        return None
    hours, minutes, seconds, frame, fraction = match.groups()
    whole = float(hours) * 3600 + float(minutes) * 60 + float(seconds)
    return whole, None if frame is None else float(frame), float(f"0.{fraction or 0}")


def _values(text: DelimitedText, rows: list[int], n_columns: int) -> np.ndarray:
    """Cells behind the count, float64, shape (len(rows), n_columns); NaN in rows without a face."""
    # every row holds a cell for every column, or none at all
    filled = [row for row in rows if text.lines[row].count(text.delimiter) > n_columns]
    if len(rows) > _SPARSEST * len(filled):
        raise UserFacingError(f"'{text.path}' shows a face in {len(filled)} of its {len(rows)} rows.")
    values = np.full((len(rows), n_columns), np.nan)
    for f, row in enumerate(rows):
        cells = text.cells(row)
        if cells[1:2] == ["0"] or not any(cells[2:]):
            continue
        if len(cells) != n_columns + 2:
            message = f"'{text.path}', line {row + 1}: {len(cells)} cells; the header has {n_columns + 2}."
            raise UserFacingError(message)
        try:
            values[f] = [float(cell) if cell else np.nan for cell in cells[2:]]
        except ValueError as error:
            raise UserFacingError(f"'{text.path}', line {row + 1}: a cell is not a number.") from error
    return values


def _frames_a_second(path: Path, codes: list[tuple[float, float | None, float]]) -> float:
    frames = [frame for _, frame, _ in codes]
    if None in frames:
        return 1.0
    if not any(later < earlier for earlier, later in pairwise(frames)):
        raise RateUnknown(path)
    base = next((rate for rate in _RATES_HZ if rate > max(frames)), None)
    if base is None:
        raise UserFacingError(f"'{path}' counts {max(frames):.0f} frames in a second, which no camera takes.")
    return base


def _seconds(path: Path, rows: list[int], codes: list, base: float) -> np.ndarray:
    times_s = np.array(
        [whole + fraction if frame is None else whole + (frame + fraction) / base for whole, frame, fraction in codes]
    )
    steps = np.diff(times_s)
    # past midnight the clock begins anew
    times_s[1:] += _DAY_S * np.cumsum(steps < -_DAY_S / 2)
    back = np.diff(times_s) < 0
    if back.any():
        raise UserFacingError(f"'{path}', line {rows[int(back.argmax()) + 1] + 1}: the timecode goes back.")
    return times_s


def _on_even_steps(
    path: Path, times_s: np.ndarray, values: np.ndarray, named_hz: float | None
) -> tuple[np.ndarray, float, list[str]]:
    """Values at even steps from the first row on, their rate, and what is to be said."""
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    times_s, values = times_s[keep], values[keep]
    notes = [] if keep.all() else [f"{int((~keep).sum())} rows repeat a timecode and were left out."]
    if len(times_s) < 2:
        raise UserFacingError(f"'{path}': the timecode does not advance.")
    step_s = float(np.median(np.diff(times_s)))
    rate_hz = (len(times_s) - 1) / float(times_s[-1] - times_s[0])
    at = (times_s - times_s[0]) * rate_hz
    if np.abs(at - np.arange(len(at))).max() <= _EVEN_FRAMES:
        meant = min((named_hz or 0.0, round(rate_hz), round(rate_hz * 1.001) / 1.001), key=lambda hz: abs(hz - rate_hz))
        exact = abs(meant - rate_hz) * (times_s[-1] - times_s[0]) < 2 * _EVEN_FRAMES and meant > 0
        return values, check_rate_hz(float(meant if exact else rate_hz), path), notes
    near = min((*_RATES_HZ, named_hz or _RATES_HZ[0]), key=lambda hz: abs(hz * step_s - 1))
    rate_hz = check_rate_hz(near if abs(near * step_s - 1) < 0.05 else 1 / step_s, path)
    n_frames = int(np.floor((times_s[-1] - times_s[0]) * rate_hz + 1e-6)) + 1
    if n_frames > _SPARSEST * len(times_s):
        raise UserFacingError(f"'{path}' lacks most of its frames: {len(times_s)} of {n_frames} are there.")
    goal_s = times_s[0] + np.arange(n_frames) / rate_hz
    even = np.stack([np.interp(goal_s, times_s, column) for column in values.T], axis=1)
    after = np.clip(np.searchsorted(times_s, goal_s), 1, len(times_s) - 1)
    lost = (times_s[after] - times_s[after - 1]) * rate_hz > _LONGEST_DROP_FRAMES
    even[lost] = np.nan
    notes.append(f"Uneven timecodes were brought to {rate_hz:g} Hz; {int(lost.sum())} frames are missing.")
    return even, rate_hz, notes
