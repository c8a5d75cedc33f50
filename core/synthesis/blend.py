"""One motion out of several that say the same: their mean, weighted by how good each is.

A concatenated capture differs from the truth by its own chance as well as the truth's, about √2 of what an average
does; the mean over near-optimal paths loses most of its own. Not in Deng and Neumann (2008).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.motion.marker_set import MarkerSet


def blend_shares(costs: Sequence[float], temperature: float) -> np.ndarray:
    """``exp(-(cost - least) / temperature)``, scaled to sum to 1; float64, shape (n_paths,).

    temperature : in the unit of the costs; 0 gives all to the least, equally where several are
    """
    extra = np.asarray(costs, float) - np.min(costs)
    shares = np.exp(-extra / temperature) if temperature > 0 else (extra == 0).astype(float)
    return shares / shares.sum()


def blended(positions: Sequence[np.ndarray], shares: np.ndarray, share_of_marker: np.ndarray) -> np.ndarray:
    """Mean of several motions where a marker asks for it, and the first motion where it does not.

    positions : each shape (n_frames, n_markers, 3); the first is that of the best path
    share_of_marker : shape (n_markers,), 0..1, see `spoken_share`
    """
    mean = sum(share * motion for share, motion in zip(shares, positions))
    return positions[0] + share_of_marker[:, None] * (mean - positions[0])


def spoken_share(markers: MarkerSet) -> np.ndarray:
    """How much each marker belongs to speech: 1 from the tip of the nose down, 0 from the eyes up, linear between.

    Blinks and brows are not told by the phones: their mean over several captures is a face that never blinks. Markers
    without these landmarks are all blended. float64, shape (n_markers,)
    """
    rows = [markers.landmark(name) for name in ("nose_tip", "inner_eye_left", "inner_eye_right")]
    if None in rows:
        return np.ones(len(markers))
    tip, *eyes = (markers.rest[row, 1] for row in rows)
    below_eyes = np.mean(eyes) - markers.rest[:, 1]
    return np.clip(below_eyes / max(np.mean(eyes) - tip, 1e-9), 0.0, 1.0)
