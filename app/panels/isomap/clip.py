"""A motion node as a clip: its captured frames at their own pace, with the sound of its sentence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app import texts
from app.jobs import JobRunner
from app.panels.map_pick import MapPick
from app.sound import Clock, Passage, open_clock
from core.media.audio import Audio, audio_from_bytes
from core.motion.database import MotionDatabase
from core.progress import Progress

_TICK_MS = 16
# what comes before and after, so that the eye has something to compare with
LEAD_S = 0.2
SLOW = 0.25


@dataclass(frozen=True)
class _Span:
    """What is played: the node with its surroundings within the sentence, in seconds of that sentence."""

    database: MotionDatabase
    row: int
    start_s: float
    end_s: float
    speed: float

    @classmethod
    def around(cls, database: MotionDatabase, row: int, speed: float) -> _Span:
        nodes = database.nodes
        sentence = database.sentences[nodes.sentence[row]]
        start_s = (nodes.start[row] - sentence.start_frame) / database.rate_hz
        end_s = (nodes.stop[row] - sentence.start_frame) / database.rate_hz
        whole_s = (sentence.stop_frame - sentence.start_frame) / database.rate_hz
        return cls(database, row, max(0.0, start_s - LEAD_S), min(whole_s, end_s + LEAD_S), speed)

    def at(self, elapsed_s: float) -> MapPick:
        """Return the captured frames at ``elapsed_s`` after the start, mixed as time asks."""
        sentence = self.database.sentences[self.database.nodes.sentence[self.row]]
        place = min((self.start_s + elapsed_s) * self.database.rate_hz, sentence.stop_frame - sentence.start_frame - 1)
        low = int(place)
        frames = sentence.start_frame + np.array([low, low + 1])
        frames = np.minimum(frames, sentence.stop_frame - 1)
        return MapPick(None, frames, np.array([1.0 - (place - low), place - low]), self.row)


class NodeClip(QObject):
    """Plays one node at a time.

    frame_shown(MapPick) : the frame of now; ended() : it is over, or was stopped
    """

    frame_shown = Signal(object)
    ended = Signal()

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._span: _Span | None = None
        self._clock: Clock | None = None
        self._tick = QTimer(self, interval=_TICK_MS)
        self._tick.timeout.connect(self._on_tick)

    @property
    def is_playing(self) -> bool:
        """Whether a clip plays, or is about to."""
        return self._span is not None

    def play(self, database: MotionDatabase, row: int, slowly: bool = False) -> None:
        """Play a node from its start; what played before stops."""
        self.stop()
        self._span = _Span.around(database, row, SLOW if slowly else 1.0)
        self._jobs.start("clip", "", self._span, _open, self._on_opened, discarded=lambda answer: answer[0].stop())

    def stop(self) -> None:
        """Stop where it is."""
        if self._span is None:
            return
        self._jobs.cancel("clip")
        self._tick.stop()
        if self._clock is not None:
            self._clock.stop()
        self._span = self._clock = None
        self.ended.emit()

    def _on_opened(self, answer: tuple[Clock, str]) -> None:
        self._clock = answer[0]
        self._tick.start()

    def _on_tick(self) -> None:
        span, elapsed_s = self._span, self._clock.now_s()
        self.frame_shown.emit(span.at(min(elapsed_s, span.end_s - span.start_s)))
        if elapsed_s >= span.end_s - span.start_s or self._clock.lost:
            self.stop()


def _open(span: _Span, progress: Progress) -> tuple[Clock, str]:
    progress.step(0.0, texts.CLIP_SOUND)
    database = span.database
    sentence = database.sentences[database.nodes.sentence[span.row]].name
    stored = database.audio_bytes(sentence)
    if stored is None:
        sound = Audio(np.zeros(max(1, round(16_000 * span.end_s)), np.float32), 16_000)
    else:
        sound = audio_from_bytes(stored, f"the sound of sentence {sentence}")
    first, stop = round(span.start_s * sound.rate_hz), round(span.end_s * sound.rate_hz)
    return open_clock((Audio(sound.samples[first:stop], sound.rate_hz), Passage(0.0, span.speed)), progress)
