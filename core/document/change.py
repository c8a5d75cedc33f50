"""What changed in a document; views pick what concerns them."""

from __future__ import annotations

from enum import Flag, auto


class Change(Flag):
    """Parts of a document.

    SPEECH : another sound (ALIGNMENT comes with it); ALIGNMENT : what is said, and when
    NODES, CLUSTERS : another database; CURATION : which of its motion nodes are removed
    CONSTRAINTS : pins and locks
    ENGINE : which engine makes the motion; WEIGHTS : of the search
    OUTPUT : frame rate, first frame, head motion
    CONTROLS : the artist's layer over the control curves; POLISH : the layer over the motion
    PATH : what the search found; PRICES : what alternatives to it would cost
    MOTION : the motion on show, both layers included; it comes with PATH
    """

    SPEECH = auto()
    ALIGNMENT = auto()
    NODES = auto()
    CLUSTERS = auto()
    CURATION = auto()
    CONSTRAINTS = auto()
    EMOTIONS = auto()
    ENGINE = auto()
    WEIGHTS = auto()
    FACE = auto()
    REFERENCE_VIDEO = auto()
    OUTPUT = auto()
    CONTROLS = auto()
    POLISH = auto()
    PATH = auto()
    MOTION = auto()
    PRICES = auto()


NOTHING = Change(0)

# Everything that hangs on what the search found.
ANSWER = Change.PATH | Change.MOTION | Change.PRICES

# Whatever of this changes, the path that is shown is no longer the best one.
ASKED_OF_THE_SEARCH = (
    Change.ALIGNMENT
    | Change.NODES
    | Change.CURATION
    | Change.CONSTRAINTS
    | Change.EMOTIONS
    | Change.ENGINE
    | Change.WEIGHTS
)
