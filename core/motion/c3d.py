"""C3D, the motion capture studios' own file: markers only, sound and forces are left alone.

Reading is written out here rather than left to ezc3d (1.7.2), which ends the process on damaged files: of 600 copies of
a small file with one byte changed in the header or the parameters, 9 were a segmentation fault (such as 0 to 255 at
byte 668, 793 or 984).
Format: https://www.c3d.org/HTML, sections "The header", "Parameters" and "3D data".
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.length_units import MM_PER_UNIT, mm_per

_BLOCK = 512
_INTEL, _DEC, _MIPS = 84, 85, 86
_HIGHEST_RATE_HZ = 10_000.0
# a count that a header's 16 bits cannot hold
_TOO_MANY = 65_535


class _Damaged(Exception):
    """What is wrong with the file, as the end of a sentence that begins with its name."""


def write_c3d(path: str | Path, positions: np.ndarray, names: Sequence[str], rate_hz: float) -> None:
    """Write markers, float32 millimetres; a NaN marker becomes a missing one (residual −1).

    positions : shape (F, K, 3), mm; names : K; rate_hz : frames a second

    Raises `UserFacingError` when the file cannot be written.
    """
    import ezc3d

    positions = np.asarray(positions, np.float32)
    if positions.ndim != 3 or positions.shape[1:] != (len(names), 3) or 0 in positions.shape:
        raise ValueError(f"positions have shape {positions.shape}; {len(names)} markers need (F, {len(names)}, 3)")
    missing = ~np.isfinite(positions).all(axis=2)
    points = np.ones((4, len(names), len(positions)))
    points[:3] = np.where(missing[:, :, None], 0.0, positions).transpose(2, 1, 0)
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [rate_hz]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(names)
    file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    if len(positions) >= _TOO_MANY:
        # the header counts in 16 bits; here the frames are counted in two signed words
        low, high = (int(word) for word in np.array([len(positions)], "<u4").view("<i2"))
        file.add_parameter("TRIAL", "ACTUAL_START_FIELD", [1, 0])
        file.add_parameter("TRIAL", "ACTUAL_END_FIELD", [low, high])
    file["data"]["points"] = points
    file["data"]["meta_points"]["residuals"] = np.where(missing, -1.0, 0.0).T[None]
    file["data"]["meta_points"]["camera_masks"] = np.zeros((7, len(names), len(positions)), bool)
    with swapped_in(path) as beside:
        # ezc3d says nothing where it may not write or the disk is full, so both are asked for here
        beside.touch()
        file.write(str(beside))
        if beside.stat().st_size < 16 * len(names) * len(positions):
            raise OSError("the disk is full")


def read_c3d(path: str | Path, unit: str | None = None) -> tuple[np.ndarray, tuple[str, ...], float]:
    """Return positions (float32, shape (F, K, 3), mm, NaN where missing), marker names and frames a second.

    Reads integer and float files of Intel, DEC and MIPS machines. A label that repeats gets a number.

    unit : a key of `core.motion.length_units.MM_PER_UNIT`; it wins over the file's own, and a file without one is in mm

    Raises `UserFacingError` for what is missing, empty, truncated, or no C3D of a known unit.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    try:
        return _read(data, None if unit is None else mm_per(unit, path))
    except _Damaged as damage:
        raise UserFacingError(f"The C3D file '{path}' {damage}.") from damage


@dataclass(frozen=True)
class _Layout:
    n_points: int
    n_analog: int
    n_frames: int
    scale: float
    start: int
    rate_hz: float


def _read(data: bytes, mm: float | None) -> tuple[np.ndarray, tuple[str, ...], float]:
    if not data:
        raise _Damaged("is empty")
    if len(data) < 2 * _BLOCK or data[1] != 0x50 or data[0] < 1:
        raise _Damaged("is not C3D, or it is truncated")
    section = (data[0] - 1) * _BLOCK
    if section + 4 > len(data):
        raise _Damaged("is truncated")
    machine = data[section + 3]
    if machine not in (_INTEL, _DEC, _MIPS):
        raise _Damaged("names no machine that is known")
    parameters = _parameters(data, section, machine)
    layout = _layout(data, parameters, machine)
    if mm is None:
        unit = (_texts(parameters.get(("POINT", "UNITS")))[:1] or [""])[0]
        mm = MM_PER_UNIT.get(unit.lower(), None if unit else 1.0)
    if mm is None:
        raise _Damaged(f"is measured in '{unit}', which is no unit of length that is known")
    return _positions(data, layout, machine, mm), _names(parameters, layout.n_points), layout.rate_hz


def _layout(data: bytes, parameters: dict, machine: int) -> _Layout:
    order = ">" if machine == _MIPS else "<"
    n_points, n_analog, first, last = struct.unpack_from(f"{order}4H", data, 2)
    (start_block,) = struct.unpack_from(f"{order}H", data, 16)
    scale, rate_hz = (_floats(data[at : at + 4], machine)[0] for at in (12, 20))
    n_frames = last - first + 1
    if last == _TOO_MANY:
        n_frames = _long_count(parameters, n_frames)
    if not 0 < rate_hz <= _HIGHEST_RATE_HZ:
        raise _Damaged(f"gives a rate of {rate_hz:g} Hz")
    if not np.isfinite(scale) or start_block < 2:
        raise _Damaged("has a damaged header")
    if n_points == 0 or n_frames <= 0:
        raise _Damaged("holds no markers")
    return _Layout(n_points, n_analog, n_frames, float(scale), (start_block - 1) * _BLOCK, float(rate_hz))


