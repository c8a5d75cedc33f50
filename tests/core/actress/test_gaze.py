import numpy as np

from core.actress.corpus import database_sentences, perform_details, transcript_of
from core.actress.gaze import gaze_course
from core.actress.performance import gaze
from core.actress.randomness import Chance

TIMES_S = np.arange(0, 20, 1 / 120)
NO_BLINKS = np.array([])


def _course(name="one", away_share=0.3, down_deg=0.0, blinks_s=NO_BLINKS):
    return gaze_course(TIMES_S, 0.8, away_share, down_deg, blinks_s, Chance(name))


def test_eyes_rest_most_of_the_time_and_jump_in_between():
    speed = np.linalg.norm(np.diff(_course(), axis=0), axis=1) * 120
    assert np.mean(speed < 10) > 0.85
    assert speed.max() > 60
    # no eye turns faster than saccades do
    assert speed.max() < 900


def test_looks_away_are_wide_and_looks_at_the_listener_are_not():
    assert np.abs(_course(away_share=0.0)).max() < 5
    assert 5 < np.abs(_course(away_share=1.0)).max() < 25


def test_hanging_eyes_hang():
    assert _course(down_deg=7.0)[:, 1].mean() < _course(down_deg=0.0)[:, 1].mean() - 5


def test_a_blink_brings_a_look():
    with_blink = _course(blinks_s=np.array([4.321]))
    f = np.searchsorted(TIMES_S, 4.321)
    assert np.linalg.norm(with_blink[f + 8] - with_blink[f - 1]) > np.linalg.norm(with_blink[f - 1] - with_blink[f - 9])


def test_gaze_is_stored_with_the_performance_and_repeats():
    spoken = database_sentences()[50]
    done = perform_details(spoken)
    assert done.gaze_deg.shape == (len(done.activations), 2)
    again = gaze(transcript_of(spoken), spoken.emotion, spoken.sentence)
    assert again.tobytes() == done.gaze_deg.tobytes()
    other = gaze(transcript_of(spoken), spoken.emotion, "another")
    assert not np.allclose(other, again)
