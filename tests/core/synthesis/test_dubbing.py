import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.dubbing import dubbed
from core.synthesis.marker_motion import MarkerMotion

RATE_HZ = 100.0


def spoken(*phones, duration_s=None):
    """A transcript of (phone, length in seconds)."""
    at_s, said = 0.0, []
    for phone, length_s in phones:
        said.append(PhonemeUtterance(phone, at_s, at_s + length_s))
        at_s += length_s
    return Transcript.covering(said, [], duration_s or at_s)


@pytest.fixture
def clock():
    """A motion that shows the time: one marker's x is the seconds since the start."""

    def make(transcript):
        times_s = np.arange(round(transcript.duration_s * RATE_HZ)) / RATE_HZ
        positions = np.zeros((len(times_s), 1, 3), np.float32)
        positions[:, 0, 0] = times_s
        return MarkerMotion(positions, RATE_HZ, MarkerSet(("m",), np.zeros((1, 3))))

    return make


CAPTURED = spoken(("pau", 0.3), ("aa", 0.2), ("b", 0.1), ("pau", 0.4))


def at(motion, time_s):
    return motion.positions[round(time_s * RATE_HZ), 0, 0]


def test_at_its_own_times_it_is_itself(clock):
    motion = clock(CAPTURED)
    np.testing.assert_allclose(dubbed(motion, CAPTURED, CAPTURED).positions, motion.positions, atol=1e-6)


def test_each_phone_is_seen_while_it_is_heard(clock):
    heard = spoken(("pau", 0.1), ("aa", 0.4), ("b", 0.3), ("pau", 0.5))
    made = dubbed(clock(CAPTURED), CAPTURED, heard)
    assert len(made.positions) == 130
    for heard_s, captured_s in ((0.0, 0.0), (0.1, 0.3), (0.3, 0.4), (0.5, 0.5), (0.65, 0.55), (0.8, 0.6), (1.05, 0.8)):
        assert at(made, heard_s) == pytest.approx(captured_s, abs=0.011)
    assert (np.diff(made.positions[:, 0, 0]) >= 0).all()


def test_a_pause_that_only_one_of_them_makes_is_passed_over(clock):
    heard = spoken(("pau", 0.3), ("aa", 0.2), ("pau", 0.5), ("b", 0.1), ("pau", 0.4))
    made = dubbed(clock(CAPTURED), CAPTURED, heard)
    assert at(made, 0.5) == pytest.approx(0.5, abs=0.011) and at(made, 1.0) == pytest.approx(0.5, abs=0.011)
    assert at(made, 1.05) == pytest.approx(0.55, abs=0.011)


def test_other_phones_for_the_same_words_are_stretched_as_a_whole(clock):
    heard = spoken(("pau", 0.5), ("ae", 0.2), ("b", 0.2), ("ax", 0.2), ("pau", 0.1))
    made = dubbed(clock(CAPTURED), CAPTURED, heard)
    for heard_s, captured_s in ((0.5, 0.3), (0.8, 0.45), (1.1, 0.6)):
        assert at(made, heard_s) == pytest.approx(captured_s, abs=0.011)
