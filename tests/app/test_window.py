"""The animator's way through the window, with real mouse and key events."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 20_000


def idle(window):
    return lambda: window.authoring.jobs.is_idle


def click(widget, point=None):
    QTest.mouseClick(widget, LEFT, pos=widget.rect().center() if point is None else point)


def phoneme_point(window, slot):
    """Where the box of a slot is in the timeline."""
    utterance = window.authoring.document.speech.transcript.phonemes[slot]
    lane = window.timeline.lanes()["phonemes"]
    x = window.timeline.scale.x((utterance.start_s + utterance.end_s) / 2)
    return QPoint(round(x), round(lane.center().y()))


def map_point(window, at):
    """Where a place of the map is on its canvas."""
    scene = window.isomap.box.mapViewToScene(QPointF(*map(float, at)))
    return window.isomap.canvas.mapFromScene(scene)


def test_every_pane_says_what_to_do_next_until_it_has_something_to_show(open_window):
    window = open_window()
    for pane in (window.motion, window.video, window.isomap, window.preview):
        assert pane.is_empty
        assert pane.empty_text.endswith(".")
    assert not window.control.synthesise_button.isEnabled()


def test_a_synthesis_can_be_browsed_frame_by_frame(animated, qtbot):
    view = animated.authoring.view
    QTest.keyClick(animated, Qt.Key.Key_Home)
    assert view.playhead_s == 0.0
    seen = []
    for _ in range(5):
        seen.append((animated.motion.frame, round(30 * view.playhead_s)))
        QTest.keyClick(animated, Qt.Key.Key_Right)
    assert [frame for _, frame in seen] == [0, 1, 2, 3, 4]
    assert [frame for frame, _ in seen] == [0, 2, 4, 6, 8]  # 60 Hz motion at 30 frames a second
    QTest.keyClick(animated, Qt.Key.Key_Left)
    assert round(30 * view.playhead_s) == 4


def test_a_clicked_phoneme_brings_its_map_its_preview_and_its_cost(animated):
    for slot, phone in ((1, "m"), (4, "iy")):
        click(animated.timeline, phoneme_point(animated, slot))
        assert animated.authoring.view.slot == slot
        assert animated.authoring.view.map_phone == phone
        assert animated.isomap.phone.currentData() == phone
        node = animated.authoring.document.database.nodes.name(animated.authoring.document.answer.path.nodes[slot])
        assert node in animated.preview.caption.whole_text
        assert animated.control.cost.slot.text().startswith(f"/{phone}/ by {node}")
        utterance = animated.authoring.document.speech.transcript.phonemes[slot]
        assert utterance.start_s <= animated.authoring.view.playhead_s <= utterance.end_s


def test_brackets_step_from_phoneme_to_phoneme(animated):
    click(animated.timeline, phoneme_point(animated, 2))
    QTest.keyClick(animated, Qt.Key.Key_BracketRight)
    assert animated.authoring.view.slot == 3
    QTest.keyClick(animated, Qt.Key.Key_BracketLeft)
    QTest.keyClick(animated, Qt.Key.Key_BracketLeft)
    assert animated.authoring.view.slot == 1


def test_a_drag_on_the_timeline_scrubs_without_selecting(animated):
    click(animated.timeline, phoneme_point(animated, 1))
    start, end = phoneme_point(animated, 1), phoneme_point(animated, 5)
    QTest.mousePress(animated.timeline, LEFT, pos=start)
    QTest.mouseMove(animated.timeline, (start + end) / 2)
    QTest.mouseMove(animated.timeline, end)
    QTest.mouseRelease(animated.timeline, LEFT, pos=end)
    utterance = animated.authoring.document.speech.transcript.phonemes[5]
    assert utterance.start_s < animated.authoring.view.playhead_s < utterance.end_s
    assert animated.authoring.view.slot == 1


def test_a_click_on_the_map_changes_the_face_in_the_preview(animated):
    click(animated.timeline, phoneme_point(animated, 2))
    before = animated.preview.pick
    document = animated.authoring.document
    shown = document.database.maps["aa"].embedding
    farthest = shown[np.linalg.norm(shown - shown.mean(axis=0), axis=1).argmax()]
    click(animated.isomap.canvas.viewport(), map_point(animated, farthest))
    after = animated.preview.pick
    assert not after.in_use
    frames = document.database.frames
    assert np.linalg.norm(after.blend(frames) - before.blend(frames)) > 0.1
    assert "in use" not in animated.preview.caption.whole_text


def test_a_double_click_pins_the_node_and_undo_brings_the_old_path_back(animated, qtbot):
    slot = 2
    click(animated.timeline, phoneme_point(animated, slot))
    document = animated.authoring.document
    old_path, old_cost = document.answer.path.nodes.copy(), document.answer.path.cost
    shown = document.database.maps["aa"]
    farthest = np.linalg.norm(shown.embedding - shown.embedding.mean(axis=0), axis=1).argmax()
    point = map_point(animated, shown.embedding[farthest])
    canvas = animated.isomap.canvas.viewport()
    click(canvas, point)
    wanted = animated.preview.pick.node
    assert wanted != old_path[slot]
    QTest.mouseDClick(canvas, LEFT, pos=point)
    qtbot.waitUntil(lambda: document.answer.path.nodes[slot] == wanted, timeout=WAIT_MS)
    assert document.pins == {slot: document.database.nodes.name(wanted)}
    assert document.answer.path.cost >= old_cost
    assert "pinned" in animated.isomap.info.whole_text
    assert animated.authoring.undo_stack.undoText().startswith("Pin node")
    QTest.keyClick(animated, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: document.answer.path.nodes.tolist() == old_path.tolist(), timeout=WAIT_MS)
    assert document.pins == {}
    assert document.answer.path.cost == pytest.approx(old_cost)
    redo = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    QTest.keyClick(animated, Qt.Key.Key_Z, redo)
    qtbot.waitUntil(lambda: document.answer.path.nodes[slot] == wanted, timeout=WAIT_MS)


def test_enter_on_the_map_pins_and_frees_again(animated, qtbot):
    click(animated.timeline, phoneme_point(animated, 4))
    document = animated.authoring.document
    canvas = animated.isomap.canvas
    click(canvas.viewport(), map_point(animated, document.database.maps["iy"].embedding[0]))
    QTest.keyClick(canvas, Qt.Key.Key_Return)
    assert set(document.pins) == {4}
    QTest.keyClick(canvas, Qt.Key.Key_Return)
    assert document.pins == {}
    qtbot.waitUntil(lambda: not animated.authoring.jobs.is_running("search"), timeout=WAIT_MS)


def test_another_emotion_finds_another_motion_at_once(animated, qtbot):
    document = animated.authoring.document
    before = document.answer
    animated.control.emotion.chosen.setFocus()
    QTest.keyClick(animated.control.emotion.chosen, Qt.Key.Key_Down)
    QTest.keyClick(animated.control.emotion.chosen, Qt.Key.Key_Down)
    animated.control.emotion.chosen.activated.emit(animated.control.emotion.chosen.currentIndex())
    assert document.modifiers[0].emotion == "anger"
    qtbot.waitUntil(lambda: document.answer is not before, timeout=WAIT_MS)
    nodes = document.database.nodes
    spoken = document.answer.path.nodes[1:-1]
    assert (nodes.emotion[spoken] == 2).mean() > (nodes.emotion[before.path.nodes[1:-1]] == 2).mean()


def test_it_plays_to_its_end_without_a_sound_device(animated, qtbot):
    QTest.keyClick(animated, Qt.Key.Key_Home)
    QTest.keyClick(animated, Qt.Key.Key_Space)
    assert animated.authoring.player.is_playing
    qtbot.waitUntil(lambda: animated.authoring.view.playhead_s > 0.2, timeout=WAIT_MS)
    QTest.keyClick(animated, Qt.Key.Key_Space)
    assert not animated.authoring.player.is_playing
    at_s = animated.authoring.view.playhead_s
    assert at_s < animated.authoring.player.duration_s
    QTest.keyClick(animated, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: not animated.authoring.player.is_playing, timeout=WAIT_MS)
    assert animated.authoring.view.playhead_s == pytest.approx(animated.authoring.player.duration_s)


def test_the_film_is_composed_played_and_saved(animated, qtbot, choose, tmp_path):
    qtbot.waitUntil(lambda: animated.authoring.film.path is not None, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: animated.video.video_view.has_frame, timeout=WAIT_MS)
    assert not animated.video.is_empty
    choose(tmp_path / "copy.avi")
    click(animated.video.save_button)
    qtbot.waitUntil(lambda: (tmp_path / "copy.avi").is_file(), timeout=WAIT_MS)
    from core.media.video import probe

    facts = probe(tmp_path / "copy.avi")
    assert facts.fps == 30
    assert abs(facts.video_duration_s - animated.authoring.player.duration_s) < 1 / 30


@pytest.mark.parametrize("content", [b"", b"no sound at all", b"RIFF\x24\x00\x00\x00WAVE"])
def test_a_bad_sound_file_is_one_sentence_in_the_window(open_window, choose, qtbot, tmp_path, content):
    window = open_window()
    path = tmp_path / "bad.wav"
    path.write_bytes(content)
    choose(path)
    window.control.speech.open_action.trigger()
    qtbot.waitUntil(lambda: window.message.text != "", timeout=WAIT_MS)
    assert "bad.wav" in window.message.text
    assert "Traceback" not in window.message.text
    assert window.authoring.document.speech is None
    click(window.message.close_button)
    assert window.message.isHidden()


def test_a_bad_database_leaves_the_open_one(animated, choose, qtbot, tmp_path):
    before = animated.authoring.document.database
    path = tmp_path / "bad.h5"
    path.write_bytes(b"not HDF5")
    choose(path)
    click(animated.control.database.open_button)
    qtbot.waitUntil(lambda: "bad.h5" in animated.message.text, timeout=WAIT_MS)
    assert animated.authoring.document.database is before


def test_the_layout_is_remembered(open_window, qtbot, settings_folder):
    window = open_window()
    window.resize(780, 560)
    upper = window.motion.parentWidget()
    upper.setSizes([320, 240])
    sizes = upper.sizes()
    window.close()
    assert (settings_folder / "window.ini").is_file()
    again = open_window()
    assert again.size() == window.size()
    assert again.motion.parentWidget().sizes() == pytest.approx(sizes, abs=2)


def test_a_late_answer_does_not_replace_a_newer_one(animated, qtbot):
    click(animated.timeline, phoneme_point(animated, 2))
    document = animated.authoring.document
    name = document.database.nodes.name
    rows = [row for row in range(len(document.database.nodes)) if document.database.nodes[row].phone == "aa"]
    for row in rows[:4]:
        animated.authoring.toggle_pin(name(row))
    qtbot.waitUntil(idle(animated), timeout=WAIT_MS)
    assert document.answer.path.nodes[2] == rows[3]


def test_a_face_that_cannot_be_read_is_one_sentence_and_the_old_choice_stays(animated, choose, qtbot, tmp_path):
    mesh = tmp_path / "bad.obj"
    mesh.write_text("this is no mesh\n")
    (tmp_path / "bad.csv").write_text("marker,vertex\nring0,0\n")
    choose(mesh)
    count = animated.authoring.undo_stack.count()
    animated.control.face.chosen.setCurrentIndex(animated.control.face.chosen.count() - 1)
    animated.control.face.chosen.activated.emit(animated.control.face.chosen.count() - 1)
    qtbot.waitUntil(lambda: "bad.obj" in animated.message.text, timeout=WAIT_MS)
    assert animated.authoring.document.face is None
    assert animated.control.face.chosen.currentData() is None
    assert animated.authoring.undo_stack.count() == count


def test_an_emotion_file_sets_its_spans_and_a_bad_line_is_named(animated, choose, qtbot, tmp_path):
    good, bad = tmp_path / "good.txt", tmp_path / "bad.txt"
    good.write_text("0 0.5 anger 0.5\n0.5 1 joy\n")
    bad.write_text("0 0.5 envy\n")
    choose(good, bad)
    click(animated.control.emotion.open_button)
    document = animated.authoring.document
    assert [(m.emotion, m.intensity) for m in document.modifiers] == [("anger", 0.5), ("happiness", 1.0)]
    assert animated.authoring.undo_stack.undoText() == "Set emotion to good.txt"
    click(animated.control.emotion.open_button)
    assert "bad.txt', line 1" in animated.message.text
    assert len(document.modifiers) == 2
    qtbot.waitUntil(idle(animated), timeout=WAIT_MS)


def test_what_had_to_be_guessed_is_said_beside_the_transcript(open_window, choose, qtbot, speech_path, tmp_path):
    (tmp_path / "hum.wav").write_bytes(speech_path.read_bytes())
    (tmp_path / "hum.lab").write_text("0 0.1 pau\n0.1 1.0 ʙ\n1.0 1.1 pau\n", encoding="utf-8")
    window = open_window()
    choose(tmp_path / "hum.wav")
    window.control.speech.open_action.trigger()
    qtbot.waitUntil(lambda: window.authoring.document.speech is not None, timeout=WAIT_MS)
    assert window.control.speech.warning.isVisible()
    assert "ʙ" in window.control.speech.warning.whole_text
