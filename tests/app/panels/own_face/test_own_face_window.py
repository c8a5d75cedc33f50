"""A scan is opened, clicked and fitted by mouse and keys; what is saved is a face that the main window shows."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from core.document.parts import FaceChoice
from core.face import own_face_closing
from core.face.default_face import character_face
from core.face.face import PARTS
from core.face.face_file import read_face
from core.face.own_face_points import feature_points, generic_points, load_points

WAIT_MS = 30_000
_LEFT = Qt.MouseButton.LeftButton
WIDER = np.array([1.08, 1.0, 1.0])
IN_FRONT = ("outer_eye_right", "inner_eye_right", "inner_eye_left", "outer_eye_left", "nose_tip", "nose_bridge",
            "mouth_corner_right", "mouth_corner_left", "chin", "lower_lip_bottom", "upper_lip_top")  # fmt: skip


@pytest.fixture(scope="module")
def scanned(own_faces, tmp_path_factory):
    """A scan as a file, and where the points are on it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EFASE_DATA_DIR", str(own_faces))
        face = character_face("default", download=False)
    skin = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    path = tmp_path_factory.mktemp("scan") / "someone.ply"
    trimesh.Trimesh(face.positions * WIDER / 10, skin, process=False).export(path)
    return path, {key: place * WIDER / 10 for key, place in generic_points(face).items()}


@pytest.fixture
def window(own_faces, scanned, open_window, choose, qtbot, monkeypatch):
    """The window, with Ada as the generic face and the scan open."""
    monkeypatch.setenv("EFASE_DATA_DIR", str(own_faces))
    monkeypatch.setattr(own_face_closing, "REACH_MM", (60.0, 20.0, 8.0))
    main = open_window()
    main.actions.by_name["own_face"].trigger()
    made = main.tools.own_face
    qtbot.waitUntil(lambda: made.draft.generic is not None, timeout=WAIT_MS)
    choose(scanned[0])
    click(made.scan_pane.open_button)
    qtbot.waitUntil(lambda: made.draft.scan is not None, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: made.jobs.is_idle)
    return made


def click(widget):
    QTest.mouseClick(widget, _LEFT, pos=widget.rect().center())


def click_point(window, scanned, key):
    window.guide.choose(key)
    view = window.scan_pane.view
    shown = window.draft.scan.shown.shown(scanned[1][key][None])
    QTest.mouseClick(view, _LEFT, pos=QPoint(*(round(x) for x in view.on_screen(shown)[0])))


def test_clicks_set_points_where_they_fall_and_the_list_goes_on(window, scanned):
    assert window.guide.key == feature_points()[0].key
    assert not window.fit_button.isEnabled()
    px_mm = 300.0 / window.scan_pane.view.height()  # about; in the scan's own cm below
    for key in IN_FRONT:
        click_point(window, scanned, key)
        assert window.guide.key != key
        off = np.linalg.norm(window.draft.points.on_scan[key] - scanned[1][key])
        assert off < 0.1 * 2.0 * px_mm * 2
    assert window.fit_button.isEnabled()
    assert window.guide.count.text() == f"{len(IN_FRONT)} of {len(feature_points())}"

    # a drag turns the scan and sets nothing, nor does a click beside the head
    view = window.scan_pane.view
    before, points = view.camera, window.draft.points
    middle = view.rect().center()
    QTest.mousePress(view, _LEFT, pos=middle)
    QTest.mouseMove(view, middle + QPoint(60, 0))
    QTest.mouseRelease(view, _LEFT, pos=middle + QPoint(60, 0))
    assert view.camera.azimuth_deg != before.azimuth_deg
    QTest.mouseClick(view, _LEFT, pos=QPoint(2, 2))
    assert window.draft.points is points


def test_undo_redo_remove_skip_and_where_the_next_point_is_expected(window, scanned):
    for key in IN_FRONT[:3]:
        click_point(window, scanned, key)
    QTest.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert set(window.draft.points.on_scan) == set(IN_FRONT[:2])
    click(window.guide.redo_button)
    assert set(window.draft.points.on_scan) == set(IN_FRONT[:3])
    window.guide.choose(IN_FRONT[1])
    click(window.guide.remove_button)
    assert set(window.draft.points.on_scan) == {IN_FRONT[0], IN_FRONT[2]}
    window.guide.choose("outer_eye_left")
    click(window.guide.skip_button)
    assert window.guide.key == "upper_lid_left"
    click(window.guide.undo_button)
    assert IN_FRONT[1] in window.draft.points.on_scan

    # after a few points the next one is expected somewhere
    assert window.draft.guess("chin") is None
    for key in ("outer_eye_right", "outer_eye_left", "nose_tip", "mouth_corner_right", "mouth_corner_left"):
        click_point(window, scanned, key)
    guess = window.draft.guess("chin")
    assert np.linalg.norm(guess - scanned[1]["chin"]) < 1.0  # cm


