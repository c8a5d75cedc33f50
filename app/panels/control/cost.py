"""What the motion on show costs, in all and in the selected utterance."""

from __future__ import annotations

from PySide6.QtWidgets import QVBoxLayout, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.pane import label
from app.theme import STEP


class CostLines(QWidget):
    """Two lines below the button."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(STEP)
        self.whole = label("", "plain", texts.COST_TIP)
        self.slot = label("", "small", texts.COST_SLOT_TIP)
        self.slot.setMinimumHeight(4 * STEP)
        column.addWidget(self.whole)
        column.addWidget(self.slot)
        authoring.document.changed.connect(self.renew)
        authoring.view.slot_selected.connect(self.renew)

    def renew(self, *_: object) -> None:
        """Show the cost of the path on show, where there is one."""
        document, slot = self._authoring.document, self._authoring.view.slot
        path = document.path
        if path is None or document.database is None:
            self.whole.setText(texts.NO_COST if document.answer is not None else "")
            self.slot.setText("")
            return
        unit = document.cost_unit
        self.whole.setText((texts.COST_PROVED if path.is_optimal else texts.COST).format(cost=path.cost / unit))
        if slot is None or slot >= len(path.nodes):
            self.slot.setText("")
            return
        terms = path.observation[slot] / unit, path.transition[slot] / unit, path.emotion[slot] / unit
        self.slot.setText(texts.COST_SLOT.format(
            phone=document.speech.transcript.phonemes[slot].phone, node=document.database.nodes.name(path.nodes[slot]),
            cost=sum(terms), observation=terms[0], transition=terms[1], emotion=terms[2],
        ))  # fmt: skip
