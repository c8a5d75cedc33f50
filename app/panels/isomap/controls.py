"""The row above the map: what a drag does, what colours tell, which emotions are shown, how splats shine."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QMenu, QSlider, QToolButton, QWidget

from app import texts
from app.emotion_colours import OKABE_ITO, PAPER, emotion_colours
from app.panels.isomap.canvas import BOX, LASSO, MOVE
from app.panels.isomap.colouring import ColourBy
from app.panels.pane import Choice
from app.theme import STEP, theme
from core.speech.emotion import EMOTIONS

SIGNS = {"neutral": "●", "happiness": "▲", "anger": "■", "sadness": "▼"}
_LEAST_LETTERS = 8
_SIGMA_PX = 2, 32
_SLIDER_PX = 7 * STEP
# the slider of ρ is logarithmic: an eighth to eight times the ρ that suits the map, in steps of a tenth of an octave
_RHO_STEPS = 30
_STEPS_AN_OCTAVE = 10


class MapControls(QWidget):
    """Says what was asked for; shows nothing itself.

    tool_chosen(tool), colours_chosen(ColourBy), filter_changed(), splats_changed(sigma_px, rho_gain)
    """

    tool_chosen = Signal(str)
    colours_chosen = Signal(object)
    filter_changed = Signal()
    splats_changed = Signal(float, float)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(3 * STEP + 4)
        row = QHBoxLayout(self)
        row.setContentsMargins(STEP, 0, STEP, 0)
        row.setSpacing(STEP // 2)
        self.tool = Choice([
            (BOX, texts.MAP_BOX, texts.MAP_BOX_TIP), (LASSO, texts.MAP_LASSO, texts.MAP_LASSO_TIP),
            (MOVE, texts.MAP_MOVE, texts.MAP_MOVE_TIP),
        ])  # fmt: skip
        self.tool.group.idClicked.connect(lambda _: self.tool_chosen.emit(self.tool.key))
        self.colour = QComboBox(toolTip=texts.COLOUR_TIP)
        self.colour.setProperty("role", "small")
        self.colour.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.colour.setMinimumContentsLength(_LEAST_LETTERS)
        self.colour.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for i, by in enumerate(ColourBy):
            self.colour.addItem(texts.COLOUR_BY[by.value], by)
            self.colour.setItemData(i, texts.COLOUR_TIPS[by.value], Qt.ItemDataRole.ToolTipRole)
        self.colour.activated.connect(lambda i: self.colours_chosen.emit(self.colour.itemData(i)))
        row.addWidget(self.tool)
        row.addWidget(self.colour)
        filters = QHBoxLayout()
        filters.setSpacing(0)
        self.filters = {emotion: self._filter(emotion) for emotion in EMOTIONS}
        for button in self.filters.values():
            filters.addWidget(button)
        self.palette_button = QToolButton(text="▾", toolTip=texts.EMOTION_COLOURS_TIP)
        self.palette_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.palette_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.palette_button.setMenu(self._palette_menu())
        filters.addWidget(self.palette_button)
        row.addLayout(filters)
        row.addStretch(1)
        self.sigma, self.rho = self._slider(*_SIGMA_PX, 9), self._slider(-_RHO_STEPS, _RHO_STEPS, 0)
        for name, slider in ((texts.SIGMA, self.sigma), (texts.RHO, self.rho)):
            word = QLabel(name)
            word.setProperty("role", "small")
            row.addWidget(word)
            row.addWidget(slider)
            slider.valueChanged.connect(self._say_splats)
        self._say_splats()
        self.show_palette()

    @property
    def colour_by(self) -> ColourBy:
        """What the colours tell."""
        return self.colour.currentData()

    @property
    def emotions(self) -> list[bool]:
        """Which of `EMOTIONS` are shown."""
        return [self.filters[emotion].isChecked() for emotion in EMOTIONS]

    def show_palette(self) -> None:
        """Paint the signs in the colours of the emotions."""
        for emotion, button in self.filters.items():
            button.setStyleSheet(
                f"QToolButton {{ color: {theme().line}; }} QToolButton:checked {{ color: {theme().emotion[emotion]}; }}"
            )
        for name, action in self._palettes.items():
            action.setChecked(name == emotion_colours.name)

    def _filter(self, emotion: str) -> QToolButton:
        button = QToolButton(text=SIGNS[emotion], checkable=True, checked=True)
        button.setToolTip(texts.FILTER_TIP.format(emotion=emotion))
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.clicked.connect(lambda _=False: self.filter_changed.emit())
        return button

    def _palette_menu(self) -> QMenu:
        menu = QMenu(self)
        self._palettes = {}
        for name in (PAPER, OKABE_ITO):
            action = menu.addAction(texts.EMOTION_COLOURS[name])
            action.setCheckable(True)
            action.triggered.connect(lambda _=False, name=name: emotion_colours.choose(name))
            self._palettes[name] = action
        return menu

    def _slider(self, low: int, high: int, value: int) -> QSlider:
        slider = QSlider(Qt.Orientation.Horizontal, minimum=low, maximum=high, value=value)
        slider.setFixedWidth(_SLIDER_PX)
        return slider

    def _say_splats(self) -> None:
        self.sigma.setToolTip(texts.SIGMA_TIP.format(sigma=self.sigma.value()))
        self.splats_changed.emit(float(self.sigma.value()), 2.0 ** (self.rho.value() / _STEPS_AN_OCTAVE))
