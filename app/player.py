"""The transport: what time it is in the speech that plays, by the clock of the sound that is heard."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal

from app.jobs import JobRunner
from app.sound import Clock, Passage, ScrubSound, TimerClock, open_clock, open_scrub
from app.texts import SOUND_LOST
from core.media.audio import Audio

_TICK_MS = 16
_FASTEST = 4.0
_SHORTEST_LOOP_S = 0.05


class Player(QObject):
    """Plays one sound, or silence of its length; ``moved`` says where, sixty times a second.

    moved(seconds), playing_changed(bool) : for the panes; noted(sentence) : for the status bar
    """

    moved = Signal(float)
    playing_changed = Signal(bool)
    noted = Signal(str)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._audio: Audio | None = None
        self._position_s = 0.0
        self._clock: Clock | None = None
        self._playing = False
        self._speed = 1.0
        self._loop: tuple[float, float] | None = None
        self._scrub: ScrubSound | None = None
        self._scrubbing = False
        self._tick = QTimer(self)
        self._tick.setInterval(_TICK_MS)
        self._tick.timeout.connect(self._on_tick)

    @property
    def is_playing(self) -> bool:
        """Whether it plays."""
        return self._playing

    @property
    def duration_s(self) -> float:
        """Length of what can be played."""
        return 0.0 if self._audio is None else self._audio.duration_s

    def set_audio(self, audio: Audio | None) -> None:
        """Play something else from now on."""
        if audio is not self._audio:
            self.pause()
            self.end_scrub()
            self._audio, self._position_s, self._loop = audio, 0.0, None

    @property
    def loop(self) -> tuple[float, float] | None:
        """What is repeated, (start_s, end_s), or None."""
        return self._loop

    def set_loop(self, loop: tuple[float, float] | None) -> None:
        """Repeat a span from now on, or play to the end again."""
        if loop is not None:
            loop = max(loop[0], 0.0), min(loop[1], self.duration_s)
            if loop[1] - loop[0] < _SHORTEST_LOOP_S:
                loop = None
        self._loop = loop
        if self._playing:
            self.seek(self._position_s)

    def play(self, speed: float = 1.0) -> None:
        """Play on from where it stands, or from the other end when it stands at the end.

        speed : 1 as recorded, negative backwards
        """
        if self._audio is None or (self._playing and speed == self._speed):
            return
        if self._playing:
            self._end_clock()
        self._speed = speed
        first_s, end_s = (0.0, self.duration_s) if self._loop is None else self._loop
        if speed > 0 and not first_s <= self._position_s < end_s - 1e-3:
            self._position_s = first_s
        elif speed < 0 and self._position_s <= 1e-3:
            self._position_s = self.duration_s
        if not self._playing:
            self._playing = True
            self.playing_changed.emit(True)
        self._begin()

    def shuttle(self, direction: int) -> None:
        """Play forwards (1) or backwards (-1), twice as fast each time it is asked again; 0 pauses."""
        if direction == 0:
            self.pause()
            return
        same_way = self._playing and self._speed * direction > 0
        self.play(direction * min(2.0 * abs(self._speed), _FASTEST) if same_way else float(direction))

    def pause(self) -> None:
        """Stop where it is."""
        if not self._playing:
            return
        self._playing = False
        self._end_clock()
        self._tick.stop()
        self.playing_changed.emit(False)

    def toggle(self) -> None:
        """Play or pause."""
        if self._playing:
            self.pause()
        else:
            self.play()

    def seek(self, time_s: float) -> None:
        """Go to ``time_s``; it plays on if it played."""
        self._position_s = min(max(time_s, 0.0), self.duration_s)
        if self._playing:
            self._end_clock()
            self._begin()

    def scrub(self, time_s: float) -> None:
        """Go to ``time_s`` and let the sound run after it; see `end_scrub`."""
        self.pause()
        self.seek(time_s)
        if self._scrub is not None:
            self._scrub.move(self._position_s)
        elif self._audio is not None and not self._scrubbing:
            self._scrubbing = True
            request = (self._audio, self._position_s)
            self._jobs.start("scrub", "", request, open_scrub, self._on_scrub, discarded=_stop_scrub)

    def end_scrub(self) -> None:
        """The playhead was let go."""
        self._scrubbing = False
        self._jobs.cancel("scrub")
        _stop_scrub(self._scrub)
        self._scrub = None

    def _on_scrub(self, scrub: ScrubSound | None) -> None:
        self._scrub = scrub
        if scrub is not None:
            scrub.move(self._position_s)

    def _begin(self) -> None:
        # a sound server can take a tenth of a second to open a stream
        request = (self._audio, self._passage())
        self._jobs.start("sound", "", request, open_clock, self._on_clock, discarded=_stop_clock)

    def _passage(self) -> Passage:
        return Passage(self._position_s, self._speed, self._loop)

    def _on_clock(self, answer: tuple[Clock, str]) -> None:
        clock, note = answer
        if not self._playing:
            clock.stop()
            return
        self._clock = clock
        if note:
            self.noted.emit(note)
        self._tick.start()

    def _end_clock(self) -> None:
        self._jobs.cancel("sound")
        if self._clock is not None:
            self._clock.stop()
            self._clock = None

    def _on_tick(self) -> None:
        if self._clock is None:
            return
        if self._clock.lost:
            self._clock.stop()
            self._clock = TimerClock(self._passage())
            self.noted.emit(SOUND_LOST)
        self._position_s = min(max(self._clock.now_s(), 0.0), self.duration_s)
        self.moved.emit(self._position_s)
        if (self._speed > 0 and self._position_s >= self.duration_s) or (self._speed < 0 and self._position_s <= 0.0):
            self.pause()


def _stop_clock(answer: tuple[Clock, str]) -> None:
    answer[0].stop()


def _stop_scrub(scrub: ScrubSound | None) -> None:
    if scrub is not None:
        scrub.stop()
