"""The motion units page by mouse: units move the face, keyframes follow, and back."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QStyle, QStyleOptionSlider

from app.panels.units import window as units_window_module
from app.texts import units as texts
from core.iface.units_of_database import units_of_database

WAIT_MS = 20_000
_LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def units_window(open_window, qtbot, database_path, tmp_path):
    """The page, with the units of the tiny database (a copy, for what is removed); no face fits its markers."""
    main = open_window()
    main.authoring.open_database(Path(shutil.copy(database_path, tmp_path)))
    qtbot.waitUntil(lambda: main.authoring.document.database is not None, timeout=WAIT_MS)
    main.actions.by_name["units"].trigger()
    window = main.tools.units
    qtbot.waitUntil(lambda: window.draft.pose is not None, timeout=WAIT_MS)
    return window


def click(widget):
    QTest.mouseClick(widget, _LEFT, pos=widget.rect().center())


def drag(slider, share):
    """Take the slider's handle to a share of its way."""
    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    handle = slider.style().subControlRect(
        QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, slider
    )
    end = QPoint(handle.width() // 2 + round(share * (slider.width() - handle.width())), handle.center().y())
    QTest.mousePress(slider, _LEFT, pos=handle.center())
    QTest.mouseMove(slider, end)
    QTest.mouseRelease(slider, _LEFT, pos=end)


def on_show(window):
    """Marker displacements that the view draws."""
    return window.view._displacements


def test_a_slider_moves_the_face_by_standard_deviations_of_what_counts(units_window, qtbot):
    window = units_window
    units = units_of_database(window.authoring.document.database)
    assert len(window.units.sliders) == len(units.utterance.units)
    np.testing.assert_allclose(on_show(window).ravel(), units.utterance.mean, atol=1e-4)
    drag(window.units.sliders[0], 5 / 6)
    deviation = window.draft.pose.deviations[0]
    assert deviation == pytest.approx(2.0, abs=0.3) and window.units.values[0].text() == f"{deviation:.2f} σ"
    expected = units.utterance.mean + deviation * np.sqrt(units.utterance.variance[0]) * units.utterance.units[0]
    np.testing.assert_allclose(on_show(window).ravel(), expected, atol=1e-4)
    click(window.reset_button)
    np.testing.assert_allclose(on_show(window).ravel(), units.utterance.mean, atol=1e-4)

    # nodes that are removed do not count any more
    document = window.authoring.document
    before = window.draft.learned.units.utterance.mean
    name = document.database.nodes.name(int(np.flatnonzero(document.database.nodes.emotion == 0)[0]))
    window.authoring.remove_nodes([name], "test")
    qtbot.waitUntil(lambda: window.draft.learned.request.removed == {name}, timeout=WAIT_MS)
    expected = units_of_database(document.database, removed={name}).utterance.mean
    np.testing.assert_allclose(window.draft.learned.units.utterance.mean, expected)
    assert np.abs(expected - before).max() > 0


def test_keyframes_follow_the_units_and_the_units_follow_them(units_window):
    window = units_window
    drag(window.units.sliders[0], 0.8)
    keyframes = window.draft.keyframes
    columns = (keyframes.shapes - keyframes.neutral).reshape(len(keyframes.names), -1).T
    face = on_show(window).reshape(-1).astype(float)
    nearest = np.linalg.lstsq(columns, face, rcond=None)[0]
    np.testing.assert_allclose(window.draft.weights, nearest, atol=1e-3)
    off_mm = np.sqrt(np.square((columns @ nearest - face).reshape(-1, 3)).sum(axis=1).mean())
    assert window.off.whole_text == texts.KEYFRAMES_OFF.format(off=off_mm)
    assert window.weights.values[0].text() == f"{nearest[0]:.2f}"

    drag(window.weights.sliders[1], 0.9)
    weights = window.draft.weights
    assert weights[1] == pytest.approx(1.7, abs=0.1)
    np.testing.assert_allclose(np.delete(weights, 1), np.delete(nearest, 1), atol=1e-3)
    np.testing.assert_allclose(on_show(window).ravel(), columns @ weights, atol=1e-3)
    pose = window.draft.pose
    expected = (columns @ weights - pose.units.utterance.mean) @ pose.units.utterance.units.T / pose.spread
    np.testing.assert_allclose(pose.deviations, expected)
    assert "units come within" in window.off.whole_text

    # as rigs want them
    drag(window.units.sliders[0], 1.0)
    assert window.draft.weights.min() < 0 or window.draft.weights.max() > 1
    click(window.bounded)
    assert window.draft.weights.min() >= 0 and window.draft.weights.max() <= 1
    assert window.weights.sliders[0].minimum() == 0
    window.form.choose(texts.PRINTED[0])
    assert not window.draft.of_displacements and window.draft.weights.min() >= 0


def test_an_expression_brings_its_units_and_as_many_as_are_asked_for_show_the_same_face(
    units_window, qtbot, choose, tmp_path, monkeypatch
):
    window, draft = units_window, units_window.draft
    n_spoken = draft.pose.n_spoken
    drag(window.units.sliders[0], 0.7)
    spoken = draft.pose.deviations.copy()
    neutral = on_show(window).copy()
    window.expression.setFocus()
    QTest.keyClick(window.expression, Qt.Key.Key_Down)
    assert draft.pose.expression == "happiness" and len(window.units.sliders) == n_spoken + 2
    np.testing.assert_array_equal(draft.pose.deviations[:n_spoken], spoken)
    full = on_show(window).copy()
    added = draft.pose.units.expressions["happiness"].mean
    np.testing.assert_allclose((full - neutral).ravel(), added, atol=1e-4)
    drag(window.intensity, -0.2)
    np.testing.assert_allclose(on_show(window), neutral, atol=1e-4)
    assert window.intensity_label.text() == texts.INTENSITY_VALUE.format(intensity=0.0)

    # other units for the same face
    before = on_show(window).copy()
    window.speech.choice.choose(texts.BY_COUNT[0])
    qtbot.waitUntil(lambda: window.jobs.is_idle)
    assert window.speech.count.value() == n_spoken
    window.speech.count.setValue(n_spoken - 1)
    qtbot.waitUntil(lambda: draft.pose.n_spoken == n_spoken - 1, timeout=WAIT_MS)
    assert f"{n_spoken - 1} cover" in window.speech.covered.text()
    # which loses what the unit that is gone carried, and no more
    units = units_of_database(window.authoring.document.database, n_spoken)
    lost = units.parameters(before.astype(float))[-1] * units.utterance.units[-1]
    np.testing.assert_allclose((before - on_show(window)).ravel(), lost, atol=1e-3)

    # figures go to another process as they are on show
    sent = []

    def drawn(request, _progress):
        sent.append(pickle.loads(pickle.dumps(request)))
        return request.path

    monkeypatch.setattr(units_window_module, "draw", drawn)
    monkeypatch.setattr(type(window.authoring), "rig", property(lambda self: "a face"))
    choose(tmp_path / "keyframes", tmp_path / "units.png")
    for button, name in ((window.save_keyframes, "keyframes.png"), (window.save_units, "units.png")):
        click(button)
        qtbot.waitUntil(
            lambda name=name: window.status.note == texts.SAVED.format(path=tmp_path / name), timeout=WAIT_MS
        )
    of_keyframes, of_units = sent
    np.testing.assert_array_equal(of_keyframes.keyframes.shapes, window.draft.keyframes.shapes)
    assert "tiny" in of_keyframes.title and of_units.keyframes is None
    units = window.draft.pose.units
    n_spoken = len(units.utterance.units)
    assert of_units.names[-2:] == ("happiness 1", "happiness 2") and of_units.poses.shape[:2] == (3, n_spoken + 2)
    step = (of_units.poses[2, 1] - of_units.poses[1, 1]).ravel()
    np.testing.assert_allclose(step, 2 * np.sqrt(units.utterance.variance[1]) * units.utterance.units[1], atol=1e-4)


def test_what_cannot_be_is_told(open_window, qtbot, units_window):
    click(units_window.save_keyframes)
    assert texts.NEEDS_FACE in units_window.message.text
    # without neutral speech there is nothing to learn from
    database = units_window.authoring.document.database
    neutral = [database.nodes.name(n) for n in np.flatnonzero(database.nodes.emotion == 0).tolist()]
    units_window.authoring.remove_nodes(neutral, "test")
    qtbot.waitUntil(lambda: units_window.pane.is_empty and units_window.jobs.is_idle, timeout=WAIT_MS)
    assert "has no neutral speech" in units_window.pane.empty_text and units_window.units.sliders == []
    units_window.authoring.undo_stack.undo()
    qtbot.waitUntil(lambda: not units_window.pane.is_empty, timeout=WAIT_MS)

    main = open_window()
    main.actions.by_name["units"].trigger()
    assert main.tools.units.pane.is_empty and main.tools.units.pane.empty_text == texts.NO_DATABASE
    assert not main.tools.units.save_units.isEnabled() and main.tools.units.units.sliders == []
