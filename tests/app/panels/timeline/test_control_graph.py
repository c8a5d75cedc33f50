"""The control curves are edited by mouse and keys, undone, kept, and exported as they are shown."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app import texts
from app.texts import curves as curve_texts
from core.document.content import ProjectContent
from core.rig.control_layer import laid_over
from core.search.compute import NumpyKernels
from core.synthesis.registry import make_engine

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 60_000


def settled(window, qtbot):
    jobs = window.authoring.jobs
    qtbot.waitUntil(lambda: not any(jobs.is_running(k) for k in ("search", "polish", "controls")), timeout=WAIT_MS)


@pytest.fixture
def graph(animated_late, qtbot):
    """The graph of a window that speaks by animemes, chosen and unfolded by mouse and keys."""
    window = animated_late()
    combo = window.control.engine.chosen
    combo.setFocus()
    before = window.authoring.document.answer
    while combo.currentData() != "animeme":
        QTest.keyClick(combo, Qt.Key.Key_Down)
    qtbot.waitUntil(lambda: getattr(window.authoring.document.answer, "model", None) is not None, timeout=WAIT_MS)
    assert window.authoring.document.answer is not before
    button = window.timeline_pane.bar.curves
    QTest.mouseClick(button, LEFT, pos=button.rect().center())
    graph = window.timeline_pane.curves.graph
    qtbot.waitUntil(lambda: graph.curves is not None and graph.isVisible(), timeout=WAIT_MS)
    graph.window_ = window
    return graph


def drag(graph, start, end, release=True):
    start, end = (QPoint(round(p.x()), round(p.y())) for p in (start, end))
    QTest.mousePress(graph, LEFT, pos=start)
    QTest.mouseMove(graph, (start + end) / 2)
    QTest.mouseMove(graph, end)
    if release:
        QTest.mouseRelease(graph, LEFT, pos=end)


def pulled(graph, time_s=0.5, up_px=30):
    """Drag the chosen curve up (or down, near the top) at a time; returns the key that was made."""
    start = graph.point(time_s)
    if start.y() - up_px < graph.graph_area().top():
        up_px = -up_px
    drag(graph, start, start + QPointF(0, -up_px))
    (key,) = graph._keys
    return key


def test_the_engine_says_that_it_has_no_path_and_its_phonemes_share_every_moment(graph):
    window = graph.window_
    assert window.control.cost.whole.text() == texts.NO_COST
    assert window.control.engine.facts.text() == texts.NO_PATH
    shares = graph.curves.ruling.shares
    assert shares.shape == (len(graph.curves.transcript.phonemes), len(graph.curves.found))
    assert np.allclose(shares.sum(axis=0), 1)


def test_a_dragged_curve_gets_a_key_passes_the_pointer_and_moves_the_markers(graph, qtbot):
    window, document = graph.window_, graph.window_.authoring.document
    before, n_before = document.motion.positions, window.authoring.undo_stack.index()
    start = graph.point(0.5)
    up = -30 if start.y() - 30 > graph.graph_area().top() else 30
    drag(graph, start, start + QPointF(0, up))
    (key,) = document.controls.of(graph.control).keys
    assert key.time_s == pytest.approx(0.5, abs=2 / window.timeline.scale.px_per_s)
    assert graph.point(key.time_s).y() == pytest.approx(start.y() + up, abs=3)
    settled(window, qtbot)
    assert not np.array_equal(document.motion.positions, before)
    assert window.authoring.undo_stack.index() == n_before + 1, "a drag is one entry"
    assert graph.control in window.authoring.undo_stack.undoText()
    QTest.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settled(window, qtbot)
    assert document.controls.changes_nothing and np.array_equal(document.motion.positions, before)


def test_keys_are_dragged_nudged_widened_and_removed(graph, qtbot):
    document = graph.window_.authoring.document
    key = pulled(graph)
    at = graph.point(key.time_s)
    drag(graph, at, at + QPointF(40, 0))
    (moved,) = graph._keys
    px_per_s = graph.window_.timeline.scale.px_per_s
    assert moved.time_s == pytest.approx(key.time_s + 40 / px_per_s, abs=2 / px_per_s)
    assert moved.reach_s == key.reach_s
    QTest.keyClick(graph, Qt.Key.Key_Up)
    (nudged,) = graph._keys
    assert nudged.amount > moved.amount and nudged.time_s == moved.time_s
    wheel = QWheelEvent(
        QPointF(at), graph.mapToGlobal(QPointF(at)), QPoint(), QPoint(0, 120), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.ControlModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(graph, wheel)
    assert graph._keys[0].reach_s > nudged.reach_s
    QTest.mouseDClick(graph, LEFT, pos=graph.point(graph.key.time_s).toPoint())
    assert document.controls.changes_nothing
    pulled(graph)
    QTest.keyClick(graph, Qt.Key.Key_Delete)
    assert document.controls.changes_nothing


def test_escape_puts_a_dragged_key_back(graph):
    start = graph.point(0.5)
    drag(graph, start, start + QPointF(0, 25), release=False)
    assert graph._keys
    QTest.keyClick(graph, Qt.Key.Key_Escape)
    assert not graph._keys


def test_a_press_beside_the_curves_selects_as_in_the_timeline(graph):
    area, window = graph.rules_area(), graph.window_
    x = round(window.timeline.scale.x(0.3))
    QTest.mouseClick(graph, LEFT, pos=QPoint(x, round(area.center().y())))
    assert window.authoring.view.slot == window.authoring.view.slot_at(window.timeline.scale.time_s(x))
    assert window.authoring.document.controls.changes_nothing


def test_mute_smooth_and_clear_by_their_buttons(graph, qtbot):
    page, document = graph.window_.timeline_pane.curves, graph.window_.authoring.document
    found = graph.curves.found.column(graph.control)
    QTest.mouseClick(page.smooth, LEFT, pos=page.smooth.rect().center())
    smooth = graph.curves.edited.column(graph.control)
    assert np.abs(np.diff(smooth, 2)).sum() < np.abs(np.diff(found, 2)).sum()
    QTest.mouseClick(page.mute, LEFT, pos=page.mute.rect().center())
    assert np.ptp(graph.curves.edited.column(graph.control)) < 1e-6
    assert graph.control + " ∗" == page.control.currentText()
    QTest.mouseClick(page.clear, LEFT, pos=page.clear.rect().center())
    assert document.controls.changes_nothing and not page.mute.isChecked() and not page.clear.isEnabled()


def test_edits_outlive_another_engine_a_saved_project_and_are_exported(graph, qtbot):
    window, document = graph.window_, graph.window_.authoring.document
    pulled(graph)
    settled(window, qtbot)
    content = ProjectContent.from_json(ProjectContent.of(document).to_json())
    assert content.controls == document.controls and not content.controls.changes_nothing
    # what `efase export` computes from the kept project
    answer = make_engine(content.engine, document.database, NumpyKernels()).synthesise(document.speech_input())
    exported = laid_over(answer.motion, document.database, content.controls, content.polish)
    assert np.array_equal(exported.positions, document.motion.positions)
    kept = document.controls
    window.authoring.set_engine("search")
    qtbot.waitUntil(lambda: document.path is not None, timeout=WAIT_MS)
    settled(window, qtbot)
    assert document.controls is kept and graph.curves.ruling is None
    assert not np.array_equal(document.motion.positions, document.answer.motion.positions)
    window.grab()


def test_hovering_the_hills_names_the_phoneme_and_its_share(graph, qtbot):
    transcript, timeline = graph.curves.transcript, graph.window_.timeline
    slot = next(p for p, u in enumerate(transcript.phonemes) if u.phone == "aa")
    middle_s = (transcript.phonemes[slot].start_s + transcript.phonemes[slot].end_s) / 2
    at = QPoint(round(timeline.scale.x(middle_s)), round(graph.rules_area().center().y()))
    graph.window_.move(0, -300)  # the screen of the tests is low, and a pointer stays on it
    QTest.mouseMove(graph, at)
    qtbot.waitUntil(lambda: graph._hovered == slot)
    words = graph.description(QPointF(at))
    assert "/aa/" in words and graph.control in words
    assert curve_texts.RULER.split(" ")[1] in words


def test_the_page_is_opened_and_closed_by_its_key_and_gives_its_room_back(graph, qtbot):
    window = graph.window_
    sizes = window.timeline_pane.height()
    QTest.keyClick(window, Qt.Key.Key_G, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert not graph.isVisible()
    qtbot.waitUntil(lambda: window.timeline_pane.height() < sizes)
    QTest.keyClick(window, Qt.Key.Key_G, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert graph.isVisible()


def test_a_model_that_was_learnt_is_read_the_next_time(graph, settings_folder, tmp_path):
    assert list((tmp_path / "cache" / "animemes").glob("*.npz"))
