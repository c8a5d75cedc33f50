"""Two motions beside each other: figures that can be worked out by hand, and those of `efase evaluate`."""

from __future__ import annotations

import csv
import dataclasses

import numpy as np
import pytest

from core.evaluation.comparison import CapturedTruth, Comparison, scores
from core.evaluation.course_table import write_course_table
from core.evaluation.known_capture import known_capture
from core.evaluation.side_by_side import CAPTURED, SideBySide
from core.motion.marker_set import MarkerSet
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.marker_motion import MarkerMotion

NAMES = ("brow", "up", "low", "left", "right")
REST = np.array([[0, 60, 0], [0, 2, 0], [0, -2, 0], [25, 0, 0], [-25, 0, 0]], float)
MARKERS = MarkerSet(
    NAMES, REST, {"lips": NAMES[1:]},
    {"upper_lip": "up", "lower_lip": "low", "mouth_corner_left": "left", "mouth_corner_right": "right"},
)  # fmt: skip
SAID = Transcript((PhonemeUtterance("m", 0.0, 1.0), PhonemeUtterance("aa", 1.0, 2.0)), (), 2.0)


def speaking(rate_hz: float, faster: float = 1.0) -> MarkerMotion:
    """Two seconds in which the lower lip sinks and the corners part, once or more often."""
    times_s = np.arange(round(2.0 * rate_hz)) / rate_hz
    positions = np.repeat(REST[None], len(times_s), axis=0)
    positions[:, 2, 1] -= 5 - 5 * np.cos(2 * np.pi * faster * times_s)
    positions[:, 3, 0] += 2 * np.sin(2 * np.pi * faster * times_s)
    return MarkerMotion(positions.astype(np.float32), rate_hz, MARKERS)


def moved(motion: MarkerMotion, by_mm) -> MarkerMotion:
    return dataclasses.replace(motion, positions=motion.positions + np.float32(by_mm))


