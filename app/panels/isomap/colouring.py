"""What the colour of a dot says: a few colours, and which of them each frame has."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
import pyqtgraph as pg

from app import texts
from app.panels.isomap.shown_map import ShownMap
from app.theme import colour, theme
from core.speech.emotion import EMOTIONS

_STEPS = 24
_HUES = 12
_ALARM = "#ff4d3d"
# the darkest colours of a map of colours do not show on a dark canvas
_VISIBLE = 0.22
# Suspicion from which on a node is worth watching, and from which on it is as bright as can be.
_SUSPICION_RANGE = 1.5, 60.0


class ColourBy(Enum):
    """What the dots can tell."""

    EMOTION = "emotion"
    TIME = "time"
    SENTENCE = "sentence"
    SUSPICION = "suspicion"
    PRICE = "price"


@dataclass(frozen=True)
class Colouring:
    """Colours of the frames of a map.

    colours : float64, shape (n_colours, 3), 0..1; few, since each is drawn once and then stamped
    index : int, shape (n_frames,)
    low, high : what the first and the last colour stand for; "" where the colours are no scale
    """

    colours: np.ndarray
    index: np.ndarray
    low: str = ""
    high: str = ""


def by_emotion(shown: ShownMap) -> Colouring:
    """The emotion it was captured in."""
    return Colouring(np.array([colour(theme().emotion[e]).getRgbF()[:3] for e in EMOTIONS]), shown.emotion)


def by_time(shown: ShownMap) -> Colouring:
    """Relative time within the node."""
    return _scale(pg.colormap.get("viridis"), shown.relative_time, texts.SCALE_START, texts.SCALE_END, _VISIBLE)


def by_sentence(shown: ShownMap) -> Colouring:
    """Which sentence it comes from; hues repeat after twelve sentences."""
    hues = np.arange(_HUES) / _HUES
    lightness, swing = 0.62, 0.28
    colours = lightness + swing * np.cos(2 * np.pi * (hues[:, None] - np.array([0.0, 1 / 3, 2 / 3])))
    # neighbours in the database get hues far apart
    return Colouring(colours, (shown.database.nodes.sentence[shown.node] * 5) % _HUES)


def by_suspicion(shown: ShownMap, score: np.ndarray) -> Colouring:
    """How much speaks against the node; ``score`` by row of the database."""
    low, high = _SUSPICION_RANGE
    share = np.log(np.maximum(score, low) / low) / np.log(high / low)
    alarm = pg.ColorMap([0.0, 0.3, 1.0], [colour(css) for css in (theme().dim, theme().accent, _ALARM)])
    return _scale(alarm, share[shown.node], texts.SCALE_SOUND, texts.SCALE_SUSPECT)


def by_price(shown: ShownMap, price: np.ndarray) -> Colouring:
    """What forcing the node into the selected slot adds; ``price`` by row, in units of PNT, infinite if impossible."""
    finite = price[shown.rows][np.isfinite(price[shown.rows])]
    dearest = max(float(np.quantile(finite, 0.95)), 1e-6) if len(finite) else 1.0
    share = np.sqrt(np.clip(np.where(np.isfinite(price), price, dearest) / dearest, 0.0, 1.0))
    return _scale(
        pg.colormap.get("cividis"), 1.0 - share[shown.node], texts.SCALE_PRICE.format(price=dearest), texts.SCALE_FREE
    )


def colouring(shown: ShownMap, by: ColourBy, score: np.ndarray | None, price: np.ndarray | None) -> Colouring:
    """Return the colours asked for; by emotion as long as suspicion or prices are not known."""
    if by is ColourBy.SUSPICION and score is not None:
        return by_suspicion(shown, score)
    if by is ColourBy.PRICE and price is not None:
        return by_price(shown, price)
    plain: dict[ColourBy, Callable[[ShownMap], Colouring]] = {ColourBy.TIME: by_time, ColourBy.SENTENCE: by_sentence}
    return plain.get(by, by_emotion)(shown)


def _scale(colours: pg.ColorMap, share: np.ndarray, low: str, high: str, darkest: float = 0.0) -> Colouring:
    """Spread ``share``, 0 to 1, over a map of colours, of which the part below ``darkest`` is left out."""
    steps = colours.map(np.linspace(darkest, 1.0, _STEPS), mode="float")[:, :3]
    index = np.round(np.clip(share, 0.0, 1.0) * (_STEPS - 1)).astype(int)
    return Colouring(np.asarray(steps, float), index, low, high)
