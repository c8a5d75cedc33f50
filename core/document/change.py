"""What changed in a document; views pick what concerns them."""

from __future__ import annotations

from enum import Flag, auto


class Change(Flag):
    """Parts of a document."""

    ALIGNMENT = auto()
    NODES = auto()
    CLUSTERS = auto()
    CONSTRAINTS = auto()
    EMOTIONS = auto()
    FACE = auto()
    PATH = auto()


NOTHING = Change(0)

# Whatever of this changes, the path that is shown is no longer the best one.
ASKED_OF_THE_SEARCH = Change.ALIGNMENT | Change.NODES | Change.CONSTRAINTS | Change.EMOTIONS
