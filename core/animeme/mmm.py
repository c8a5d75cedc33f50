"""The rival of Ezzat, Geiger and Poggio (2002): each phoneme a Gaussian, and the smoothest path through them.

Kuo et al. (2012) call it MMM. For each control the path y minimises

    Σ_f w(p_f) (y_f − μ(p_f))²  +  λ Σ_f (Δ^q y)_f²

with μ and 1/w the mean and variance of the control over the frames of the phoneme said at f (diagonal covariances, as
there), and Δ^q the q-th difference. Its normal equations are banded. Ezzat's gradient descent on the training error,
which moves means and variances, is done here by damped Gauss–Newton steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded
from scipy.special import comb

from core.animeme.damping import START, damped_step
from core.animeme.examples import Example, Lesson
from core.animeme.levels import N_PHONEMES
from core.animeme.utterances import Nearby, Utterances
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.speech.phoneme import VISEME_OF_PHONEME
from core.speech.transcript import Transcript

_VISEME = np.asarray(VISEME_OF_PHONEME)
_PRIOR_FRAMES = 3.0  # of its viseme class, or of all, that a phoneme counts besides its own
_LEAST_GAIN, _MOST_STEPS = 1e-4, 30


@dataclass(frozen=True, eq=False)
class MmmModel:
    """Means and precisions by phoneme.

    means, precisions : float64, shape (n_phonemes, U); precisions are over the control's variance, dimensionless
    smoothness : λ, at ``rate_hz``; order : q
    """

    names: tuple[str, ...]
    means: np.ndarray
    precisions: np.ndarray
    smoothness: float
    order: int
    rate_hz: float

    def curves(self, transcript: Transcript, rate_hz: float) -> ControlTrack:
        """Speak ``transcript``: solved at the rate that was learnt at, then sampled."""
        n_frames = max(1, round(transcript.duration_s * self.rate_hz))
        values = self.values(Utterances.of([transcript]), [np.arange(n_frames) / self.rate_hz])
        track = ControlTrack(self.names, values, self.rate_hz)
        return track.at_rate(rate_hz, max(1, round(transcript.duration_s * rate_hz)))

    def values(self, utterances: Utterances, times_s: Sequence[np.ndarray]) -> np.ndarray:
        """Solve for the paths of any sentences, whose frames stand ``1 / rate_hz`` apart; shape (n_frames, U)."""
        phoneme = _phoneme_said(utterances, times_s)
        band = smoothness_band([len(times) for times in times_s], self.smoothness, self.order)
        return np.stack(
            [_path(band, phoneme, mean, weight) for mean, weight in zip(self.means.T, self.precisions.T)], axis=1
        )


def train_mmm(
    examples: Sequence[Example], smoothness: float = 30.0, order: int = 2, is_refined: bool = True,
    progress: Progress = SILENT,
) -> MmmModel:  # fmt: skip
    """Take means and variances of the phonemes, and refine both on the training error if wanted."""
    lesson = Lesson.of(examples)
    phoneme = _phoneme_said(lesson.utterances, lesson.times_s)
    band = smoothness_band([len(times) for times in lesson.times_s], smoothness, order)
    spread = lesson.values.std(axis=0)
    spread = np.where(spread > 1e-9, spread, 1.0)
    targets = lesson.values / spread
    means, precisions = _moments(targets, phoneme)
    for u in range(targets.shape[1] if is_refined else 0):
        progress.step(u / targets.shape[1], f"refining {lesson.names[u]}")
        means[:, u], precisions[:, u] = _refined(band, phoneme, targets[:, u], means[:, u], precisions[:, u])
    progress.step(1.0, "trained")
    return MmmModel(lesson.names, means * spread, precisions, smoothness, order, lesson.rate_hz)


def smoothness_band(lengths: Sequence[int], smoothness: float, order: int) -> np.ndarray:
    """λ DᵀD of sentences of these lengths, one after the other and not coupled, as `solveh_banded` wants it (lower).

    returns : float64, shape (order + 1, n_frames)
    """
    stencil = comb(order, np.arange(order + 1)) * (-1.0) ** np.arange(order + 1)
    band = np.zeros((order + 1, sum(lengths)))
    stops = np.cumsum(lengths)
    starts_at = np.concatenate([np.arange(stop - n, max(stop - order, stop - n)) for n, stop in zip(lengths, stops)])
    for i in range(order + 1):
        for below in range(order + 1 - i):
            np.add.at(band[below], starts_at + i, smoothness * stencil[i] * stencil[i + below])
    return band


def _phoneme_said(utterances: Utterances, times_s: Sequence[np.ndarray]) -> np.ndarray:
    return utterances.phoneme[Nearby.of(utterances, times_s, 0).utterance]


def _moments(targets: np.ndarray, phoneme: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and inverse variance of each phoneme; a rare one leans on its class, and that on all."""
    means, precisions = np.empty((2, N_PHONEMES, targets.shape[1]))
    mean, variance = targets.mean(axis=0), targets.var(axis=0)
    for p in range(N_PHONEMES):
        alike, own = targets[_VISEME[phoneme] == _VISEME[p]], targets[phoneme == p]
        by_class = (alike.sum(axis=0) + _PRIOR_FRAMES * mean) / (len(alike) + _PRIOR_FRAMES)
        means[p] = (own.sum(axis=0) + _PRIOR_FRAMES * by_class) / (len(own) + _PRIOR_FRAMES)
        scatter = ((own - means[p]) ** 2).sum(axis=0) + _PRIOR_FRAMES * variance
        precisions[p] = (len(own) + _PRIOR_FRAMES) / np.maximum(scatter, 1e-9)
    return means, precisions


def _banded(band: np.ndarray, weights: np.ndarray) -> np.ndarray:
    system = band.copy()
    system[0] += weights
    return system


def _path(band: np.ndarray, phoneme: np.ndarray, means: np.ndarray, precisions: np.ndarray) -> np.ndarray:
    weights = precisions[phoneme]
    return solveh_banded(_banded(band, weights), weights * means[phoneme], lower=True)


def _refined(
    band: np.ndarray, phoneme: np.ndarray, target: np.ndarray, means: np.ndarray, precisions: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Move means and precisions of what is said so that the path comes nearest to the training curve."""
    said, row = np.unique(phoneme, return_inverse=True)
    frames, n_said = np.arange(len(phoneme)), len(said)
    means, logs, damping = means.copy(), np.log(precisions), START
    path = _path(band, phoneme, means, np.exp(logs))
    loss = float(((target - path) ** 2).sum())
    for _ in range(_MOST_STEPS):
        weights = np.exp(logs)[phoneme]
        pushes = np.zeros((len(phoneme), 2 * n_said))
        pushes[frames, row] = weights
        pushes[frames, n_said + row] = weights * (means[phoneme] - path)
        jacobian = solveh_banded(_banded(band, weights), pushes, lower=True)

        def attempt(step: np.ndarray, means: np.ndarray = means, logs: np.ndarray = logs) -> tuple[float, tuple]:
            moved, scaled = means.copy(), logs.copy()
            moved[said] += step[:n_said]
            scaled[said] = np.clip(scaled[said] + step[n_said:], -7.0, 7.0)
            reached = _path(band, phoneme, moved, np.exp(scaled))
            return float(((target - reached) ** 2).sum()), (moved, scaled, reached)

        slope = jacobian.T @ (target - path)
        better, damping = damped_step(jacobian.T @ jacobian, slope, damping, loss, attempt)
        if better is None:
            break
        before, (loss, (means, logs, path)) = loss, better
        if before - loss < _LEAST_GAIN * before:
            break
    return means, np.exp(logs)
