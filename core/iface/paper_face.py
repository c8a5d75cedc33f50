"""The paper's own audio-to-motion mapping: a class of sound has a perceptron, so has an expression (section VI)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.iface.classes import SpeechClasses
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import N_CEPSTRA
from core.iface.unit_face import UnitFace, windows


@dataclass(frozen=True, eq=False)
class PaperFace(UnitFace):
    """Ξ_0i from seven frames of features to utterance MUPs, Υ_k from those to the final MUPs of expression k.

    classes : of sound; the one of the frame itself decides which perceptron hears the window around it
    spoken : Ξ, one perceptron a class
    expressive : Υ, one perceptron an expression
    """

    classes: SpeechClasses
    spoken: tuple[Perceptron, ...]
    expressive: tuple[Perceptron, ...]

    def parameters(self, context: np.ndarray) -> tuple[np.ndarray, ...]:
        """See `UnitFace.parameters`."""
        context, n_frames = context[:, :N_CEPSTRA], len(context) - self.n_back - self.n_ahead
        heard = windows(context, n_frames)
        utterance = self.utterance(heard, context[self.n_back : self.n_back + n_frames])
        return utterance, *(perceptron(utterance) for perceptron in self.expressive)

    def utterance(self, heard: np.ndarray, features: np.ndarray) -> np.ndarray:
        """Return utterance MUPs, float32, shape (n, A_0), of windows ``heard`` around frames of ``features``."""
        best = self.classes.best(features)
        parameters = np.empty((len(heard), self.spoken[0].n_outputs), np.float32)
        for c in np.unique(best):
            parameters[best == c] = self.spoken[c](heard[best == c])
        return parameters
