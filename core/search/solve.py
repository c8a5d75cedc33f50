"""The quickest exact way to a best path."""

from __future__ import annotations

from collections.abc import Callable

from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.transitions import TransitionCosts

# Gathering one transition for the relaxation takes some fifty times as long as reading it in a pass over the matrix.
_WIDEST_LATTICE = 0.02


def solve(
    request: SearchRequest,
    costs: TransitionCosts,
    kernels: Callable[[], SearchKernels],
    progress: Progress = SILENT,
) -> MotionPath:
    """Find the best path by relaxation, or exhaustively where the relaxation would look at much of the matrix anyway.

    kernels : gives a compute backend that was prepared with the matrix of ``costs``; asked only when it is needed
    Beyond the memory budget there is no matrix, and the relaxation has no limit. Raises `UserFacingError` when the
    request cannot be satisfied.
    """
    all_pairs = request.n_slots * float(len(costs.terms.nodes)) ** 2
    # a small lattice is quick however much of a small matrix it is
    most_pairs = max(_WIDEST_LATTICE * all_pairs, 1e7) if costs.is_held else float("inf")
    path = find_path_by_relaxation(request, costs, progress, most_pairs=most_pairs)
    return path if path is not None else find_path(request, costs, kernels(), progress)
