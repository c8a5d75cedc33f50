"""A corpus: the recordings of one actor, with what is known of the markers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from core.motion.recording import Recording


@dataclass(frozen=True)
class Corpus:
    """What a motion database is built from.

    name : shown to the user
    recordings : one a sentence, all with the same markers
    kept_markers : names of the markers to use, in order
    groups, landmarks : as in `core.motion.marker_set.MarkerSet`; the groups ``origin`` and ``rigid`` steer
        normalisation
    rest : shape (n_kept, 3), mm, the neutral pose if the corpus knows it; otherwise it is chosen from the recordings
    with_scale : the capture has no true scale (tracked video): estimate one a frame
    outer_eye_mm : with ``with_scale``, the distance of the outer eye corners that sets the millimetre
    synthetic : the motion was made by a program, and is called so wherever it is shown
    held_out : sentence names by split (``tune``, ``test``) that stay out of the database
    report : what was done to the recordings before; it travels with the database's own report
    """

    name: str
    recordings: Sequence[Recording]
    kept_markers: tuple[str, ...]
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    landmarks: Mapping[str, str] = field(default_factory=dict)
    rest: np.ndarray | None = None
    with_scale: bool = False
    outer_eye_mm: float | None = None
    synthetic: bool = False
    held_out: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    report: Mapping[str, object] = field(default_factory=dict)
