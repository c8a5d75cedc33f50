"""The motion follows the document: each edit is answered at once, and its alternatives are priced soon after."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from PySide6.QtCore import QObject, Signal

from app import texts
from app.jobs import JobRunner
from core.document.change import ASKED_OF_THE_SEARCH, Change
from core.document.document import Document
from core.document.live_search import LiveSearch, PricedPath
from core.media.audio import Audio
from core.progress import Progress
from core.search.best_path import MotionPath
from core.search.engine import SearchAnswer, SearchEngine
from core.search.weights import SearchWeights
from core.speech.loudness import levels_db
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import Polish, polished
from core.synthesis.pose_tracks import PoseTracks


class Solving(QObject):
    """Searches in the background, for as long as the sound on show is the one that `follow` was asked for.

    solved(SearchAnswer) : the document shows another motion
    """

    solved = Signal(object)

    def __init__(self, document: Document, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document, self._jobs = document, jobs
        # by content of the database, so that undo need not price its transitions again
        self._searches: dict[str, LiveSearch] = {}
        self._followed: Audio | None = None
        self._tracks = PoseTracks()
        self.changed_slots: tuple[int, ...] = ()
        document.changed.connect(self._on_document_changed)

    def add_engine(self, engine: SearchEngine) -> None:
        """Take the engine of a database that was opened."""
        self._searches.setdefault(engine.database.content_hash, LiveSearch(engine))

    def follow(self) -> None:
        """Find motion for the speech on show, and anew after each edit; see `follow_later`."""
        self.follow_later()
        self._solve()

    def follow_later(self) -> None:
        """From the next edit on, find motion for the speech on show."""
        speech = self._document.speech
        self._followed = None if speech is None else speech.audio

    @property
    def tracks(self) -> PoseTracks:
        """What moves besides the markers, at the rate of the motion on show."""
        moves = self._document.output.head_moves
        return self._tracks if moves else replace(self._tracks, head=None, gaze=None)

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        speech = self._document.speech
        if change & Change.POLISH and self._document.answer is not None:
            request = (self._document.answer.motion, self._document.polish)
            self._jobs.start("polish", "", request, _polish, self._document.show_motion)
        if change & ASKED_OF_THE_SEARCH:
            self._jobs.cancel("prices")
            self._jobs.cancel("search")
            if speech is not None and speech.audio is self._followed:
                self._solve()

    def _solve(self) -> None:
        document = self._document
        speech, database = document.speech_input(), document.database
        if speech is None or database is None:
            return
        self._jobs.cancel("prices")
        search = self._searches[database.content_hash]
        request = _SolveRequest(search, speech, document.weights, document.speech.audio, document.polish)
        self._jobs.start("search", texts.SYNTHESISING, request, _solve, self._on_solved)

    def _on_solved(self, solved: tuple[SearchAnswer, MarkerMotion, PoseTracks]) -> None:
        answer, motion, self._tracks = solved
        self._jobs.cancel("polish")
        before = self._document.answer
        self.changed_slots = () if before is None else changed_slots(before.path, answer.path)
        self._document.show_answer(answer, motion)
        self.solved.emit(answer)
        search = self._searches[self._document.database.content_hash]
        self._jobs.start("prices", "", search, _price, self._on_priced)

    def _on_priced(self, priced: PricedPath | None) -> None:
        answer = self._document.answer
        if priced is not None and answer is not None and priced.path is answer.path:
            self._document.show_prices(priced.prices, priced.breakdown)


def changed_slots(before: MotionPath, after: MotionPath) -> tuple[int, ...]:
    """Return the slots whose motion node is another one; none where the slots themselves are others."""
    if len(before.nodes) != len(after.nodes):
        return ()
    return tuple(np.flatnonzero(before.nodes != after.nodes).tolist())


@dataclass(frozen=True)
class _SolveRequest:
    search: LiveSearch
    speech: SpeechInput
    weights: SearchWeights | None
    audio: Audio
    polish: Polish


def _solve(request: _SolveRequest, progress: Progress) -> tuple[SearchAnswer, MarkerMotion, PoseTracks]:
    answer = request.search.answer(request.speech, request.weights, progress)
    motion = answer.motion
    loudness_db = _levels_db(request.audio)
    tracks = PoseTracks.of(request.speech.transcript, motion.rate_hz, len(motion.positions), loudness_db)
    return answer, polished(motion, request.polish), tracks


def _polish(request: tuple[MarkerMotion, Polish], _progress: Progress) -> MarkerMotion:
    return polished(*request)


@lru_cache(maxsize=2)
def _levels_db(audio: Audio) -> np.ndarray:
    return levels_db(audio.samples, audio.rate_hz)


def _price(search: LiveSearch, progress: Progress) -> PricedPath | None:
    return search.price(progress)
