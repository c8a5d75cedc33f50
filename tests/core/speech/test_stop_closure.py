import pytest

from core.speech.sphinx import HeardWord
from core.speech.stop_closure import with_short_closures


def word(*phones):
    """A word of (phone, start_s, end_s)."""
    return HeardWord(0, "word", phones[0][1], phones[-1][2], phones)


def test_a_stop_after_a_pause_keeps_its_end_and_its_word_begins_with_it():
    (place,) = with_short_closures([word(("p", 0.1, 0.75), ("l", 0.75, 0.8))])
    assert place.phones == (("p", 0.65, 0.75), ("l", 0.75, 0.8))
    assert place.start_s == 0.65 and place.end_s == 0.8
    first, second = with_short_closures([word(("m", 0.2, 0.3)), word(("b", 0.5, 0.9), ("iy", 0.9, 1.0))])
    assert first == word(("m", 0.2, 0.3))
    assert second.start_s == pytest.approx(0.84)


@pytest.mark.parametrize("start_s", [0.0, 0.2])
def test_a_first_stop_is_cut_wherever_it_begins(start_s):
    (word_,) = with_short_closures([word(("t", start_s, 0.6), ("uw", 0.6, 0.8))])
    assert word_.start_s == pytest.approx(0.5)


def test_stops_in_running_speech_short_ones_and_other_phones_stay():
    running = [word(("s", 0.2, 0.4)), word(("t", 0.4, 0.7), ("uw", 0.7, 0.9))]
    assert with_short_closures(running) == running
    short = [word(("k", 0.5, 0.58), ("ae", 0.58, 0.7))]
    assert with_short_closures(short) == short
    slow = [word(("s", 0.1, 0.9), ("ow", 0.9, 1.0))]
    assert with_short_closures(slow) == slow


def test_a_word_without_phones_stays():
    bare = HeardWord(0, "word", 0.1, 0.5)
    assert with_short_closures([bare]) == [bare]
