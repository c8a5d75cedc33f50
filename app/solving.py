"""The motion follows the document: each edit is answered at once, and its alternatives are priced soon after."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np
from PySide6.QtCore import QObject, Signal

from app import texts
from app.jobs import JobRunner
from core.document.change import ASKED_OF_THE_SEARCH, Change
from core.document.document import Document
from core.document.live_engine import LiveEngine
from core.document.live_search import PricedPath
from core.media.audio import Audio
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.rig.control_layer import laid_over
from core.search.best_path import MotionPath
from core.search.engine import SearchEngine
from core.search.weights import SearchWeights
from core.speech.loudness import levels_db
from core.synthesis.control_edits import ControlEdits
from core.synthesis.engine import EngineAnswer, MotionEngine, SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import Polish
from core.synthesis.pose_tracks import PoseTracks
from core.synthesis.registry import DEFAULT_ENGINE, make_engine


class Solving(QObject):
    """Animates in the background, for as long as the sound on show is the one that `follow` was asked for.

    solved(EngineAnswer) : the document shows another motion
    """

    solved = Signal(object)

    def __init__(self, document: Document, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document, self._jobs = document, jobs
        # by content of the database and name, so that undo need not price transitions again
        self._engines: dict[tuple[str, str], LiveEngine] = {}
        self._followed: Audio | None = None
        self._tracks = PoseTracks()
        self.changed_slots: tuple[int, ...] = ()
        document.changed.connect(self._on_document_changed)

    def add_engine(self, engine: SearchEngine) -> None:
        """Take the search of a database that was opened; other engines for it are made when they are asked for."""
        self._engines.setdefault((engine.database.content_hash, DEFAULT_ENGINE), LiveEngine(lambda: engine))

    def engine(self, name: str) -> LiveEngine:
        """Return the engine ``name`` for the database that is open, one for all who ask."""
        database = self._document.database
        key = database.content_hash, name
        if key not in self._engines:
            self._engines[key] = LiveEngine(partial(_made_engine, name, database))
        return self._engines[key]

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
        if change & (Change.CONTROLS | Change.POLISH) and self._document.answer is not None:
            request = self._document.answer.motion, _Layers.of(self._document)
            self._jobs.start("polish", "", request, _lay_over, self._document.show_motion)
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
        weights, audio = document.search_weights, document.speech.audio
        request = _SolveRequest(self.engine(document.engine), speech, weights, audio, _Layers.of(document))
        self._jobs.start("search", texts.SYNTHESISING, request, _solve, self._on_solved)

    def _on_solved(self, solved: tuple[EngineAnswer, MarkerMotion, PoseTracks]) -> None:
        answer, motion, self._tracks = solved
        self._jobs.cancel("polish")
        document, before, path = self._document, self._document.path, getattr(answer, "path", None)
        self.changed_slots = () if before is None or path is None else changed_slots(before, path)
        document.show_answer(answer, motion)
        self.solved.emit(answer)
        if path is not None:
            self._jobs.start("prices", "", self.engine(document.engine), _price, self._on_priced)

    def _on_priced(self, priced: PricedPath | None) -> None:
        if priced is not None and priced.path is self._document.path:
            self._document.show_prices(priced.prices, priced.breakdown)


def changed_slots(before: MotionPath, after: MotionPath) -> tuple[int, ...]:
    """Return the slots whose motion node is another one; none where the slots themselves are others."""
    if len(before.nodes) != len(after.nodes):
        return ()
    return tuple(np.flatnonzero(before.nodes != after.nodes).tolist())


@dataclass(frozen=True)
class _Layers:
    """What is laid over the motion of any engine."""

    database: MotionDatabase
    controls: ControlEdits
    polish: Polish

    @classmethod
    def of(cls, document: Document) -> _Layers:
        return cls(document.database, document.controls, document.polish)

    def over(self, motion: MarkerMotion) -> MarkerMotion:
        return laid_over(motion, self.database, self.controls, self.polish)


@dataclass(frozen=True)
class _SolveRequest:
    engine: LiveEngine
    speech: SpeechInput
    weights: SearchWeights | None
    audio: Audio
    layers: _Layers


def _solve(request: _SolveRequest, progress: Progress) -> tuple[EngineAnswer, MarkerMotion, PoseTracks]:
    answer = request.engine.answer(request.speech, request.weights, progress)
    motion = answer.motion
    loudness_db = _levels_db(request.audio)
    tracks = PoseTracks.of(request.speech.transcript, motion.rate_hz, len(motion.positions), loudness_db)
    return answer, request.layers.over(motion), tracks


def _lay_over(request: tuple[MarkerMotion, _Layers], _progress: Progress) -> MarkerMotion:
    motion, layers = request
    return layers.over(motion)


@lru_cache(maxsize=2)
def _levels_db(audio: Audio) -> np.ndarray:
    return levels_db(audio.samples, audio.rate_hz)


def _made_engine(name: str, database: MotionDatabase) -> MotionEngine:
    from gpu.device import open_kernels

    return make_engine(name, database, open_kernels()[0])


def _price(engine: LiveEngine, progress: Progress) -> PricedPath | None:
    return engine.price(progress)
