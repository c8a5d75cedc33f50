"""The engines by name: the window offers them, `efase synth` takes them, `efase evaluate` measures them.

A new engine adds its line to `ENGINES`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from core.animeme.engine import AnimemeEngine
from core.animeme.form import COHEN_MASSARO_NORMALISED
from core.animeme.form import PRINTED as PRINTED_ANIMEMES
from core.animeme.rival_engines import MmmEngine
from core.errors import UserFacingError
from core.evaluation.engines.phone_means import PhoneMeans
from core.evaluation.engines.random_nodes import RandomNodes
from core.evaluation.engines.static_face import StaticFace
from core.iface.engine import IfaceEngine
from core.iface.model_file import PAPER
from core.motion.database import MotionDatabase
from core.search.compute import SearchKernels
from core.search.engine import SearchEngine
from core.search.weights import SearchWeights
from core.synthesis.engine import MotionEngine
from core.synthesis.options import SEARCHES

DEFAULT_ENGINE = "search"
PRINTED = "search-paper"


class MakesEngine(Protocol):
    """Makes an engine for one database; only the search looks at more than that."""

    def __call__(
        self, database: MotionDatabase, kernels: SearchKernels, weights: SearchWeights, exhaustive: bool
    ) -> MotionEngine:
        """See `make_engine`."""


@dataclass(frozen=True)
class EngineKind:
    """What is known of an engine before it is made.

    title, tip : what the window calls it, and what it does, in a sentence
    searches : whether its motion is a path of motion nodes, with costs, prices, pins and weights
    is_offered : whether the window offers it; plain rivals are there to be measured beside
    can_hold : whether it can keep dragged sounds at their middle (`core.synthesis.engine.SpeechInput.holds`)
    listens : whether it goes by the sound alone, and learns from sentences that are kept with theirs
    """

    title: str
    tip: str
    make: MakesEngine
    searches: bool = False
    is_offered: bool = True
    can_hold: bool = False
    listens: bool = False


def _search(name: str, title: str, tip: str) -> EngineKind:
    def make(database, kernels, weights, exhaustive):
        return SearchEngine(database, kernels, weights, exhaustive, SEARCHES[name])

    return EngineKind(title, tip, make, searches=True)


def _rival(
    title: str, tip: str, make: Callable[[MotionDatabase, SearchKernels], MotionEngine], can_hold: bool = False
) -> EngineKind:
    return EngineKind(title, tip, lambda database, kernels, *_: make(database, kernels), False, False, can_hold)


ENGINES: Mapping[str, EngineKind] = MappingProxyType({
    "static": _rival("Still face", "The mean face of the database, held still.",
                     lambda database, kernels: StaticFace(database)),
    "phone-means": _rival("Mean faces", "What each phone looks like on average, and straight lines between.",
                          lambda database, kernels: PhoneMeans(database)),
    "random": _rival("Random nodes", "Any captured node of the right phone.",
                     lambda database, kernels: RandomNodes(make_engine(PRINTED, database, kernels))),
    "cohen-massaro": _rival("Cohen and Massaro", "Constant targets under normalised dominance functions.",
                            lambda database, kernels: AnimemeEngine(database, COHEN_MASSARO_NORMALISED), can_hold=True),
    "mmm": _rival("MMM", "Gaussians by phoneme, and the smoothest path through them.",
                  lambda database, kernels: MmmEngine(database)),
    "animeme-printed": _rival("Animemes, as printed", "Dominated animemes as the paper of 2012 prints them.",
                              lambda database, kernels: AnimemeEngine(database, PRINTED_ANIMEMES), can_hold=True),
    "animeme": EngineKind("Dominated animemes", "A shape over time for every phoneme, learnt from the captures, "
                          "and how far each rules its neighbours; smooth, and at once.",
                          lambda database, *_: AnimemeEngine(database), can_hold=True),
    "iface-paper": EngineKind("Speaking face, as printed", "Goes by the sound alone, as the paper of 2002 prints it: a "
                              "perceptron for each class of sound.",
                              lambda database, *_: IfaceEngine(database, PAPER), listens=True),
    "iface": EngineKind("Speaking face", "Goes by the sound alone, as it does live: no words are needed, and there is "
                        "nothing to pin.", lambda database, *_: IfaceEngine(database), listens=True),
    PRINTED: _search(PRINTED, "Search, as printed", "The constrained search as the paper of 2008 prints it: one path, "
                     "no context, straight silences."),
    "search-single": _search("search-single", "Search, best path alone", "The motion of the best path alone: every "
                             "frame is one capture, a little less smooth."),
    DEFAULT_ENGINE: _search(DEFAULT_ENGINE, "Constrained search", "The best path through the captured motion nodes, "
                            "blended with its near rivals."),
})  # fmt: skip


def engine_kind(name: str) -> EngineKind:
    """Return what is known of the engine ``name``; raises `UserFacingError` for one that there is not."""
    if name not in ENGINES:
        raise UserFacingError(f"There is no engine '{name}'.", f"Choose among {', '.join(ENGINES)}.")
    return ENGINES[name]


def weights_of(name: str, database: MotionDatabase, asked: SearchWeights | None = None) -> SearchWeights:
    """Return what the engine ``name`` weighs by when ``asked`` for these weights, or for none.

    The search as printed has weights of its own, tuned for just that if there are any, and never those that go beyond
    the paper.
    """
    if name == PRINTED:
        return database.paper_weights if asked is None else asked.as_printed
    return database.weights if asked is None else asked


def make_engine(
    name: str, database: MotionDatabase, kernels: SearchKernels, weights: SearchWeights | None = None,
    exhaustive: bool = False,
) -> MotionEngine:  # fmt: skip
    """Make the engine ``name``; raises `UserFacingError` for one that there is not.

    kernels : what a search computes on; two searches that live side by side need kernels each
    weights : None for the database's own; see `weights_of`
    exhaustive : see `core.search.engine.SearchEngine`
    """
    return engine_kind(name).make(database, kernels, weights_of(name, database, weights), exhaustive)


def make_engines(
    names: Sequence[str], database: MotionDatabase, open_kernels: Callable[[], SearchKernels]
) -> dict[str, MotionEngine]:
    """Make the engines ``names``, each on kernels of its own, for those keep one engine's costs.

    None named are all; but a database that keeps no sound has nothing for those that listen.
    """
    for name in names:
        engine_kind(name)
    if not names:
        is_audible = any(database.audio_bytes(sentence.name) is not None for sentence in database.sentences)
        names = [name for name, kind in ENGINES.items() if is_audible or not kind.listens]
    return {name: make_engine(name, database, open_kernels()) for name in names}
