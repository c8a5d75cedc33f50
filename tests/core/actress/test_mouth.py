import numpy as np
import pytest

from core.actress.mouth import MouthCourse, measure_phones, mouth_course
from core.motion.marker_set import MarkerSet
from core.speech.transcript import PhonemeUtterance, Transcript

MARKERS = MarkerSet(
    ("up", "low", "left", "right"),
    np.zeros((4, 3)),
    {},
    {"upper_lip": "up", "lower_lip": "low", "mouth_corner_left": "left", "mouth_corner_right": "right"},
)


def test_gap_is_upright_and_width_is_seen_from_the_front():
    face = np.array([[[0, 3, 9], [1, -2, 4], [30, 40, 7], [0, 0, -5]]], float)
    mouth = mouth_course(face, MARKERS, 25.0)
    assert mouth.gap_mm.tolist() == [5.0] and mouth.width_mm.tolist() == [50.0]


def test_phones_of_a_swinging_mouth():
    """Gap 5 - 5 cos(2 pi t): closed at 0 and 1 s, open 10 mm at 0.5 s, fastest at 0.25 s with 10 pi mm/s."""
    times_s = np.arange(0, 1.0001, 0.04)
    mouth = MouthCourse(5 - 5 * np.cos(2 * np.pi * times_s), np.full(26, 50.0), 25.0)
    phones = [("aa", 0.3, 0.7), ("pau", 0.7, 0.8), ("b", 0.8, 1.0)]
    transcript = Transcript.covering([PhonemeUtterance(*p) for p in phones], [], 1.0)
    (first, open_vowel), (second, closing) = measure_phones(transcript, mouth)
    assert (first, second) == ("aa", "b")
    assert open_vowel.gap_mm == pytest.approx(9.7, abs=0.2) and open_vowel.width_mm == pytest.approx(50)
    assert open_vowel.closure_mm == pytest.approx(5 - 5 * np.cos(0.6 * np.pi), abs=0.05)
    assert open_vowel.speed_mm_s == pytest.approx(10 * np.pi * np.sin(0.6 * np.pi), rel=0.02)
    assert closing.closure_mm < 0.1


def test_a_phone_beyond_the_capture_is_not_measured():
    mouth = MouthCourse(np.ones(10), np.ones(10), 25.0)
    transcript = Transcript.covering([PhonemeUtterance("aa", 0.1, 0.5)], [], 0.5)
    assert measure_phones(transcript, mouth) == []
