"""What faces listen to, the same for a whole file as for a microphone: the paper's ten MFCCs a frame, and finer ones.

The paper's face hears the first ten (Hong et al. 2002, VI), the modern one the others.
"""

from __future__ import annotations

import math

import numpy as np

from core.iface.fine_cepstra import N_FINE, WINDOW, fine_cepstra
from core.iface.fine_cepstra import RATE_HZ as FINE_RATE_HZ
from core.media.audio import Audio, resampled

RATE_HZ = 30  # frames a second
SAMPLE_RATE_HZ = 16_000
N_CEPSTRA = 10
FINE_PER_FRAME = FINE_RATE_HZ // RATE_HZ
N_FEATURES = N_CEPSTRA + FINE_PER_FRAME * N_FINE
_SHIFT_S, _LENGTH_S = 0.010, 0.025
_FULL_SCALE = 32768.0  # the extractor's features expect samples of 16 bits


class SpeechFeatureStream:
    """Takes sound as it comes and gives the features of every frame as soon as its sound is in.

    Cepstra are taken every 10 ms over windows of 25 ms. Frame f, at ``f / 30`` seconds, has the mean of the cepstra
    whose windows end in the 30th of a second before that time, so that it never waits for sound that comes after it;
    then the fine cepstra of the three windows that end in it, oldest first (`core.iface.fine_cepstra`).
    """

    def __init__(self) -> None:
        import kaldi_native_fbank

        options = kaldi_native_fbank.MfccOptions()
        options.frame_opts.samp_freq = SAMPLE_RATE_HZ
        options.frame_opts.frame_shift_ms = 1000 * _SHIFT_S
        options.frame_opts.frame_length_ms = 1000 * _LENGTH_S
        options.frame_opts.dither = 0.0  # equal sound gives equal features
        options.frame_opts.snip_edges = True  # a window never reaches beyond the sound that is there
        options.num_ceps = N_CEPSTRA
        options.energy_floor = 1.0
        self._extractor = kaldi_native_fbank.OnlineMfcc(options)
        self._n_frames = 0
        self._n_windows = 0
        self._sound = np.zeros(0, np.float32)  # what is not yet heard finely
        self._first = -round(_LENGTH_S * SAMPLE_RATE_HZ)  # the place of its first sample
        self._take(np.zeros(round(_LENGTH_S * SAMPLE_RATE_HZ), np.float32))  # window i ends at i · 10 ms

    def accept(self, samples: np.ndarray) -> np.ndarray:
        """Take mono ``samples`` at 16 kHz, -1..1; return the features of the frames that are complete, (n, 70)."""
        self._take(samples)
        frames, n_heard = [], self._first + len(self._sound)
        while _fine_stops(self._n_frames)[-1] <= n_heard:
            ended = _windows_ended(self._n_frames)
            windows = [self._extractor.get_frame(i) for i in range(self._n_windows, ended)]
            frames.append(np.concatenate([np.mean(windows, axis=0), self._fine()]))
            self._extractor.pop(len(windows))
            self._n_windows = ended
            self._n_frames += 1
        begin = max(0, _fine_stops(self._n_frames)[0] - (WINDOW + 1) - self._first)
        self._sound, self._first = self._sound[begin:], self._first + begin
        return np.array(frames, np.float32).reshape(-1, N_FEATURES)

    def _fine(self) -> np.ndarray:
        """The fine cepstra of the next frame; frame by frame, so that they are the same to the last bit."""
        stops = _fine_stops(self._n_frames)
        first = stops[0] - (WINDOW + 1)
        sound = self._sound[max(0, first - self._first) : stops[-1] - self._first]
        before = np.zeros(max(0, self._first - first), np.float32)
        return fine_cepstra(np.concatenate([before, sound]), stops - first, SAMPLE_RATE_HZ).ravel()

    def _take(self, samples: np.ndarray) -> None:
        samples = np.asarray(samples, np.float32) * np.float32(_FULL_SCALE)
        self._extractor.accept_waveform(SAMPLE_RATE_HZ, samples.tolist())
        self._sound = np.concatenate([self._sound, samples])


def _windows_ended(frame: int) -> int:
    """How many windows have ended at ``frame / 30`` seconds."""
    return math.floor(frame / RATE_HZ / _SHIFT_S + 1e-6) + 1


def _fine_stops(frame: int) -> np.ndarray:
    """Where the fine windows of ``frame`` end, samples; the last at ``frame / 30`` seconds."""
    windows = FINE_PER_FRAME * frame + np.arange(1 - FINE_PER_FRAME, 1)
    return np.rint(windows * SAMPLE_RATE_HZ / FINE_RATE_HZ).astype(int)


def speech_features(audio: Audio, n_frames: int | None = None) -> np.ndarray:
    """Return the features of a whole sound, float32, shape (n_frames, 70); all frames of the sound when None.

    A frame that stands beyond the end of the sound hears silence.
    """
    heard = resampled(audio, SAMPLE_RATE_HZ).samples
    if n_frames is None:
        n_frames = max(1, round(audio.duration_s * RATE_HZ))
    missing = math.ceil(n_frames / RATE_HZ * SAMPLE_RATE_HZ) - len(heard)
    return SpeechFeatureStream().accept(np.concatenate([heard, np.zeros(max(0, missing), np.float32)]))[:n_frames]
