"""The engines that can be measured, by name. A new one adds its line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.errors import UserFacingError
from core.evaluation.engines.phone_means import PhoneMeans
from core.evaluation.engines.random_nodes import RandomNodes
from core.evaluation.engines.static_face import StaticFace
from core.motion.database import MotionDatabase
from core.search.compute import SearchKernels
from core.search.engine import SearchEngine
from core.synthesis.engine import MotionEngine
from core.synthesis.options import PAPER, SEARCHES

EngineFactory = Callable[[MotionDatabase, SearchKernels], MotionEngine]


def paper_search(database: MotionDatabase, kernels: SearchKernels) -> SearchEngine:
    """Make the search as Deng and Neumann (2008) print it, with weights tuned for just that if there are any."""
    return SearchEngine(database, kernels, database.paper_weights, options=PAPER)


ENGINES: Mapping[str, EngineFactory] = {
    "static": lambda database, kernels: StaticFace(database),
    "phone-means": lambda database, kernels: PhoneMeans(database),
    "random": lambda database, kernels: RandomNodes(paper_search(database, kernels)),
    "search-paper": paper_search,
    "search-single": lambda database, kernels: SearchEngine(database, kernels, options=SEARCHES["search-single"]),
    "search": SearchEngine,
}


def make_engines(names: Sequence[str], database: MotionDatabase, kernels: SearchKernels) -> dict[str, MotionEngine]:
    """Make the engines ``names`` (all when empty); raises `UserFacingError` for one that there is not."""
    unknown = [name for name in names if name not in ENGINES]
    if unknown:
        raise UserFacingError(f"There is no engine '{unknown[0]}'.", f"Choose among {', '.join(ENGINES)}.")
    return {name: ENGINES[name](database, kernels) for name in names or ENGINES}
