"""What the head of a column says: a point's axis, a time, a frame number, a unit."""

from __future__ import annotations

import re
from dataclasses import dataclass

from core.motion.length_units import MM_PER_UNIT

_LONGEST_HEAD = 200
_UNIT = r"(?:(?:[ _]+|[ _]*[\[(])(?P<unit>mm|cm|m|in|px)[\])]?)?"
_AXIS_LAST = re.compile(
    rf"(?P<name>.*?)[ _.:\-\[(]+(?:(?:pos(?:ition)?|translate|trans|t)[ _.]?)?(?P<axis>[xyzXYZ])[\])]?{_UNIT}"
)
_AXIS_CAPITAL = re.compile(rf"(?P<name>.*[^XYZ ])(?P<axis>[XYZ]){_UNIT}")
_AXIS_FIRST = re.compile(rf"(?P<axis>[xyzXYZ])[ _.:\-]?(?P<name>\d+){_UNIT}")
_AXIS_FIRST_NAMED = re.compile(rf"(?P<axis>[xyzXYZ])[ _.:\-](?P<name>.+?){_UNIT}")
_BARE_AXIS = re.compile(rf"(?P<axis>[xyzXYZ])\d*{_UNIT}")
# columns that come in three axes and are no places
_NO_PLACE = re.compile(
    r"(?:^|[ _.:\-]|(?<=[a-z]))(?:rot|rotation|rotate|scale|vel|velocity|acc|quat|angle)$", re.IGNORECASE
)
_TIMES = {
    "time": 1.0, "times": 1.0, "timestamp": 1.0, "t": 1.0, "sec": 1.0, "seconds": 1.0, "time_s": 1.0, "time_sec": 1.0,
    "time_seconds": 1.0, "timestamp_s": 1.0, "time_ms": 1e-3, "timestamp_ms": 1e-3, "ms": 1e-3, "milliseconds": 1e-3,
    "time_milliseconds": 1e-3, "time_us": 1e-6, "timestamp_us": 1e-6,
}  # fmt: skip
_FRAMES = {"frame", "frames", "frame_number", "frame_no", "frame_id", "frame_index", "frame_idx", "field", "sample"}


@dataclass(frozen=True)
class AxisColumn:
    """One axis of one point; ``axis`` is 0, 1 or 2, ``capital`` tells X from x, ``unit`` is "" if unsaid."""

    name: str
    axis: int
    capital: bool
    unit: str


def axis_column(head: str) -> AxisColumn | None:
    """Read a head such as ``nose_x``, ``nose:X``, ``nose.translateX``, ``noseX (mm)``, ``x_12`` or ``x12``."""
    # what a name ends in weighs more than how it begins: x_y would be the y of x
    if len(head) > _LONGEST_HEAD:
        return None
    for pattern in (_AXIS_FIRST, _AXIS_LAST, _AXIS_CAPITAL, _AXIS_FIRST_NAMED):
        match = pattern.fullmatch(head)
        if match and match["name"] and not _NO_PLACE.search(match["name"]):
            axis = match["axis"]
            return AxisColumn(match["name"].strip(), "xyz".index(axis.lower()), axis.isupper(), match["unit"] or "")
    return None


def bare_axis(head: str) -> AxisColumn | None:
    """Read a head that is X, Y or Z and nothing else (a number or a unit may follow); its name is ""."""
    match = _BARE_AXIS.fullmatch(head) if len(head) <= _LONGEST_HEAD else None
    if match is None:
        return None
    return AxisColumn("", "xyz".index(match["axis"].lower()), match["axis"].isupper(), match["unit"] or "")


def time_factor(head: str) -> float | None:
    """Return seconds per unit of a column of times, None for any other column."""
    return _TIMES.get(_plain(head))


def is_frame(head: str) -> bool:
    """Tell whether a column counts frames."""
    return _plain(head) in _FRAMES


def is_length(cell: str) -> bool:
    """Tell whether a cell is a unit of length."""
    return cell.strip(" []()").lower() in MM_PER_UNIT


def _plain(head: str) -> str:
    return re.sub(r"[ _\-]+", "_", re.sub(r"[#\[\]().]", " ", head.lower()).strip())
