import numpy as np
import pytest

from core.iface.speech_features import N_FEATURES, RATE_HZ, SAMPLE_RATE_HZ, SpeechFeatureStream, speech_features
from core.media.audio import Audio


def murmur(seconds, seed=0):
    """Noise whose loudness comes and goes."""
    n = round(seconds * SAMPLE_RATE_HZ)
    samples = 0.1 * np.random.default_rng(seed).standard_normal(n) * np.sin(np.arange(n) / 3000) ** 2
    return Audio(samples.astype(np.float32), SAMPLE_RATE_HZ, None)


@pytest.mark.parametrize("seed", range(3))
def test_in_pieces_of_any_size_it_is_heard_as_at_once(seed):
    sound = murmur(4.0)
    stream, rng, heard, i = SpeechFeatureStream(), np.random.default_rng(seed), [], 0
    while i < len(sound.samples):
        n = int(rng.integers(1, 900))
        heard.append(stream.accept(sound.samples[i : i + n]))
        i += n
    heard = np.concatenate(heard)
    whole = speech_features(sound)
    np.testing.assert_array_equal(heard[: len(whole)], whole)


def test_a_frame_is_given_as_soon_as_its_time_has_come_and_hears_nothing_later():
    sound = murmur(1.0)
    for f in (5, 17, 26):
        n = -(-f * SAMPLE_RATE_HZ // RATE_HZ)
        assert len(SpeechFeatureStream().accept(sound.samples[:n])) == f + 1
        other = sound.samples.copy()
        other[n:] = murmur(1.0, seed=1).samples[n:]
        changed = speech_features(Audio(other, SAMPLE_RATE_HZ, None))
        same = speech_features(sound)
        np.testing.assert_array_equal(changed[: f + 1], same[: f + 1])
        assert np.abs(changed[f + 2] - same[f + 2]).max() > 0.1


def test_there_are_30_frames_a_second_for_ever():
    """A hop of 533 samples would be 0.4 s late after ten minutes."""
    stream = SpeechFeatureStream()
    second = murmur(1.0).samples
    n_frames = sum(len(stream.accept(second)) for _ in range(120))
    assert n_frames == 120 * RATE_HZ + 1


def test_another_rate_sounds_the_same():
    t = np.arange(48_000) / 48_000
    tone = 0.3 * np.sin(2 * np.pi * (300 + 200 * t) * t).astype(np.float32)
    at_48k = speech_features(Audio(tone, 48_000, None))
    t = np.arange(16_000) / 16_000
    at_16k = speech_features(Audio(0.3 * np.sin(2 * np.pi * (300 + 200 * t) * t).astype(np.float32), 16_000, None))
    assert np.abs(at_48k[3:-3, :4] - at_16k[3:-3, :4]).mean() < 1.0 < at_16k.std()


def test_beyond_the_end_there_is_silence():
    sound = murmur(0.5)
    longer = speech_features(sound, 30)
    assert longer.shape == (30, N_FEATURES) and longer.dtype == np.float32
    np.testing.assert_array_equal(longer[:15], speech_features(sound)[:15])
    np.testing.assert_allclose(longer[-1], longer[-2], atol=1e-4)


def test_the_first_cepstrum_is_the_logarithm_of_the_energy():
    """Of the window as it came, its mean removed: told by a sum of squares."""
    sound = murmur(1.0)
    quiet = Audio(sound.samples / 10, SAMPLE_RATE_HZ, None)
    fall = speech_features(sound)[5:, 0] - speech_features(quiet)[5:, 0]
    np.testing.assert_allclose(fall, 2 * np.log(10), atol=0.05)
