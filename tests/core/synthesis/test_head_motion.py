import numpy as np
import pytest

from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.synthesis.head_motion import gaze_track, head_track
from core.synthesis.pose_tracks import PoseTracks

RATE = 60.0


def speech(*phones, each_s=0.1):
    utterances = tuple(PhonemeUtterance(p, k * each_s, (k + 1) * each_s) for k, p in enumerate(phones))
    words = tuple(
        WordUtterance(f"w{k}", utterances[k].start_s, utterances[min(k + 3, len(phones) - 1)].end_s)
        for k in range(0, len(phones), 4)
    )
    return Transcript(utterances, words, len(phones) * each_s)


@pytest.fixture
def sentence():
    return speech(*(["dh", "ax", "k", "ae", "t", "s", "ae", "t", "pau", "aa", "n", "dh", "ax", "m", "ae", "t"] * 3))


def test_the_same_speech_moves_the_same_way_and_other_speech_does_not(sentence):
    once, again = head_track(sentence, RATE, 288), head_track(sentence, RATE, 288)
    np.testing.assert_array_equal(once[0], again[0])
    other = head_track(speech(*(["aa", "b", "iy", "k"] * 12)), RATE, 288)
    assert np.abs(once[0] - other[0]).max() > 0.005


def test_a_head_moves_a_little_and_smoothly_from_rest_to_rest(sentence):
    rotation, shift = head_track(sentence, RATE, 288)
    assert rotation.shape == shift.shape == (288, 3)
    degrees = np.degrees(rotation)
    assert 0.3 < degrees.std(axis=0).max() < 4.0
    assert np.abs(degrees).max() < 9.0
    assert np.abs(shift).max() < 6.0
    assert np.abs(np.diff(degrees, axis=0)).max() * RATE < 40.0
    np.testing.assert_allclose(rotation[[0, -1]], 0.0, atol=1e-9)
    np.testing.assert_allclose(shift[[0, -1]], 0.0, atol=1e-9)


def test_it_nods_into_the_loud_word(sentence):
    quiet = np.full(480, -40.0)
    loud = quiet.copy()
    word = sentence.words[5]
    loud[int(word.start_s * 100) : int(word.end_s * 100)] = -10.0
    nod = head_track(sentence, RATE, 288, loud)[0][:, 0] - head_track(sentence, RATE, 288, quiet)[0][:, 0]
    assert word.start_s - 0.05 < nod.argmax() / RATE < word.end_s + 0.05
    assert np.degrees(nod.max()) > 1.0


def test_eyes_rest_and_jump_and_end_on_the_viewer(sentence):
    gaze = gaze_track(sentence, RATE, 288)
    speed = np.abs(np.diff(gaze, axis=0)).max(axis=1) * RATE
    assert (speed < 1e-6).mean() > 0.85
    assert np.abs(gaze).max() <= 8.0
    assert np.abs(gaze).max() > 0.5
    np.testing.assert_array_equal(gaze[[0, -1]], 0.0)


@pytest.mark.parametrize("head", [True, False])
@pytest.mark.parametrize("gaze", [True, False])
def test_each_track_is_on_or_off_and_the_tongue_always_on(sentence, head, gaze):
    pose = PoseTracks.of(sentence, RATE, 10, head=head, gaze=gaze).at(20)
    assert (pose["head"] is not None, pose["gaze"] is not None, pose["tongue"] is not None) == (head, gaze, True)


def test_speech_of_one_frame_is_no_trouble():
    tracks = PoseTracks.of(speech("pau"), RATE, 1)
    assert np.isfinite(tracks.head[0]).all()
    assert np.isfinite(tracks.gaze).all()
