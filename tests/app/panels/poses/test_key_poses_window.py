"""A character is posed by mouse and keys; what is saved is what core reads, and what is cancelled leaves no trace."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QStyle, QStyleOptionSlider

from core.pipeline.gltf import write_glb
from core.rig.control_track import ControlTrack
from core.rig.key_poses import KeyPoses, load_key_poses
from tests.core.rig.small_rigs import small_rig

WAIT_MS = 20_000
_AS_LIT_SKIN = 120  # the empty studio is darker
_LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def poses_window(own_faces, open_window, qtbot, database_path, monkeypatch):
    """The window, with Ada to be posed and the tiny database open."""
    monkeypatch.setenv("EFASE_DATA_DIR", str(own_faces))
    main = open_window()
    main.authoring.open_database(database_path)
    qtbot.waitUntil(lambda: main.authoring.document.database is not None, timeout=WAIT_MS)
    main.actions.by_name["key_poses"].trigger()
    window = main.tools.key_poses
    qtbot.waitUntil(lambda: window.draft.posing.face is not None, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: window.jobs.is_idle)
    return window


@pytest.fixture
def found(poses_window, choose, tmp_path, qtbot):
    """The same, with three captured frames as key lip shapes, at rest, loaded from a file."""
    database, rig = poses_window.authoring.document.database, poses_window.draft.posing.face.rig
    lips = database.markers.group("lips")
    moved = database.pca.positions(database.frames[[10, 40, 70]].astype(float))[:, lips] - database.markers.rest[lips]
    names = tuple(database.markers.names[k] for k in lips)
    at_rest = np.zeros((3, len(rig.names)))
    KeyPoses("default", ("lips1", "lips2", "lips3"), names, moved, rig.names, at_rest).save(tmp_path / "rest.json")
    choose(tmp_path / "rest.json")
    click(poses_window.load_button)
    qtbot.waitUntil(lambda: bool(poses_window.draft.posing.keys), timeout=WAIT_MS)
    return poses_window


def click(widget):
    QTest.mouseClick(widget, _LEFT, pos=widget.rect().center())


def drag(slider, *values):
    """Take the slider's handle from one value to the next."""
    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    handle = slider.style().subControlRect(
        QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, slider
    )
    at, run = handle.center(), slider.width() - handle.width()
    QTest.mousePress(slider, _LEFT, pos=at)
    for value in values:
        QTest.mouseMove(slider, QPoint(handle.width() // 2 + round(value * run), at.y()))
    QTest.mouseRelease(slider, _LEFT, pos=QPoint(handle.width() // 2 + round(values[-1] * run), at.y()))


def vertices(window):
    posing = window.draft.posing
    return posing.face.pose(posing.poses.values[window.row])


def seen(window):
    """The picture of the posed face, its colours."""
    picture = window.posed.view.grabFramebuffer()
    return np.frombuffer(picture.constBits(), np.uint8).reshape(-1, 4)[:, :3].astype(int)


def test_a_drag_moves_the_jaw_and_is_one_step_of_undo(found, qtbot):
    qtbot.waitUntil(lambda: seen(found).max() > _AS_LIT_SKIN, timeout=WAIT_MS)  # its shaders are made one by one
    before, rest_picture = vertices(found), seen(found)
    drag(found.controls.sliders["jawOpen"], 0.3, 0.5, 0.8)
    value = found.draft.posing.poses.values[found.row][found.draft.posing.poses.controls.index("jawOpen")]
    assert value == pytest.approx(0.8, abs=0.03)
    rig = found.draft.posing.face.rig
    chin = rig.face.landmarks["chin"]
    moved = vertices(found) - before
    np.testing.assert_allclose(moved[chin], value * rig.shape("jawOpen")[chin], atol=0.05)
    assert np.linalg.norm(moved[chin]) > 5
    assert np.abs(seen(found) - rest_picture).mean() > 0.5
    steps = found.draft.undo_stack.index()
    QTest.keyClick(found, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert found.draft.undo_stack.index() == steps - 1
    np.testing.assert_array_equal(vertices(found), before)
    assert found.controls.sliders["jawOpen"].value() == 0
    np.testing.assert_array_equal(seen(found), rest_picture)
    click(found.redo_button)
    assert found.controls.sliders["jawOpen"].value() == round(100 * value)


def test_what_is_saved_is_what_core_reads_and_what_is_loaded_again(found, choose, tmp_path, qtbot):
    drag(found.controls.sliders["mouthFunnel"], 0.5)
    found.list.setCurrentRow(1)
    drag(found.controls.sliders["jawOpen"], 0.25)
    wanted = found.draft.posing.poses
    assert found.isWindowModified()
    choose(tmp_path / "mine")
    click(found.save_button)
    read = load_key_poses(tmp_path / "mine.json")
    assert not found.isWindowModified() and found.message.text == ""
    assert (read.rig, read.keys, read.controls, read.markers) == (
        "default", wanted.keys, wanted.controls, ("lip_up", "lip_low"),
    )  # fmt: skip
    np.testing.assert_allclose(read.values, wanted.values, atol=1e-6)
    np.testing.assert_allclose(read.lips_mm, wanted.lips_mm, atol=1e-4)
    assert np.count_nonzero(read.values, axis=1).tolist() == [1, 1, 0]
    click(found.reset_button)
    choose(tmp_path / "mine.json")
    QTest.keyClick(found, Qt.Key.Key_O, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: "mine.json" in found.status.note and found.jobs.is_idle, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: found.draft.posing.poses.values[1].any(), timeout=WAIT_MS)
    np.testing.assert_allclose(found.draft.posing.poses.values, wanted.values, atol=1e-6)
    assert all(frame is not None for frame in found.draft.posing.frames)


def test_shapes_are_found_in_the_captures(poses_window, qtbot):
    poses_window.count.setValue(3)
    click(poses_window.find_button)
    qtbot.waitUntil(lambda: bool(poses_window.draft.posing.keys), timeout=WAIT_MS)
    posing, database = poses_window.draft.posing, poses_window.authoring.document.database
    assert 2 <= len(posing.keys) <= 6 and poses_window.list.count() == len(posing.keys)
    lips = database.markers.group("lips")
    captured = database.pca.positions(database.frames.astype(float))[:, lips] - database.markers.rest[lips]
    for shape, frame in zip(posing.poses.lips_mm, posing.frames):
        assert np.abs(captured - shape).max(axis=(1, 2)).min() < 1e-6
        np.testing.assert_allclose(frame[lips], shape, atol=1e-4)
    click(poses_window.undo_button)
    assert poses_window.draft.posing.keys == ()


def test_a_search_that_is_cancelled_changes_nothing(found, qtbot):
    drag(found.controls.sliders["jawOpen"], 0.4)
    before, steps = found.draft.posing, found.draft.undo_stack.count()
    found.count.setValue(2)
    click(found.find_button)
    assert found.jobs.is_running("keys")
    click(found.status.cancel_button)
    assert found.jobs.is_idle
    qtbot.wait(800)  # a late answer would have come
    assert found.draft.posing is before and found.draft.undo_stack.count() == steps


def test_files_that_do_not_fit_are_one_sentence(found, choose, tmp_path, qtbot):
    choose(tmp_path / "other.json")
    click(found.save_button)
    other = (tmp_path / "other.json").read_text().replace('"default"', '"sheet.glb"').replace("jawOpen", "Jaw_01")
    (tmp_path / "other.json").write_text(other)
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "strange.json").write_text('{"format": "other"}')
    before = found.draft.posing
    for name, said in (("broken", "no JSON"), ("strange", "no poses"), ("other", "sheet.glb"), ("none", "none.json")):
        choose(tmp_path / f"{name}.json")
        click(found.load_button)
        qtbot.waitUntil(lambda name=name: f"{name}.json" in found.message.text, timeout=WAIT_MS)
        assert said in found.message.text
    (tmp_path / "no.glb").write_bytes(b"nothing")
    choose(tmp_path / "no.glb")
    QTest.keyClick(found.posed.characters, Qt.Key.Key_End)
    qtbot.waitUntil(lambda: "no.glb" in found.message.text, timeout=WAIT_MS)
    assert found.draft.posing is before and found.posed.characters.currentText() == "Ada"


def test_controls_are_found_by_their_names_and_moved_by_keys(found):
    QTest.keyClicks(found.controls.search, "smile left")
    assert found.controls.visible_names == ("mouthSmileLeft",)
    slider = found.controls.sliders["mouthSmileLeft"]
    QTest.keyClick(slider, Qt.Key.Key_Right)
    QTest.keyClick(slider, Qt.Key.Key_PageUp)
    assert found.draft.posing.poses.values[found.row].sum() == pytest.approx(0.11)
    found.controls.search.clear()
    click(found.controls.used)
    assert found.controls.visible_names == ("mouthSmileLeft",)


def test_shapes_are_named_removed_and_brought_back(found, qtbot):
    keys = found.draft.posing.keys
    found.list.setFocus()
    found.list.setCurrentRow(1)
    QTest.keyClick(found.list, Qt.Key.Key_F2)
    editor = found.list.findChild(QLineEdit)
    QTest.keyClicks(editor, "aa")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: found.draft.posing.keys == (keys[0], "aa", *keys[2:]))
    click(found.remove_button)
    assert found.draft.posing.keys == (keys[0], *keys[2:])
    assert len(found.draft.posing.poses.lips_mm) == len(found.draft.posing.frames) == len(keys) - 1
    click(found.undo_button)
    assert found.draft.posing.keys == (keys[0], "aa", *keys[2:]) and found.row == 1


def test_a_rig_of_ones_own_takes_over_controls_by_name(found, choose, tmp_path, qtbot):
    drag(found.controls.sliders["jawOpen"], 0.5)
    value = found.controls.sliders["jawOpen"].value() / 100
    rig = small_rig(names=("Jaw_Open", "Ooh"))
    write_glb(rig, ControlTrack(rig.names, np.zeros((2, 2)), 30.0), tmp_path / "sheet.glb")
    choose(tmp_path / "sheet.glb")
    box = found.posed.characters
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_End)
    qtbot.waitUntil(lambda: found.draft.posing.face.face.name == "sheet.glb", timeout=WAIT_MS)
    assert tuple(found.controls.sliders) == ("Jaw_Open", "Ooh") and box.currentText() == "sheet.glb"
    np.testing.assert_allclose(found.draft.posing.poses.values[found.row], [value, 0.0])
    drag(found.controls.sliders["Ooh"], 1.0)
    flat = vertices(found) - found.draft.posing.face.face.positions
    np.testing.assert_allclose(flat, value * rig.deltas[0] + rig.deltas[1], atol=1e-3)
    click(found.undo_button)
    click(found.undo_button)
    assert found.draft.posing.face.face.name == "default" and box.currentText() == "Ada"


def test_without_database_or_motion_a_sentence_says_so(poses_window):
    click(poses_window.add_button)
    assert "no motion" in poses_window.message.text
    poses_window.draft.find(None, 7)
    assert "no database" in poses_window.message.text
    assert poses_window.draft.posing.keys == ()


def test_the_frame_at_the_playhead_becomes_a_shape(animated, qtbot, monkeypatch):
    from app.panels.poses import work
    from core.face.default_face import FaceUnavailable

    def none_here(_progress):
        raise FaceUnavailable("a test")

    rig = small_rig()
    monkeypatch.setattr(work, "default_face", none_here)
    monkeypatch.setattr(work, "load_rig", lambda _name, _progress: rig)
    animated.actions.by_name["key_poses"].trigger()
    window, motion = animated.tools.key_poses, animated.authoring.document.motion
    qtbot.waitUntil(lambda: window.draft.posing.face is not None, timeout=WAIT_MS)
    lips = motion.markers.group("lips")
    for frame in (12, 30):
        animated.authoring.seek(frame / motion.rate_hz)
        click(window.add_button)
        qtbot.waitUntil(lambda: window.jobs.is_idle, timeout=WAIT_MS)
        np.testing.assert_allclose(window.draft.posing.poses.lips_mm[-1], motion.displacements[frame, lips])
    assert window.draft.posing.keys == ("lips1", "lips2") and window.row == 1
    assert "rest" in window.status.note  # no face to guess with


def test_the_main_window_asks_before_it_loses_poses(found, monkeypatch):
    main, asked, answers = found.parent(), [], [False, True]

    def gives_up(what):
        asked.append(what)
        return answers.pop(0)

    monkeypatch.setattr(main, "_gives_up", gives_up)
    drag(found.controls.sliders["jawOpen"], 0.3, 0.5)
    assert not main.close() and main.isVisible() and found.draft.posing.keys
    assert main.close() and not main.isVisible()
    assert len(asked) == 2 and all("lip shapes are not saved" in what for what in asked)


def test_poses_as_they_were_saved_close_without_a_word(found, monkeypatch):
    main = found.parent()
    monkeypatch.setattr(main, "_gives_up", lambda what: pytest.fail(what))
    assert main.close()
