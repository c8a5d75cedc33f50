"""What the other markers say of a missing one: the Gaussian of a capture's poses, conditioned on what is seen."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from core.errors import UserFacingError
from core.importing.matching import typical_pose
from core.motion.database import MotionDatabase
from core.motion.normalise import normalise
from core.motion.resample import fill_gaps

# Gaps up to this length are bridged before the poses are learnt; frames of longer ones teach nothing.
_BRIDGED_S = 0.2
_LEAST_FRAMES = 30
_MOST_FRAMES = 6000


@dataclass(frozen=True)
class PoseModel:
    """Mean and covariance of head-stabilised poses.

    mean : float64, shape (n_markers, 3), mm
    covariance : float64, shape (3 n_markers, 3 n_markers), mm²
    rigid : rows that tell the head's motion
    noise_mm2 : variance of what no other marker explains, added to each seen coordinate
    """

    mean: np.ndarray
    covariance: np.ndarray
    rigid: np.ndarray
    noise_mm2: float = 0.02

    @classmethod
    def fit(cls, takes: Iterable[tuple[np.ndarray, float]], rigid: np.ndarray) -> PoseModel | None:
        """Learn the poses of ``takes``, each positions (n_frames, n_markers, 3) in mm and frames a second.

        None when too few frames show all markers, even with short gaps bridged.
        """
        whole, reference = [], None
        for positions, rate_hz in takes:
            bridged, _, masked = fill_gaps(positions, round(_BRIDGED_S * rate_hz))
            frames = bridged[~masked]
            if len(frames):
                whole.append(frames[:: max(1, len(frames) // _MOST_FRAMES)])
        if sum(map(len, whole)) < _LEAST_FRAMES:
            return None
        frames = np.concatenate(whole)
        reference = typical_pose(frames)
        for _ in range(2):
            face, _ = normalise(frames, reference, rigid)
            reference = face.mean(axis=0)
        packed = (face - reference).reshape(len(face), -1)
        return cls(reference, packed.T @ packed / len(packed), np.asarray(rigid))

    @classmethod
    def of_database(cls, database: MotionDatabase, names: Sequence[str]) -> PoseModel:
        """Return the poses of a database of the same actor, its markers in the order of ``names``.

        Raises `UserFacingError` when it has other markers.
        """
        lacking = [name for name in names if name not in database.markers.names]
        if lacking:
            raise UserFacingError(f"The database '{database.name}' has no marker '{lacking[0]}' to learn poses from.")
        rows = database.markers.indices(names)
        columns = (3 * rows[:, None] + np.arange(3)).ravel()
        basis = database.pca.basis[columns]
        rigid = [k for k, row in enumerate(rows) if row in set(database.markers.group("rigid").tolist())]
        return cls(database.pca.mean.reshape(-1, 3)[rows], basis * database.pca.variance @ basis.T,
                   np.array(rigid if len(rigid) >= 3 else range(len(rows)), int))  # fmt: skip

    def expected(self, frames: np.ndarray, seen: np.ndarray, wanted: int) -> np.ndarray:
        """Return where marker ``wanted`` is expected in each frame, in the frames' own space; shape (n_frames, 3).

        The principal components of the capture, weighted by their variances, are what the covariance holds; the answer
        is the conditional mean ``μ_w + Σ_ws (Σ_ss + σ²I)⁻¹ (x_s − μ_s)`` (Bishop 2006, equation 2.81).

        frames : shape (n_frames, n_markers, 3), mm, finite in the columns ``seen``
        seen : rows of the markers that all frames show, at least 3, without ``wanted``
        """
        steady = np.intersect1d(seen, self.rigid)
        local = np.flatnonzero(np.isin(seen, steady)) if len(steady) >= 3 else None
        face, head = normalise(frames[:, seen], self.mean[seen], local)
        known = np.arange(len(seen)) if local is None else local
        face = face + self.mean[seen][known].mean(axis=0)
        columns = (3 * seen[:, None] + np.arange(3)).ravel()
        target = 3 * wanted + np.arange(3)
        within = self.covariance[np.ix_(columns, columns)] + self.noise_mm2 * np.eye(len(columns))
        gain = cho_solve(cho_factor(within), self.covariance[np.ix_(columns, target)])
        pose = self.mean[wanted] + (face - self.mean[seen]).reshape(len(frames), -1) @ gain
        centred = (pose - self.mean[seen][known].mean(axis=0))[:, None]
        return head.put_back(centred)[:, 0]
