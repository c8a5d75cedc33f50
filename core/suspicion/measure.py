"""How good a ranking is, when it is known which nodes are contaminated."""

from __future__ import annotations

import numpy as np
from scipy.stats import rankdata


def precision_at_planted(score: np.ndarray, planted: np.ndarray) -> float:
    """Return the share of planted nodes among as many worst ones; chance is the planted share of all.

    score : shape (n_nodes,), worst highest; equal scores keep their order of rows
    planted : bool, same shape
    """
    worst = np.argsort(-score, kind="stable")[: int(planted.sum())]
    return float(planted[worst].mean()) if len(worst) else 0.0


def area_under_curve(score: np.ndarray, planted: np.ndarray) -> float:
    """Return the chance that a planted node scores above a sound one, ties counting half (area under the ROC curve).

    score : shape (n_nodes,); planted : bool, same shape, with both kinds in it; raises `ValueError` otherwise
    """
    n_planted, n_sound = int(planted.sum()), int((~planted).sum())
    if n_planted == 0 or n_sound == 0:
        raise ValueError("the area under the curve needs planted and sound nodes")
    ranks = rankdata(score)
    return float((ranks[planted].sum() - n_planted * (n_planted + 1) / 2) / (n_planted * n_sound))
