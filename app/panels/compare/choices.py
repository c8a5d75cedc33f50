"""Who is compared with whom: two lists of engines, with the capture where there is one."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QToolButton, QWidget

from app.panels.compare.faces import Swatch
from app.panels.pane import label
from app.texts import compare as texts
from app.theme import STEP
from core.evaluation.side_by_side import CAPTURED
from core.synthesis.registry import DEFAULT_ENGINE, ENGINES

_WIDTH_PX = 208
_BESIDE_SEARCHES = "animeme"


class EngineChoices(QWidget):
    """A and B, which always differ.

    changed() : somebody else is to be compared
    """

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.one, self.other = _engines(texts.ONE_TIP), _engines(texts.OTHER_TIP)
        self.swap_button = QToolButton(text="⇄", toolTip=texts.SWAP_TIP)
        self.swap_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.swap_button.clicked.connect(self.swap)
        self._before = 0, 0
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(STEP)
        for key, name, chosen in (("one", texts.ONE, self.one), ("other", texts.OTHER, self.other)):
            chosen.activated.connect(lambda _, chosen=chosen: self._on_chosen(chosen))
            for widget in (Swatch(key), label(name, "title"), chosen):
                row.addWidget(widget)
            if key == "one":
                row.addWidget(self.swap_button)

    @property
    def names(self) -> tuple[str, str]:
        """A and B: engines of `core.synthesis.registry`, or `core.evaluation.side_by_side.CAPTURED`."""
        return self.one.currentData(), self.other.currentData()

    def offers(self, name: str) -> bool:
        """Whether there is such an engine in the lists."""
        return self.one.findData(name) >= 0

    def choose(self, one: str, other: str) -> None:
        """Compare these two, which differ."""
        self._set(self.one.findData(one), self.other.findData(other))
        self.changed.emit()

    def swap(self) -> None:
        """Let A be B."""
        self.choose(*reversed(self.names))

    def offer_capture(self, is_there: bool) -> bool:
        """Let the capture be chosen or not; tells whether an engine had to take over from it."""
        rows = [self.one.currentIndex(), self.other.currentIndex()]
        took_over = False
        for n, chosen in enumerate((self.one, self.other)):
            row = chosen.findData(CAPTURED)
            chosen.model().item(row).setEnabled(is_there)
            chosen.setItemData(row, texts.CAPTURED_TIP if is_there else texts.CAPTURED_NONE_TIP,
                               Qt.ItemDataRole.ToolTipRole)  # fmt: skip
            if rows[n] == row and not is_there:
                beside = self.one.itemData(rows[1 - n])
                rows[n], took_over = chosen.findData(usual_beside(beside)), True
        self._set(*rows)
        return took_over

    def _set(self, one: int, other: int) -> None:
        self._before = one, other
        self.one.setCurrentIndex(one)
        self.other.setCurrentIndex(other)

    def _on_chosen(self, chosen: QComboBox) -> None:
        """Choosing what the other one is swaps them."""
        one, other = self.one.currentIndex(), self.other.currentIndex()
        if one == other:
            one, other = (one, self._before[0]) if chosen is self.one else (self._before[1], other)
        self._set(one, other)
        self.changed.emit()


def usual_beside(name: str) -> str:
    """Return the engine that another is held against where nobody chose."""
    return _BESIDE_SEARCHES if name in ENGINES and ENGINES[name].searches else DEFAULT_ENGINE


def _engines(tip: str) -> QComboBox:
    chosen = QComboBox(toolTip=tip)
    chosen.setFixedWidth(_WIDTH_PX)
    for name, kind in reversed(ENGINES.items()):
        if kind.is_offered:
            chosen.addItem(kind.title, name)
            chosen.setItemData(chosen.count() - 1, kind.tip, Qt.ItemDataRole.ToolTipRole)
    chosen.addItem(texts.CAPTURED, CAPTURED)
    return chosen
