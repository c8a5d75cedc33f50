"""Which control of one set means which of another: ARKit's names in the spellings of other programs."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

_ENDS_IN_SIDE = re.compile(r"^(.+?)(Left|Right|_[lLrR]|_[lL]eft|_[rR]ight)$")


def control_mixing(given: Sequence[str], wanted: Sequence[str]) -> np.ndarray:
    """Return how much of each given control each wanted one takes; float32, shape (n_given, n_wanted).

    The same name comes first; then the same name in another spelling: capitals (Live Link Face's ``JawOpen``), the
    side as ``_L`` or ``Left``, what a program puts before a dot or colon (``blendShape1.jawOpen``). A control for one
    side takes the one for both (ARKit's ``browInnerUp`` moves ICT-FaceKit's ``browInnerUp_L`` and ``browInnerUp_R``),
    and one for both takes the mean of the two sides.
    """
    mixing = np.zeros((len(given), len(wanted)), np.float32)
    row = {name: g for g, name in enumerate(given)}
    by_key: dict[tuple[str, str], int] = {}
    for g, name in enumerate(given):
        by_key.setdefault(_key(name), g)
    for w, name in enumerate(wanted):
        stem, side = _key(name)
        if name in row:
            mixing[row[name], w] = 1.0
        elif (stem, side) in by_key:
            mixing[by_key[stem, side], w] = 1.0
        elif side and (stem, "") in by_key:
            mixing[by_key[stem, ""], w] = 1.0
        elif not side:
            for other in ("l", "r"):
                if (stem, other) in by_key:
                    mixing[by_key[stem, other], w] = 0.5
    return mixing


def _key(name: str) -> tuple[str, str]:
    """Stem in small letters and digits, and side: ``l``, ``r`` or nothing."""
    own = re.split(r"[.:|]", name)[-1] or name
    found = _ENDS_IN_SIDE.match(own)
    stem, side = (found[1], found[2].strip("_")[0].lower()) if found else (own, "")
    return re.sub(r"[\W_]", "", stem.lower()), side
