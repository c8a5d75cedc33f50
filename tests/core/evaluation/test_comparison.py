"""A synthesis beside its capture: same frames, same space, and figures that can be worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.comparison import CapturedTruth, Comparison, by_phoneme, scores
from core.motion.resample import resample
from core.synthesis.marker_motion import MarkerMotion


@pytest.fixture
def truth(mouth_database):
    return CapturedTruth.of(mouth_database.held_out_recordings("test")[0], mouth_database)


def test_the_truth_is_what_the_builder_would_have_made_of_it(mouth_corpus, mouth_database):
    """A sentence of the database, normalised anew and raised to its rate, is the database's own but for the PCA."""
    sentence = mouth_database.sentence("s03")
    recording = next(r for r in mouth_corpus.recordings if r.sentence == "s03")
    truth = CapturedTruth.of(recording, mouth_database)
    stored = mouth_database.frames[sentence.start_frame : sentence.stop_frame]
    raised = resample(truth.positions, 60.0, 120.0, len(stored))
    assert mouth_database.pca.coefficients(raised) == pytest.approx(stored, abs=1e-3)


def test_the_capture_itself_scores_full_marks(truth):
    found = scores([(truth, truth.positions)])
    assert (found.error_mm2, found.lip_error_mm) == (0.0, 0.0)
    assert found.lip_gap_r == pytest.approx(1.0)
    assert found.closure_rate == 1.0
    assert 0.95 < found.gap_variance_ratio < 1.2 and found.velocity_variance_ratio > 1.0


def test_motion_at_another_rate_meets_the_capture_in_time(truth):
    raised = resample(truth.positions, 60.0, 120.0, 2 * len(truth.positions) - 1).astype(np.float32)
    comparison = Comparison.of(truth, MarkerMotion(raised, 120.0, truth.markers), 0.5)
    off = np.abs(comparison.synthesised - truth.positions)
    assert comparison.synthesised.shape == truth.positions.shape
    assert np.median(off) < 0.02 and off.max() < 0.6
    late = MarkerMotion(np.roll(raised, 12, axis=0), 120.0, truth.markers)  # 0.1 s
    assert scores([(truth, Comparison.of(truth, late, 0.5).synthesised)]).lip_error_mm > 0.5


def test_the_standard_for_joins_is_the_capture_through_the_components(mouth_database, truth):
    database, n_frames = mouth_database, round(truth.recording.transcript.duration_s * 120)
    raised = resample(truth.positions, 60.0, 120.0, n_frames)
    shown = database.pca.positions(database.pca.coefficients(raised))
    comparison = Comparison.of(truth, MarkerMotion(shown, 120.0, truth.markers), 0.5)
    assert tuple(comparison.joins) == pytest.approx(tuple(truth.joins))
    seam = shown.copy()
    seam[n_frames // 2 :, 5] += 4.0
    assert Comparison.of(truth, MarkerMotion(seam, 120.0, truth.markers), 0.5).joins[1] >= truth.joins[1]


def test_scores_are_means_over_sentences_and_phonemes_over_frames(mouth_database, truth):
    other = CapturedTruth.of(mouth_database.held_out_recordings("test")[1], mouth_database)
    off_mm = np.array([[0.0, 0.0, 1.0], [0.0, 3.0, 0.0]])
    pairs = [(t, t.positions + off) for t, off in zip((truth, other), off_mm)]
    found = scores(pairs)
    assert found.error_mm2 == pytest.approx((1.0 + 9.0) / 2)
    assert found.lip_error_mm == pytest.approx((1.0 + 3.0) / 2)
    assert found.lip_gap_r == pytest.approx(1.0)
    table = by_phoneme(pairs[:1])
    assert {phone: row["said"] for phone, row in table.items()} == {"aa": 2, "b": 2, "iy": 1, "k": 1, "pau": 2}
    assert all(row["error_mm2"] == pytest.approx(1.0) for row in table.values())


def test_frames_in_long_gaps_and_beyond_the_end_are_left_out(mouth_database):
    recording = mouth_database.held_out_recordings("test")[0]
    holed = recording.positions.copy()
    holed[30:50, 4] = np.nan
    longer = np.concatenate([holed, np.repeat(holed[-1:], 30, axis=0)])
    truth = CapturedTruth.of(replace(recording, positions=longer), mouth_database)
    assert not truth.usable[30:50].any() and truth.usable[:30].all()
    assert truth.usable.sum() == pytest.approx(recording.transcript.duration_s * 60 - 20, abs=1.5)
    wrong = truth.positions.copy()
    wrong[~truth.usable] += 100.0
    assert scores([(truth, wrong)]).error_mm2 == 0.0


def test_a_sentence_that_was_lost_altogether_is_no_figure(mouth_database):
    recording = mouth_database.held_out_recordings("test")[0]
    lost = replace(recording, positions=np.full_like(recording.positions, np.nan))
    truth = CapturedTruth.of(lost, mouth_database)
    assert not truth.usable.any()
    assert set(vars(scores([(truth, np.zeros_like(truth.positions))])).values()) == {None}


def test_a_capture_without_lips_is_measured_without_them(truth):
    blind = replace(truth, markers=replace(truth.markers, groups={}, landmarks={}))
    found = scores([(blind, truth.positions + 1.0)])
    assert found.error_mm2 == pytest.approx(3.0)
    assert found.lip_error_mm is found.lip_gap_r is found.closure_rate is found.gap_variance_ratio is None


def test_a_recording_without_a_marker_of_the_database_is_refused(mouth_database):
    recording = mouth_database.held_out_recordings("test")[0]
    other = replace(recording, marker_names=("tail", *recording.marker_names[1:]))
    with pytest.raises(UserFacingError, match="no marker 'nose'"):
        CapturedTruth.of(other, mouth_database)
