"""The spectrogram of a sound, as one reads formants and bursts from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.media.audio import Audio, resampled

RATE_HZ = 16_000
COLUMN_S = 0.002
# As short as one period of a voice, so that bursts and formants show rather than harmonics.
_WINDOW_S = 0.005
_RANGE_DB = 60.0
# Speech falls by about 6 dB an octave; raised again, fricatives are as dark as vowels.
_PRE_EMPHASIS = 0.97
_COLUMNS_AT_ONCE = 8192


@dataclass(frozen=True)
class Spectrogram:
    """Levels over time and frequency.

    levels : uint8, shape (n_bands, n_columns); 255 is the loudest, 0 is 60 dB below it or less; band 0 lies at 0 Hz
        and the last one at ``top_hz``; column c lies at ``c * column_s``
    """

    levels: np.ndarray
    column_s: float
    top_hz: float

    @classmethod
    def of(cls, audio: Audio) -> Spectrogram:
        """Measure a sound: Gaussian windows of 5 ms each 2 ms, up to 8 kHz."""
        from scipy.signal import ShortTimeFFT
        from scipy.signal.windows import gaussian

        samples = resampled(audio, RATE_HZ).samples.astype(np.float64)
        emphasised = np.append(samples[:1], samples[1:] - _PRE_EMPHASIS * samples[:-1])
        length = 2 * round(_WINDOW_S * RATE_HZ)
        hop = round(COLUMN_S * RATE_HZ)
        window = gaussian(length, length / 6.0)
        if len(emphasised) < length:
            emphasised = np.pad(emphasised, (0, length - len(emphasised)))
        transform = ShortTimeFFT(window, hop, RATE_HZ, mfft=256, scale_to="magnitude")
        n_columns = -(-len(samples) // hop)
        power = np.empty((transform.f_pts, n_columns), np.float32)
        for first in range(0, n_columns, _COLUMNS_AT_ONCE):
            stop = min(first + _COLUMNS_AT_ONCE, n_columns)
            # p is counted from the first sample, so columns of neighbouring stretches are the same as in one piece
            power[:, first:stop] = np.abs(transform.stft(emphasised, p0=first, p1=stop)) ** 2
        db = 10.0 * np.log10(power + 1e-12)
        top = float(db.max(initial=-120.0))
        levels = np.clip((db - top + _RANGE_DB) / _RANGE_DB, 0.0, 1.0)
        return cls(np.round(255 * levels).astype(np.uint8), hop / RATE_HZ, RATE_HZ / 2)
