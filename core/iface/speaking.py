"""A face that speaks what it hears: the protocol that every trained model answers, live or as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

# Expression to its strength, 0..1; one that is left out is 0, and a sum over 1 is brought down to 1.
Strengths = Mapping[str, "float | np.ndarray"]

MOST_AHEAD = 3  # frames; 100 ms, beyond which a face lags visibly behind its voice


class FaceStream(Protocol):
    """The same face as it listens: frames come as soon as what lies ahead of them is heard."""

    def accept(self, features: np.ndarray, strengths: Strengths) -> np.ndarray:
        """Take the next features, shape (n, 70); return the frames that are due, float32, (m, n_markers, 3), mm.

        strengths : of the frames that are returned, one number an expression

        All frames returned so far are those of `SpeakingFace.motion` for the whole, frame by frame.
        """

    def finish(self) -> np.ndarray:
        """Return the last ``n_ahead`` frames, ahead of which there is silence, at the strengths given last."""


class SpeakingFace(Protocol):
    """What was learned from one database: features of speech (`core.iface.speech_features`) to marker motion.

    neutral : float32, shape (n_markers, 3), mm, the pose s_0 that deformations are added to
    expressions : those that it can show, without neutral; there may be none
    n_ahead : frames of 1/30 s that it hears beyond the one it shows, at most `MOST_AHEAD`
    """

    neutral: np.ndarray
    expressions: tuple[str, ...]
    n_ahead: int

    def motion(self, features: np.ndarray, strengths: Strengths) -> np.ndarray:
        """Return marker positions at 30 Hz, float32, shape (n_frames, n_markers, 3), mm, head space.

        features : shape (n_frames, 70)
        strengths : 0..1, one number or shape (n_frames,) an expression; deformations mix as
            ``d = (1 - Σ α_k) d_0 + Σ α_k d_k``, each d_k by equation 2 at full strength

        Raises `UserFacingError` for an expression that it does not have.
        """

    def stream(self) -> FaceStream:
        """Start to listen."""
