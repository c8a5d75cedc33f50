"""Where tracking begins: clicks on mouth and eye corners lay the generic face on the first picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.tracking.face_model import CLICKED, FaceModel

SMALLEST_PX = 16.0
_LEAST_LIKENESS = 0.75  # of the clicks to the face, squared correlation; a turned or uncommon face has over 0.9


@dataclass(frozen=True)
class Placement:
    """A similarity from face to picture: ``point_px = scale · turn · point_mm + shift``, shapes (2, 2) and (2,)."""

    scale: float
    turn: np.ndarray
    shift: np.ndarray

    def pixels(self, points_mm: np.ndarray) -> np.ndarray:
        """Face to picture, shape (..., 2)."""
        return self.scale * points_mm @ self.turn.T + self.shift

    def millimetres(self, points_px: np.ndarray) -> np.ndarray:
        """Picture to face, shape (..., 2)."""
        return (points_px - self.shift) @ self.turn / self.scale

    def shrunk(self, share: float) -> Placement:
        """The same in pictures of that share of the size; a point at x is then at share · x."""
        return Placement(self.scale * share, self.turn, self.shift * share)


def named_clicks(points: Sequence[tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Name clicks in the order of `CLICKED`: mouth corners, then outer eye corners, each time the picture's left first.

    A pair in the other order is the same pair: which is which follows from where the eyes are, or the picture's up.
    Raises `UserFacingError` unless there are two points or four.
    """
    if len(points) not in (2, 4):
        raise UserFacingError(
            f"Tracking begins with 2 or 4 points, and {len(points)} were given.",
            "Give both mouth corners, and if you can both outer eye corners: x,y;x,y;x,y;x,y.",
        )
    pairs = [np.array(points[i : i + 2], float) for i in range(0, len(points), 2)]
    up = pairs[1].mean(axis=0) - pairs[0].mean(axis=0) if len(pairs) == 2 else np.array([0.0, -1.0])
    right = np.array([-up[1], up[0]])
    ordered = [pair if (pair[1] - pair[0]) @ right >= 0 else pair[::-1] for pair in pairs]
    return {name: (float(x), float(y)) for name, (x, y) in zip(CLICKED, np.concatenate(ordered))}


def placed(model: FaceModel, clicks: Mapping[str, tuple[float, float]], size_px: tuple[int, int]) -> Placement:
    """Lay the face's points on the clicks by translation, scale and rotation (least squares).

    clicks : landmark to x, y in pixels, two or more; landmarks that the face lacks are left out
    size_px : width and height of the picture
    Raises `UserFacingError` for clicks beside the picture, too close together, or not laid out as on a face.
    """
    used = {name: at for name, at in clicks.items() if name in model.landmarks}
    width, height = size_px
    for x, y in used.values():
        if not (0 <= x < width and 0 <= y < height):
            raise UserFacingError(f"The point {x:g},{y:g} lies outside of the picture of {width} by {height} pixels.")
    if len(used) < 2:
        raise UserFacingError("Two points of the face are needed to begin with, and the database knows fewer of them.")
    target = np.array(list(used.values()), float)
    apart = max(float(np.linalg.norm(a - b)) for a in target for b in target)
    if apart < SMALLEST_PX:
        raise UserFacingError(f"The points lie only {apart:.0f} pixels apart; a face is tracked from "
                              f"{SMALLEST_PX:.0f} pixels on.", "Use a closer or larger picture.")  # fmt: skip
    source = model.seen[[model.landmarks[name] for name in used]]
    # a similarity of the plane is a product of complex numbers
    a, b = ((points - points.mean(axis=0)) @ [1.0, 1.0j] for points in (source, target))
    likeness = abs(np.vdot(a, b)) ** 2 / (np.vdot(a, a).real * np.vdot(b, b).real)
    if likeness < _LEAST_LIKENESS:
        raise UserFacingError("The points do not lie as the corners of a mouth and of eyes do.",
                              "Click both mouth corners, then both outer eye corners.")  # fmt: skip
    factor = np.vdot(a, b) / np.vdot(a, a).real
    turn = np.array([[factor.real, -factor.imag], [factor.imag, factor.real]]) / abs(factor)
    scale = float(abs(factor))
    return Placement(scale, turn, target.mean(axis=0) - scale * turn @ source.mean(axis=0))
