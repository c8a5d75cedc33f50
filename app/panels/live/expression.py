"""Four emotions on buttons and keys, how strongly they are shown, and how far the face has come."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QGridLayout, QHBoxLayout, QProgressBar, QPushButton, QSlider, QWidget

from app.icons import dot
from app.panels.pane import label
from app.texts import live as texts
from app.theme import STEP, theme
from core.iface.live import NEUTRAL
from core.speech.emotion import EMOTIONS

_FULL = 100


class ExpressionChoice(QWidget):
    """``asked(emotion, intensity)`` : the user wants the face to go there."""

    asked = Signal(str, float)

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(STEP // 2)
        self._group = QButtonGroup(self)
        self._bars: dict[str, QProgressBar] = {}
        for e, emotion in enumerate(EMOTIONS):
            button = QPushButton(texts.EMOTION_BUTTON.format(key=e + 1, emotion=emotion), checkable=True)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            self._group.addButton(button, e)
            bar = QProgressBar(maximum=_FULL, textVisible=False)
            self._bars[emotion] = bar
            grid.addWidget(button, 2 * (e // 2), e % 2)
            grid.addWidget(bar, 2 * (e // 2) + 1, e % 2)
        self._group.button(0).setChecked(True)
        self._group.idClicked.connect(lambda _: self._tell())
        self.slider = QSlider(Qt.Orientation.Horizontal, maximum=_FULL, value=_FULL, toolTip=texts.INTENSITY_TIP)
        self.slider.setPageStep(10)
        self._value = label()
        self._value.setFixedWidth(5 * STEP)
        self._value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.slider.valueChanged.connect(lambda _: self._tell())
        row = QHBoxLayout()
        row.addWidget(label(texts.INTENSITY, tip=texts.INTENSITY_TIP))
        row.addWidget(self.slider, 1)
        row.addWidget(self._value)
        grid.addLayout(row, 4, 0, 1, 2)
        self.renew()
        self.offer(EMOTIONS)
        self._tell()

    @property
    def emotion(self) -> str:
        """The emotion that is asked for."""
        return EMOTIONS[self._group.checkedId()]

    @property
    def intensity(self) -> float:
        """How strongly, 0..1."""
        return self.slider.value() / _FULL

    def button(self, emotion: str) -> QPushButton:
        """Return the button of an emotion."""
        return self._group.button(EMOTIONS.index(emotion))

    def choose(self, emotion: str, intensity: float | None = None) -> None:
        """Ask for an emotion, as a click on its button does, at an intensity of 0..1 or that of the slider."""
        if intensity is not None:
            self.slider.setValue(round(_FULL * intensity))
        if self.button(emotion).isEnabled():
            self.button(emotion).setChecked(True)
            self._tell()

    def offer(self, expressions: tuple[str, ...]) -> None:
        """Enable what the face has learned; neutral it always has."""
        for e, emotion in enumerate(EMOTIONS):
            has = emotion == NEUTRAL or emotion in expressions
            tip = texts.EMOTION_TIP if has else texts.NOT_LEARNED
            self._group.button(e).setEnabled(has)
            self._group.button(e).setToolTip(tip.format(emotion=emotion, key=e + 1))
        if not self.button(self.emotion).isEnabled():
            self.choose(NEUTRAL)

    def show_strengths(self, strengths: Mapping[str, float]) -> None:
        """Show how far the face has come; what is left of 1 is neutral."""
        rest = 1.0 - sum(strengths.values())
        for emotion, bar in self._bars.items():
            bar.setValue(round(_FULL * (rest if emotion == NEUTRAL else strengths.get(emotion, 0.0))))

    def renew(self) -> None:
        """Paint the emotions in their colours of the moment."""
        for e, emotion in enumerate(EMOTIONS):
            css = theme().emotion[emotion]
            self._group.button(e).setIcon(dot(css, 6))
            self._group.button(e).setStyleSheet(f"QPushButton:checked {{ border-color: {css}; color: {css}; }}")
            self._bars[emotion].setStyleSheet(f"QProgressBar::chunk {{ background: {css}; }}")

    def _tell(self) -> None:
        self._value.setText(texts.PER_CENT.format(value=self.slider.value()))
        self.slider.setEnabled(self.emotion != NEUTRAL)
        self.asked.emit(self.emotion, self.intensity)
