"""Working in the timeline with mouse and keys."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.panels.timeline.description import description
from core.speech.emotion import EmotionModifier

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 20_000


def phonemes(window):
    return window.authoring.document.speech.transcript.phonemes


def place(window, lane, time_s, height=0.5):
    """Where a moment is in a lane; height 0 is its bottom."""
    area = window.timeline.lanes()[lane]
    return QPoint(round(window.timeline.scale.x(time_s)), round(area.bottom() - height * area.height()))


def middle(window, slot, lane="phonemes", height=0.5):
    utterance = phonemes(window)[slot]
    return place(window, lane, (utterance.start_s + utterance.end_s) / 2, height)


def drag(window, start, end, release=True):
    QTest.mousePress(window.timeline, LEFT, pos=start)
    QTest.mouseMove(window.timeline, (start + end) / 2)
    QTest.mouseMove(window.timeline, end)
    if release:
        QTest.mouseRelease(window.timeline, LEFT, pos=end)


def solved_again(window, qtbot):
    qtbot.waitUntil(lambda: not window.authoring.jobs.is_running("search"), timeout=WAIT_MS)


def test_a_dragged_edge_moves_the_boundary_and_keeps_the_pin(animated, qtbot):
    document = animated.authoring.document
    node = document.database.nodes.name(document.answer.path.nodes[2])
    QTest.mouseClick(animated.timeline, LEFT, pos=middle(animated, 2))
    animated.authoring.toggle_pin(node)
    solved_again(animated, qtbot)
    edge_s = phonemes(animated)[2].end_s
    drag(animated, place(animated, "phonemes", edge_s), place(animated, "phonemes", edge_s + 0.06))
    moved_s = phonemes(animated)[2].end_s
    assert moved_s == pytest.approx(edge_s + 0.06, abs=1.5 / animated.timeline.scale.px_per_s)
    assert phonemes(animated)[3].start_s == moved_s
    assert document.pins == {2: node}
    QTest.keyClick(animated, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert phonemes(animated)[2].end_s == edge_s


def test_an_edge_cannot_be_dragged_over_its_neighbour(animated):
    end_s = phonemes(animated)[3].end_s
    drag(animated, place(animated, "phonemes", phonemes(animated)[2].end_s), place(animated, "phonemes", end_s + 0.2))
    assert phonemes(animated)[2].end_s == pytest.approx(end_s - 0.01)


def test_escape_gives_a_drag_up(animated):
    before = phonemes(animated)
    edge_s = before[2].end_s
    drag(animated, place(animated, "phonemes", edge_s), place(animated, "phonemes", edge_s + 0.05), release=False)
    QTest.keyClick(animated.timeline, Qt.Key.Key_Escape)
    QTest.mouseRelease(animated.timeline, LEFT, pos=place(animated, "phonemes", edge_s + 0.05))
    assert phonemes(animated) == before


def test_strokes_snap_to_phonemes_and_their_height_is_the_intensity(animated, qtbot):
    document = animated.authoring.document
    QTest.keyClick(animated, Qt.Key.Key_3)
    assert animated.timeline.brush == "anger"
    assert animated.timeline_pane.bar.brush.key == "anger"
    drag(animated, middle(animated, 2, "emotion"), middle(animated, 4, "emotion", 0.375))
    span = phonemes(animated)[2].start_s, phonemes(animated)[4].end_s
    assert document.modifiers == (EmotionModifier(*span, "anger", 0.5),)
    assert animated.authoring.undo_stack.undoText() == "Paint anger"
    solved_again(animated, qtbot)
    QTest.keyClick(animated, Qt.Key.Key_1)  # erase
    drag(animated, middle(animated, 3, "emotion"), middle(animated, 3, "emotion"))
    cut = phonemes(animated)[3]
    assert [(m.start_s, m.end_s) for m in document.modifiers] == [(span[0], cut.start_s), (cut.end_s, span[1])]


def test_overlapping_strokes_of_two_emotions_mix(animated):
    for key, first, last in ((Qt.Key.Key_2, 1, 3), (Qt.Key.Key_4, 2, 4)):
        QTest.keyClick(animated, key)
        drag(animated, middle(animated, first, "emotion", 0.9), middle(animated, last, "emotion", 0.9))
    emotions = {m.emotion: (m.start_s, m.end_s) for m in animated.authoring.document.modifiers}
    assert emotions["happiness"][1] > emotions["sadness"][0]


def test_a_phone_is_renamed_where_it_stands(animated, qtbot):
    QTest.mouseDClick(animated.timeline, LEFT, pos=middle(animated, 2))
    editor = animated.timeline.focusWidget()
    QTest.keyClicks(editor, "iy")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    assert phonemes(animated)[2].phone == "iy"
    solved_again(animated, qtbot)
    assert len(animated.authoring.document.answer.path.nodes) == len(phonemes(animated))


def test_what_is_no_phone_is_said_in_the_window(animated):
    before = phonemes(animated)
    QTest.mouseDClick(animated.timeline, LEFT, pos=middle(animated, 2))
    QTest.keyClicks(animated.timeline.focusWidget(), "qqq")
    QTest.keyClick(animated.timeline.focusWidget(), Qt.Key.Key_Return)
    assert phonemes(animated) == before
    assert animated.message.isVisible()


def test_split_and_merge_are_inverse_in_time(animated):
    before = phonemes(animated)
    QTest.mouseClick(animated.timeline, LEFT, pos=middle(animated, 2))
    QTest.keyClick(animated, Qt.Key.Key_K, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert len(phonemes(animated)) == len(before) + 1
    QTest.mouseClick(animated.timeline, LEFT, pos=middle(animated, 2))
    QTest.keyClick(animated, Qt.Key.Key_J, Qt.KeyboardModifier.ControlModifier)
    assert phonemes(animated) == before


def test_a_locked_span_keeps_its_nodes_whatever_is_painted(animated, qtbot):
    document = animated.authoring.document
    QTest.mouseClick(animated.timeline, LEFT, pos=middle(animated, 2))
    QTest.mouseClick(animated.timeline, LEFT, Qt.KeyboardModifier.ShiftModifier, middle(animated, 4))
    assert animated.authoring.view.span == (2, 4)
    kept = document.answer.path.nodes[2:5].copy()
    QTest.keyClick(animated, Qt.Key.Key_L, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert set(document.locks) == {2, 3, 4}
    for emotion in (Qt.Key.Key_3, Qt.Key.Key_4):
        QTest.keyClick(animated, emotion)
        drag(animated, middle(animated, 0, "emotion", 0.95), middle(animated, 6, "emotion", 0.95))
        solved_again(animated, qtbot)
        assert (document.answer.path.nodes[2:5] == kept).all()


def test_costs_and_prices_come_with_the_motion(animated, qtbot):
    document = animated.authoring.document
    qtbot.waitUntil(lambda: document.breakdown is not None, timeout=WAIT_MS)
    total = sum(sum(row.values()) for row in document.breakdown)
    assert total == pytest.approx(document.answer.path.cost)
    text = description(animated.authoring.document, 2, "cost")
    assert "cost of this slot" in text
    assert "next best" in description(animated.authoring.document, 2, "price")


def test_keys_of_the_polish_curve_are_set_dragged_and_taken_away_and_undone(animated, qtbot):
    document = animated.authoring.document
    before = document.motion
    QTest.mouseClick(animated.timeline, LEFT, pos=place(animated, "curve", 0.5, 0.95))
    ((at_s, gain),) = document.polish.curves["lips"]
    assert at_s == pytest.approx(0.5, abs=1.5 / animated.timeline.scale.px_per_s)
    assert gain > 1.5
    qtbot.waitUntil(lambda: document.motion is not before, timeout=WAIT_MS)
    lips = document.motion.markers.group("lips")
    rest = document.motion.markers.rest[lips]
    moved, found = (np.abs(m.positions[:, lips] - rest).sum() for m in (document.motion, before))
    assert moved > 1.3 * found
    drag(animated, place(animated, "curve", at_s, 0.95), place(animated, "curve", 0.8, 0.3))
    ((_, lower),) = document.polish.curves["lips"]
    assert lower < 1.0
    QTest.keyClick(animated, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert document.polish.curves["lips"] == ((at_s, gain),)
    QTest.mouseDClick(animated.timeline, LEFT, pos=place(animated, "curve", at_s, gain / 2))
    assert document.polish.changes_nothing


def test_polish_stays_when_the_search_answers_anew(animated, qtbot):
    document = animated.authoring.document
    slider = animated.control.engine.polish.sliders["expression"]
    slider.setValue(25)
    assert document.polish.expression == 0.5
    qtbot.waitUntil(lambda: not animated.authoring.jobs.is_running("polish"), timeout=WAIT_MS)
    QTest.keyClick(animated, Qt.Key.Key_3)
    drag(animated, middle(animated, 1, "emotion", 0.95), middle(animated, 5, "emotion", 0.95))
    solved_again(animated, qtbot)
    assert document.polish.expression == 0.5
    found, shown = (np.abs(m.displacements).mean() for m in (document.answer.motion, document.motion))
    assert shown < 0.95 * found
