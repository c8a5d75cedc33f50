"""A face that was lost, looked for in all of a picture."""

from __future__ import annotations

import numpy as np

# The face is made this wide before it is looked for; that is enough to know it by, and quick.
_COARSE_PX = 48
_SURE = 0.35


def found_again(sheet: np.ndarray, mask: np.ndarray, look: np.ndarray) -> np.ndarray | None:
    """Return where the middle of ``sheet`` is seen in ``look``, shape (2,), pixels; None where it is not.

    Normalised cross-correlation of coarse pictures, upright and at the size of the first picture. The face may be cut
    off by the picture's edge by up to half.

    sheet : uint8, the face of the first picture; mask : its pixels that are face; look : uint8, the picture
    """
    import cv2

    shrink = min(1.0, _COARSE_PX / sheet.shape[1])
    small, coarse, region = (_shrunk(picture, shrink) for picture in (sheet, look, mask))
    high, wide = small.shape
    room = cv2.copyMakeBorder(coarse, high // 2, high // 2, wide // 2, wide // 2, cv2.BORDER_CONSTANT, value=128)
    if float(coarse.std()) < 1.0:
        return None
    scores = cv2.matchTemplate(room, small, cv2.TM_CCOEFF_NORMED, mask=region)
    scores = np.where(np.isfinite(scores), scores, -1.0)
    row, column = np.unravel_index(int(scores.argmax()), scores.shape)
    if scores[row, column] < _SURE:
        return None
    corner = np.array([column - wide // 2, row - high // 2], float)
    return (corner + np.array([wide, high]) / 2) / shrink


def _shrunk(picture: np.ndarray, share: float) -> np.ndarray:
    import cv2

    size = tuple(max(4, round(n * share)) for n in picture.shape[::-1])
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
