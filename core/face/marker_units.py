"""How every blendshape unit moves every marker: all that a demo corpus needs to know of the default face."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.face.face import Face
from core.face.face_file import read_arrays, write_arrays
from core.face.marker_placement import ACTRESS_FILE, MarkerPlacement, load_marker_file, marker_set_on
from core.motion.marker_set import MarkerSet

MARKER_UNITS_FILE = Path(__file__).resolve().parents[2] / "resources" / "demo" / "marker_units.npz"


@dataclass(frozen=True)
class MarkerUnits:
    """The 52 ARKit units as seen by the actress's 102 markers.

    markers : names, groups, landmarks and rest (102, 3), mm from the origin marker
    kept : bool, shape (102,); the 90 that are used
    names : of the units
    moves : float32, shape (n_units, 102, 3), millimetres at full strength, head space
    """

    markers: MarkerSet
    kept: np.ndarray
    names: tuple[str, ...]
    moves: np.ndarray


def marker_units_of(face: Face, placement: MarkerPlacement) -> MarkerUnits:
    """Sample the units of ``face`` at its markers."""
    names = tuple(face.units)
    moves = np.array([face.units[name][placement.vertices] for name in names], np.float32)
    return MarkerUnits(marker_set_on(face, placement, kept_only=False), placement.kept, names, moves)


def write_marker_units(face: Face, path: Path = MARKER_UNITS_FILE) -> None:
    """Make the bundled file anew from the default face (CC0); ``python -m core.face.marker_units`` runs this."""
    units = marker_units_of(face, load_marker_file(ACTRESS_FILE))
    write_arrays(
        path,
        marker_names=np.array(units.markers.names),
        rest=units.markers.rest.astype(np.float32),
        unit_names=np.array(units.names),
        moves=units.moves,
        credit=np.str_(face.credit),
    )


def load_marker_units(path: Path = MARKER_UNITS_FILE) -> MarkerUnits:
    """Read the bundled file; needs no face and no network."""
    placement = load_marker_file(ACTRESS_FILE)
    data = read_arrays(path)
    names = tuple(data["marker_names"].tolist())
    markers = MarkerSet(names, data["rest"], placement.groups, placement.landmarks)
    return MarkerUnits(markers, placement.kept, tuple(data["unit_names"].tolist()), data["moves"])


if __name__ == "__main__":
    from core.face.default_face import default_face

    write_marker_units(default_face())
