"""Clicks and corrections of one video, kept as JSON, so that a track can be made again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.marker_set import LANDMARKS
from core.tracking.face_model import ANY

_FORMAT = "efase-tracking 1"
_LARGEST_BYTES = 1 << 26
_FURTHEST_PX = 1e6

Places = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class TrackingStart:
    """What a hand said of a video.

    clicks : landmark to x, y in pixels of the first picture
    corrections : frame to marker to x, y
    expression : ``any``, ``neutral``, or the name of one, whose units may be used
    """

    clicks: Places
    corrections: Mapping[int, Places] = field(default_factory=dict)
    expression: str = ANY


def read_start(path: str | Path) -> TrackingStart:
    """Read what `write_start` wrote; raises `UserFacingError` that names file and place for anything else."""
    path = Path(path)
    try:
        if path.stat().st_size > _LARGEST_BYTES:
            raise UserFacingError(f"'{path}' is too large for clicks and corrections.")
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (ValueError, RecursionError) as error:
        line = f", line {error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        raise UserFacingError(f"'{path}'{line}: this is not JSON.") from error
    if not isinstance(data, dict) or data.get("format") != _FORMAT:
        raise UserFacingError(f"'{path}' does not hold clicks and corrections of a video.")
    clicks = _places(path, "clicks", data.get("clicks"))
    strangers = [name for name in clicks if name not in LANDMARKS]
    if strangers:
        raise UserFacingError(f"'{path}', clicks: '{strangers[0][:40]}' is no point of a face.",
                              f"Known are {', '.join(LANDMARKS)}.")  # fmt: skip
    corrections = data.get("corrections", {})
    if not isinstance(corrections, dict) or not all(key.isascii() and key.isdecimal() for key in corrections):
        raise UserFacingError(f"'{path}', corrections: these are not frames with points.")
    expression = data.get("expression", ANY)
    if not isinstance(expression, str):
        raise UserFacingError(f"'{path}', expression: this is not a name.")
    frames = {int(key[:9]): _places(path, f"corrections of frame {key}", value) for key, value in corrections.items()}
    return TrackingStart(clicks, frames, expression)


def write_start(start: TrackingStart, path: str | Path) -> None:
    """Write clicks and corrections; raises `UserFacingError` when that cannot be."""
    corrections = {str(f): _plain(places) for f, places in sorted(start.corrections.items()) if places}
    data = {"format": _FORMAT, "expression": start.expression, "clicks": _plain(start.clicks)}
    data["corrections"] = corrections
    with swapped_in(path) as beside:
        beside.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def _plain(places: Places) -> dict[str, list[float]]:
    return {name: [round(float(x), 3), round(float(y), 3)] for name, (x, y) in places.items()}


def _places(path: Path, where: str, value: object) -> dict[str, tuple[float, float]]:
    def is_place(pair: object) -> bool:
        return isinstance(pair, list) and len(pair) == 2 and all(
            isinstance(n, int | float) and not isinstance(n, bool) and abs(n) < _FURTHEST_PX for n in pair
        )  # fmt: skip

    if not isinstance(value, dict):
        raise UserFacingError(f"'{path}' lacks {where}.")
    for name, pair in value.items():
        if not is_place(pair):
            raise UserFacingError(f"'{path}', {where}: '{name[:40]}' is not a pair of pixels.")
    return {name: (float(x), float(y)) for name, (x, y) in value.items()}
