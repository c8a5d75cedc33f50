"""Head motion out, face motion kept: every frame brought into the space of a rest pose.

Deng and Neumann 2008, section 3, equations 1 and 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class HeadMotion:
    """What normalisation took out, so that it can be put back.

    rotation : float64, shape (n_frames, 3, 3), acts on the right of row vectors
    translation : float64, shape (n_frames, 3), millimetres
    scale : float64, shape (n_frames,); 1 unless the capture has no true scale (tracked video)

    captured = face / scale @ rotation.T + translation
    """

    rotation: np.ndarray
    translation: np.ndarray
    scale: np.ndarray

    def put_back(self, positions: np.ndarray) -> np.ndarray:
        """Return head-space ``positions``, shape (n_frames, n_markers, 3), in the space of the capture."""
        turned = positions / self.scale[:, None, None] @ self.rotation.transpose(0, 2, 1)
        return turned + self.translation[:, None, :]


def normalise(
    positions: np.ndarray,
    reference: np.ndarray,
    rigid: np.ndarray | None = None,
    origin: int | None = None,
    with_scale: bool = False,
) -> tuple[np.ndarray, HeadMotion]:
    """Remove head motion from a capture.

    Each frame x_i is translated so that the origin marker is at 0 and turned by ``R = V Uᵀ`` where
    ``yᵀ x_i = U D Vᵀ`` and y is the reference pose (equations 1 and 2). Differences from the paper: a reflection
    (det R = -1) is turned into the nearest rotation; the rotation may be estimated on near-rigid markers only;
    without an origin marker the centroid of those markers is used, which spreads its noise over them.

    positions : shape (n_frames, n_markers, 3), NaN where missing; markers that are missing in a frame take no part
        in the estimate of that frame
    reference : shape (n_markers, 3), finite
    rigid : rows of the near-rigid markers; None means all
    origin : row of the marker that is put at 0; None means the centroid of the rigid markers
    with_scale : also estimate one scale a frame
    returns : float64 head-space positions of the same shape, and the motion that was removed. A frame with fewer
        than three usable rigid markers, or without its origin marker, becomes NaN.
    """
    positions = np.asarray(positions, float)
    reference = np.asarray(reference, float)
    rows = np.arange(positions.shape[1]) if rigid is None or len(rigid) == 0 else np.asarray(rigid)
    usable = np.isfinite(positions[:, rows]).all(axis=2)
    count = usable.sum(axis=1)
    weight = usable / np.maximum(count, 1)[:, None]

    rigid_now = np.where(usable[..., None], positions[:, rows], 0.0)
    if origin is None:
        # the reference is centred on the same markers that this frame still shows
        centre = np.einsum("fk,fkc->fc", weight, rigid_now)
        rest_centre = weight @ reference[rows]
        goal_centre = rest_centre - reference[rows].mean(axis=0)
    else:
        centre = positions[:, origin]
        rest_centre = np.broadcast_to(reference[origin], centre.shape)
        goal_centre = np.zeros_like(centre)
    now = np.where(usable[..., None], rigid_now - centre[:, None], 0.0)
    rest = np.where(usable[..., None], reference[rows] - rest_centre[:, None], 0.0)

    lost = (count < 3) | ~np.isfinite(centre).all(axis=1)
    now[lost] = 0.0
    u, _, vt = np.linalg.svd(np.einsum("fki,fkj->fij", rest, now))
    handed = np.linalg.det(u @ vt)
    vt[:, 2] *= np.where(handed < 0, -1.0, 1.0)[:, None]
    rotation = (u @ vt).transpose(0, 2, 1)

    scale = np.ones(len(positions))
    if with_scale:
        size = np.sqrt((now**2).sum(axis=(1, 2)))
        rest_size = np.sqrt((rest**2).sum(axis=(1, 2)))
        scale = np.where(lost, 1.0, rest_size / np.where(size > 0, size, 1.0))
    face = (positions - centre[:, None]) @ rotation * scale[:, None, None] + goal_centre[:, None]
    face[lost] = np.nan
    translation = centre - np.einsum("fc,fdc->fd", goal_centre / scale[:, None], rotation)
    return face, HeadMotion(rotation, translation, scale)
