"""Guess what the pieces of a user's mesh are, from the names of its objects, groups and materials."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from core.face.face import PARTS
from core.face.geodesic import components, seam_partners
from core.face.mesh_readers import RawMesh

# Tried in this order; the first word found in a name decides. "" leaves the piece to the rules of attachments.py.
WORDS = (
    ("lash", "lashes"),
    ("brow|lacrimal|tear|occlusion|blend|gum|hair", ""),
    ("socket|mouth.?(inner|interior|inside|cavity|bag)|inner.?mouth", "mouth_socket"),
    ("tongue", "tongue"),
    ("teeth|tooth|denture", "teeth"),
    ("sclera|iris|pupil|cornea|eye", "eye"),
    ("skin|face|head|body|neck", "skin"),
)


def guess_parts(mesh: RawMesh, landmarks: Mapping[str, int]) -> np.ndarray:
    """Return the part of every vertex; uint8, shape (V,), index into `PARTS`.

    Names decide first. Of what they leave open, the pieces that carry a landmark are skin (the largest piece, when
    nothing else is), and the rest is ``other``. Left is where x is positive; teeth are upper or lower by their name,
    else by the side of the mouth corners they lie on; lashes by the side of the middle of all lashes.
    """
    part = np.full(len(mesh.positions), PARTS.index("other"), np.uint8)
    kinds = [_kind(label) for label in mesh.labels]
    welded = seam_partners(mesh.positions, mesh.triangles)
    piece = components(len(mesh.positions), welded[mesh.triangles])[welded]
    kind_of_vertex = np.full(len(part), "", dtype="U24")
    for label, kind in enumerate(kinds):
        kind_of_vertex[mesh.triangles[mesh.label_of_triangle == label]] = kind
    for kind in ("skin", "mouth_socket", "tongue", "upper_teeth", "lower_teeth"):
        part[kind_of_vertex == kind] = PARTS.index(kind)
    _split_eyes(mesh, kind_of_vertex, part)
    _split_lashes(mesh, kind_of_vertex, part)
    _split_teeth(mesh, kind_of_vertex, piece, part, landmarks)
    unnamed = kind_of_vertex == ""
    marked = np.isin(piece, piece[list(landmarks.values())])
    part[unnamed & marked] = PARTS.index("skin")
    if not (part == PARTS.index("skin")).any():
        part[piece == np.bincount(piece[np.unique(mesh.triangles)]).argmax()] = PARTS.index("skin")
    return part


def _kind(label: str) -> str:
    name = label.lower()
    for words, kind in WORDS:
        if re.search(words, name):
            if kind == "teeth" and re.search("upper|top", name):
                return "upper_teeth"
            if kind == "teeth" and re.search("lower|bottom", name):
                return "lower_teeth"
            return kind
    return ""


def _split_eyes(mesh: RawMesh, kind: np.ndarray, part: np.ndarray) -> None:
    left = mesh.positions[:, 0] > 0
    part[(kind == "eye") & left] = PARTS.index("eye_left")
    part[(kind == "eye") & ~left] = PARTS.index("eye_right")


def _split_lashes(mesh: RawMesh, kind: np.ndarray, part: np.ndarray) -> None:
    lashes = np.flatnonzero(kind == "lashes")
    if len(lashes) == 0:
        return
    middle = mesh.positions[lashes, 1].mean()
    piece = components(len(part), mesh.triangles)  # not welded: strips of lashes touch each other
    for number in np.unique(piece[lashes]):
        strip = lashes[piece[lashes] == number]
        across, up, _ = mesh.positions[strip].mean(axis=0)
        name = f"lashes_{'upper' if up > middle else 'lower'}_{'left' if across > 0 else 'right'}"
        part[strip] = PARTS.index(name)


def _split_teeth(
    mesh: RawMesh, kind: np.ndarray, piece: np.ndarray, part: np.ndarray, landmarks: Mapping[str, int]
) -> None:
    corners = [landmarks.get(name) for name in ("mouth_corner_left", "mouth_corner_right")]
    if None in corners:
        return
    mouth_line = mesh.positions[corners, 1].mean()
    teeth = np.flatnonzero(kind == "teeth")
    for number in np.unique(piece[teeth]):
        tooth = teeth[piece[teeth] == number]
        upper = mesh.positions[tooth, 1].mean() > mouth_line
        part[tooth] = PARTS.index("upper_teeth" if upper else "lower_teeth")
