"""Two ways to good weights: the paper's gradient descent from many random starts, and an evolution strategy.

Motion nodes change one for another, so the error is piecewise constant in the weights: its derivative is 0 wherever it
exists. Gradient descent therefore takes central differences over steps of a tenth and more of a weight, wide enough to
cross many such changes, and a line search that only accepts what really is better.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence

import numpy as np

from core.evaluation.tuning_fields import TuningSpace

# Errors of points on some of the sentences: (points (n, n_dims), sentence numbers) -> mm², shape (n, n_sentences)
Ask = Callable[[np.ndarray, Sequence[int]], np.ndarray]

_DIFFERENCE = 0.25  # of a weight's logarithm, to either side
_FIRST_STEP, _LAST_STEP = 1.0, 0.02  # length of a step, in the same unit
_SHORTER = (1.0, 0.5, 0.2)  # what the line search tries, of the step
_RUNGS = ((1 / 10, 1.0, 0.4), (1 / 3, 1 / 6, 0.3), (1.0, 1 / 25, 0.3))  # of sentences, of starts, of the budget


def gradient_descent(space: TuningSpace, starts: np.ndarray, ask: Ask, n_sentences: int, budget: int) -> None:
    """Descend from all ``starts`` at once, shape (n_starts, n_dims), the paper's way (section 6.4).

    So that hundreds of starts can be paid for, they all begin on a tenth of the sentences; the best sixth of them goes
    on with a third of the sentences, and the best few with all.

    budget : sentence-solves to spend
    """
    points, steps = starts.clip(space.low, space.high), np.full(len(starts), _FIRST_STEP)
    for share_of_sentences, share_of_starts, share_of_budget in _RUNGS:
        sentences = range(max(2, round(share_of_sentences * n_sentences)))
        values = ask(points, sentences).sum(axis=1)
        kept = np.argsort(values, kind="stable")[: max(2, round(share_of_starts * len(starts)))]
        points, steps, values = points[kept], steps[kept], values[kept]
        left = share_of_budget * budget - values.size
        cost = len(points) * len(sentences) * (2 * len(space.names) + len(_SHORTER))
        while left >= cost and (steps > _LAST_STEP).any():
            points, values, steps = _descend(space, points, values, steps, ask, sentences)
            left -= cost
    ask(points, range(n_sentences))


def _descend(
    space: TuningSpace, points: np.ndarray, values: np.ndarray, steps: np.ndarray, ask: Ask, sentences: Sequence[int]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One step of each point, along its differences, as far as it gets better; a step that fails is halved."""
    n_dims = points.shape[1]
    offsets = _DIFFERENCE * np.eye(n_dims)
    sides = []
    for sign in (1.0, -1.0):
        probes = (points[:, None] + sign * offsets).clip(space.low, space.high)
        sides.append(ask(probes.reshape(-1, n_dims), sentences).sum(axis=1).reshape(len(points), n_dims))
    slope = sides[0] - sides[1]
    length = np.linalg.norm(slope, axis=1, keepdims=True)
    direction = -slope / np.where(length > 0, length, 1.0)
    shorter = np.array(_SHORTER)
    trials = points[:, None] + shorter[None, :, None] * steps[:, None, None] * direction[:, None]
    trials = trials.clip(space.low, space.high)
    found = ask(trials.reshape(-1, n_dims), sentences).sum(axis=1).reshape(len(points), len(shorter))
    best = found.argmin(axis=1)
    everyone = np.arange(len(points))
    better = found[everyone, best] < values
    points = np.where(better[:, None], trials[everyone, best], points)
    values = np.where(better, found[everyone, best], values)
    return points, values, np.where(better, steps, steps * 0.5)


def evolution(space: TuningSpace, starts: np.ndarray, ask: Ask, n_sentences: int, seed: int) -> None:
    """Halve ``starts`` on more and more sentences, then walk on from the best by CMA-ES until the budget ends.

    CMA-ES (Hansen 2006) looks at ranks only, so steps of the error and flat stretches between them do it no harm.
    When a run has settled, the next begins at the next best start.
    """
    with warnings.catch_warnings():
        # cma says that it cannot draw without matplotlib, which is no news to who asks it for numbers
        warnings.filterwarnings("ignore", message="Could not import matplotlib", category=UserWarning)
        import cma

    points = starts.clip(space.low, space.high)
    for share, kept in ((1 / 6, 1 / 4), (1 / 3, 1 / 10), (1.0, 1.0)):
        sentences = range(max(2, round(share * n_sentences)))
        values = ask(points, sentences).sum(axis=1)
        points = points[np.argsort(values, kind="stable")[: max(2, round(kept * len(starts)))]]
    rng = np.random.default_rng(seed)
    width = space.high - space.low
    options = {"CMA_stds": width / 6.0, "popsize": 16, "verbose": -9, "seed": np.nan, "tolfun": 1e-3,
               "randn": lambda *shape: rng.standard_normal(shape)}  # fmt: skip
    for run in range(len(points)):
        strategy = cma.CMAEvolutionStrategy(points[run], 1.0, options)
        while not strategy.stop():
            asked = np.array(strategy.ask())
            within = asked.clip(space.low, space.high)
            values = ask(within, range(n_sentences)).sum(axis=1)
            # beyond the bounds it is uphill, so that the walk comes back
            uphill = 1.0 + (((asked - within) / width) ** 2).sum(axis=1)
            strategy.tell(list(asked), (values * uphill).tolist())
