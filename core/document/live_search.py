"""A search that follows a document: edits are answered from what the last search left, and alternatives are priced."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.progress import SILENT, Progress
from core.search.best_path import MotionPath
from core.search.constraints import SearchRequest
from core.search.engine import SearchAnswer, SearchEngine
from core.search.session import SearchSession
from core.search.weights import SearchWeights
from core.synthesis.engine import SpeechInput

# The tables behind the prices take 24 bytes a slot and node, the prices 8 more.
MOST_PRICES = 1 << 24


@dataclass(frozen=True)
class PricedPath:
    """What goes with one path.

    path : whose alternatives these are
    prices : float64, shape (n_slots, n_nodes), cost added if a node is forced into a slot; None beyond `MOST_PRICES`
    breakdown : cost of each slot by term; see `SearchSession.breakdown`
    """

    path: MotionPath
    prices: np.ndarray | None
    breakdown: Sequence[Mapping[str, float]]


class LiveSearch:
    """One engine and the session that it keeps; threads take turns.

    An answer equals what `SearchEngine.synthesise` finds from nothing for the same question.
    """

    def __init__(self, engine: SearchEngine) -> None:
        self.engine = engine
        self._session: SearchSession | None = None
        self._lock = threading.Lock()

    def answer(
        self, speech: SpeechInput, weights: SearchWeights | None = None, progress: Progress = SILENT
    ) -> SearchAnswer:
        """Find the best motion under ``weights`` (None: the database's).

        Raises `UserFacingError` when the request cannot be satisfied.
        """
        with self._lock:
            engine = self.engine
            weights = weights or engine.database.weights
            if weights != engine.weights:
                self._session = None
                engine.reweight(weights)
            find = self._find if engine.costs.is_held else None
            return engine.synthesise(speech, progress, find)

    def _find(self, request: SearchRequest, _progress: Progress) -> MotionPath:
        if self._session is None:
            self._session = SearchSession(request, self.engine.costs, self.engine.prepared_kernels())
        else:
            self._session.update(request)
        return self._session.path

    def price(self, progress: Progress = SILENT) -> PricedPath | None:
        """Price every alternative to the last answer, which takes a pass over the transitions a slot.

        None when there is no answer, or the database is beyond the memory budget. A cancel keeps what was done.
        """
        with self._lock:
            session = self._session
            if session is None:
                return None
            n_slots, n_nodes = session.request.n_slots, len(self.engine.database.nodes)
            prices = None
            if n_slots * n_nodes <= MOST_PRICES:
                session.refresh(progress)
                prices = np.stack([session.prices(slot) for slot in range(n_slots)])
            return PricedPath(session.path, prices, tuple(session.breakdown()))
