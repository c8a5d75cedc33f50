import csv

import numpy as np
import pytest

from core.face.tongue import TONGUE_FILE, tongue_targets, tongue_track
from core.speech.phoneme import PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript


def said(*phones, each_s=0.12):
    utterances = [PhonemeUtterance(p, k * each_s, (k + 1) * each_s) for k, p in enumerate(phones)]
    return Transcript(tuple(utterances), (), len(phones) * each_s)


def test_every_phone_has_a_row_with_a_reason():
    assert set(tongue_targets()) == set(PHONEMES)
    with open(TONGUE_FILE, encoding="utf-8", newline="") as file:
        assert all(len(row["reason"]) > 3 for row in csv.DictReader(file))


def test_targets_are_within_what_the_rig_understands():
    for tip, back, advance, hold in tongue_targets().values():
        assert 0 <= tip <= 1
        assert 0 <= back <= 1
        assert -1 <= advance <= 1
        assert hold > 0


@pytest.mark.parametrize(("phone", "column"), [("l", 0), ("n", 0), ("t", 0), ("k", 1), ("ng", 1), ("th", 2)])
def test_between_vowels_the_tongue_reaches_its_phone(phone, column):
    track = tongue_track(said("aa", phone, "aa"), 100.0, 36)
    assert track[18, column] > 0.8 * tongue_targets()[phone][column]
    assert track[18, column] > track[4, column] + 0.4
    assert track[18, column] > track[31, column] + 0.4


def test_it_is_smooth_and_stays_in_range():
    track = tongue_track(said("pau", "th", "aa", "k", "l", "iy", "t", "pau", each_s=0.05), 120.0, 48)
    assert track.shape == (48, 3)
    assert np.abs(np.diff(track, axis=0)).max() < 0.35
    assert track.min() >= -1
    assert track.max() <= 1


def test_a_lip_sound_leaves_the_tongue_to_its_neighbours():
    through_b = tongue_track(said("l", "b", "l"), 100.0, 36)[18]
    through_k = tongue_track(said("l", "k", "l"), 100.0, 36)[18]
    # on its way from /l/ to /l/ it hardly leaves the ridge for /b/, and does for /k/
    assert through_b[0] > through_k[0]


def test_frames_past_the_end_rest():
    track = tongue_track(said("aa"), 100.0, 100)
    np.testing.assert_allclose(track[-1], tongue_targets()["pau"][:3], atol=0.02)
