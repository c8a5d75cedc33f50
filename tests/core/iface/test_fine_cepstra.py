"""Fine cepstra by definition, and at their places in the sound."""

import numpy as np
import pytest
from scipy.fft import dct
from scipy.signal import get_window

from core.iface.fine_cepstra import FIRST_OF_A_NEPER, N_FINE, WINDOW, fine_cepstra
from core.iface.speech_features import N_CEPSTRA, SAMPLE_RATE_HZ, speech_features
from core.media.audio import Audio

_RATE_HZ = 16_000


def _noise(n, seed=0):
    return (3000 * np.random.default_rng(seed).standard_normal(n)).astype(np.float32)


def _by_definition(wave):
    """One window by loops over bands, its cosine transform by scipy."""
    sharpened = wave[1:].astype(float) - 0.97 * wave[:-1]
    power = np.abs(np.fft.fft(sharpened * get_window("hann", WINDOW), 512))[:257] ** 2
    hertz = np.arange(257) * _RATE_HZ / 512
    mel = np.linspace(1127 * np.log(1 + 60 / 700), 1127 * np.log(1 + 7600 / 700), 28)
    edges = 700 * (np.exp(mel / 1127) - 1)
    bands = [np.sum(power * np.interp(hertz, edges[b : b + 3], [0, 1, 0], 0, 0)) for b in range(26)]
    cepstra = dct(np.log(np.array(bands) + 1e3), norm="ortho")[:N_FINE]
    return cepstra * np.where(np.arange(N_FINE) == 0, np.sqrt(2), 1)


def test_cepstra_are_those_of_the_definition():
    sound = _noise(1200)
    stops = np.array([401, 600, 1200])
    found = fine_cepstra(sound, stops, _RATE_HZ)
    assert found.dtype == np.float32
    for row, stop in zip(found, stops):
        np.testing.assert_allclose(row, _by_definition(sound[stop - 401 : stop]), atol=2e-3)


def test_louder_sound_is_told_by_the_first_alone():
    sound = _noise(800)
    quiet, loud = (fine_cepstra(sound * np.exp(n / 2), np.array([500, 800]), _RATE_HZ) for n in (0.0, 1.0))
    np.testing.assert_allclose(loud[:, 0] - quiet[:, 0], FIRST_OF_A_NEPER, rtol=1e-3)
    np.testing.assert_allclose(loud[:, 1:], quiet[:, 1:], atol=5e-3)


@pytest.mark.parametrize("frame", [1, 2, 3, 20])
def test_a_frame_has_the_three_windows_that_end_in_its_thirtieth_of_a_second(frame):
    sound = _noise(_RATE_HZ) / 32768
    features = speech_features(Audio(sound, SAMPLE_RATE_HZ, None))[frame, N_CEPSTRA:].reshape(3, N_FINE)
    padded = np.concatenate([np.zeros(1000, np.float32), sound * 32768])
    for window, row in enumerate(features):
        stop = 1000 + round((3 * frame - 2 + window) * _RATE_HZ / 90)
        np.testing.assert_allclose(row, _by_definition(padded[stop - 401 : stop]), atol=5e-3)
