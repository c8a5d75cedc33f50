"""Head: which markers tell the head's motion, and how much they still move once it is taken out."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QListWidget, QListWidgetItem, QPushButton, QSplitter

from app.panels.importing.captures import CaptureFacts
from app.panels.importing.draft import ImportDraft
from app.panels.importing.head_view import HeadView
from app.panels.importing.head_work import Residual, ResidualRequest, SteadyRequest, kept_markers, measure, propose
from app.panels.importing.match_view import Cloud
from app.panels.importing.page import Page, SentenceBox, themed_plot
from app.panels.pane import label
from app.texts import importing as texts
from app.theme import STEP, colour, theme
from core.importing.matching import typical_pose

_LIST_PX = 230
_PLOT_PX = 220


class HeadPage(Page):
    """Dots, a list with the same marks for the keyboard, and the residual over time."""

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__(draft, texts.HEAD, texts.HEAD_HINT, texts.FILES_FIRST)
        self._residual: Residual | None = None
        self._measured: tuple | None = None
        self._pose: tuple[CaptureFacts, np.ndarray] | None = None
        self.origin = QComboBox(toolTip=texts.ORIGIN_TIP)
        self.propose_button = QPushButton(texts.PROPOSE, toolTip=texts.PROPOSE_TIP)
        self.sentence = SentenceBox(draft)
        top = QHBoxLayout()
        top.setSpacing(STEP)
        for widget in (label(texts.ORIGIN, "plain"), self.origin, self.propose_button):
            top.addWidget(widget)
        top.addStretch(1)
        top.addWidget(label(texts.HEAD_LEGEND))
        self.body.addLayout(top)
        self.view, self.list = HeadView(), QListWidget()
        split = QSplitter(childrenCollapsible=False, handleWidth=1)
        split.addWidget(self.view)
        split.addWidget(self.list)
        split.setStretchFactor(0, 1)
        split.setSizes([3 * _LIST_PX, _LIST_PX])
        self.body.addWidget(split, 1)
        self.note = label("", "plain")
        row = QHBoxLayout()
        row.addWidget(self.note, 1)
        row.addWidget(label(texts.TAKE, "plain"))
        row.addWidget(self.sentence)
        self.body.addLayout(row)
        self.plot = themed_plot(texts.RESIDUAL)
        self.plot.setFixedHeight(_PLOT_PX)
        self.body.addWidget(self.plot)
        self.origin.activated.connect(lambda _: self.set_origin(self.origin.currentData()))
        self.propose_button.clicked.connect(self.on_propose)
        self.view.toggled.connect(self.toggle)
        self.view.origin_asked.connect(self.set_origin)
        self.list.itemChanged.connect(self._on_item)
        self.sentence.chosen.connect(lambda _: self.refresh())

    @property
    def state(self) -> str:
        """See `Page.state`."""
        plan = self.draft.plan
        if plan is None or not plan.rigid:
            return ""
        if self._residual is not None:
            return texts.STATE_HEAD.format(n=len(plan.rigid), rms=self._residual.whole_mm)
        return texts.STATE_HEAD_SHORT.format(n=len(plan.rigid))

    def refresh(self) -> None:
        """See `Page.refresh`."""
        plan, facts = self.draft.plan, self.draft.first_facts()
        self.sentence.renew()
        if facts is None:
            return
        if self._pose is None or self._pose[0] is not facts:
            self._pose = facts, typical_pose(facts.sample)
        kept = kept_markers(plan, facts.names)
        points = self._pose[1][[facts.names.index(name) for name in kept]]
        self.view.show_markers(Cloud(tuple(kept.values()), points), frozenset(plan.rigid), plan.origin)
        self._fill(tuple(kept.values()))
        if not plan.rigid and self._measured is None:
            self._measured = ()
            self.on_propose()
            return
        sentence = self.sentence.sentence
        asked = (sentence, plan.markers, plan.rigid, plan.with_scale, plan.outer_eye_mm)
        if sentence is not None and asked != self._measured:
            self._measured = asked
            request = ResidualRequest(sentence, plan)
            self.draft.jobs.start("head", texts.MEASURING_HEAD, request, measure, self._show_residual)

    def _fill(self, names: tuple[str, ...]) -> None:
        plan = self.draft.plan
        rms = {} if self._residual is None else dict(zip(self._residual.names, self._residual.rms_mm))
        self.origin.clear()
        self.origin.addItem(texts.ORIGIN_NONE, None)
        for name in names:
            self.origin.addItem(name, name)
        self.origin.setCurrentIndex(max(self.origin.findData(plan.origin), 0))
        row = self.list.currentRow()
        self.list.blockSignals(True)
        self.list.clear()
        for name in sorted(names, key=lambda n: (n not in plan.rigid, rms.get(n, 0.0))):
            item = QListWidgetItem(f"{name}   {texts.MM.format(mm=rms[name])}" if name in rms and plan.rigid else name)
            item.setData(Qt.ItemDataRole.UserRole, name)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            item.setCheckState(Qt.CheckState.Checked if name in plan.rigid else Qt.CheckState.Unchecked)
            self.list.addItem(item)
        self.list.setCurrentRow(max(row, 0))
        self.list.blockSignals(False)

    def _show_residual(self, residual: Residual) -> None:
        self._residual = residual
        times_s = np.arange(len(residual.away_mm)) / residual.rate_hz
        self.plot.clear()
        self.plot.setLabel("bottom", texts.RESIDUAL_TIME.format(name=residual.sentence))
        thin = pg.mkPen(colour(theme().dim, 0.5), width=1)
        for column in residual.away_mm.T:
            self.plot.plot(times_s, column, pen=thin)
        together = np.sqrt(np.nanmean(residual.away_mm**2, axis=1))
        self.plot.plot(times_s, together, pen=pg.mkPen(colour(theme().accent), width=1.8))
        most = float(np.nanmax(residual.away_mm))
        note = texts.RESIDUAL_NOTE.format(n=len(residual.names), name=residual.sentence, rms=residual.whole_mm,
                                          most=most)  # fmt: skip
        self.note.setText(note if len(self.draft.plan.rigid) >= 3 else f"{note}  {texts.RESIDUAL_FEW}")
        self._fill(tuple(kept_markers(self.draft.plan, self.draft.first_facts().names).values()))
        self.draft.measured.emit()

    def on_theme(self) -> None:
        """See `Page.on_theme`."""
        super().on_theme()
        if self._residual is not None:
            self._show_residual(self._residual)

    # Reactions

    def on_propose(self) -> None:
        """Look for steady markers."""
        facts = tuple(f for s in self.draft.sentences if (f := self.draft.facts.get(s.name)) and not f.problem)
        request = SteadyRequest(self.draft.plan, facts)
        self.draft.jobs.start("steady", texts.FINDING_STEADY, request, propose, self._on_proposed)

    def _on_proposed(self, found: tuple[tuple[str, ...], str]) -> None:
        self.draft.change(texts.EDIT_HEAD, rigid=found[0], origin=found[1])

    def toggle(self, name: str) -> None:
        """Take a marker for near-rigid, or no longer."""
        rigid = self.draft.plan.rigid
        after = tuple(n for n in rigid if n != name) if name in rigid else (*rigid, name)
        self.draft.change(texts.EDIT_HEAD, rigid=after)

    def set_origin(self, name: str | None) -> None:
        """Put another marker at zero."""
        self.draft.change(texts.EDIT_HEAD, origin=name)

    def _on_item(self, item: QListWidgetItem) -> None:
        name = item.data(Qt.ItemDataRole.UserRole)
        if (item.checkState() == Qt.CheckState.Checked) != (name in self.draft.plan.rigid):
            self.toggle(name)
