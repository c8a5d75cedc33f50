"""Equation 1 as a matrix: what each phoneme near a frame weighs in it, times the powers of its own time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from core.animeme.dominance import dominance, dominance_slopes, held
from core.animeme.form import AnimemeForm
from core.animeme.utterances import Nearby, Utterances

_FAINTEST = 1e-5  # a phoneme whose dominance times its largest power is less in a frame is left out of it


class Weights(NamedTuple):
    """What each pair counts, and for a normalised form the sum of dominances in its frame (else None)."""

    value: np.ndarray
    total: np.ndarray | None


class Scene:
    """Sentences laid over their frames; everything of equation 1 but the widths and the coefficients.

    powers : float64, shape (N, degree + 1), of each pair. Legendre polynomials in 2t − 1 span what the powers of t
        (equation 2) span, and keep the normal equations well away from singular
    """

    def __init__(
        self, form: AnimemeForm, utterances: Utterances, nearby: Nearby, longest_s: np.ndarray | None = None
    ) -> None:
        self.form, self.utterances, self.nearby = form, utterances, nearby
        self.phoneme = utterances.phoneme[nearby.utterance]
        self.offset_s, self.duration_s = nearby.offset_s, utterances.duration_s[nearby.utterance]
        if longest_s is not None:
            self.offset_s, self.duration_s = held(self.offset_s, self.duration_s, longest_s[self.phoneme])
        place = 2.0 * self.offset_s / self.duration_s
        if form.edge:
            place = np.clip(place, -form.edge, form.edge)
        self.powers = np.polynomial.legendre.legvander(place, form.degree)

    @property
    def n_frames(self) -> int:
        """Frames of all sentences together."""
        return self.nearby.n_frames

    def dominances(self, widths: np.ndarray) -> np.ndarray:
        """Equation 7 of each pair; ``widths``: σ1 and σ2, shape (2, n_phonemes)."""
        keep, reach = widths[:, self.phoneme]
        return dominance(self.offset_s, self.duration_s, keep, reach, self.form.spread)

    def weights(self, widths: np.ndarray) -> Weights:
        """Dominance of each pair, over the sum in its frame if the form is normalised."""
        ruling = self.dominances(widths)
        if not self.form.is_normalised:
            return Weights(ruling, None)
        # where the nearest phoneme is far beyond its reach the sum underflows, and so does all that it divides
        total = np.bincount(self.nearby.frame, ruling, self.n_frames) + 1e-12
        return Weights(ruling / total[self.nearby.frame], total)

    def seen(self, weights: Weights) -> np.ndarray:
        """Return which pairs count for anything, bool, shape (N,)."""
        return weights.value * np.abs(self.powers).max(axis=1) > _FAINTEST

    def slopes(self, widths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of each pair's dominance by the logarithm of its σ1 and of its σ2, each of shape (N,)."""
        keep, reach = widths[:, self.phoneme]
        found = dominance_slopes(self.offset_s, self.duration_s, keep, reach, self.form.spread)
        return found.by_keep * keep, found.by_reach * reach

    def matrix(self, weights: Weights) -> csr_matrix:
        """Rows are frames, columns the powers of each occurrence; times their coefficients it is equation 1."""
        n_powers = self.form.degree + 1
        seen = self.seen(weights)
        values = weights.value[seen, None] * self.powers[seen]
        columns = self.nearby.utterance[seen, None] * n_powers + np.arange(n_powers)
        stops = np.bincount(self.nearby.frame[seen], minlength=self.n_frames).cumsum() * n_powers
        shape = (self.n_frames, len(self.utterances) * n_powers)
        return csr_matrix((values.ravel(), columns.ravel(), np.concatenate([[0], stops])), shape=shape)

    def shapes(self, coefficients: np.ndarray) -> np.ndarray:
        """A_j at each pair, shape (N, U); coefficients: shape (J (degree + 1), U)."""
        by_utterance = coefficients.reshape(len(self.utterances), self.form.degree + 1, -1)
        return np.einsum("nm,nmu->nu", self.powers, by_utterance[self.nearby.utterance])
