"""Numbered still pictures, as compositing programs take them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import check_target, swapped_in
from core.progress import SILENT, Progress

SUFFIX = ".png"
_DIGITS = 4
_PLACE = re.compile(r"#+|%0?\d*d")
_HIGHEST_COMPRESSION_THAT_IS_QUICK = "3"


def numbered(path: Path, number: int) -> Path:
    """Return the path of picture ``number``: it stands for ``####`` or ``%04d`` in the name, or before the suffix."""
    found = _PLACE.search(path.stem)
    if found is None:
        return path.with_name(f"{path.stem}.{number:0{_DIGITS}d}{path.suffix}")
    text = found[0]
    digits = len(text) if text.startswith("#") else int(text[1:-1] or 0)
    return path.with_name(f"{path.stem[: found.start()]}{number:0{digits}d}{path.stem[found.end() :]}{path.suffix}")


def write_images(
    path: Path, frames: Iterable[np.ndarray], n_frames: int, progress: Progress = SILENT, first_number: int = 0
) -> list[Path]:
    """Write each picture to a PNG of its own; return their paths.

    path : ``name.png`` or ``name.####.png``; see `numbered`
    frames : ``n_frames`` pictures, uint8, shape (height, width, 3)
    Each file appears whole or not at all. When it is cancelled or fails, those that were not there before are
    removed. Raises `UserFacingError` for what cannot be written.
    """
    check_target(numbered(path, first_number))
    written: list[Path] = []
    new: list[Path] = []
    try:
        for k, picture in enumerate(frames):
            progress.step(k / n_frames, "writing pictures")
            target = numbered(path, first_number + k)
            if not target.exists():
                new.append(target)
            write_png(target, picture)
            written.append(target)
    except BaseException:
        for target in new:
            target.unlink(missing_ok=True)
        raise
    return written


def write_png(path: Path, picture: np.ndarray) -> None:
    """Write one picture, uint8, shape (height, width, 3), whole or not at all; raises `UserFacingError`."""
    data = encode_png(picture)
    with swapped_in(path) as beside:
        beside.write_bytes(data)


def encode_png(picture: np.ndarray) -> bytes:
    """Return the PNG file of a picture, uint8, shape (height, width, 3)."""
    import av

    height, width, _ = picture.shape
    codec = av.CodecContext.create("png", "w")
    codec.width, codec.height, codec.pix_fmt = width, height, "rgb24"
    codec.time_base = Fraction(1)
    codec.options = {"compression_level": _HIGHEST_COMPRESSION_THAT_IS_QUICK}
    packets = codec.encode(av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24"))
    packets += codec.encode(None)
    data = b"".join(bytes(packet) for packet in packets)
    if not data:
        raise UserFacingError(f"A picture of {width} by {height} pixels cannot be written as PNG.")
    return data
