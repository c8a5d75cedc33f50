"""What signs and colours of the map mean, in one line."""

from __future__ import annotations

from PySide6.QtGui import QColor
from PySide6.QtWidgets import QLabel, QSizePolicy

from app import texts
from app.panels.isomap.colouring import ColourBy, Colouring
from app.panels.isomap.controls import SIGNS
from app.theme import theme
from core.speech.emotion import EMOTIONS

_SCALE_CELLS = 8


class MapLegend(QLabel):
    """A line of rich text that gives way."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "small")
        self.setToolTip(texts.LEGEND_TIP)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def show_legend(self, by: ColourBy, colouring: Colouring | None) -> None:
        """Explain the colours of ``colouring``; emotions keep their symbols whatever the colours tell."""
        if colouring is not None and colouring.low:
            steps = [round(i * (len(colouring.colours) - 1) / (_SCALE_CELLS - 1)) for i in range(_SCALE_CELLS)]
            cells = "".join(_coloured("█", QColor.fromRgbF(*colouring.colours[i]).name()) for i in steps)
            colours = [f"{colouring.low}&nbsp;{cells}&nbsp;{colouring.high}"]
        elif by is ColourBy.SENTENCE:
            colours = [texts.COLOUR_TIPS[by.value]]
        else:
            colours = [f"{_coloured(SIGNS[e], theme().emotion[e])}&nbsp;{e}" for e in EMOTIONS]
        marks = [
            f"{_coloured('◆', theme().accent)}&nbsp;{texts.LEGEND_USED}", f"○&nbsp;{texts.LEGEND_TIME}",
            f"{_coloured('◎', theme().accent)}&nbsp;{texts.LEGEND_CONTEXT}", f"⊕&nbsp;{texts.LEGEND_PICKED}",
        ]  # fmt: skip
        self.setText("&nbsp;&nbsp; ".join([*colours, *marks]))


def _coloured(sign: str, css: str) -> str:
    return f'<span style="color:{css}">{sign}</span>'
