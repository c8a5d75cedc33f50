"""Whichever engine the document asks for, made when it is first asked, and kept."""

from __future__ import annotations

import threading
from collections.abc import Callable

from core.document.live_search import LiveSearch, PricedPath
from core.progress import SILENT, Progress
from core.search.engine import SearchEngine
from core.search.weights import SearchWeights
from core.synthesis.engine import EngineAnswer, MotionEngine, SpeechInput


class LiveEngine:
    """One engine that follows a document; threads take turns. A search keeps its session (`LiveSearch`).

    make : makes the engine, in the thread that first asks for an answer
    """

    def __init__(self, make: Callable[[], MotionEngine]) -> None:
        self._make = make
        self._engine: MotionEngine | None = None
        self._search: LiveSearch | None = None
        self._lock = threading.Lock()

    def answer(
        self, speech: SpeechInput, weights: SearchWeights | None = None, progress: Progress = SILENT
    ) -> EngineAnswer:
        """Animate ``speech``, a search under ``weights``; raises `UserFacingError` for what cannot be animated."""
        with self._lock:
            if self._engine is None:
                self._engine = self._make()
                if isinstance(self._engine, SearchEngine):
                    self._search = LiveSearch(self._engine)
            if self._search is None:
                self._engine.prepare(progress.part(0.0, 0.5))
                return self._engine.synthesise(speech, progress.part(0.5, 1.0))
        return self._search.answer(speech, weights, progress)

    def price(self, progress: Progress = SILENT) -> PricedPath | None:
        """Price every alternative to the last answer; None where there is none, or no path. See `LiveSearch.price`."""
        return None if self._search is None else self._search.price(progress)