def test_points_move_on_the_generic_face_and_stay_on_a_scan_that_is_turned(window, scanned, qtbot):
    window.guide.choose("brow_left")
    view = window.face_pane.view
    goal = window.draft.generic_places["brow_left"] + [6.0, 0, 0]
    QTest.mouseClick(view, _LEFT, pos=QPoint(*(round(x) for x in view.on_screen(goal[None])[0])))
    moved = window.draft.generic_places["brow_left"]
    assert np.linalg.norm((moved - goal)[:2]) < 1.0
    click(window.guide.undo_button)
    assert not window.draft.points.moved

    # turned a quarter, points stay where they are on the scan
    click_point(window, scanned, "nose_tip")
    place = window.draft.points.on_scan["nose_tip"].copy()
    before = window.draft.scan
    click(window.scan_pane.round_button)
    qtbot.waitUntil(lambda: window.draft.scan is not before, timeout=WAIT_MS)
    np.testing.assert_array_equal(window.draft.points.on_scan["nose_tip"], place)
    shown = [scan.shown.shown(place[None])[0] for scan in (before, window.draft.scan)]
    np.testing.assert_allclose(shown[1], [shown[0][2], shown[0][1], -shown[0][0]], atol=0.01)


def test_fit_look_save_and_use(window, scanned, choose, tmp_path, qtbot):
    for key in IN_FRONT:
        click_point(window, scanned, key)
    choose(tmp_path / "clicked")
    click(window.guide.save_button)
    assert set(load_points(tmp_path / "clicked.json").points) == set(IN_FRONT)
    click(window.fit_button)
    qtbot.waitUntil(lambda: window.draft.fitted is not None, timeout=WAIT_MS)
    pane = window.face_pane
    assert pane.shown.key == "fitted"
    assert "median" in pane.distance.whole_text
    assert window.draft.fitted.own.closed.median < 0.5
    assert window.has_unsaved_face and window.isWindowModified()
    rest = pane.view._rig.pose(np.zeros(len(window.draft.fitted.shown.rig.names)))
    pane.strength.setValue(100)
    chin = window.draft.fitted.face.landmarks["chin"]
    assert np.linalg.norm(pane.view._rig.pose(pane.view._displacements)[chin] - rest[chin]) > 5
    pane.shown.choose("distance")
    assert pane.view._rig is window.draft.fitted.distance
    pane.shown.choose("generic")
    assert pane.on_generic

    choose(tmp_path / "mine")
    QTest.keyClick(window, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: window.draft.saved_path is not None, timeout=WAIT_MS)
    assert not window.has_unsaved_face
    assert read_face(tmp_path / "mine.npz").name == "mine"
    click(window.use_button)
    document = window.authoring.document
    qtbot.waitUntil(lambda: document.face == FaceChoice(str(tmp_path / "mine.npz")), timeout=WAIT_MS)


def test_what_is_cancelled_or_bad_leaves_all_as_it_was(window, scanned, choose, tmp_path, qtbot):
    for key in IN_FRONT:
        click_point(window, scanned, key)
    QTest.keyClick(window, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    assert window.jobs.is_running("fit")
    click(window.status.cancel_button)
    qtbot.waitUntil(lambda: window.jobs.is_idle)
    assert window.draft.fitted is None
    assert window.face_pane.on_generic

    before = window.draft.scan
    for name, content, words in (("empty.obj", b"", "holds no triangles"), ("bad.stl", b"solid", "bad.stl")):
        (tmp_path / name).write_bytes(content)
        choose(tmp_path / name)
        click(window.scan_pane.open_button)
        qtbot.waitUntil(lambda words=words: words in window.message.text, timeout=WAIT_MS)
    assert window.draft.scan is before
    (tmp_path / "points.json").write_text("{}")
    choose(tmp_path / "points.json")
    click(window.guide.load_button)
    qtbot.waitUntil(lambda: "no feature points" in window.message.text, timeout=WAIT_MS)


def test_points_on_a_photo(window, choose, tmp_path, qtbot):
    import cv2

    cv2.imwrite(str(tmp_path / "photo.png"), np.full((200, 100, 3), 80, np.uint8))
    choose(tmp_path / "photo.png")
    click(window.scan_pane.photo_button)
    qtbot.waitUntil(lambda: window.draft.photo is not None, timeout=WAIT_MS)
    view = window.scan_pane.photo_view
    qtbot.waitUntil(lambda: view.isVisible() and view.width() > 200)
    window.guide.choose("nose_tip")
    at = view.on_screen(np.array([[60.0, 120.0]]))[0]
    QTest.mouseClick(view, _LEFT, pos=QPoint(round(at[0]), round(at[1])))
    np.testing.assert_allclose(window.draft.points.on_photo["nose_tip"], [60, 120], atol=0.5)
    assert not window.draft.points.on_scan
    QTest.mouseClick(view, _LEFT, pos=QPoint(3, 3))  # beside the photo
    assert len(window.draft.points.on_photo) == 1
