"""Words on pictures, in a typeface that comes with OpenCV: the same on every machine, without a display."""

from __future__ import annotations

from functools import cache

import numpy as np

_FONT = "sans"
_REGULAR, _BOLD = 400, 600


def text_width_px(text: str, size_px: int, bold: bool = False) -> int:
    """Return how wide ``text`` is, in pixels."""
    import cv2

    if not text:
        return 0
    return int(cv2.getTextSize((0, 0), text, (0, 0), _face(), size_px, _BOLD if bold else _REGULAR)[2])


def fitting(text: str, size_px: int, width_px: int) -> str:
    """Return ``text``, cut to ``width_px`` pixels with three dots if it is wider."""
    if text_width_px(text, size_px) <= width_px:
        return text
    for n in range(len(text) - 1, 0, -1):
        if text_width_px(cut := f"{text[:n].rstrip()}…", size_px) <= width_px:
            return cut
    return ""


def write_text(
    picture: np.ndarray, text: str, x: int, baseline: int, size_px: int, colour: tuple[int, int, int],
    middle: bool = False, bold: bool = False,
) -> None:  # fmt: skip
    """Write one line into ``picture``, uint8, shape (height, width, 3), contiguous, in place.

    x : where the line begins, or its middle with ``middle``; baseline : the row that letters stand on
    colour : red, green, blue, 0..255
    Letters that the typeface lacks become question marks; what reaches beyond the picture is cut.
    """
    import cv2

    if not text:
        return
    left = x - text_width_px(text, size_px, bold) // 2 if middle else x
    # without a range of its own a line that meets the edge would go on in the next row
    beyond = (0, 2**20)
    cv2.putText(picture, text, (left, baseline), colour, _face(), size_px, _BOLD if bold else _REGULAR, 0, beyond)


@cache
def _face():
    import cv2

    return cv2.FontFace(_FONT)
