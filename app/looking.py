"""What is looked at and played: selection, playhead, transport. Nothing here changes the project."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.jobs import JobRunner
from app.player import Player
from core.document.change import Change
from core.document.document import Document
from core.document.parts import FaceChoice
from core.document.view_state import ViewState
from core.media.video import FRAME_RATES
from core.speech.phoneme import PAU


class Looking(QObject):
    """One document, what of it is selected, and the playhead.

    failed(sentence, remedy) : for the message bar; noted(sentence) : for the status bar
    """

    failed = Signal(str, str)
    noted = Signal(str)

    def __init__(self, face: FaceChoice | None, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = Document(face)
        self.view = ViewState(self.document)
        self.jobs = JobRunner(self)
        self.player = Player(self.jobs, self)
        self.document.changed.connect(self._on_speech_changed)
        self.player.moved.connect(self.view.move_playhead)
        self.player.noted.connect(self.noted)
        self.jobs.failed.connect(self.failed)

    @property
    def fps(self) -> float:
        """Output frames a second."""
        return float(FRAME_RATES[self.document.output.frame_rate])

    def select_slot(self, slot: int, time_s: float | None = None) -> None:
        """Select an utterance and bring the playhead to it: to ``time_s``, or to its middle."""
        utterance = self.document.speech.transcript.phonemes[slot]
        self.seek((utterance.start_s + utterance.end_s) / 2 if time_s is None else time_s)
        self.view.select_slot(slot)

    def step_slot(self, by: int) -> None:
        """Select the next or the previous utterance; the one at the playhead when none is selected."""
        speech = self.document.speech
        if speech is not None:
            slot = self.view.slot_at(self.view.playhead_s) if self.view.slot is None else self.view.slot + by
            self.select_slot(min(max(slot, 0), len(speech.transcript.phonemes) - 1))

    def select_a_vowel(self) -> None:
        """Select the longest phone in the middle of the sentence, so that the map is not blank."""
        phonemes = self.document.speech.transcript.phonemes
        spoken = [slot for slot, utterance in enumerate(phonemes) if utterance.phone != PAU]
        middle = spoken[len(spoken) // 4 : -(len(spoken) // 4) or None]
        if middle:
            self.select_slot(max(middle, key=lambda p: phonemes[p].end_s - phonemes[p].start_s))

    def seek(self, time_s: float) -> None:
        """Move the playhead, and the sound if it plays."""
        self.player.seek(time_s)
        self.view.move_playhead(time_s)

    def scrub(self, time_s: float) -> None:
        """Move the playhead and let the sound run after it; see `end_scrub`."""
        self.player.scrub(time_s)
        self.view.move_playhead(time_s)

    def end_scrub(self) -> None:
        """The playhead was let go."""
        self.player.end_scrub()

    def step_frame(self, by: int) -> None:
        """Move the playhead by frames of the output rate."""
        self.player.pause()
        self.seek((round(self.view.playhead_s * self.fps) + by) / self.fps)

    def play_or_pause(self) -> None:
        """Play, or stop where it is."""
        if not self.player.is_playing:
            self.player.seek(self.view.playhead_s)
        self.player.toggle()

    def shuttle(self, direction: int) -> None:
        """Play forwards (1) or backwards (-1), faster each time; 0 pauses."""
        if not self.player.is_playing:
            self.player.seek(self.view.playhead_s)
        self.player.shuttle(direction)

    def toggle_loop(self) -> None:
        """Repeat the selected utterances from now on, or play to the end again."""
        speech, span = self.document.speech, self.view.span
        if self.player.loop is not None or speech is None or span is None:
            self.player.set_loop(None)
            return
        phonemes = speech.transcript.phonemes
        self.player.set_loop((phonemes[span[0]].start_s, phonemes[span[1]].end_s))

    def _on_speech_changed(self, change: Change, _origin: object) -> None:
        if change & Change.SPEECH:
            self.player.set_audio(None if self.document.speech is None else self.document.speech.audio)
            self.view.select_slot(None)
            self.view.move_playhead(0.0)
        elif change & Change.ALIGNMENT:
            self.view.fit()
        if change & Change.CLUSTERS:
            self._show_a_map()

    def _show_a_map(self) -> None:
        maps = {} if self.document.database is None else self.document.database.maps
        if self.view.map_phone not in maps:
            self.view.show_map(max(maps, key=lambda phone: len(maps[phone].frames), default=None))
