"""What the animeme of one occurrence is added up from: its class, its phoneme, its neighbours, how long, how felt.

The paper gives each phoneme one polynomial (equation 6). Here that polynomial is a sum over levels, each with a ridge
of its own: a phoneme that is rare stays near its viseme class, which may be said often, and a neighbour or an emotion
only changes what the recordings show changed. Every level is linear in its coefficients, so all are solved for at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, hstack

from core.animeme.form import AnimemeForm
from core.animeme.utterances import Utterances
from core.speech.emotion import EMOTIONS
from core.speech.phoneme import PHONEMES, VISEME_CLASSES, VISEME_OF_PHONEME

_TYPICAL_S = 0.08
_VISEME = np.asarray(VISEME_OF_PHONEME)
N_PHONEMES, _N_VISEMES = len(PHONEMES), len(VISEME_CLASSES)


@dataclass(frozen=True)
class Level:
    """One summand: ``n_rows`` polynomials of ``degree``, held near zero as if by ``ridge_s`` seconds of speech."""

    name: str
    degree: int
    ridge_s: float
    n_rows: int

    @property
    def n_columns(self) -> int:
        """Number of coefficients for one control."""
        return self.n_rows * (self.degree + 1)


def levels_of(form: AnimemeForm, ridges_s: Mapping[str, float]) -> tuple[Level, ...]:
    """Return the levels of ``form``; ``ridges_s``: level name to its ridge, seconds."""
    square = _N_VISEMES * _N_VISEMES
    every = (
        ("class", form.degree, _N_VISEMES),
        ("phoneme", form.degree, N_PHONEMES),
        ("previous", min(form.context_degree, form.degree), square),
        ("following", min(form.context_degree, form.degree), square),
        ("duration", min(form.duration_degree, form.degree), N_PHONEMES),
        ("emotion", min(form.emotion_degree, form.degree), len(EMOTIONS) * N_PHONEMES),
    )
    return tuple(Level(name, degree, ridges_s.get(name, 0.0), n) for name, degree, n in every if degree >= 0)


def membership(level: Level, utterances: Utterances, span_s: np.ndarray) -> csr_matrix:
    """Return how much each row of ``level`` adds to each occurrence; shape (J, n_rows).

    span_s : float64, shape (2, n_phonemes), shortest and longest duration that was learnt from; others count as these
    """
    phoneme, n = utterances.phoneme, len(utterances)
    ones, each = np.ones(n), np.arange(n)
    if level.name == "emotion":
        row = np.arange(len(EMOTIONS)) * N_PHONEMES + phoneme[:, None]
        each, row, ones = np.repeat(each, len(EMOTIONS)), row.ravel(), utterances.emotions.ravel()
    elif level.name == "duration":
        known_s = np.clip(utterances.duration_s, span_s[0, phoneme], span_s[1, phoneme])
        row, ones = phoneme, np.log(known_s / _TYPICAL_S)
    else:
        row = {
            "class": _VISEME[phoneme],
            "phoneme": phoneme,
            "previous": _VISEME[phoneme] * _N_VISEMES + _VISEME[utterances.previous],
            "following": _VISEME[phoneme] * _N_VISEMES + _VISEME[utterances.following],
        }[level.name]
    return csr_matrix((ones, (each, row)), shape=(n, level.n_rows))


def sharing(levels: Sequence[Level], degree: int, utterances: Utterances, span_s: np.ndarray) -> csr_matrix:
    """Return the matrix from the coefficients of all levels to the polynomials of the occurrences.

    shape (J (degree + 1), n_columns of all levels); equation 6's sum over occurrences is its transpose at work
    """
    return hstack([_spread(membership(level, utterances, span_s), degree, level.degree) for level in levels]).tocsr()


def _spread(members: csr_matrix, degree: int, level_degree: int) -> csr_matrix:
    """Kronecker product of ``members`` with the map that takes each power to itself, as far as the level has it."""
    pairs = members.tocoo()
    m = np.arange(level_degree + 1)
    row = pairs.row[:, None].astype(np.int64) * (degree + 1) + m
    column = pairs.col[:, None].astype(np.int64) * (level_degree + 1) + m
    values = np.repeat(pairs.data, level_degree + 1)
    shape = (members.shape[0] * (degree + 1), members.shape[1] * (level_degree + 1))
    return csr_matrix((values, (row.ravel(), column.ravel())), shape=shape)


def ridge_of(levels: Sequence[Level], rate_hz: float) -> np.ndarray:
    """Return the ridge of each column, in frames at ``rate_hz``; float64, shape (n_columns of all levels,)."""
    return np.concatenate([np.full(level.n_columns, level.ridge_s * rate_hz) for level in levels])
