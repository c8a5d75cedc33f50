"""Mend: what will be filled, cut and swapped back, and one marker before and after."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QCheckBox, QComboBox, QDoubleSpinBox, QHBoxLayout, QSplitter

from app.panels.importing.draft import ImportDraft
from app.panels.importing.mend_work import MendFacts, MendPicture, MendRequest, look, picture
from app.panels.importing.page import Page, themed_plot
from app.panels.importing.plain_table import PlainTable
from app.panels.pane import Choice, label
from app.texts import importing as texts
from app.theme import STEP, colour, theme
from core.importing.mending import GAP, LONG_GAP, SPIKE, SWAP
from core.importing.plan import MendLimits

_AXES = ("x", "y", "z")
_SOON_MS = 400
_PLOT_PX = 250
_AROUND_S = 0.5


class MendPage(Page):
    """Limits above, sentences and events side by side, one marker's path below."""

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__(draft, texts.MEND, texts.MEND_HINT, texts.FILES_FIRST)
        self._looked: object = None
        self._facts: dict[str, MendFacts] = {}
        self._order: list[str] = []
        self._picture: MendPicture | None = None
        self._soon = QTimer(self, singleShot=True, interval=_SOON_MS)
        self._soon.timeout.connect(self._set_limits)
        self._add_limits()
        self.sentences = PlainTable(texts.MEND_COLUMNS, texts.MEND_COLUMN_TIPS, (0, 60, 64, 90, 76, 76))
        self.events = PlainTable(texts.EVENT_COLUMNS, (), (96, 0, 76, 80, 92))
        split = QSplitter(childrenCollapsible=False, handleWidth=1)
        for table in (self.sentences, self.events):
            split.addWidget(table)
            split.setStretchFactor(split.count() - 1, 1)
        self.body.addWidget(split, 1)
        self._add_plot()
        self.sentences.chosen.connect(self.on_sentence)
        self.events.chosen.connect(self.on_event)

    def _add_limits(self) -> None:
        self.longest = QDoubleSpinBox(decimals=2, minimum=0.0, maximum=5.0, singleStep=0.05, suffix=" s",
                                      toolTip=texts.LONGEST_GAP_TIP)  # fmt: skip
        self.faults = QCheckBox(texts.LOOK_FOR_FAULTS, toolTip=texts.LOOK_FOR_FAULTS_TIP)
        self.spike = QDoubleSpinBox(decimals=1, minimum=0.0, maximum=1000.0, singleStep=0.5, suffix=" mm",
                                    toolTip=texts.LEAST_SPIKE_TIP)  # fmt: skip
        self.deviations = QDoubleSpinBox(decimals=1, minimum=0.0, maximum=1000.0, suffix=texts.DEVIATIONS,
                                         toolTip=texts.LEAST_DEVIATIONS_TIP)  # fmt: skip
        row = QHBoxLayout()
        row.setSpacing(STEP)
        for widget in (label(texts.LONGEST_GAP, "plain"), self.longest, self.faults,
                       label(texts.LEAST_SPIKE, "plain"), self.spike, label(texts.LEAST_DEVIATIONS, "plain"),
                       self.deviations):  # fmt: skip
            row.addWidget(widget)
        row.insertSpacing(2, 2 * STEP)
        row.addStretch(1)
        self.body.addLayout(row)
        for box in (self.longest, self.spike, self.deviations):
            box.valueChanged.connect(lambda _: self._soon.start())
        self.faults.toggled.connect(lambda _: self._soon.start())

    def _add_plot(self) -> None:
        self.marker = QComboBox(toolTip=texts.MEND_MARKER_TIP)
        self.marker.setMinimumWidth(20 * STEP)
        self.axis = Choice([(axis, axis, texts.MEND_AXIS_TIP) for axis in _AXES])
        self.axis.choose("y")
        self.note = label("", "plain")
        self.legend = label()
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self._dress_legend()
        row = QHBoxLayout()
        row.setSpacing(STEP)
        for widget in (label(texts.MEND_MARKER, "plain"), self.marker, self.axis, self.note):
            row.addWidget(widget)
        row.addStretch(1)
        self.total = label()
        for widget in (self.total, self.legend):
            row.addWidget(widget)
        self.body.addLayout(row)
        self.plot = themed_plot("")
        self.plot.setFixedHeight(_PLOT_PX)
        self.plot.setMouseEnabled(x=True, y=False)
        self.body.addWidget(self.plot)
        self.marker.currentIndexChanged.connect(lambda _: self._draw())
        self.axis.group.idClicked.connect(lambda _: self._draw())

    @property
    def state(self) -> str:
        """See `Page.state`."""
        if not self._facts:
            return ""
        swaps, spikes, gaps, long, _ = np.sum([facts.counts for facts in self._facts.values()], axis=0)
        if not swaps + spikes + gaps + long:
            return texts.STATE_SOUND
        return texts.STATE_MEND.format(n=swaps + spikes + gaps, long=long)

    def refresh(self) -> None:
        """See `Page.refresh`."""
        plan = self.draft.plan
        limits = plan.mending
        for widget, value in ((self.longest, limits.longest_gap_s), (self.spike, limits.least_spike_mm),
                              (self.deviations, limits.least_deviations)):  # fmt: skip
            widget.blockSignals(True)
            widget.setValue(value)
            widget.blockSignals(False)
        self.faults.blockSignals(True)
        self.faults.setChecked(limits.faults)
        self.faults.blockSignals(False)
        for widget in (self.spike, self.deviations):
            widget.setEnabled(limits.faults)
        looked = (
            limits,
            plan.markers,
            plan.rigid,
            plan.reading,
            plan.like,
            [(s.name, s.motion, s.take) for s in plan.sentences],
        )
        if looked != self._looked:
            self._looked = looked
            request = MendRequest(plan, plan.sentences)
            self.draft.jobs.start("mend", texts.MENDING, request, look, self._on_looked)

    def _set_limits(self) -> None:
        limits = MendLimits(self.longest.value(), self.faults.isChecked(), self.spike.value(), self.deviations.value())
        self.draft.change(texts.EDIT_LIMITS, mending=limits)

    def _on_looked(self, facts: dict[str, MendFacts]) -> None:
        self._facts = facts
        self._order = sorted(facts, key=lambda name: facts[name].badness, reverse=True)
        rows = [(name, *(str(n) if n else "–" for n in facts[name].counts)) for name in self._order]
        self.sentences.show_rows(rows, [i for i, name in enumerate(self._order) if facts[name].count(LONG_GAP)])
        sums = {kind: sum(f.count(kind) for f in facts.values()) for kind in (GAP, LONG_GAP, SPIKE, SWAP)}
        self.total.setText(texts.MEND_TOTAL.format(gaps=sums[GAP], long=sums[LONG_GAP], spikes=sums[SPIKE],
                                                   swaps=sums[SWAP]))  # fmt: skip
        self.draft.measured.emit()
        current = self.draft.current if self._picture is not None and self.draft.current in facts else None
        self.sentences.choose(self._order.index(current) if current else 0)

    def on_theme(self) -> None:
        """See `Page.on_theme`."""
        super().on_theme()
        self._dress_legend()
        self._draw()

    def _dress_legend(self) -> None:
        self.legend.setText(f"<span style='color:{theme().text}'>╌ {texts.MEND_LEGEND_BEFORE}</span> &nbsp; "
                            f"<span style='color:{theme().accent}'>━ {texts.MEND_LEGEND_AFTER}</span>")  # fmt: skip

    # Reactions

    def on_sentence(self, row: int) -> None:
        """Show what is done to a sentence."""
        name = self._order[row]
        self.draft.current = name
        facts = self._facts[name]
        rows = [
            (texts.EVENT_KINDS[r.kind],
             texts.EVENT_OTHER.format(marker=r.marker, other=r.other) if r.other else r.marker,
             texts.SECONDS.format(s=r.start / facts.rate_hz),
             texts.MILLISECONDS.format(ms=1000 * (r.stop - r.start) / facts.rate_hz),
             texts.MM_ABOUT.format(mm=r.size_mm) if np.isfinite(r.size_mm) and r.size_mm else "")
            for r in facts.rows
        ]  # fmt: skip
        self.events.show_rows(rows, [i for i, r in enumerate(facts.rows) if r.kind == LONG_GAP])
        self.note.setText("" if rows else texts.MEND_NOTHING.format(name=name))
        sentence = next((s for s in self.draft.sentences if s.name == name), None)
        if sentence is not None:
            self.draft.jobs.start("mended", "", (self.draft.plan, sentence), picture, self._on_picture)

    def _on_picture(self, shown: MendPicture) -> None:
        self._picture = shown
        self.marker.blockSignals(True)
        self.marker.clear()
        self.marker.addItems(list(shown.names))
        self.marker.blockSignals(False)
        if self._facts[shown.sentence].rows:
            self.events.choose(0)
        else:
            self._draw()

    def on_event(self, row: int) -> None:
        """Show the marker that it happened to, near the moment."""
        event = self._facts[self.draft.current].rows[row]
        self.marker.setCurrentText(event.marker)
        if self._picture is not None and self._picture.sentence == self.draft.current:
            self.axis.choose(_AXES[self._picture.most_changed(event)])
        self._draw()
        if self._picture is not None:
            rate_hz = self._picture.rate_hz
            self.plot.setXRange(event.start / rate_hz - _AROUND_S, event.stop / rate_hz + _AROUND_S, padding=0.0)

    def _draw(self) -> None:
        self.plot.clear()
        shown, row = self._picture, self.marker.currentIndex()
        if shown is None or row < 0:
            return
        self.plot.setLabel("bottom", texts.RESIDUAL_TIME.format(name=shown.sentence))
        axis = _AXES.index(self.axis.key)
        unit = texts.PIXELS if self.draft.plan.with_scale else texts.MILLIMETRES
        self.plot.setLabel("left", texts.MEND_PLACE.format(unit=unit))
        times_s = np.arange(len(shown.before)) / shown.rate_hz
        for event in self._facts[shown.sentence].rows:
            if shown.names[row] in (event.marker, event.other):
                span = pg.LinearRegionItem((event.start / shown.rate_hz, event.stop / shown.rate_hz), movable=False,
                                           brush=colour(theme().accent, 0.12), pen=pg.mkPen(None))  # fmt: skip
                self.plot.addItem(span, ignoreBounds=True)
        self.plot.plot(times_s, shown.after[:, row, axis], pen=pg.mkPen(colour(theme().accent), width=1.8),
                       connect="finite")  # fmt: skip
        self.plot.plot(times_s, shown.before[:, row, axis], connect="finite",
                       pen=pg.mkPen(colour(theme().text), width=1, style=Qt.PenStyle.DashLine))  # fmt: skip
        self.plot.setAutoVisible(y=True)
        self.plot.enableAutoRange()