def _long_count(parameters: dict, n_frames: int) -> int:
    """Frames of a take longer than the header can say: two 16-bit words each, or a float."""
    ends = [parameters.get(("TRIAL", name)) for name in ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD")]
    if all(isinstance(end, np.ndarray) and end.size >= 2 for end in ends):
        first, last = ((int(end[0]) & 0xFFFF) + 65_536 * (int(end[1]) & 0xFFFF) for end in ends)
        return last - first + 1
    count = parameters.get(("POINT", "FRAMES"))
    if isinstance(count, np.ndarray) and count.size and np.isfinite(count[0]) and count[0] > n_frames:
        return int(count[0])
    return n_frames


def _positions(data: bytes, layout: _Layout, machine: int, mm: float) -> np.ndarray:
    is_float = layout.scale < 0
    words = 4 * layout.n_points + layout.n_analog
    frame_bytes = words * (4 if is_float else 2)
    n_there = max(len(data) - layout.start, 0) // frame_bytes
    if n_there < layout.n_frames:
        raise _Damaged(f"is truncated: {n_there} of its {layout.n_frames} frames are there")
    raw = data[layout.start : layout.start + layout.n_frames * frame_bytes]
    if is_float:
        values = _floats(raw, machine)
        factor = mm
    else:
        values = np.frombuffer(raw, ">i2" if machine == _MIPS else "<i2").astype(np.float32)
        factor = mm * layout.scale
    points = values.reshape(layout.n_frames, words)[:, : 4 * layout.n_points].reshape(layout.n_frames, -1, 4)
    with np.errstate(over="ignore", invalid="ignore"):
        positions = points[:, :, :3] * np.float32(factor)
    if np.isinf(positions).any():
        frame = int(np.isinf(positions).any(axis=(1, 2)).argmax())
        raise _Damaged(f"holds an infinite coordinate in frame {frame}")
    positions[(points[:, :, 3] < 0) | np.isnan(positions).any(axis=2)] = np.nan
    return positions


def _floats(raw: bytes, machine: int) -> np.ndarray:
    """Return float32 numbers as the machine wrote them; DEC swaps the words and counts exponents from elsewhere."""
    if machine == _MIPS:
        return np.frombuffer(raw, ">f4").astype(np.float32)
    if machine == _DEC:
        return np.frombuffer(raw, "<u2").reshape(-1, 2)[:, ::-1].copy().view("<f4").ravel() / np.float32(4)
    return np.frombuffer(raw, "<f4")


def _parameters(data: bytes, section: int, machine: int) -> dict[tuple[str, str], np.ndarray | list[str]]:
    """Return the parameter section as (group, name) to numbers or texts; unknown types are passed over."""
    order = ">" if machine == _MIPS else "<"
    groups: dict[int, str] = {}
    found: list[tuple[int, str, np.ndarray | list[str]]] = []
    at = section + 4
    try:
        while at < len(data):
            length, group = struct.unpack_from("bb", data, at)
            length = abs(length)
            if length == 0 or group == 0:
                break
            name = data[at + 2 : at + 2 + length].decode("latin-1").strip().upper()
            pointer = at + 2 + length
            (step,) = struct.unpack_from(f"{order}H", data, pointer)
            if group < 0:
                groups[-group] = name
            else:
                value = _value(data, pointer + 2, machine, order)
                if value is not None:
                    found.append((group, name, value))
            if step == 0:
                break
            at = pointer + step
    except (struct.error, IndexError) as error:
        raise _Damaged("has a damaged list of parameters") from error
    return {(groups.get(group, ""), name): value for group, name, value in found}


def _value(data: bytes, at: int, machine: int, order: str) -> np.ndarray | list[str] | None:
    kind, n_dims = struct.unpack_from("bB", data, at)
    dims = data[at + 2 : at + 2 + n_dims]
    count = 1
    for n in dims:
        count *= n
    size = count * abs(kind)
    raw = data[at + 2 + n_dims : at + 2 + n_dims + size]
    if kind not in (-1, 1, 2, 4) or len(raw) < size:
        return None
    if kind == -1:
        width = dims[0] if n_dims else 1
        text = raw.decode("utf-8", "replace")
        if len(text) != len(raw):
            text = raw.decode("latin-1")
        return [text[i : i + width].strip(" \0") for i in range(0, len(text), width)] if width else []
    if kind == 4:
        return _floats(raw, machine)
    return np.frombuffer(raw, "i1" if kind == 1 else f"{order}i2")


def _texts(value: np.ndarray | list[str] | None) -> list[str]:
    return value if isinstance(value, list) else []


def _names(parameters: dict, n_points: int) -> tuple[str, ...]:
    """Return one unique name a marker, from LABELS, LABELS2, ... as far as they go."""
    labels: list[str] = []
    for suffix in ("", *map(str, range(2, 2 + n_points // 255))):
        labels += _texts(parameters.get(("POINT", f"LABELS{suffix}")))
    names: list[str] = []
    seen: dict[str, int] = {}
    for k in range(n_points):
        label = (labels[k] if k < len(labels) else "") or f"point_{k}"
        seen[label] = seen.get(label, 0) + 1
        names.append(label if seen[label] == 1 else f"{label}_{seen[label]}")
    return tuple(names)
