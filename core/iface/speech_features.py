"""What the face listens to: ten MFCCs a frame, the same for a whole file as for a microphone (Hong et al. 2002, VI)."""

from __future__ import annotations

import math

import numpy as np

from core.media.audio import Audio, resampled

RATE_HZ = 30  # frames a second
SAMPLE_RATE_HZ = 16_000
N_CEPSTRA = 10
_SHIFT_S, _LENGTH_S = 0.010, 0.025
_FULL_SCALE = 32768.0  # the extractor's features expect samples of 16 bits


class SpeechFeatureStream:
    """Takes sound as it comes and gives the features of every frame as soon as its sound is in.

    Cepstra are taken every 10 ms over windows of 25 ms. Frame f, at ``f / 30`` seconds, has the mean of the cepstra
    whose windows end in the 30th of a second before that time, so that it never waits for sound that comes after it.
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
        self._take(np.zeros(round(_LENGTH_S * SAMPLE_RATE_HZ), np.float32))  # window i ends at i · 10 ms

    def accept(self, samples: np.ndarray) -> np.ndarray:
        """Take mono ``samples`` at 16 kHz, -1..1; return the features of the frames that are complete, (n, 10)."""
        self._take(samples)
        frames = []
        while (ended := _windows_ended(self._n_frames)) <= self._extractor.num_frames_ready:
            windows = [self._extractor.get_frame(i) for i in range(self._n_windows, ended)]
            frames.append(np.mean(windows, axis=0))
            self._extractor.pop(len(windows))
            self._n_windows = ended
            self._n_frames += 1
        return np.array(frames, np.float32).reshape(-1, N_CEPSTRA)

    def _take(self, samples: np.ndarray) -> None:
        self._extractor.accept_waveform(SAMPLE_RATE_HZ, (np.asarray(samples, np.float32) * _FULL_SCALE).tolist())


def _windows_ended(frame: int) -> int:
    """How many windows have ended at ``frame / 30`` seconds."""
    return math.floor(frame / RATE_HZ / _SHIFT_S + 1e-6) + 1


def speech_features(audio: Audio, n_frames: int | None = None) -> np.ndarray:
    """Return the features of a whole sound, float32, shape (n_frames, 10); all frames of the sound when None.

    A frame that stands beyond the end of the sound hears silence.
    """
    heard = resampled(audio, SAMPLE_RATE_HZ).samples
    if n_frames is None:
        n_frames = max(1, round(audio.duration_s * RATE_HZ))
    missing = math.ceil(n_frames / RATE_HZ * SAMPLE_RATE_HZ) - len(heard)
    return SpeechFeatureStream().accept(np.concatenate([heard, np.zeros(max(0, missing), np.float32)]))[:n_frames]
