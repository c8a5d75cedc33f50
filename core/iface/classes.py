"""Classes of sound, one a phoneme, each a mixture of Gaussians over features (Hong, Wen and Huang 2002, VI-A)."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.iface.heard_takes import HeardTake
from core.iface.speech_features import N_CEPSTRA, RATE_HZ
from core.speech.phoneme import PAU, PHONEME_INDEX, PHONEMES

N_CLASSES = 44  # the paper's; our set of phonemes has 45, of which no corpus says all
# A frame's features are of windows of 25 ms that end in the 30th of a second before it; their middle lies so far back.
_HEARD_BEFORE_S = 0.5 / RATE_HZ + 0.0125

_FLOOR = 1e-3  # of a variance, as a share of that of all frames, so that few frames make no needle
_ROUNDS = 50


@dataclass(frozen=True, eq=False)
class SpeechClasses:
    """Gaussian mixtures; the class whose mixture scores highest has the frame, in training and in use.

    phones : one a class
    means : float64, shape (n_classes, n_components, 10)
    factors : float64, shape (n_classes, n_components, 10, 10), F of the precision matrices F Fᵀ
    log_scales : float64, shape (n_classes, n_components), logarithm of weight times the density's peak; -inf for a
        component that a class does not have
    """

    phones: tuple[str, ...]
    means: np.ndarray
    factors: np.ndarray
    log_scales: np.ndarray

    def scores(self, features: np.ndarray) -> np.ndarray:
        """Return the log-likelihood of each frame under each mixture, float64, shape (n_frames, n_classes)."""
        factors, offsets = self._flat
        n_classes, n_components = self.log_scales.shape
        spread = np.asarray(features, float) @ factors - offsets
        density = -0.5 * np.square(spread).reshape(-1, n_classes, n_components, N_CEPSTRA).sum(axis=3)
        density += self.log_scales
        highest = density.max(axis=2)
        return highest + np.log(np.exp(density - highest[..., None]).sum(axis=2))

    def best(self, features: np.ndarray) -> np.ndarray:
        """Return the class of each frame, int, shape (n_frames,)."""
        return self.scores(features).argmax(axis=1)

    def only(self, rows: Sequence[int]) -> SpeechClasses:
        """Return some of the classes."""
        rows = list(rows)
        return SpeechClasses(
            tuple(self.phones[row] for row in rows), self.means[rows], self.factors[rows], self.log_scales[rows]
        )

    @property
    def _flat(self) -> tuple[np.ndarray, np.ndarray]:
        """All factors side by side, shape (10, n · 10), and what the means give through them."""
        side_by_side = self.factors.transpose(2, 0, 1, 3).reshape(N_CEPSTRA, -1)
        return side_by_side, np.einsum("cji,cjik->cjk", self.means, self.factors).reshape(-1)


def spoken_phones(take: HeardTake) -> np.ndarray:
    """Return what each frame of ``take`` hears by its transcript: rows of `PHONEMES`, shape (n_frames,)."""
    times_s = np.arange(len(take)) / RATE_HZ - _HEARD_BEFORE_S
    phones = np.full(len(take), PHONEME_INDEX[PAU])
    for said in take.transcript.phonemes:
        phones[(times_s >= said.start_s) & (times_s < said.end_s)] = PHONEME_INDEX[said.phone]
    return phones


def fit_classes(features: np.ndarray, phones: np.ndarray, n_components: int, fewest: int, seed: int) -> SpeechClasses:
    """Learn one mixture for every phoneme that is heard in ``fewest`` frames, the 44 most frequent at most.

    features : shape (n_frames, 10); phones : rows of `PHONEMES`, shape (n_frames,)
    n_components : at most; a class has one for every ``fewest`` frames
    fewest : a class that scores highest in fewer frames is left out too, the smallest first, and its frames go to those
        that score next; silence is a class like any other
    """
    counts = np.bincount(phones, minlength=len(PHONEMES))
    said = {p: features[phones == p] for p in np.argsort(-counts, kind="stable")[:N_CLASSES] if counts[p] >= fewest}
    if not said:
        said = {int(counts.argmax()): features}
    tables = (
        np.zeros((len(said), n_components, N_CEPSTRA)),
        np.zeros((len(said), n_components, N_CEPSTRA, N_CEPSTRA)),
        np.full((len(said), n_components), -np.inf),
    )
    floor = max(1e-6, _FLOOR * float(features.var(axis=0).mean()))
    for c, heard in enumerate(said.values()):
        j = int(np.clip(len(heard) // fewest, 1, n_components))
        for table, part in zip(tables, _mixture(heard, j, floor, seed)):
            table[c, :j] = part
    classes = SpeechClasses(tuple(PHONEMES[p] for p in said), *tables)
    scores = classes.scores(features)
    kept = np.arange(len(said))
    while len(kept) > 1:
        won = np.bincount(scores[:, kept].argmax(axis=1), minlength=len(kept))
        if won.min() >= fewest:
            break
        kept = np.delete(kept, won.argmin())
    return classes.only(kept)


def _mixture(
    heard: np.ndarray, n_components: int, floor: float, seed: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return means, factors and log scales (see `SpeechClasses`) of a mixture; ``floor`` is added to variances."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.mixture import GaussianMixture
    from threadpoolctl import threadpool_limits

    mixture = GaussianMixture(n_components, reg_covar=floor, random_state=seed, max_iter=_ROUNDS, tol=1e-2)
    with threadpool_limits(1), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # a mixture that still moves a little serves as well
        mixture.fit(heard.astype(float))
    factors = mixture.precisions_cholesky_
    peak = np.log(np.diagonal(factors, axis1=1, axis2=2)).sum(axis=1) - 0.5 * N_CEPSTRA * np.log(2 * np.pi)
    return mixture.means_, factors, np.log(mixture.weights_) + peak
