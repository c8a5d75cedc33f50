"""The tuning's error against that of the evaluation."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.comparison import CapturedTruth
from core.evaluation.evaluate import evaluate
from core.evaluation.tuning_problem import TuningProblem
from core.evaluation.tuning_workers import TuningEvaluator
from core.motion.resample import resample
from core.search.compute import NumpyKernels
from core.search.engine import SearchEngine
from core.synthesis.options import PAPER, SynthesisOptions


def errors(database, weights, objective="all", options=PAPER) -> np.ndarray:
    problem = TuningProblem.of(database, database.held_out_recordings("tune"), objective, options)
    evaluator = TuningEvaluator(problem)
    return np.array([evaluator.error(weights, s) for s in range(len(problem.sentences))])


@pytest.mark.parametrize("options", [PAPER, SynthesisOptions(n_paths=1, silence="cosine", lip_weight=3.0)])
def test_it_is_the_error_that_the_evaluation_measures(mouth_database, options):
    weights = mouth_database.weights
    engine = SearchEngine(mouth_database, NumpyKernels(), weights, options=options)
    recordings = mouth_database.held_out_recordings("tune")
    measured = evaluate(mouth_database, recordings, {"it": engine}).engines["it"].scores.error_mm2
    assert errors(mouth_database, weights, options=options).mean() == pytest.approx(measured, rel=1e-4)


def test_the_gap_alone_is_compared_when_asked(mouth_database):
    engine = SearchEngine(mouth_database, NumpyKernels(), options=PAPER)
    recordings = sorted(mouth_database.held_out_recordings("tune"), key=lambda r: r.sentence)
    comparisons = evaluate(mouth_database, recordings, {"it": engine}).engines["it"].comparisons
    found = errors(mouth_database, mouth_database.weights, "gap")
    for error, comparison in zip(found, comparisons):
        truth: CapturedTruth = comparison.truth
        off = truth.gap_mm(comparison.synthesised) - truth.gap_mm(truth.positions)
        assert error == pytest.approx(float((off[truth.usable] ** 2).mean()), rel=1e-3)


def test_sentences_come_from_each_emotion_in_turn(mouth_database, mouth_corpus):
    problem = TuningProblem.of(mouth_database, mouth_corpus.recordings[:6])
    emotions = [s.request.emotions[0].argmax() for s in problem.sentences]
    assert emotions == [0, 2] * 3 or emotions == [2, 0] * 3


def test_another_question_has_another_key(mouth_database):
    recordings = mouth_database.held_out_recordings("tune")
    asked = [
        TuningProblem.of(mouth_database, recordings), TuningProblem.of(mouth_database, recordings, "lips"),
        TuningProblem.of(mouth_database, recordings[:1]),
        TuningProblem.of(mouth_database, recordings, options=SynthesisOptions(n_paths=1)),
    ]  # fmt: skip
    assert len({problem.key for problem in asked}) == len(asked)
    assert asked[0].key == TuningProblem.of(mouth_database, recordings).key


def test_what_cannot_be_compared_is_refused(mouth_database):
    with pytest.raises(UserFacingError, match="objective 'beauty'"):
        TuningProblem.of(mouth_database, mouth_database.held_out_recordings("tune"), "beauty")


def test_frames_are_resampled_linearly_in_coefficients_as_in_positions():
    # what lets the error be taken in principal components
    rng = np.random.default_rng(0)
    coefficients, basis = rng.normal(size=(50, 4)), rng.normal(size=(4, 9))
    a = resample(coefficients, 120.0, 25.0, 10) @ basis
    b = resample(coefficients @ basis, 120.0, 25.0, 10)
    assert np.allclose(a, b)
