"""What both trained faces share: a window of features heard, motion units moved, expressions mixed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.errors import UserFacingError
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.speaking import Strengths
from core.iface.speech_features import N_FEATURES


@dataclass(frozen=True, eq=False)
class UnitFace(ABC):
    """A `core.iface.speaking.SpeakingFace` that moves motion units by what it hears around a frame.

    units : of the database that it was trained on
    neutral : float32, shape (n_markers, 3), mm, s_0
    silence : float32, shape (70,), the features of silence, which is heard before the start and after the end
    n_back, n_ahead : frames that are heard before and after the one that is shown
    """

    units: MotionUnits
    neutral: np.ndarray
    silence: np.ndarray
    n_back: int
    n_ahead: int

    @abstractmethod
    def parameters(self, context: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return the MUPs of every frame, float32, (n, n_parameters), for neutral and then for each expression.

        context : float32, shape (n_back + n + n_ahead, 70)
        """

    @property
    def expressions(self) -> tuple[str, ...]:
        """Those that it was trained on, without neutral."""
        return tuple(self.units.expressions)

    def motion(self, features: np.ndarray, strengths: Strengths) -> np.ndarray:
        """See `core.iface.speaking.SpeakingFace.motion`."""
        features = _checked(features)
        context = np.concatenate([self._silent(self.n_back), features, self._silent(self.n_ahead)])
        return self.frames(context, self._shares(strengths, len(features)))

    def stream(self) -> UnitFaceStream:
        """Start to listen."""
        return UnitFaceStream(self)

    def frames(self, context: np.ndarray, shares: np.ndarray) -> np.ndarray:
        """Return the frames in the middle of ``context``; ``shares`` of neutral and each expression sum to 1 a frame.

        shares : float32, shape (n, 1 + n_expressions)
        """
        moved = np.zeros((len(shares), self.neutral.size), np.float32)
        for k, (parameters, (mean, units)) in enumerate(zip(self.parameters(context), self._spanned)):
            if shares[:, k].any():
                moved += shares[:, k, None] * (mean + parameters @ units)
        return self.neutral + moved.reshape(-1, *self.neutral.shape)

    @cached_property
    def _spanned(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Mean and units of the deformations of each state (equation 2), float32, flat."""
        spoken = self.units.utterance
        states = [(spoken.mean, spoken.units)]
        for added in self.units.expressions.values():
            states.append((spoken.mean + added.mean, np.concatenate([spoken.units, added.units])))
        return [(mean.astype(np.float32), units.astype(np.float32)) for mean, units in states]

    def _silent(self, n_frames: int) -> np.ndarray:
        return np.broadcast_to(self.silence, (n_frames, N_FEATURES))

    def _shares(self, strengths: Strengths, n_frames: int) -> np.ndarray:
        """Strengths within 0..1, brought down to a sum of 1, and what they leave to neutral."""
        shares = np.zeros((n_frames, 1 + len(self.expressions)))
        for name, strength in strengths.items():
            if name in self.expressions:
                shares[:, 1 + self.expressions.index(name)] = np.clip(strength, 0.0, 1.0)
            elif name != NEUTRAL:
                known = ", ".join((NEUTRAL, *self.expressions))
                raise UserFacingError(f"This face was not trained on '{name}'.", f"It knows {known}.")
        shares /= np.maximum(1.0, shares.sum(axis=1))[:, None]
        shares[:, 0] = 1.0 - shares.sum(axis=1)
        return shares.astype(np.float32)


class UnitFaceStream:
    """A `core.iface.speaking.FaceStream` of a `UnitFace`."""

    def __init__(self, face: UnitFace) -> None:
        self._face = face
        self._context = face._silent(face.n_back).copy()
        self._strengths: Mapping[str, float] = {}

    def accept(self, features: np.ndarray, strengths: Strengths) -> np.ndarray:
        """See `core.iface.speaking.FaceStream.accept`."""
        face = self._face
        self._strengths = dict(strengths)
        context = np.concatenate([self._context, _checked(features)])
        n_due = max(0, len(context) - face.n_back - face.n_ahead)
        self._context = context[n_due:]
        if n_due == 0:
            return np.zeros((0, *face.neutral.shape), np.float32)
        return face.frames(context, face._shares(strengths, n_due))

    def finish(self) -> np.ndarray:
        """See `core.iface.speaking.FaceStream.finish`; the stream then listens anew."""
        last = self.accept(self._face._silent(self._face.n_ahead), self._strengths)
        self._context = self._face._silent(self._face.n_back).copy()
        return last


def windows(context: np.ndarray, n_frames: int) -> np.ndarray:
    """Lay the features around each frame side by side, oldest first; shape (n_frames, n_window · n_features)."""
    n_window = len(context) - n_frames + 1
    return np.concatenate([context[i : i + n_frames] for i in range(n_window)], axis=1)


def _checked(features: np.ndarray) -> np.ndarray:
    features = np.asarray(features, np.float32)
    if features.ndim != 2 or features.shape[1] != N_FEATURES:
        raise ValueError(f"features of shape {features.shape}, not (n, {N_FEATURES})")
    return features
