"""The figures, against counting and another library."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.metrics import roc_auc_score

from core.suspicion.measure import area_under_curve, precision_at_planted


def test_precision_counts_the_planted_among_as_many_worst():
    score = np.array([9.0, 1.0, 8.0, 7.0, 0.0])
    planted = np.array([True, True, False, False, False])
    assert precision_at_planted(score, planted) == 0.5
    assert precision_at_planted(-score, planted) == 0.5
    assert precision_at_planted(score, score > 7.5) == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_area_is_that_of_scikit_learn_with_ties(seed):
    rng = np.random.default_rng(seed)
    score = rng.integers(0, 6, 200).astype(float)
    planted = rng.random(200) < 0.1 + 0.1 * score / 6
    assert area_under_curve(score, planted) == pytest.approx(roc_auc_score(planted, score))


def test_area_needs_both_kinds():
    with pytest.raises(ValueError, match="planted and sound"):
        area_under_curve(np.ones(3), np.ones(3, bool))
