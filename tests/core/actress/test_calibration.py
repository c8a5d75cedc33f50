from pathlib import Path

import numpy as np
import pytest

from core.actress.calibration import ENOUGH, her_figures, main, misses, tolerances
from core.actress.grid_talker import (
    PLACES,
    TalkerFigures,
    figures_of,
    read_grid_clips,
    sentences_like_grid,
    stored_figures,
)
from core.actress.mouth import PhoneMeasure
from core.speech.phoneme import PAU

GRID = Path(__file__).resolve().parents[3] / "../shared/data/grid-s1"
BASE = PhoneMeasure(gap_mm=8.0, width_mm=1.0, closure_mm=4.0, speed_mm_s=100.0)


def _talker(**changes):
    return TalkerFigures({"aa": BASE._replace(**changes)}, {"aa": ENOUGH}, 5.0)


def test_a_quarter_is_allowed_and_more_is_a_miss():
    assert misses(_talker(), _talker(gap_mm=9.9, width_mm=2.2, closure_mm=3.1, speed_mm_s=124.0)) == []
    for name, value in (("gap_mm", 10.1), ("width_mm", -0.3), ("closure_mm", 2.9), ("speed_mm_s", 74.0)):
        assert misses(_talker(), _talker(**{name: value})) == [("aa", name)]


def test_a_rare_phone_is_not_judged():
    rare = _talker()._replace(counts={"aa": ENOUGH - 1})
    assert misses(rare, _talker(gap_mm=99.0)) == []


def test_differences_below_the_jitter_mean_nothing():
    closed = _talker(closure_mm=0.1)
    assert misses(closed, _talker(closure_mm=0.5)) == []
    assert misses(closed, _talker(closure_mm=0.7)) == [("aa", "closure_mm")]
    assert tolerances(closed, "aa").width_mm == pytest.approx(1.25)


def test_sentences_follow_the_grammar_at_the_talkers_timing():
    sentences = sentences_like_grid(40)
    for transcript in sentences:
        assert transcript.phones[0] == transcript.phones[-1] == PAU
        assert 2.0 < transcript.duration_s < 4.0
    assert len({transcript.phones for transcript in sentences}) > 35
    assert PLACES == 6


def test_she_is_like_the_stored_talker():
    sentences = [(f"like GRID {i}", s) for i, s in enumerate(sentences_like_grid(60))]
    hers, real = her_figures(sentences), stored_figures()
    missed = misses(real, hers)
    # few sentences: a median may stray, but not the most of them
    assert len(missed) < 0.15 * 4 * len(real.medians)


def test_stored_figures_hold_no_recording():
    real = stored_figures()
    assert len(real.medians) < 45 and all(np.isfinite(measure).all() for measure in real.medians.values())
    assert sum(count >= ENOUGH for count in real.counts.values()) >= 25


@pytest.mark.skipif(not GRID.is_dir(), reason="the GRID recordings are not on this machine")
def test_stored_figures_are_those_of_the_recordings():
    clips = read_grid_clips(GRID)
    assert len(clips) == 400
    measured, stored = figures_of([(transcript, mouth) for _, transcript, mouth in clips]), stored_figures()
    assert measured.counts == stored.counts
    for phone, measure in measured.medians.items():
        assert measure == pytest.approx(stored.medians[phone], abs=0.02), phone
    closed = [measured.medians[phone].closure_mm for phone in ("p", "b")]
    assert max(closed) < 0.5 and measured.medians["ey"].gap_mm > 8


@pytest.mark.prove
@pytest.mark.skipif(not GRID.is_dir(), reason="the GRID recordings are not on this machine")
def test_the_command_passes_on_the_recordings(capsys):
    assert main(["--grid", str(GRID)]) == 0, capsys.readouterr().out


@pytest.mark.prove
def test_the_command_passes_on_the_stored_figures(capsys):
    assert main([]) == 0, capsys.readouterr().out
