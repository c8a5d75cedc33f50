"""Classes of sound: scikit-learn's mixtures, scored by plain numpy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal
from sklearn.mixture import GaussianMixture

from core.iface.classes import fit_classes, spoken_phones
from core.iface.heard_takes import HeardTake
from core.speech.phoneme import PHONEME_INDEX, PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript


@pytest.fixture(scope="module")
def heard():
    """Three phonemes apart, one that is rare, and one that nothing tells from another."""
    rng = np.random.default_rng(0)
    counts = {"aa": 400, "s": 300, "pau": 200, "zh": 9}
    features = [rng.normal(6.0 * i, 1.0 + 0.5 * i, (n, 10)) for i, n in enumerate(counts.values())]
    phones = np.repeat([PHONEME_INDEX[p] for p in counts], list(counts.values()))
    return np.concatenate(features), phones


def test_scores_are_those_of_sklearn_and_of_scipy(heard):
    features, phones = heard
    classes = fit_classes(features, phones, n_components=2, fewest=100, seed=3)
    scores = classes.scores(features)
    spread = features.var(axis=0).mean()
    for c, phone in enumerate(classes.phones):
        mine = features[phones == PHONEME_INDEX[phone]]
        twin = GaussianMixture(2, reg_covar=1e-3 * spread, random_state=3, max_iter=50, tol=1e-2).fit(mine)
        np.testing.assert_allclose(scores[:, c], twin.score_samples(features), rtol=1e-9)
        densities = [
            np.log(w) + multivariate_normal(m, v).logpdf(features)
            for w, m, v in zip(twin.weights_, twin.means_, twin.covariances_)
        ]
        np.testing.assert_allclose(scores[:, c], logsumexp(densities, axis=0), rtol=1e-6)


def test_a_frame_goes_to_its_phoneme_and_a_rare_phoneme_to_the_class_that_scores_next(heard):
    features, phones = heard
    classes = fit_classes(features, phones, n_components=3, fewest=50, seed=0)
    assert set(classes.phones) == {"aa", "s", "pau"}
    best = np.array(classes.phones)[classes.best(features)]
    said = np.array(PHONEMES)[phones]
    assert (best == said)[said != "zh"].mean() > 0.99
    assert set(best[said == "zh"]) == {"pau"}  # the nearest and widest


def test_a_class_that_hardly_ever_wins_is_left_out():
    rng = np.random.default_rng(1)
    features = np.concatenate([rng.normal(0.0, 1.0, (500, 10)), rng.normal(0.0, 1.3, (60, 10))])
    phones = np.repeat([PHONEME_INDEX["aa"], PHONEME_INDEX["ae"]], [500, 60])
    assert len(fit_classes(features, phones, 1, fewest=50, seed=0).phones) == 2
    won = np.bincount(fit_classes(features, phones, 1, fewest=50, seed=0).best(features))
    kept = fit_classes(features, phones, 1, fewest=int(won.min()) + 1, seed=0)
    assert len(kept.phones) == 1


def test_too_little_speech_is_one_class():
    few = np.random.default_rng(2).normal(size=(3, 10))
    classes = fit_classes(few, np.array([0, 1, 2]), 3, fewest=100, seed=0)
    assert len(classes.phones) == 1 and np.isfinite(classes.scores(few)).all()


def test_frames_are_labelled_by_what_their_windows_heard():
    spoken = [("pau", 0.0, 0.5), ("b", 0.5, 0.6), ("aa", 0.6, 1.0)]
    transcript = Transcript(tuple(PhonemeUtterance(*s) for s in spoken), (), 1.0)
    take = HeardTake("s", "neutral", transcript, np.zeros((30, 10)), np.zeros((30, 1, 3)), np.ones(30, bool))
    named = [PHONEMES[p] for p in spoken_phones(take)]
    # windows of frame 15, at 0.5 s, end between 0.467 and 0.5 s; those of frame 16 between 0.5 and 0.533 s
    assert named[15] == "pau" and named[17] == "b" and named[19:] == ["aa"] * 11
