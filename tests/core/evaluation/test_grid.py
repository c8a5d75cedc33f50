"""GRID's standards agree with figures that were taken once by another program, on a split like ours."""

from __future__ import annotations

import pytest

from core.evaluation.evaluate import evaluate
from core.evaluation.split import hold_out
from core.motion.build import build_database
from core.motion.readers.corpus_folder import read_corpus
from core.search.compute import NumpyKernels
from core.synthesis.registry import make_engines


@pytest.mark.prove
def test_static_face_and_phone_means_are_as_far_off_as_elsewhere(shared_data, tmp_path):
    database = build_database(hold_out(read_corpus(shared_data("grid-s1"))), tmp_path / "grid.h5")
    engines = make_engines(["static", "phone-means"], database, NumpyKernels)
    found = evaluate(database, database.held_out_recordings("test"), engines)
    static, means = (found.engines[name].scores for name in engines)
    assert static.lip_error_mm == pytest.approx(2.19, abs=0.1)
    assert (static.lip_gap_r, static.velocity_variance_ratio) == (0.0, 0.0)
    assert means.lip_error_mm == pytest.approx(1.66, abs=0.1)
    assert means.lip_gap_r == pytest.approx(0.72, abs=0.05)
    ratios = (means.gap_variance_ratio, means.velocity_variance_ratio, means.acceleration_variance_ratio)
    assert ratios == pytest.approx((0.44, 0.40, 0.64), abs=0.15)
    assert found.floor.lip_error_mm < 0.4  # jitter of the set: 0.13 to 0.17 mm an axis
