"""The quickest exact way to a best path."""

from __future__ import annotations

from collections.abc import Callable

from core.errors import UserFacingError
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.transitions import TransitionCosts

# Gathering one transition for the relaxation takes some fifty times as long as reading it in a pass over the matrix.
_WIDEST_LATTICE = 0.02
# Without a matrix the lattice is all there is: 2 GiB of it, for a minute, which most sentences do not need.
_MOST_PAIRS = 2**29
_LONGEST_S = 60.0


def solve(
    request: SearchRequest,
    costs: TransitionCosts,
    kernels: Callable[[], SearchKernels],
    progress: Progress = SILENT,
) -> MotionPath:
    """Find the best path by relaxation, or exhaustively where the relaxation would look at much of the matrix anyway.

    kernels : gives a compute backend that was prepared with the matrix of ``costs``; asked only when it is needed
    Beyond the memory budget there is no matrix, and the relaxation goes on as long as its lattice stays within a budget
    of its own, a minute at most; the answer is then the best path that it found, with the bound that it reached. Raises
    `UserFacingError` when the request cannot be satisfied, or the database is too large for it.
    """
    if not costs.is_held:
        path = find_path_by_relaxation(request, costs, progress, _LONGEST_S, most_pairs=_MOST_PAIRS)
        if path is None:
            raise UserFacingError(
                f"A database of {len(costs.terms.nodes)} motion nodes is too large for this sentence.",
                "Pin some of its phonemes, or build a smaller database.",
            )
        return path
    all_pairs = request.n_slots * float(len(costs.terms.nodes)) ** 2
    # a small lattice is quick however much of a small matrix it is
    path = find_path_by_relaxation(request, costs, progress, most_pairs=max(_WIDEST_LATTICE * all_pairs, 1e7))
    return path if path is not None and path.is_optimal else find_path(request, costs, kernels(), progress)
