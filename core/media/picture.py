"""Pictures from files, such as a user's texture."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np

from core.errors import UserFacingError

LARGEST_PX = 8192


def read_picture(source: Path | BinaryIO, name: str = "") -> np.ndarray:
    """Read a PNG, JPEG or other still picture; uint8, shape (height, width, 3), top row first.

    name : what to call it in messages, when ``source`` is no path
    Raises `UserFacingError` for files that are missing, damaged, no picture, or larger than 8192 pixels a side.
    """
    import av

    shown = name or str(source)
    if isinstance(source, Path) and not source.is_file():
        raise UserFacingError(f"There is no picture '{shown}'.")
    try:
        with av.open(str(source) if isinstance(source, Path) else source) as container:
            stream = container.streams.video[0]
            if max(stream.width, stream.height) > LARGEST_PX:
                size = f"{stream.width} by {stream.height}"
                raise UserFacingError(f"The picture '{shown}' has {size} pixels; a side may have {LARGEST_PX}.")
            return next(container.decode(stream)).to_ndarray(format="rgb24")
    except (av.error.FFmpegError, StopIteration, IndexError, OSError, ValueError) as error:
        raise UserFacingError(f"'{shown}' is not a readable picture.", "Give a PNG or JPEG file.") from error
