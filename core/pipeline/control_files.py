"""Which file of controls a name asks for, and the writing of it."""

from __future__ import annotations

from pathlib import Path

from core.motion.live_link_face import write_live_link_face
from core.pipeline.blendshapes import arkit_weights
from core.pipeline.curves import write_curves_csv, write_curves_json
from core.pipeline.gltf import write_glb
from core.pipeline.usd import SUFFIXES as _USD
from core.pipeline.usd import check_usd, write_usd
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig, fitted

LIVE_LINK = ".livelink.csv"
_POINTS = tuple(f".points{suffix}" for suffix in _USD)
# the longer before the shorter
SUFFIXES = (LIVE_LINK, ".curves.csv", ".curves.json", *_POINTS, ".json", ".glb", *_USD)


def control_suffix(path: Path, plain_csv: bool = False) -> str | None:
    """Return which of `SUFFIXES` the name of ``path`` ends in, or None.

    plain_csv : a bare ``.csv`` is Live Link Face's
    """
    name = path.name.lower()
    found = next((suffix for suffix in SUFFIXES if name.endswith(suffix)), None)
    return LIVE_LINK if found is None and plain_csv and name.endswith(".csv") else found


def needs_rig(suffix: str) -> bool:
    """Whether a file holds the face that moves, and not only what moves it."""
    return suffix in (".glb", *_USD, *_POINTS)


def check_control_suffix(suffix: str) -> None:
    """Raise `UserFacingError`, before any work goes into it, for a file that this machine cannot write."""
    if suffix in (*_USD, *_POINTS):
        check_usd()


def write_controls(path: Path, suffix: str, track: ControlTrack, rig: Rig | None = None) -> tuple[str, ...]:
    """Write ``track`` as ``suffix`` says, at its rate; return sentences to warn with.

    rig : what moves in .glb and USD; controls are matched with it by name
    """
    if suffix == LIVE_LINK:
        weights, warnings = arkit_weights(track)
        write_live_link_face(path, weights)
        return warnings
    if suffix == ".curves.csv":
        write_curves_csv(path, track)
        return ()
    if suffix in (".curves.json", ".json"):
        write_curves_json(path, track)
        return ()
    own, warnings = fitted(rig, track)
    if suffix == ".glb":
        write_glb(rig, own, path)
    else:
        write_usd(rig, own, path, as_points=suffix in _POINTS)
    return warnings
