"""The same sentences as they could have been heard: what makes a face listen to more than the recording's own sound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.iface.fine_cepstra import FIRST_OF_A_NEPER, N_FINE
from core.iface.heard_takes import HeardTake
from core.iface.lessons import heard_in_noise, silence_of
from core.iface.speech_features import N_CEPSTRA


class VariedSpeech:
    """Takes with silence around them, heard anew each time: louder or softer, with noise or without.

    takes : in as many noises each; n_back, n_ahead : frames of silence around each
    silence : float32, shape (70,)
    loudness : standard deviation, nepers of energy; noise_share : of the takes that are heard in noise
    """

    def __init__(
        self, takes: Sequence[HeardTake], n_back: int, n_ahead: int, silence: np.ndarray, loudness: float,
        noise_share: float,
    ) -> None:  # fmt: skip
        n_noisy = min(len(take.in_noise) for take in takes)
        self.takes, self.n_back, self.n_ahead, self._loudness = takes, n_back, n_ahead, loudness
        self._heard = [self._surrounded(takes, silence)]
        for i in range(n_noisy):
            noisy = [heard_in_noise(take, i) for take in takes]
            self._heard.append(self._surrounded(noisy, silence_of(noisy)))
        self._chances = np.full(1 + n_noisy, noise_share / max(1, n_noisy))
        self._chances[0] = 1.0 - noise_share if n_noisy else 1.0
        # what a neper more of energy adds to the first cepstrum, which is the log energy, and to those of the bands
        self._neper = np.zeros(len(silence), np.float32)
        self._neper[0], self._neper[N_CEPSTRA::N_FINE] = 1.0, FIRST_OF_A_NEPER

    def contexts(self, rng: np.random.Generator) -> list[np.ndarray]:
        """Return the features of each take as it is heard this time, shape (n_back + n_frames + n_ahead, 70)."""
        which = rng.choice(len(self._heard), len(self.takes), p=self._chances)
        louder = rng.normal(0.0, self._loudness, len(self.takes)).astype(np.float32)
        return [self._heard[w][t] + n * self._neper for t, (w, n) in enumerate(zip(which, louder))]

    def _surrounded(self, takes: Sequence[HeardTake], silence: np.ndarray) -> list[np.ndarray]:
        before, after = (np.broadcast_to(silence, (n, len(silence))) for n in (self.n_back, self.n_ahead))
        return [np.concatenate([before, take.features, after]) for take in takes]
