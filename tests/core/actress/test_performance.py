import numpy as np
import pytest

from core.actress.capture import markers_of
from core.actress.corpus import database_sentences, transcript_of
from core.actress.performance import bundled_marker_units, perform
from core.speech.emotion import EMOTIONS
from core.speech.transcript import PhonemeUtterance, Transcript

RATE_HZ = 120
UNITS = bundled_marker_units()


def _mouth(activations):
    """Lip gap and mouth width in mm, speed of the lower lip in mm/s; the gap is 0 at rest."""
    markers, rest = markers_of(activations, UNITS), UNITS.markers.rest
    upper, lower = UNITS.markers.landmark("upper_lip"), UNITS.markers.landmark("lower_lip")
    left, right = UNITS.markers.landmark("mouth_corner_left"), UNITS.markers.landmark("mouth_corner_right")
    gap = markers[:, upper, 1] - markers[:, lower, 1] - (rest[upper, 1] - rest[lower, 1])
    width = np.linalg.norm(markers[:, left] - markers[:, right], axis=1)
    speed = np.linalg.norm(np.gradient(markers[:, lower], 1 / RATE_HZ, axis=0), axis=1)
    return gap, width, speed


@pytest.fixture(scope="module")
def spoken():
    """(sentence, emotion, transcript, activations) of the whole corpus."""
    made = []
    for sentence in database_sentences():
        transcript = transcript_of(sentence)
        made.append(
            (sentence.sentence, sentence.emotion, transcript, perform(transcript, sentence.emotion, sentence.sentence))
        )
    return made


def _frames(utterance):
    first = int(np.ceil(utterance.start_s * RATE_HZ))
    return slice(first, max(first + 1, int(np.ceil(utterance.end_s * RATE_HZ))))


def _by_phone(spoken, emotion, measure):
    """Median over utterances of each phone of ``measure(gap, width)``."""
    found: dict[str, list[float]] = {}
    for _, of, transcript, activations in spoken:
        if of == emotion:
            gap, width, _ = _mouth(activations)
            for u in transcript.phonemes:
                found.setdefault(u.phone, []).append(measure(gap[_frames(u)], width[_frames(u)]))
    return {phone: float(np.median(values)) for phone, values in found.items()}


def test_activations_are_proper(spoken):
    for _, _, transcript, activations in spoken:
        assert activations.shape == (int(np.ceil(transcript.duration_s * RATE_HZ - 1e-6)), 52)
        assert activations.min() >= 0 and activations.max() <= 1


def test_every_bilabial_closes_the_lips(spoken):
    for name, _, transcript, activations in spoken:
        gap, _, _ = _mouth(activations)
        for u in transcript.phonemes:
            if u.phone in ("p", "b", "m"):
                assert gap[_frames(u)].min() < 1.0, (name, u)


def test_lips_never_pass_through_each_other(spoken):
    assert all(_mouth(activations)[0].min() > -0.5 for _, _, _, activations in spoken)


def test_open_vowels_are_open_and_labiodentals_nearly_closed(spoken):
    widest = _by_phone(spoken, "neutral", lambda gap, width: gap.max())
    least = _by_phone(spoken, "neutral", lambda gap, width: gap.min())
    for phone in ("aa", "ae", "ay", "aw", "eh"):
        assert 9 < widest[phone] < 18, phone
    for phone in ("f", "v"):
        assert 0.3 < least[phone] < 4, phone


def test_rounded_vowels_are_narrower_than_spread_ones(spoken):
    for emotion in EMOTIONS:
        width = _by_phone(spoken, emotion, lambda gap, width: width[len(width) // 2])
        for rounded in ("uw", "w"):
            for spread in ("iy", "s"):
                assert width[rounded] < width[spread] - 1, (emotion, rounded, spread)


def test_lips_move_as_fast_as_lips_do(spoken):
    for emotion in EMOTIONS:
        peaks = [_mouth(activations)[2].max() for _, of, _, activations in spoken if of == emotion]
        assert 100 < np.median(peaks) < 400, emotion
        assert max(peaks) < 600, emotion


def test_motion_has_no_jitter(spoken):
    """Above 30 Hz, where no articulator lives, there is less than half a percent of the lip's movement."""
    for name, _, _, activations in spoken:
        gap, _, _ = _mouth(activations)
        power = np.abs(np.fft.rfft(np.diff(gap) * np.hanning(len(gap) - 1))) ** 2
        rate_hz = np.fft.rfftfreq(len(gap) - 1, 1 / RATE_HZ)
        assert power[rate_hz > 30].sum() < 0.005 * power.sum(), name


def test_a_shorter_vowel_opens_less():
    peaks = []
    for duration_s in (0.06, 0.10, 0.20):
        end_s = 0.3 + duration_s
        phones = [("pau", 0, 0.2), ("b", 0.2, 0.3), ("aa", 0.3, end_s), ("b", end_s, end_s + 0.1)]
        transcript = Transcript.covering([PhonemeUtterance(*p) for p in phones], [], end_s + 0.4)
        peaks.append(_mouth(perform(transcript, "neutral", "same"))[0].max())
    assert peaks[0] + 1 < peaks[1] < peaks[2] - 1


def test_a_consonant_takes_on_its_neighbours():
    widths = []
    for vowel in ("iy", "uw"):
        phones = [("pau", 0, 0.2), (vowel, 0.2, 0.35), ("t", 0.35, 0.43), (vowel, 0.43, 0.6)]
        transcript = Transcript.covering([PhonemeUtterance(*p) for p in phones], [], 0.9)
        widths.append(_mouth(perform(transcript, "neutral", "same"))[1][int(0.39 * RATE_HZ)])
    assert widths[0] > widths[1] + 3


def test_rate_only_chooses_frames():
    sentence = database_sentences()[3]
    transcript = transcript_of(sentence)
    fast, slow = (perform(transcript, "anger", "same", rate_hz) for rate_hz in (120, 30))
    assert np.allclose(fast[::4], slow, atol=1e-12)


def test_seed_varies_and_repeats():
    transcript = transcript_of(database_sentences()[0])
    first, again, other = (perform(transcript, "neutral", seed) for seed in ("one", "one", "two"))
    assert first.tobytes() == again.tobytes()
    assert 0.001 < np.abs(first - other).mean() < 0.1


def test_blinks_close_the_lids():
    lid = UNITS.names.index("eyeBlinkLeft")
    blinks = 0
    for sentence in database_sentences():
        course = perform(transcript_of(sentence), sentence.emotion, sentence.sentence)[:, lid]
        blinks += course.max() > 0.95
    assert blinks > 24
