"""What is drawn of the dominance functions is what the curves are made of."""

from __future__ import annotations

import numpy as np
import pytest

from core.animeme.animeme import AnimemeModel
from core.animeme.form import AnimemeForm
from core.animeme.levels import N_PHONEMES, levels_of
from core.animeme.ruling import ruling_of
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import PhonemeUtterance, Transcript

RATE_HZ = 50.0
SAID = Transcript.covering(
    [PhonemeUtterance(p, 0.2 * i, 0.2 * (i + 1)) for i, p in enumerate(("pau", "m", "aa", "pau"))], [], 0.8
)


@pytest.fixture
def constant():
    """One constant target a phoneme: equation 1 is then the mean of the targets, weighed by the shares."""
    form = AnimemeForm(degree=0, context_degree=-1, duration_degree=-1, emotion_degree=-1)
    tables = {level.name: np.zeros((level.n_rows, level.degree + 1, 2)) for level in levels_of(form, {})}
    table = tables["phoneme"]
    table[:, 0] = np.random.default_rng(5).normal(size=(N_PHONEMES, 2))
    widths, span_s = np.full((1, 2, N_PHONEMES), 0.6), np.tile([[0.01], [2.0]], N_PHONEMES)
    return AnimemeModel(form, ("a", "b"), np.array([0.1, 0.2]), widths, np.zeros(2, int), tables, span_s), table


def test_shares_of_what_is_asked_make_the_curves(constant):
    model, _ = constant
    ruling = ruling_of(model, SAID, (), RATE_HZ, 40)
    assert ruling.shares.shape == (4, 40) and np.allclose(ruling.shares.sum(axis=0), 1)
    assert np.allclose(ruling.shares.T @ ruling.asked, model.curves(SAID, RATE_HZ, n_frames=40).values, atol=1e-4)


def test_each_phoneme_rules_its_own_centre_and_asks_for_its_own_target(constant):
    model, table = constant
    ruling = ruling_of(model, SAID, (), RATE_HZ, 40)
    assert ruling.shares[:, [5, 15, 25, 35]].argmax(axis=0).tolist() == [0, 1, 2, 3]
    assert np.allclose(ruling.asked[2], table[PHONEME_INDEX["aa"], 0] + model.rest)
