"""The constrained search as an engine: aligned speech in, marker motion out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import DeviceReport, NumpyKernels, SearchKernels
from core.search.constraints import SearchRequest, missing_phonemes
from core.search.solve import solve
from core.search.terms import TransitionTerms
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights
from core.speech.emotion import emotion_weights
from core.speech.phoneme import PHONEME_INDEX
from core.synthesis.concatenate import SlotFrames, concatenate
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.silence import regenerate_silence
from core.synthesis.smoothing import smooth_joins

FindPath = Callable[[SearchRequest, Progress], MotionPath]


@dataclass(frozen=True)
class SearchAnswer:
    """Motion, and the path that it came from.

    device : what the path was found on; None when the caller found it
    method : "relaxation", "exhaustive", or "session" for a path that the caller found
    warnings : sentences about slots that the database serves badly
    """

    motion: MarkerMotion
    path: MotionPath
    slots: SlotFrames
    search_s: float
    synthesis_s: float
    device: DeviceReport | None = None
    method: str = "session"
    warnings: tuple[str, ...] = ()


class SearchEngine:
    """Constrained search over a motion database (Deng and Neumann 2008, sections 6.2 and 7.2).

    exhaustive : look at every node in every slot, on the compute backend, as the paper does; otherwise the relaxation
        finds the same path in a fraction of the time and proves that it is the best
    """

    name = "search"

    def __init__(
        self,
        database: MotionDatabase,
        kernels: SearchKernels,
        weights: SearchWeights | None = None,
        exhaustive: bool = False,
    ) -> None:
        self.database = database
        self.kernels = kernels
        self.weights = weights or database.weights
        terms = TransitionTerms(database.frames, database.nodes, database.rate_hz)
        self.costs = TransitionCosts(terms, self.weights)
        self.exhaustive = exhaustive
        self._is_prepared = False

    def prepare(self, progress: Progress = SILENT) -> None:
        """Price all transitions, once, and hand them to the compute backend if it is to see them all."""
        self.costs.prepare(progress)
        if self.exhaustive:
            self.prepared_kernels()

    def prepared_kernels(self) -> SearchKernels:
        """Return the compute backend, which knows all transitions."""
        if not self._is_prepared:
            self.kernels.prepare(self.costs.matrix)
            self._is_prepared = True
        return self.kernels

    def reweight(self, weights: SearchWeights) -> None:
        """Search under other weights from now on."""
        if weights != self.weights:
            self.weights = weights
            self.costs.reweight(weights)
            self._is_prepared = False

    def request(self, speech: SpeechInput) -> SearchRequest:
        """Translate names to rows; raises `UserFacingError` for a node that the database does not have."""
        utterances = speech.transcript.phonemes
        nodes = self.database.nodes
        return SearchRequest(
            phonemes=np.array([PHONEME_INDEX[u.phone] for u in utterances]),
            emotions=emotion_weights([u.start_s for u in utterances], [u.end_s for u in utterances], speech.modifiers),
            pins={slot: nodes.row(name) for slot, name in speech.pins.items()},
            removed=frozenset(nodes.row(name) for name in speech.removed),
            start_s=tuple(u.start_s for u in utterances),
        )

    def synthesise(
        self, speech: SpeechInput, progress: Progress = SILENT, find: FindPath | None = None
    ) -> SearchAnswer:
        """Find the best path and turn it into marker motion at the database's rate.

        find : finds the path another way, for instance by a session that was asked before; it must find the same
        """
        request = self.request(speech)
        self.prepare(progress.part(0.0, 0.5))
        began = time.perf_counter()
        stage = progress.part(0.5, 0.9)
        if find is not None:
            path, device, method = find(request, stage), None, "session"
        else:
            path, device, method = self._search(request, stage)
        searched = time.perf_counter()
        slots = SlotFrames.of(
            [u.start_s for u in speech.transcript.phonemes],
            [u.end_s for u in speech.transcript.phonemes],
            self.database.rate_hz,
        )
        motion = self.motion_of(path.nodes, request.phonemes, slots)
        progress.step(1.0, "motion made")
        synthesis_s = time.perf_counter() - searched
        warnings = missing_phonemes(request, self.database.nodes)
        return SearchAnswer(motion, path, slots, searched - began, synthesis_s, device, method, warnings)

    def _search(self, request: SearchRequest, progress: Progress) -> tuple[MotionPath, DeviceReport, str]:
        """Return the best path, and what it was found on, by which method."""
        asked = []

        def kernels() -> SearchKernels:
            asked.append(True)
            return self.prepared_kernels()

        if self.exhaustive:
            path = find_path(request, self.costs, kernels(), progress)
        else:
            path = solve(request, self.costs, kernels, progress)
        if asked:
            return path, self.kernels.report, "exhaustive"
        return path, NumpyKernels.report, "relaxation"

    def motion_of(self, path: np.ndarray, phonemes: np.ndarray, slots: SlotFrames) -> MarkerMotion:
        """Concatenate, warp, smooth, regenerate silence, and go back to markers (section 7.2)."""
        database = self.database
        motion = concatenate(path, slots, database.frames, database.nodes)
        motion = smooth_joins(motion, path, phonemes, slots, database.nodes)
        motion = regenerate_silence(motion, phonemes, slots, database.rest_coefficients, database.rate_hz)
        return MarkerMotion(database.pca.positions(motion).astype(np.float32), database.rate_hz, database.markers)
