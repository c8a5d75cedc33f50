"""Which phoneme's shape wins, when, and what it asks for: the dominance functions as an artist looks at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.animeme.animeme import AnimemeModel
from core.animeme.utterances import Utterances
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript


@dataclass(frozen=True, eq=False)
class Ruling:
    """The say of each of J phonemes in each of F frames.

    shares : float64, shape (J, F), 0..1; those of one frame sum to 1
    asked : float64, shape (J, U), values of the model's controls that each phoneme has at its centre, were it alone
    """

    shares: np.ndarray
    asked: np.ndarray


def ruling_of(
    model: AnimemeModel, transcript: Transcript, modifiers: Sequence[EmotionModifier], rate_hz: float, n_frames: int,
    holds: bool = False,
) -> Ruling:  # fmt: skip
    """Return who rules which frame of ``transcript``, said with the emotions of ``modifiers``."""
    ruling = model.rule(transcript, rate_hz, n_frames, holds=holds)
    polynomials = model.polynomials(Utterances.of([transcript], [modifiers]))
    n_powers = model.form.degree + 1
    at_centre = np.polynomial.legendre.legvander(np.zeros(1), model.form.degree)[0]
    asked = np.einsum("m,jmu->ju", at_centre, polynomials.reshape(-1, n_powers, len(model.names))) + model.rest
    return Ruling(ruling / np.maximum(ruling.sum(axis=0), 1e-12), asked)
