"""Colours of the emotions: the paper's, or a set that colour-blind eyes can tell apart; the same everywhere."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.settings import window_settings
from app.theme import DARK, LIGHT, set_emotion_colours, theme

PAPER, OKABE_ITO = "paper", "okabe-ito"
_SETTING = "emotion_colours"
# Okabe and Ito 2008; on light ground the darker of their two blues, and neutral dark
_OKABE_ITO = {
    "dark": {"neutral": "#d0d2d6", "happiness": "#56b4e9", "anger": "#d55e00", "sadness": "#009e73"},
    "light": {"neutral": "#4a4d52", "happiness": "#0072b2", "anger": "#d55e00", "sadness": "#009e73"},
}


class EmotionColours(QObject):
    """Which colours are chosen; remembered by the window's settings.

    changed() : whoever keeps colours, of the emotions or of the theme, paints anew
    """

    changed = Signal()

    @property
    def name(self) -> str:
        """`PAPER` or `OKABE_ITO`, as remembered."""
        name = window_settings().value(_SETTING, PAPER)
        return name if name in (PAPER, OKABE_ITO) else PAPER

    def choose(self, name: str) -> None:
        """Take other colours and remember them."""
        window_settings().setValue(_SETTING, name)
        self.put_on()
        self.changed.emit()

    def put_on(self) -> None:
        """Dress the theme in the remembered colours."""
        light = theme().ground == LIGHT.ground
        paper = (LIGHT if light else DARK).emotion
        set_emotion_colours(paper if self.name == PAPER else _OKABE_ITO["light" if light else "dark"])


emotion_colours = EmotionColours()