def read_rows(path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def course(compared: SideBySide, measure: str, of: str = "") -> np.ndarray:
    return next(c.values_mm for c in compared.courses if (c.measure, c.of) == (measure, of))


def test_a_face_that_stands_five_millimetres_aside_is_five_millimetres_off_and_moves_alike():
    one = speaking(60.0)
    compared = SideBySide.of(("here", "aside"), (one, moved(one, [3.0, 4.0, 0.0])), SAID)
    (found,) = compared.agreements
    assert (found.of, found.standard) == ("here", "aside")
    for value in (found.rms_mm, found.mean_mm, found.lip_rms_mm, found.lip_mean_mm):
        assert value == pytest.approx(5.0, abs=1e-4)
    assert (found.gap_r, found.width_r) == pytest.approx((1.0, 1.0))
    assert found.gap_variance_ratio == pytest.approx(1.0, abs=0.02)
    np.testing.assert_allclose(course(compared, "difference"), 5.0, atol=1e-4)
    np.testing.assert_allclose(course(compared, "lip gap", "here"), course(compared, "lip gap", "aside"), atol=1e-4)


def test_gap_and_width_are_read_off_the_markers():
    one = speaking(60.0)
    compared = SideBySide.of(("one", "two"), (one, speaking(60.0, 2.0)), SAID)
    times_s = np.arange(120) / 60
    np.testing.assert_allclose(course(compared, "lip gap", "one"), 9 - 5 * np.cos(2 * np.pi * times_s), atol=1e-4)
    np.testing.assert_allclose(course(compared, "lip width", "two"), 50 + 2 * np.sin(4 * np.pi * times_s), atol=1e-4)
    assert abs(compared.agreements[0].gap_r) < 0.05  # waves of one and of two periods have nothing in common


def test_the_difference_of_a_frame_is_the_root_of_its_mean_square_over_markers():
    one, two = speaking(60.0), speaking(60.0, 3.0)
    compared = SideBySide.of(("one", "two"), (one, two), SAID)
    lips = [1, 2, 3, 4]
    for f in (7, 40, 111):
        squares = [float(((one.positions[f, k] - two.positions[f, k]) ** 2).sum()) for k in range(len(NAMES))]
        assert course(compared, "difference")[f] == pytest.approx((sum(squares) / 5) ** 0.5, rel=1e-4)
        assert course(compared, "lip difference")[f] == pytest.approx(
            (sum(squares[k] for k in lips) / 4) ** 0.5, rel=1e-4
        )
    found = compared.agreements[0]
    assert found.rms_mm**2 == pytest.approx((course(compared, "difference") ** 2).mean())


def test_motions_of_other_rates_meet_in_time_at_the_higher_one():
    compared = SideBySide.of(("slow", "fast"), (speaking(60.0), speaking(120.0)), SAID)
    assert (compared.rate_hz, compared.n_frames) == (120.0, 240)
    assert np.median(course(compared, "difference")) < 0.01
    assert compared.agreements[0].gap_r > 0.9999


@pytest.fixture
def known(mouth_database):
    recording = mouth_database.held_out_recordings("test")[0]
    return known_capture(mouth_database, recording.text, recording.transcript.duration_s)


def other_face(truth: CapturedTruth, rate_hz: float = 120.0) -> MarkerMotion:
    n_frames = round(truth.recording.transcript.duration_s * rate_hz)
    positions = np.repeat(truth.markers.rest[None], n_frames, axis=0)
    positions[:, 4, 1] -= 4 + 3 * np.sin(np.arange(n_frames) / 15)
    return MarkerMotion(positions.astype(np.float32), rate_hz, truth.markers)


def test_errors_against_the_capture_are_those_of_evaluate(known):
    truth, said = known.truth, known.truth.recording.transcript
    motions = other_face(truth), moved(other_face(truth), [0.0, 0.5, 0.0])
    compared = SideBySide.of(("one", "two"), motions, said, truth)
    assert compared.pairs == (("one", "two"), ("one", CAPTURED), ("two", CAPTURED))
    assert compared.rate_hz == truth.rate_hz and compared.n_frames == len(truth.positions)
    for name, motion, found in zip(("one", "two"), motions, compared.agreements[1:]):
        wanted = scores([(truth, Comparison.of(truth, motion, 0.0).synthesised)])
        assert (found.of, found.standard) == (name, CAPTURED)
        assert found.rms_mm**2 == pytest.approx(wanted.error_mm2, rel=1e-5)
        assert found.lip_mean_mm == pytest.approx(wanted.lip_error_mm, rel=1e-5)
        assert found.gap_r == pytest.approx(wanted.lip_gap_r, abs=1e-6)
        assert found.velocity_variance_ratio == pytest.approx(wanted.velocity_variance_ratio, rel=1e-4)
        np.testing.assert_allclose(np.nanmean(course(compared, "error", name) ** 2), wanted.error_mm2, rtol=1e-5)


def test_the_capture_can_be_one_of_the_two_on_either_side(known):
    truth, said = known.truth, known.truth.recording.transcript
    for names, motions in (
        (("one", CAPTURED), (other_face(truth), None)),
        ((CAPTURED, "one"), (None, other_face(truth))),
    ):
        compared = SideBySide.of(names, motions, said, truth)
        assert compared.pairs == (("one", CAPTURED),)
        shown = compared.motions[names.index(CAPTURED)]
        np.testing.assert_allclose(shown.positions, truth.positions, atol=1e-4)
        assert [c.of for c in compared.courses if c.measure == "error"] == []
        assert {c.of for c in compared.courses if c.measure == "lip gap"} == {"one", CAPTURED}
        beside = SideBySide.of(("one", "two"), (other_face(truth), other_face(truth)), said, truth)
        np.testing.assert_allclose(course(compared, "difference"), course(beside, "error", "one"), atol=1e-5)


def test_frames_that_the_capture_lacks_count_nowhere(known, tmp_path):
    truth = dataclasses.replace(known.truth, usable=known.truth.usable.copy())
    truth.usable[:] = True
    wild = truth.positions.copy()
    wild[10:20] += 1000.0
    broken = dataclasses.replace(
        truth, positions=wild, usable=truth.usable & ~np.isin(np.arange(len(wild)), range(10, 20))
    )
    said = truth.recording.transcript
    compared = SideBySide.of(("one", "two"), (other_face(truth), other_face(truth)), said, broken)
    assert compared.agreements[1].rms_mm < 20 and compared.agreements[0].rms_mm == 0.0
    assert np.flatnonzero(np.isnan(course(compared, "error", "one"))).tolist() == list(range(10, 20))
    write_course_table(tmp_path / "curves.csv", compared)
    rows = read_rows(tmp_path / "curves.csv")
    assert [f for f, row in enumerate(rows) if row["error_one_mm"] == ""] == list(range(10, 20))
    assert all(row["lip_gap_one_mm"] for row in rows)


def test_the_table_of_curves_reads_back_frame_by_frame(tmp_path):
    compared = SideBySide.of(("search", "animeme"), (speaking(50.0), speaking(50.0, 2.0)), SAID)
    path = tmp_path / "curves.csv"
    write_course_table(path, compared)
    rows = read_rows(path)
    assert list(rows[0]) == [
        "frame", "time_s", "phone", "lip_gap_search_mm", "lip_gap_animeme_mm", "lip_width_search_mm",
        "lip_width_animeme_mm", "difference_mm", "lip_difference_mm",
    ]  # fmt: skip
    assert [row["phone"] for row in rows] == 50 * ["m"] + 50 * ["aa"]
    np.testing.assert_allclose([float(row["time_s"]) for row in rows], np.arange(100) / 50, atol=1e-6)
    read = [float(row["lip_width_animeme_mm"]) for row in rows]
    np.testing.assert_allclose(read, course(compared, "lip width", "animeme"), atol=1e-4)


def test_a_sentence_of_the_database_is_known_and_said_to_be_learnt_from(mouth_database, known):
    own = mouth_database.sentences[2]
    found = known_capture(mouth_database, own.text.upper(), own.transcript.duration_s)
    stored = mouth_database.pca.positions(mouth_database.frames[own.start_frame : own.stop_frame].astype(float))
    np.testing.assert_allclose(found.truth.positions, stored, atol=1e-4)
    assert not found.is_held_out and known.is_held_out
    assert known_capture(mouth_database, own.text, own.transcript.duration_s + 0.5) is None
    assert known_capture(mouth_database, "something else", own.transcript.duration_s) is None
