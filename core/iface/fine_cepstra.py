"""Finer hearing than the paper's: twenty cepstra 90 times a second, since a lip closes in less than a frame."""

from __future__ import annotations

from functools import cache

import numpy as np

RATE_HZ = 90  # windows a second, three a frame
N_FINE = 20
WINDOW = 400  # samples, 25 ms at 16 kHz
_N_BANDS, _N_SPECTRUM = 26, 512
FIRST_OF_A_NEPER = (2.0 * _N_BANDS) ** 0.5  # what a neper more in every band adds to the first cepstrum
_LOWEST_HZ, _HIGHEST_HZ = 60.0, 7600.0
_EMPHASIS = 0.97
_FLOOR = 1e3  # of a band's power at 16 bits a sample, about that of the rounding, so that silence is one value


def fine_cepstra(samples: np.ndarray, stops: np.ndarray, rate_hz: int) -> np.ndarray:
    """Return the cepstra of windows of 25 ms, float32, shape (n_windows, 20).

    samples : float32, at 16 bits' scale
    stops : int, shape (n_windows,), where each window ends; at least `WINDOW` + 1 samples lie before each
    """
    wave = samples[stops[:, None] - (WINDOW + 1) + np.arange(WINDOW + 1)]
    sharpened = wave[:, 1:] - np.float32(_EMPHASIS) * wave[:, :-1]
    power = np.square(np.abs(np.fft.rfft(sharpened * _taper(), _N_SPECTRUM, axis=1)).astype(np.float32))
    return np.log(power @ _bands(rate_hz) + np.float32(_FLOOR)) @ _cosines()


@cache
def _taper() -> np.ndarray:
    return np.hanning(WINDOW + 1)[:WINDOW].astype(np.float32)


@cache
def _bands(rate_hz: int) -> np.ndarray:
    """Triangles that are even on the mel scale, float32, shape (n_spectrum / 2 + 1, n_bands)."""
    lowest, highest = (1127.0 * np.log1p(f / 700.0) for f in (_LOWEST_HZ, _HIGHEST_HZ))
    edges = 700.0 * np.expm1(np.linspace(lowest, highest, _N_BANDS + 2) / 1127.0)
    place = np.arange(_N_SPECTRUM // 2 + 1) * rate_hz / _N_SPECTRUM
    rising = (place - edges[:-2, None]) / np.diff(edges)[:-1, None]
    falling = (edges[2:, None] - place) / np.diff(edges)[1:, None]
    return np.maximum(0.0, np.minimum(rising, falling)).T.astype(np.float32)


@cache
def _cosines() -> np.ndarray:
    """The first rows of the cosine transform (type II), float32, shape (n_bands, 20)."""
    turns = np.pi / _N_BANDS * (np.arange(_N_BANDS)[:, None] + 0.5) * np.arange(N_FINE)
    return (np.cos(turns) * np.sqrt(2.0 / _N_BANDS)).astype(np.float32)
