"""Pictures in rows with words beside and under them: film strips, and figures of many faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.media.lettering import fitting, text_width_px, write_text

Colour = tuple[int, int, int]
_GAP_PX, _MARGIN_PX = 4, 12
_TITLE_PX, _LABEL_PX, _SMALL_PX = 20, 17, 13
_LIGHT_FROM = 128.0


@dataclass(frozen=True)
class PictureRow:
    """Pictures side by side.

    cells : uint8, each of one shape (height, width, 3)
    label : what the row is, left of it; captions, notes : one under each cell, the second one smaller; may be none
    """

    cells: Sequence[np.ndarray]
    label: str = ""
    captions: Sequence[str] = ()
    notes: Sequence[str] = ()


def picture_grid(rows: Sequence[PictureRow], title: str = "", ground: Colour = (26, 28, 31)) -> np.ndarray:
    """Return one picture of all rows, uint8, shape (height, width, 3); rows with fewer cells stand left.

    ground : red, green, blue, 0..255, behind and between the cells; words are dark on a light one
    """
    high, wide = rows[0].cells[0].shape[:2]
    if any(cell.shape != (high, wide, 3) for row in rows for cell in row.cells):
        raise ValueError("cells of one grid have one shape")
    text, dim = _inks(ground)
    label_px = max(text_width_px(row.label, _LABEL_PX) for row in rows)
    label_px += _MARGIN_PX if label_px else 0
    columns = max(len(row.cells) for row in rows)
    width = 2 * _MARGIN_PX + label_px + columns * wide + (columns - 1) * _GAP_PX
    top = _MARGIN_PX + (_TITLE_PX + _MARGIN_PX if title else 0)
    heights = [high + _words_height_px(row) + _GAP_PX for row in rows]
    picture = np.empty((top + sum(heights) - _GAP_PX + _MARGIN_PX, width, 3), np.uint8)
    picture[:] = ground
    if title:
        write_text(picture, fitting(title, _TITLE_PX, width - 2 * _MARGIN_PX), _MARGIN_PX, _MARGIN_PX + _TITLE_PX - 3,
                   _TITLE_PX, text)  # fmt: skip
    for row, height in zip(rows, heights):
        write_text(picture, row.label, _MARGIN_PX, top + high // 2 + _LABEL_PX // 3, _LABEL_PX, text)
        for c, cell in enumerate(row.cells):
            left = _MARGIN_PX + label_px + c * (wide + _GAP_PX)
            picture[top : top + high, left : left + wide] = cell
            baseline = top + high
            for words, size, colour in ((row.captions, _LABEL_PX, text), (row.notes, _SMALL_PX, dim)):
                if words:
                    baseline += size + _GAP_PX
                    write_text(picture, fitting(words[c], size, wide), left + wide // 2, baseline, size, colour, True)
        top += height
    return picture


def _words_height_px(row: PictureRow) -> int:
    lines = [size + _GAP_PX for words, size in ((row.captions, _LABEL_PX), (row.notes, _SMALL_PX)) if words]
    return sum(lines) + 2 * _GAP_PX if lines else 0


def _inks(ground: Colour) -> tuple[Colour, Colour]:
    """Colours of words and of lesser words on a ground."""
    is_light = float(np.dot(ground, (0.299, 0.587, 0.114))) >= _LIGHT_FROM
    return ((38, 40, 43), (109, 113, 122)) if is_light else ((217, 219, 223), (141, 146, 155))
