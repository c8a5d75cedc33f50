"""The map under the animator's hand, by real mouse and key events."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from app.panels.isomap.colouring import ColourBy
from app.panels.map_pick import MapPick

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 30_000


def place_px(view, point):
    """Where a place of the map is on its canvas."""
    return view.canvas.mapFromScene(view.box.mapViewToScene(QPointF(*map(float, point))))


def click(view, point):
    QTest.mouseClick(view.canvas.viewport(), LEFT, pos=place_px(view, point))


def drag(view, points):
    canvas = view.canvas.viewport()
    QTest.mousePress(canvas, LEFT, pos=points[0])
    for start, end in pairwise(points):
        for share in (0.3, 0.7, 1.0):
            QTest.mouseMove(canvas, (start + (end - start) * share))
            QTest.qWait(15)  # the scene looks at a hundred moves a second
    QTest.mouseRelease(canvas, LEFT, pos=points[-1])


@pytest.fixture
def pane(animated, qtbot):
    """The pane with the map of an utterance that is said by a node of its own phone, prices known."""
    document = animated.authoring.document
    qtbot.waitUntil(lambda: document.prices is not None, timeout=WAIT_MS)
    phones, nodes = document.speech.transcript.phones, document.database.nodes
    own = [p for p, row in enumerate(document.answer.path.nodes) if nodes[int(row)].phone == phones[p]]
    animated.authoring.select_slot(own[len(own) // 2])
    assert animated.isomap.view.shown.phone == animated.authoring.view.slot_phone
    return animated.isomap


def unused_place(pane):
    """A place far from the frame in use, of another node."""
    shown, used = pane.view.shown, pane.used
    away = np.linalg.norm(shown.points - used.at, axis=1)
    away[shown.node == used.node] = -1
    return int(away.argmax())


def test_hovering_shows_a_mix_of_captured_frames_and_outside_says_so(pane, animated, qtbot):
    shown, canvas = pane.view.shown, pane.canvas.viewport()
    triangle = shown.map.triangles[len(shown.map.triangles) // 2]
    target = place_px(pane.view, shown.points[triangle].mean(axis=0))
    QTest.mouseMove(canvas, target)
    qtbot.waitUntil(lambda: not animated.preview.pick.in_use, timeout=WAIT_MS)
    pick = animated.preview.pick
    scene = pane.box.mapSceneToView(pane.canvas.mapToScene(target))  # the pointer stands on whole pixels
    expected = MapPick.under(shown, np.array([scene.x(), scene.y()]))
    assert expected.inside
    assert pick.frames.tolist() == expected.frames.tolist()
    assert pick.weights == pytest.approx(expected.weights, abs=1e-6)
    assert pane.view.pointed_way.points.tolist() == shown.trajectory(pick.node).tolist()
    QTest.qWait(15)
    QTest.mouseMove(canvas, QPoint(2, 2))
    qtbot.waitUntil(lambda: not animated.preview.pick.inside, timeout=WAIT_MS)
    assert animated.preview.caption.whole_text.startswith("nearest frame")


def test_a_click_on_a_dot_selects_its_node_and_shows_that_very_frame_with_its_price(pane, animated):
    shown, place = pane.view.shown, unused_place(pane)
    click(pane.view, shown.points[place])
    pick = animated.preview.pick
    assert pick.frames.tolist() == [shown.map.frames[pane_place(shown, pick)]]
    assert pane.selection == {pick.node}
    document = animated.authoring.document
    price = document.prices[animated.authoring.view.slot, pick.node] / document.cost_unit
    assert pick.price == pytest.approx(price)
    assert f"+{price:.2f}" in animated.preview.caption.whole_text
    node = document.database.nodes[pick.node]
    for fact in (node.name, node.emotion, f"{1000 * node.n_frames / document.database.rate_hz:.0f} ms"):
        assert fact in animated.preview.caption.whole_text


def pane_place(shown, pick):
    return int(np.searchsorted(shown.map.frames, pick.frames[0]))


def test_double_click_pins_and_u_frees(pane, animated, qtbot):
    document = animated.authoring.document
    slot = animated.authoring.view.slot
    point = pane.view.shown.points[unused_place(pane)]
    click(pane.view, point)
    wanted = pane.kept.node
    QTest.mouseDClick(pane.canvas.viewport(), LEFT, pos=place_px(pane.view, point))
    assert document.pins == {slot: document.database.nodes.name(wanted)}
    qtbot.waitUntil(lambda: document.answer.path.nodes[slot] == wanted, timeout=WAIT_MS)
    QTest.keyClick(pane.canvas, Qt.Key.Key_U)
    assert document.pins == {}
    qtbot.waitUntil(lambda: document.answer.path.nodes[slot] != wanted, timeout=WAIT_MS)


def test_delete_asks_why_and_only_enter_removes(pane, animated, qtbot):
    document = animated.authoring.document
    used = pane.used
    click(pane.view, used.at)
    row = next(iter(pane.selection))
    name = document.database.nodes.name(row)
    before = document.answer
    QTest.keyClick(pane.canvas, Qt.Key.Key_Delete)
    assert pane.strip.isVisible()
    assert document.removed == frozenset()
    QTest.keyClick(pane.strip.reason, Qt.Key.Key_Escape)
    assert not pane.strip.isVisible()
    assert document.removed == frozenset()

    said = []
    animated.authoring.noted.connect(said.append)
    QTest.keyClick(pane.canvas, Qt.Key.Key_Delete)
    QTest.keyClicks(pane.strip.reason, "jaw tears")
    QTest.keyClick(pane.strip.reason, Qt.Key.Key_Return)
    assert document.removed == {name}
    qtbot.waitUntil(lambda: document.answer is not before and document.answer is not None, timeout=WAIT_MS)
    assert row not in document.answer.path.nodes
    assert document.answer.path.cost >= before.path.cost
    qtbot.waitUntil(lambda: any("cost" in sentence for sentence in said), timeout=WAIT_MS)

    QTest.mouseClick(pane.removed_button, LEFT)
    assert pane.removed.nodes == [row]
    assert "jaw tears" in pane.removed.node_texts[0]
    pane.removed.step(1)
    QTest.keyClick(pane.removed.view, Qt.Key.Key_Return)
    assert document.removed == frozenset()
    qtbot.waitUntil(lambda: document.answer.path.cost == pytest.approx(before.path.cost), timeout=WAIT_MS)


def test_a_box_selects_what_it_encloses_and_a_lasso_too(pane):
    shown = pane.view.shown
    left, bottom, right, top = shown.bounds
    middle = float(np.median(shown.points[:, 0]))
    low, high = place_px(pane.view, (left, bottom)), place_px(pane.view, (right, top))
    low, high, middle_px = low + QPoint(-3, 3), high + QPoint(3, -3), place_px(pane.view, (middle, top)).x()
    QTest.mouseClick(pane.controls.tool.button("box"), LEFT)
    drag(pane.view, [low, high])
    assert pane.selection == set(shown.rows.tolist())

    QTest.keyClick(pane.canvas, Qt.Key.Key_Escape)
    assert pane.selection == frozenset()
    QTest.mouseClick(pane.controls.tool.button("lasso"), LEFT)
    drag(pane.view, [low, QPoint(middle_px, low.y()), QPoint(middle_px, high.y()), QPoint(low.x(), high.y())])
    share_left = {row: float((shown.trajectory(row)[:, 0] < middle).mean()) for row in shown.rows.tolist()}
    assert {row for row, share in share_left.items() if share == 1.0} <= pane.selection
    assert not {row for row, share in share_left.items() if share == 0.0} & pane.selection


def test_colour_by_price_paints_the_cheapest_node_brightest(pane, animated):
    pane.controls.colour.setFocus()
    while pane.controls.colour_by is not ColourBy.PRICE:
        QTest.keyClick(pane.controls.colour, Qt.Key.Key_Down)
    pane.controls.colour.activated.emit(pane.controls.colour.currentIndex())
    shown, painted = pane.view.shown, pane.view._colouring
    slot = animated.authoring.view.slot
    used = int(animated.authoring.document.answer.path.nodes[slot])
    assert set(painted.index[shown.node == used]) == {painted.index.max()}
    price = animated.authoring.document.prices[slot][shown.node]
    order = np.argsort(price, kind="stable")
    assert (np.diff(painted.index[order]) <= 0).all()
    assert "free" in pane.legend.text()


def test_a_filtered_emotion_is_not_drawn(pane):
    shown = pane.view.shown
    everything = pane.view.dots.n_shown
    QTest.mouseClick(pane.controls.filters["anger"], LEFT)
    assert pane.view.dots.n_shown == everything - int((shown.emotion == 2).sum())


def test_other_emotion_colours_are_put_on_everywhere_and_remembered(pane, animated):
    from app.emotion_colours import OKABE_ITO, PAPER, emotion_colours
    from app.theme import colour, theme

    before = pane.view._colouring.colours.copy()
    pane.controls.palette_button.menu().actions()[1].trigger()
    assert emotion_colours.name == OKABE_ITO
    assert not np.allclose(pane.view._colouring.colours, before)
    assert pane.view._colouring.colours[2] == pytest.approx(colour(theme().emotion["anger"]).getRgbF()[:3])
    pane.controls.palette_button.menu().actions()[0].trigger()
    assert emotion_colours.name == PAPER
    assert np.allclose(pane.view._colouring.colours, before)


def test_space_plays_the_selected_node_as_a_clip_and_not_the_sentence(pane, animated, qtbot):
    place = unused_place(pane)
    click(pane.view, pane.view.shown.points[place])
    seen = []
    pane.clip.frame_shown.connect(lambda pick: seen.append(int(pick.frames[0])))
    with qtbot.waitSignal(pane.clip.ended, timeout=WAIT_MS):
        QTest.keyClick(pane.canvas, Qt.Key.Key_Space)
    assert not animated.authoring.player.is_playing
    assert seen == sorted(seen)
    nodes = animated.authoring.document.database.nodes
    row = next(iter(pane.selection))
    assert seen[0] < nodes.stop[row]
    assert seen[-1] >= nodes.stop[row] - 1


def test_time_correct_frames_move_with_the_playhead(pane, animated):
    utterance = animated.authoring.document.speech.transcript.phonemes[animated.authoring.view.slot]
    shown = pane.view.shown
    for share in (0.0, 0.5, 0.9):
        animated.authoring.seek(utterance.start_s + share * (utterance.end_s - utterance.start_s))
        marked = np.vstack(
            [np.column_stack(marks.getData()) for marks in (pane.view.time_correct, pane.view.context_correct)]
        )
        expected = shown.at_share(pane._share)
        assert sorted(map(tuple, marked.round(4))) == sorted(map(tuple, expected.round(4)))


def test_the_pca_map_comes_beside_with_figures_of_both(pane, qtbot):
    QTest.mouseClick(pane.pca_button, LEFT)
    assert pane.pca.isVisible()
    qtbot.waitUntil(lambda: "%" in pane.pca.caption.text(), timeout=WAIT_MS)
    assert "Isomap" in pane.view.caption.text()
    assert "PCA" in pane.pca.caption.text()


def test_suspects_are_listed_and_stepped_through(pane, animated, qtbot):
    QTest.mouseClick(pane.suspects_button, LEFT)
    qtbot.waitUntil(lambda: pane.side.suspicion is not None, timeout=WAIT_MS)
    if len(pane.suspects.nodes) < 2:
        pytest.skip("nothing in this small database looks contaminated")
    QTest.keyClick(pane.suspects.view, Qt.Key.Key_N)
    assert pane.selection == {pane.suspects.nodes[0]}
    assert pane.clip.is_playing
    QTest.keyClick(pane.suspects.view, Qt.Key.Key_N)
    assert pane.selection == {pane.suspects.nodes[1]}
    assert animated.authoring.document.removed == frozenset()
    pane.clip.stop()
