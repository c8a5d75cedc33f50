"""Review: every alignment looked at, the least sure first."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QSplitter, QVBoxLayout, QWidget

from app.panels.importing.alignment_lanes import AlignmentLanes
from app.panels.importing.draft import ImportDraft
from app.panels.importing.page import Page
from app.panels.importing.plain_table import PlainTable
from app.panels.importing.speech_work import SpeechWork
from app.panels.pane import ElidedLabel, label
from app.panels.timeline.wave import Peaks
from app.player import Player
from app.texts import importing as texts
from app.theme import STEP
from core.importing.plan import SentencePlan
from core.media.audio import Audio, load_audio
from core.progress import Progress
from core.speech.second_listening import AlignmentConfidence
from core.speech.spectrogram import Spectrogram
from core.speech.transcript import Transcript

_TABLE_PX = 300
_UNSURE = 0.5


class ReviewPage(Page):
    """A list of sentences, and the lanes of one."""

    def __init__(self, draft: ImportDraft, work: SpeechWork, player: Player) -> None:
        super().__init__(draft, texts.REVIEW, texts.REVIEW_HINT, texts.REVIEW_EMPTY)
        self.work, self.player = work, player
        self._order: list[str] = []
        self._shown: str | None = None
        self._touched = False  # until the user has chosen, the least sure sentence is on show
        self._audio: Audio | None = None
        self._edited: dict[str, Transcript] = {}
        self.table = PlainTable(texts.REVIEW_COLUMNS, texts.REVIEW_COLUMN_TIPS, (0, 56, 92))
        self.lanes = AlignmentLanes()
        self.lanes.setToolTip(texts.LANES_TIP)
        split = QSplitter(childrenCollapsible=False, handleWidth=1)
        split.addWidget(self.table)
        split.addWidget(self._right())
        split.setStretchFactor(1, 1)
        split.setSizes([_TABLE_PX, 3 * _TABLE_PX])
        self.body.addWidget(split, 1)
        self.table.chosen.connect(self.on_sentence)
        self.lanes.changed.connect(self._on_moved_boundary)
        self.lanes.time_asked.connect(self._on_time)
        self.work.renewed.connect(self.on_changed)
        self.player.moved.connect(self._on_playhead)
        self._add_keys()

    def _right(self) -> QWidget:
        right = QWidget()
        column = QVBoxLayout(right)
        column.setContentsMargins(STEP, 0, 0, 0)
        column.setSpacing(STEP)
        self.said = ElidedLabel("plain")
        top = QHBoxLayout()
        top.addWidget(self.said, 1)
        top.addWidget(label(texts.LANES_TIP))
        column.addWidget(self.lanes, 1)
        column.insertLayout(0, top)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.play = QPushButton(texts.PLAY, toolTip=texts.PLAY_TIP)
        self.revert = QPushButton(texts.REVERT, toolTip=texts.REVERT_TIP)
        self.previous = QPushButton(texts.PREVIOUS, toolTip=texts.PREVIOUS_TIP)
        self.following = QPushButton(texts.NEXT_SENTENCE, toolTip=texts.NEXT_SENTENCE_TIP)
        self.accept = QPushButton(texts.ACCEPT, toolTip=texts.ACCEPT_TIP)
        self.accept.setProperty("role", "primary")
        for widget in (self.play, self.revert):
            row.addWidget(widget)
        row.addStretch(1)
        for widget in (self.previous, self.following, self.accept):
            row.addWidget(widget)
        column.addLayout(row)
        self.play.clicked.connect(self.on_play)
        self.revert.clicked.connect(self.on_revert)
        self.previous.clicked.connect(lambda: self.step(-1))
        self.following.clicked.connect(lambda: self.step(1))
        self.accept.clicked.connect(self.on_accept)
        return right

    def _add_keys(self) -> None:
        keys = {"PgDown": lambda: self.step(1), "PgUp": lambda: self.step(-1), "Return": self.on_accept,
                "Enter": self.on_accept, "Space": self.on_play, "Escape": self.on_revert}  # fmt: skip
        for key, done in keys.items():
            QShortcut(QKeySequence(key), self, activated=done, context=Qt.ShortcutContext.WidgetWithChildrenShortcut)

    @property
    def is_ready(self) -> bool:
        """See `Page.is_ready`."""
        return any(s.audio is not None for s in self.draft.sentences)

    @property
    def state(self) -> str:
        """See `Page.state`."""
        spoken = [s for s in self.draft.sentences if s.audio is not None]
        n = sum(self.work.is_accepted(s) for s in spoken)
        return texts.STATE_REVIEW.format(n=n, all=len(spoken)) if n else ""

    def refresh(self) -> None:
        """See `Page.refresh`."""
        self.work.ask()
        self.work.listen()
        spoken = {s.name: s for s in self.draft.sentences if s.audio is not None}
        judged = {name: self.work.confidence.get(name) for name in spoken}

        def badness(name: str) -> tuple:
            accepted = self.work.is_accepted(spoken[name])
            return accepted, 2.0 if judged[name] is None else judged[name].of_sentence

        self._order = sorted(spoken, key=badness)
        rows = [self._row(spoken[name], judged[name]) for name in self._order]
        unsure = [i for i, name in enumerate(self._order) if judged[name] is not None
                  and judged[name].of_sentence < _UNSURE and not self.work.is_accepted(spoken[name])]  # fmt: skip
        self.table.chosen.disconnect(self.on_sentence)
        self.table.show_rows(rows, unsure)
        if self.draft.current not in spoken or (not self._touched and None not in judged.values()):
            self.draft.current = self._order[0]
        self.table.choose(self._order.index(self.draft.current))
        self.table.chosen.connect(self.on_sentence)
        self._show()
        self.draft.measured.emit()

    def _row(self, sentence: SentencePlan, judged: AlignmentConfidence | None) -> tuple[str, ...]:
        facts = self.work.known(sentence.name)
        how = "" if facts is None else texts.ALIGNMENTS.get(facts.alignment, "")
        if self.work.is_accepted(sentence):
            how = texts.ACCEPTED
        return sentence.name, "" if judged is None else texts.SURE.format(share=judged.of_sentence), how

    def _show(self) -> None:
        name = self.draft.current
        facts = self.work.known(name)
        if name != self._shown:
            self._shown, self._audio = name, None
            self.lanes.show_sound(None, None)
            self.lanes.show_transcript(None, None)
            sentence = next(s for s in self.draft.sentences if s.name == name)
            self.draft.jobs.start("review sound", "", sentence, _sound, self._on_sound)
        transcript = None if facts is None else self._edited.get(name, facts.transcript)
        self.lanes.show_transcript(transcript, self.work.confidence.get(name))
        words = "" if transcript is None else " ".join(w.word for w in transcript.words)
        failure = "" if facts is None else facts.failure
        if failure:
            words = texts.FAILED_SENTENCE.format(name=name, why=failure)
        self.said.setText(words)
        self.revert.setEnabled(name in self._edited)
        for button in (self.accept, self.play):
            button.setEnabled(transcript is not None)

    def _on_sound(self, answer: tuple[str, Audio, Spectrogram, Peaks]) -> None:
        name, audio, spectrogram, peaks = answer
        if name == self._shown:
            self._audio = audio
            self.lanes.show_sound(spectrogram, peaks)

    # Reactions

    def on_sentence(self, row: int) -> None:
        """Show another sentence."""
        self._touched = True
        self.player.pause()
        self.lanes.show_time(None)
        self.draft.current = self._order[row]
        self._show()

    def step(self, by: int) -> None:
        """Go to the sentence before or after, as the list has them."""
        if self.draft.current in self._order:
            self.table.choose(min(max(self._order.index(self.draft.current) + by, 0), len(self._order) - 1))

    def on_accept(self) -> None:
        """Keep what is shown, and go on to the next that is not accepted."""
        name, transcript = self.draft.current, self.lanes.transcript
        if transcript is None:
            return
        self._edited.pop(name, None)
        self._touched = True
        self.work.accept(name, transcript)
        accepted = {s.name for s in self.draft.sentences if self.work.is_accepted(s)}
        here = self._order.index(name)
        waiting = [other for other in (*self._order[here:], *self._order[:here]) if other not in accepted]
        if waiting:
            self.draft.current = waiting[0]
        self.refresh()

    def on_revert(self) -> None:
        """Take back what was dragged here."""
        if self._edited.pop(self.draft.current, None) is not None:
            self._show()

    def on_play(self) -> None:
        """Hear it, or stop."""
        if self._audio is not None:
            self.player.set_audio(self._audio)
            self.player.toggle()

    def _on_time(self, time_s: float) -> None:
        if self._audio is not None:
            self.player.set_audio(self._audio)
            self.player.seek(time_s)
            self.lanes.show_time(time_s)

    def _on_playhead(self, time_s: float) -> None:
        if self.isVisible():
            self.lanes.show_time(time_s)

    def _on_moved_boundary(self, transcript: Transcript) -> None:
        self._touched = True
        self._edited[self.draft.current] = transcript
        self.revert.setEnabled(True)

    def hideEvent(self, event) -> None:
        """Fall silent."""
        self.player.pause()
        super().hideEvent(event)


def _sound(sentence: SentencePlan, _progress: Progress) -> tuple[str, Audio, Spectrogram, Peaks]:
    audio = load_audio(Path(sentence.audio))
    return sentence.name, audio, Spectrogram.of(audio), Peaks.of(audio)
