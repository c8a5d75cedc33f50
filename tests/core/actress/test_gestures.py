import csv

import numpy as np
import pytest

from core.actress.gestures import END, gesture_score, gestures_of_phones, tract_variables
from core.actress.performance import bundled_marker_units
from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.speech.phoneme import PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript

TIMES_S = np.arange(240) / 240


class NoChance(Chance):
    """Every draw is the most likely one."""

    def normal(self, *shape):
        return np.zeros(shape)


def _score(*phones):
    transcript = Transcript.covering([PhonemeUtterance(*phone) for phone in phones], [], 1.0)
    return gesture_score(transcript, TIMES_S, 1.0, 1.0, NoChance("none"))


def _column(name):
    return [variable.name for variable in tract_variables()].index(name)


def test_every_phoneme_has_gestures_and_every_row_a_reason():
    assert set(gestures_of_phones()) == {*PHONEMES, END}
    for table in ("gestures", "variables", "expressions", "manners", "voices"):
        with open(DEMO_FOLDER / f"{table}.csv", encoding="utf-8", newline="") as lines:
            for row in csv.DictReader(lines):
                assert len(row["reason"]) > 10 and None not in row, (table, row)


def test_variables_drive_units_that_exist():
    known = set(bundled_marker_units().names)
    assert all(set(variable.units) <= known for variable in tract_variables())


def test_one_gesture_alone_draws_to_its_own_target():
    score = _score(("pau", 0, 0.3), ("aa", 0.3, 0.7), ("pau", 0.7, 1.0))
    (gesture,) = (g for g in gestures_of_phones()["aa"] if g.variable == "jaw")
    middle = score.targets[TIMES_S == 0.5, _column("jaw")][0]
    # the pull to rest takes a twentieth
    assert middle == pytest.approx(gesture.target, rel=0.06)


def test_gestures_begin_before_their_phone_is_heard():
    score = _score(("pau", 0, 0.5), ("uw", 0.5, 1.0))
    rounding = score.targets[:, _column("round")]
    assert rounding[np.searchsorted(TIMES_S, 0.45)] > 0.5 * rounding.max()
    assert rounding[0] == 0


def test_the_stronger_of_two_competing_gestures_wins():
    score = _score(("aa", 0, 0.5), ("b", 0.5, 0.6), ("aa", 0.6, 1.0))
    assert score.targets[np.searchsorted(TIMES_S, 0.55), _column("closure")] > 1
