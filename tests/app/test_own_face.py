"""`efase fit-face` as a user meets it: its own face as the scan, a centimetre longer."""

import json
import re
from functools import partial

import numpy as np
import pytest
import trimesh

import app.own_face
from core.face import own_face_closing
from core.face.default_face import character_face
from core.face.face import PARTS
from core.face.face_file import read_face
from core.face.own_face import painted
from core.face.own_face_points import PointFile, feature_points, generic_points, save_points

LONGER = np.array([1.0, 1.1, 1.0])


@pytest.fixture
def face(own_faces, monkeypatch):
    monkeypatch.setenv("EFASE_DATA_DIR", str(own_faces))
    monkeypatch.setattr(own_face_closing, "REACH_MM", (60.0, 20.0, 8.0))
    monkeypatch.setattr(app.own_face, "painted", partial(painted, size_px=96))
    return character_face("default", download=False)


@pytest.fixture
def files(face, tmp_path):
    """A scan with a colour on every vertex, and points by their vertices where they are one."""
    skin = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    colours = np.tile(np.array([150, 100, 80], np.uint8), (len(face.positions), 1))
    mesh = trimesh.Trimesh(face.positions * LONGER, skin, vertex_colors=colours, process=False)
    mesh.export(tmp_path / "scan.ply")
    points = {key: place * LONGER for key, place in generic_points(face).items()}
    vertices = {point.key: point.vertices[0] for point in feature_points() if len(point.vertices) == 1}
    photo = {key: place[:2] * [1, -1] * 2 + 300 for key, place in points.items()}
    save_points(tmp_path / "points.json", PointFile({"lips_meet": points["lips_meet"]}, vertices, photo=photo))
    return tmp_path / "scan.ply", tmp_path / "points.json"


def test_a_face_file_of_a_scan_and_its_points(efase, face, files, tmp_path):
    scan, points = files
    code, out, err = efase("fit-face", scan, "--points", points, "--out", tmp_path / "mine.npz", "--json")
    assert (code, err) == (0, "")
    answer = json.loads(out)
    assert answer["points"] == len(feature_points())
    assert answer["remaining"]["median_mm"] < 0.3
    assert answer["textured"]
    made = read_face(tmp_path / "mine.npz")
    assert made.name == "mine"
    assert np.abs(made.texture.astype(int) - [150, 100, 80]).max() <= 1
    height = [np.ptp(f.positions[f.vertices_of("skin"), 1]) for f in (face, made)]
    assert height[1] == pytest.approx(1.1 * height[0], rel=0.01)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("missing.obj", "--points", "{points}", "--out", "{out}"), "missing.obj cannot be read"),
        (("{scan}", "--points", "missing.json", "--out", "{out}"), "missing.json cannot be read"),
        (("{scan}", "--points", "{points}", "--out", "{folder}/face.obj"), "not a name for a face file"),
        (("{scan}", "--points", "{points}", "--out", "{folder}/none/face.npz"), "no folder"),
        (("{scan}", "--points", "{points}", "--out", "{out}", "--generic", "zoe"), "no character 'zoe'"),
        (
            ("{scan}", "--points", "{points}", "--out", "{out}", "--texture", "{points}"),
            "not a readable picture|no texture",
        ),
        (("{scan}", "--points", "{points}", "--out", "{out}", "--photo", "{points}"), "not a readable picture"),
    ],
)
def test_a_wrong_request_is_one_sentence_and_leaves_no_file(efase, files, tmp_path, words, message):
    scan, points = files
    known = {"scan": scan, "points": points, "out": tmp_path / "mine.npz", "folder": tmp_path}
    code, out, err = efase("fit-face", *(word.format(**known) for word in words))
    assert code == 2
    assert re.search(message, err)
    assert "Traceback" not in err
    assert out == ""
    assert not list(tmp_path.glob("*.npz"))
