"""Sound and words: whether mouth and sound move together."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QHBoxLayout,
    QPushButton,
    QSlider,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from app.panels.importing.draft import ImportDraft
from app.panels.importing.page import Page, themed_plot
from app.panels.importing.plain_table import PlainTable
from app.panels.importing.speech_work import SpeechFacts, SpeechWork
from app.panels.pane import label
from app.player import Player
from app.texts import importing as texts
from app.theme import STEP, colour, theme
from core.importing.plan import OFFSETS, SentencePlan
from core.importing.run import SURE
from core.media.audio import Audio, load_audio
from core.progress import Progress
from core.speech.loudness import FRAME_S, levels_db

_MOST_MS = 600
_TABLE_PX = 440
_AGREEMENT_PX = 150
_FLOOR_DB = 30.0


@dataclass(frozen=True)
class _Heard:
    """A sound, and how loud it is: 0..1 each 10 ms."""

    name: str
    audio: Audio
    loudness: np.ndarray


class SoundPage(Page):
    """The mouth over the loudness, and a slider."""

    def __init__(self, draft: ImportDraft, work: SpeechWork, player: Player) -> None:
        super().__init__(draft, texts.SOUND, texts.SOUND_HINT, texts.FILES_FIRST)
        self.work, self.player = work, player
        self._order: list[str] = []
        self._heard: _Heard | None = None
        top = QHBoxLayout()
        top.setSpacing(STEP)
        self.offsets = QComboBox(toolTip=texts.OFFSETS_TIP)
        for key in OFFSETS:
            self.offsets.addItem(texts.OFFSET_MODES[key], key)
        self.session = label("", "plain")
        top.addWidget(label(texts.OFFSETS, "plain"))
        top.addWidget(self.offsets)
        top.addSpacing(STEP)
        top.addWidget(self.session)
        top.addStretch(1)
        self.body.addLayout(top)
        self.table = PlainTable(texts.SOUND_COLUMNS, texts.SOUND_COLUMN_TIPS, (0, 80, 56, 76, 92))
        split = QSplitter(childrenCollapsible=False, handleWidth=1)
        split.addWidget(self.table)
        split.addWidget(self._right())
        split.setStretchFactor(1, 1)
        split.setSizes([_TABLE_PX, 2 * _TABLE_PX])
        self.body.addWidget(split, 1)
        self.offsets.activated.connect(
            lambda _: self.draft.change(texts.EDIT_OFFSET, offsets=self.offsets.currentData())
        )
        self.table.chosen.connect(self.on_sentence)
        self.work.renewed.connect(self.on_changed)
        self.player.moved.connect(self._on_moved)
        self.player.playing_changed.connect(lambda playing: self.cursor.setVisible(playing))

    def _right(self) -> QWidget:
        right = QWidget()
        column = QVBoxLayout(right)
        column.setContentsMargins(STEP, 0, 0, 0)
        column.setSpacing(STEP)
        self.legend = label("", "plain")
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        column.addWidget(self.legend)
        self.plot = themed_plot("", texts.TIME_AXIS)
        self.loud_view = pg.ViewBox(enableMouse=False, enableMenu=False)
        self.plot.scene().addItem(self.loud_view)
        self.loud_view.setXLink(self.plot.plotItem)
        self.loud_view.setYRange(0.0, 1.0, padding=0.02)
        self.plot.plotItem.vb.sigResized.connect(lambda box: self.loud_view.setGeometry(box.sceneBoundingRect()))
        self.cursor = pg.InfiniteLine(0.0, 90, pen=pg.mkPen(colour(theme().text), width=1))
        self.cursor.setVisible(False)
        column.addWidget(self.plot, 1)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.play = QPushButton(texts.PLAY, toolTip=texts.PLAY_TIP)
        self.slider = QSlider(Qt.Orientation.Horizontal, minimum=-_MOST_MS, maximum=_MOST_MS, toolTip=texts.SHIFT_TIP)
        self.slider.setPageStep(10)
        self.shift = QDoubleSpinBox(decimals=0, minimum=-10_000, maximum=10_000, suffix=" ms", toolTip=texts.SHIFT_TIP)
        self.shift.setKeyboardTracking(False)
        self.all = QPushButton(texts.SHIFT_ALL, toolTip=texts.SHIFT_ALL_TIP)
        for widget in (self.play, label(texts.SHIFT, "plain"), self.slider, self.shift, self.all):
            row.addWidget(widget)
        row.setStretchFactor(self.slider, 1)
        column.addLayout(row)
        self.agreement = themed_plot(texts.AGREEMENT_AXIS, texts.AGREEMENT_X)
        self.agreement.setFixedHeight(_AGREEMENT_PX)
        column.addWidget(self.agreement)
        self.play.clicked.connect(self.on_play)
        self.slider.valueChanged.connect(lambda ms: self._shift(ms / 1000))
        self.shift.valueChanged.connect(lambda ms: self._shift(ms / 1000))
        self.all.clicked.connect(self.on_all)
        return right

    @property
    def state(self) -> str:
        """See `Page.state`."""
        session = self.work.session if self.draft.plan is not None else None
        if session is None:
            return ""
        return texts.STATE_OFFSET.format(ms=1000 * session.offset_s, share=session.confidence)

    @property
    def _sentence(self) -> SentencePlan | None:
        return next((s for s in self.draft.sentences if s.name == self.draft.current), None)

    def refresh(self) -> None:
        """See `Page.refresh`."""
        self.work.ask()
        self.offsets.setCurrentIndex(OFFSETS.index(self.draft.plan.offsets))
        session = self.work.session
        self.session.setText("" if session is None else texts.SESSION_OFFSET.format(
            ms=1000 * session.offset_s, share=session.confidence))  # fmt: skip
        known = {s.name: self.work.known(s.name) for s in self.draft.sentences}
        self._order = sorted(known, key=lambda name: _sureness(known[name]))
        by_name = {s.name: s for s in self.draft.sentences}
        unsure = [i for i, name in enumerate(self._order) if _sureness(known[name]) < SURE]
        self.table.chosen.disconnect(self.on_sentence)
        self.table.show_rows([_row(by_name[name], known[name]) for name in self._order], unsure)
        if self.draft.current not in by_name:
            self.draft.current = self._order[0]
        self.table.choose(self._order.index(self.draft.current))
        self.table.chosen.connect(self.on_sentence)
        self._show()
        self.draft.measured.emit()

    # Reactions

    def on_sentence(self, row: int) -> None:
        """Show another sentence."""
        self.player.pause()
        self.draft.current = self._order[row]
        self._show()

    def on_play(self) -> None:
        """Hear it, or stop."""
        if self._heard is not None and self._heard.name == self.draft.current:
            self.player.set_audio(self._heard.audio)
            self.player.toggle()

    def on_all(self) -> None:
        """Shift all sentences as this one is."""
        names = [s.name for s in self.draft.sentences]
        self.draft.change_sentences(names, texts.EDIT_OFFSET, offset_s=self._sentence.offset_s)

    def _shift(self, offset_s: float) -> None:
        if self._sentence is not None and abs(offset_s - self._sentence.offset_s) > 5e-4:
            self.draft.change_sentences([self._sentence.name], texts.EDIT_OFFSET, offset_s=round(offset_s, 4))

    def _on_moved(self, time_s: float) -> None:
        if self.isVisible():
            self.cursor.setValue(time_s)

    def _on_heard(self, heard: _Heard) -> None:
        self._heard = heard
        if heard.name == self.draft.current:
            self._draw()

    def _show(self) -> None:
        sentence = self._sentence
        for widget in (self.slider, self.shift):
            widget.blockSignals(True)
            widget.setValue(round(1000 * sentence.offset_s))
            widget.blockSignals(False)
        has_sound = sentence.audio is not None
        for widget in (self.slider, self.shift, self.all, self.play):
            widget.setEnabled(has_sound)
        if has_sound and (self._heard is None or self._heard.name != sentence.name):
            self.draft.jobs.start("heard", "", sentence, _hear, self._on_heard)
        self._draw()

    def _draw(self) -> None:
        sentence, facts = self._sentence, self.work.known(self.draft.current)
        self.plot.clear()
        self.loud_view.clear()
        self.agreement.clear()
        self.plot.addItem(self.cursor, ignoreBounds=True)
        if facts is not None and facts.failure:
            self.legend.setText(texts.FAILED_SENTENCE.format(name=sentence.name, why=facts.failure))
            return
        if sentence.audio is None:
            self.legend.setText(texts.NOTHING_HEARD.format(name=sentence.name))
            return
        out_s = self.work.taken_out_s(sentence)
        unit = texts.PIXELS if self.draft.plan.with_scale else texts.MILLIMETRES
        self.plot.setLabel("left", texts.OPENING_AXIS.format(unit=unit))
        mouth = texts.SOUND_LEGEND_MOUTH.format(ms=round(-1000 * out_s) + 0.0)
        self.legend.setText(f"<span style='color:{theme().dim}'>█ {texts.SOUND_LEGEND_LOUD}</span> &nbsp; "
                            f"<span style='color:{theme().accent}'>━ {mouth}</span>")  # fmt: skip
        if self._heard is not None and self._heard.name == sentence.name:
            times_s = np.arange(len(self._heard.loudness)) * FRAME_S
            self.loud_view.addItem(pg.PlotCurveItem(times_s, self._heard.loudness, fillLevel=0.0, pen=pg.mkPen(None),
                                                    brush=colour(theme().dim, 0.35)))  # fmt: skip
        if facts is None:
            return
        times_s = np.arange(len(facts.opening_mm)) / facts.rate_hz - out_s
        self.plot.plot(times_s, facts.opening_mm, pen=pg.mkPen(colour(theme().accent), width=1.8), connect="finite")
        if facts.offset is not None:
            self.agreement.plot(1000 * facts.offset.lags_s, facts.offset.agreement,
                                pen=pg.mkPen(colour(theme().text), width=1.2))  # fmt: skip
            for at_s, css in ((facts.offset.offset_s, theme().dim), (out_s, theme().accent)):
                self.agreement.addItem(pg.InfiniteLine(1000 * at_s, 90, pen=pg.mkPen(colour(css), width=1.2)))

    def hideEvent(self, event) -> None:
        """Fall silent."""
        self.player.pause()
        super().hideEvent(event)

    def keyPressEvent(self, event) -> None:
        """Space plays."""
        if event.key() == Qt.Key.Key_Space:
            self.on_play()
        else:
            super().keyPressEvent(event)


def _sureness(facts: SpeechFacts | None) -> float:
    if facts is None:
        return 3.0
    if facts.failure:
        return -1.0
    return 2.0 if facts.offset is None else facts.offset.confidence


def _row(sentence: SentencePlan, facts: SpeechFacts | None) -> tuple[str, ...]:
    offset = None if facts is None else facts.offset
    measured = "" if offset is None else texts.MS.format(ms=1000 * offset.offset_s)
    sure = "" if offset is None else texts.SURE.format(share=offset.confidence)
    by_hand = texts.MS.format(ms=1000 * sentence.offset_s) if sentence.offset_s else ""
    return sentence.name, measured, sure, by_hand, "" if facts is None else texts.ALIGNMENTS.get(facts.alignment, "")


def _hear(sentence: SentencePlan, _progress: Progress) -> _Heard:
    audio = load_audio(Path(sentence.audio))
    levels = levels_db(audio.samples, audio.rate_hz)
    loud = np.clip((levels - np.percentile(levels, 98)) / _FLOOR_DB + 1.0, 0.0, 1.0)
    return _Heard(sentence.name, audio, loud)
