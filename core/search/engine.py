"""The constrained search as an engine: aligned speech in, marker motion out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from core.motion.database import MotionDatabase
from core.motion.steadying import without_jitter, without_offsets
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import DeviceReport, NumpyKernels, SearchKernels
from core.search.constraints import SearchRequest, missing_phonemes
from core.search.lip_weight import pose_metric
from core.search.near_optimal import near_optimal_paths
from core.search.solve import solve
from core.search.terms import TransitionTerms
from core.search.transitions import PriceParts, TransitionCosts, TransitionParts
from core.search.weights import SearchWeights
from core.speech.emotion import EMOTIONS, emotion_weights
from core.speech.phoneme import PHONEME_INDEX
from core.synthesis.blend import blend_shares, blended, spoken_share
from core.synthesis.concatenate import SlotFrames, concatenate
from core.synthesis.emotion_strength import frame_strengths, is_mixed, pure_layers
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.options import CAPTURED, SynthesisOptions
from core.synthesis.silence import regenerate_silence
from core.synthesis.silence_motion import CapturedSilences
from core.synthesis.smoothing import smooth_joins

_EMOTION_FADE_S = 0.1  # between slots of different strength
FindPath = Callable[[SearchRequest, Progress], MotionPath]


@dataclass(frozen=True)
class SearchAnswer:
    """Motion, and the path that it came from; the best one, where several were blended.

    device : what the path was found on; None when the caller found it
    method : "relaxation", "exhaustive", or "session" for a path that the caller found
    warnings : sentences about a device that failed, and slots that the database serves badly
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
    options : what is done beyond the paper; `core.synthesis.options.PAPER` is the paper's own setting
    price : makes what is held of the transitions; see `core.search.transitions.TransitionCosts`
    """

    name = "search"

    def __init__(
        self,
        database: MotionDatabase,
        kernels: SearchKernels,
        weights: SearchWeights | None = None,
        exhaustive: bool = False,
        options: SynthesisOptions | None = None,
        price: PriceParts = TransitionParts.of,
    ) -> None:
        self.database = database
        self.kernels = kernels
        self.options = options or SynthesisOptions()
        self.weights = weights or database.weights
        self.frames = usable_frames(database, self.options)
        self._silences = CapturedSilences(database, self.frames) if self.options.silence == CAPTURED else None
        metric = pose_metric(database.pca, database.markers, self.options.lip_weight)
        compared = self.frames if self.options.lip_weight == 1.0 else self.frames @ metric
        terms = TransitionTerms(compared, database.nodes, database.rate_hz)
        self.costs = TransitionCosts(terms, self.weights, price=price)
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
        slots = self._slots(speech)
        return SearchRequest(
            phonemes=np.array([PHONEME_INDEX[u.phone] for u in utterances]),
            emotions=emotion_weights([u.start_s for u in utterances], [u.end_s for u in utterances], speech.modifiers),
            pins={slot: nodes.row(name) for slot, name in speech.pins.items()},
            removed=frozenset(nodes.row(name) for name in speech.removed),
            lengths=slots.stop - slots.start,
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
        motion = self._motion(request, path, self._slots(speech))
        progress.step(1.0, "motion made")
        synthesis_s = time.perf_counter() - searched
        lost = self.kernels.report.lost
        warnings = (*((lost,) if lost else ()), *missing_phonemes(request, self.database.nodes))
        return SearchAnswer(motion, path, self._slots(speech), searched - began, synthesis_s, device, method, warnings)

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

    def _slots(self, speech: SpeechInput) -> SlotFrames:
        utterances = speech.transcript.phonemes
        return SlotFrames.of([u.start_s for u in utterances], [u.end_s for u in utterances], self.database.rate_hz)

    def _motion(self, request: SearchRequest, path: MotionPath, slots: SlotFrames) -> MarkerMotion:
        """Blend near-optimal paths, and motions of pure emotions, as the options say."""
        if not (self.options.emotion_strength and is_mixed(request.emotions)):
            return self._marker_motion(self._blend(request, path, slots))
        layers = pure_layers(request.emotions)
        fade = round(_EMOTION_FADE_S * self.database.rate_hz)
        shares = frame_strengths([strength for _, strength in layers], slots, fade)
        positions = np.zeros(())
        for (emotions, _), share in zip(layers, shares):
            pure = replace(request, emotions=emotions)
            positions = positions + share[:, None, None] * self._blend(pure, self._solve(pure), slots)
        return self._marker_motion(positions)

    def _blend(self, request: SearchRequest, best: MotionPath, slots: SlotFrames) -> np.ndarray:
        """Marker positions of near-optimal paths, blended."""
        options = self.options
        paths = near_optimal_paths(request, best, self.costs, options.n_paths, options.surcharge)
        taken: set[int] = set()
        made = [self._positions(p.nodes, request.phonemes, slots, request.emotions, taken) for p in paths]
        shares = blend_shares([p.cost for p in paths], options.temperature * self.weights.pnt)
        return blended(made, shares, spoken_share(self.database.markers))

    def _solve(self, request: SearchRequest) -> MotionPath:
        return self._search(request, SILENT)[0]

    def motion_of(self, path: np.ndarray, phonemes: np.ndarray, slots: SlotFrames) -> MarkerMotion:
        """Return the motion of one path: section 7.2, with silence and frames as the options say."""
        any_emotion = np.ones((len(path), len(EMOTIONS)))
        return self._marker_motion(self._positions(path, phonemes, slots, any_emotion, set()))

    def _positions(
        self, path: np.ndarray, phonemes: np.ndarray, slots: SlotFrames, emotions: np.ndarray, taken: set[int]
    ) -> np.ndarray:
        """Concatenate, warp, smooth, make silence anew, and go back to markers (section 7.2)."""
        database = self.database
        motion = concatenate(path, slots, self.frames, database.nodes)
        motion = smooth_joins(motion, path, phonemes, slots, database.nodes)
        if self._silences is not None:
            motion = self._silences.fill(motion, phonemes, slots, emotions, taken)
        else:
            rest, rate_hz = database.rest_coefficients, database.rate_hz
            motion = regenerate_silence(motion, phonemes, slots, rest, rate_hz, self.options.silence)
        return database.pca.positions(motion)

    def _marker_motion(self, positions: np.ndarray) -> MarkerMotion:
        return MarkerMotion(positions.astype(np.float32), self.database.rate_hz, self.database.markers)


def usable_frames(database: MotionDatabase, options: SynthesisOptions) -> np.ndarray:
    """Return the database's frames as the search is to see them, float32, shape (n_frames, n_dims)."""
    frames = database.frames
    if options.jitter_window_s:
        frames = without_jitter(frames, database.sentences, database.rate_hz, options.jitter_window_s)
    if options.steady_sentences:
        frames = without_offsets(frames, database.sentences, database.rate_hz)
    return frames
