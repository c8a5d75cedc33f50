"""Motion units of a motion database: its frames by emotion as deformations of the neutral face."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from core.errors import UserFacingError
from core.iface.motion_unit import NEUTRAL, PAPER_UTTERANCE, MotionUnits
from core.motion.database import MotionDatabase
from core.speech.emotion import EMOTIONS

RATE_HZ = 30.0  # of the paper's video


def spoken_deformations(
    database: MotionDatabase, removed: Collection[str] = (), rate_hz: float = RATE_HZ
) -> dict[str, np.ndarray]:
    """Return what speech does to the face: emotion to float64, shape (n_frames, n_markers, 3), mm from rest.

    The frames of all motion nodes, thinned out to ``rate_hz`` or the nearest rate above that leaves out whole frames.
    Global motion is out already, for a database holds head space; so are silences and frames with lost markers, which
    make no motion node, and nodes in ``removed`` (public names). Emotions without frames are left out.
    """
    stays = nodes_that_count(database, removed)
    step = max(1, int(database.rate_hz / rate_hz + 1e-6))
    moved = {}
    for e, emotion in enumerate(EMOTIONS):
        chosen = stays & (database.nodes.emotion == e)
        # by the place in the file, so that a thinner choice of nodes thins the same frames
        frames = [
            np.arange(start, stop) for start, stop in zip(database.nodes.start[chosen], database.nodes.stop[chosen])
        ]
        rows = np.concatenate(frames) if frames else np.zeros(0, int)
        rows = rows[rows % step == 0]
        if len(rows):
            moved[emotion] = database.pca.positions(database.frames[rows].astype(float)) - database.markers.rest
    return moved


def nodes_that_count(database: MotionDatabase, removed: Collection[str]) -> np.ndarray:
    """Return which motion nodes are not in ``removed`` (public names); bool, shape (n_nodes,)."""
    return np.array([not removed or database.nodes.name(n) not in removed for n in range(len(database.nodes))], bool)


def units_of_database(
    database: MotionDatabase, n_utterance: int | float = PAPER_UTTERANCE, n_expression: int | float = 2,
    removed: Collection[str] = (),
) -> MotionUnits:  # fmt: skip
    """Learn motion units from what `spoken_deformations` returns; see `MotionUnits.fit` for the counts.

    Raises `UserFacingError` for a database without neutral speech.
    """
    moved = spoken_deformations(database, removed)
    if NEUTRAL not in moved:
        raise UserFacingError(
            f"The database '{database.name}' has no neutral speech, which utterance motion units are learned from."
        )
    few = [emotion for emotion, frames in moved.items() if len(frames) < 2 and emotion != NEUTRAL]
    return MotionUnits.fit({e: f for e, f in moved.items() if e not in few}, n_utterance, n_expression)
