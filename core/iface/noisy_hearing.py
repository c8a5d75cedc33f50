"""Speech as other rooms and microphones would give it, for faces to be trained on beside the clean sound."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from core.iface.speech_features import speech_features
from core.media.audio import Audio

_QUIETEST_DB, _LOUDEST_DB = 40.0, 5.0  # how far below the speech the noise lies
_DARKEST = 0.95  # a one-pole low pass colours the noise, from white to the rumble of a room


def in_noise(audio: Audio, rng: np.random.Generator) -> Audio:
    """Add stationary noise of a random colour, 5 to 40 dB below the sound's own level; a still sound stays as it is."""
    noise = lfilter([1.0], [1.0, -rng.uniform(0.0, _DARKEST)], rng.standard_normal(len(audio.samples)))
    level = np.sqrt(np.mean(np.square(audio.samples, dtype=float)))
    noise *= level / noise.std() * 10.0 ** (-rng.uniform(_LOUDEST_DB, _QUIETEST_DB) / 20.0)
    return Audio((audio.samples + noise).astype(np.float32), audio.rate_hz, audio.path)


def heard_in_noises(audio: Audio, n_frames: int, n_noises: int, seed: int) -> tuple[np.ndarray, ...]:
    """Return the features of ``audio`` in ``n_noises`` noises, each float32, shape (n_frames, 70)."""
    rng = np.random.default_rng(seed)
    return tuple(speech_features(in_noise(audio, rng), n_frames) for _ in range(n_noises))
