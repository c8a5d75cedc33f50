"""Another engine is chosen by keys, makes the motion, undoes, and is kept; one without a path says so everywhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app import texts
from core.animeme import engine
from core.document.content import ProjectContent
from core.search.compute import NumpyKernels
from core.synthesis import registry
from core.synthesis.registry import make_engine
from tests.core.iface.linear_face import LinearFace

WAIT_MS = 20_000


@pytest.fixture
def means_on_offer(monkeypatch):
    """The plain rival without a path, offered as the engines of other kinds will be."""
    means = replace(registry.ENGINES["phone-means"], is_offered=True)
    engines = {**registry.ENGINES, "phone-means": means}
    monkeypatch.setattr("app.panels.control.engine.ENGINES", engines)


def choose(window, qtbot, name):
    combo, authoring = window.control.engine.chosen, window.authoring
    before = authoring.document.answer
    combo.setFocus()
    while combo.currentData() != name:
        below = combo.findData(name) > combo.currentIndex()
        QTest.keyClick(combo, Qt.Key.Key_Down if below else Qt.Key.Key_Up)
    qtbot.waitUntil(lambda: authoring.document.answer is not before, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: not authoring.jobs.is_running("prices"), timeout=WAIT_MS)
    assert authoring.document.engine == name


def made_by(document, name):
    return make_engine(name, document.database, NumpyKernels()).synthesise(document.speech_input()).motion.positions


@pytest.mark.parametrize("name", ["search-single", "search-paper"])
def test_another_search_makes_the_motion_on_show_and_undo_brings_the_first_back(animated, qtbot, name):
    authoring, document = animated.authoring, animated.authoring.document
    first, n_before = document.motion.positions, authoring.undo_stack.index()
    choose(animated, qtbot, name)
    assert np.array_equal(document.motion.positions, made_by(document, name))
    assert not np.array_equal(document.motion.positions, first)
    assert document.prices is not None and animated.control.cost.whole.text()
    assert ProjectContent.from_json(ProjectContent.of(document).to_json()).engine == name
    answer = document.answer
    authoring.undo_stack.setIndex(n_before)
    qtbot.waitUntil(lambda: document.answer is not answer, timeout=WAIT_MS)
    assert document.engine == "search" == animated.control.engine.chosen.currentData()
    assert np.array_equal(document.motion.positions, first)


def test_weights_of_the_search_as_printed_leave_out_what_the_paper_does_not_have(animated, qtbot):
    choose(animated, qtbot, "search-paper")
    sliders = animated.control.engine.weights.sliders
    assert sliders["alpha1"].isEnabled() and not sliders["context_before"].isEnabled()
    assert sliders["context_before"].value() == sliders["duration"].value() == 0


def test_an_engine_without_a_path_says_so_in_the_empty_places(means_on_offer, animated_late, qtbot):
    window = animated_late()
    document = window.authoring.document
    window.authoring.select_slot(3)
    choose(window, qtbot, "phone-means")
    assert np.array_equal(document.motion.positions, made_by(document, "phone-means"))
    assert document.prices is None and document.breakdown is None and window.isomap.used is None
    assert window.control.cost.whole.text() == texts.NO_COST
    assert window.control.engine.facts.text() == texts.NO_PATH
    assert not window.control.engine.weights.isVisible()
    assert texts.NO_NODE_IN_USE in window.isomap.info.whole_text
    assert not window.preview.pin_button.isEnabled()
    window.grab()  # the lanes are painted without costs
    QTest.keyClick(window.isomap.canvas, Qt.Key.Key_Return)
    window.authoring.toggle_pin("s0:1")
    assert window.message.text.startswith(texts.PIN_NEEDS_SEARCH) and not document.pins
    window.authoring.lock()
    assert "no path of motion nodes" in window.message.text and not document.locks
    choose(window, qtbot, "search")
    assert document.path is not None and document.prices is not None
    assert window.control.engine.weights.isVisibleTo(window)


def test_a_face_that_listens_makes_the_motion_and_has_no_path(animated, qtbot, monkeypatch):
    document = animated.authoring.document
    face = LinearFace(document.database.markers.rest)
    monkeypatch.setattr("core.iface.engine.default_model", lambda *_: face)
    for name in ("iface", "iface-paper"):
        choose(animated, qtbot, name)
        assert np.array_equal(document.motion.positions, made_by(document, name))
        assert document.path is None and animated.control.engine.facts.text() == texts.NO_PATH
    assert ProjectContent.from_json(ProjectContent.of(document).to_json()).engine == "iface-paper"


def test_learning_animemes_can_be_given_up_and_taken_up_again(animated, qtbot, monkeypatch):
    """The first time a model is learnt, with progress; a cancel leaves the motion on show and no half a model."""
    authoring, document, learn, steps = animated.authoring, animated.authoring.document, engine.train_animemes, []

    def endless(*_args, progress, **_kwargs):
        while True:
            steps.append(len(steps))
            progress.step(0.5, "learning")

    monkeypatch.setattr(engine, "train_animemes", endless)
    before = document.answer
    authoring.set_engine("animeme")
    qtbot.waitUntil(lambda: len(steps) > 3, timeout=WAIT_MS)
    qtbot.waitUntil(animated.status.cancel_button.isVisible, timeout=WAIT_MS)
    QTest.mouseClick(animated.status.cancel_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: authoring.jobs.is_idle, timeout=WAIT_MS)
    assert document.answer is before
    monkeypatch.setattr(engine, "train_animemes", learn)
    authoring.synthesise()
    qtbot.waitUntil(lambda: document.answer is not before, timeout=WAIT_MS)
    assert np.array_equal(document.motion.positions, made_by(document, "animeme"))


def test_animemes_hold_long_sounds_by_a_switch_that_undoes_and_that_no_search_has(animated, qtbot):
    window, document, section = animated, animated.authoring.document, animated.control.engine
    assert not section.hold.isVisibleTo(window)
    choose(window, qtbot, "animeme")
    assert section.hold.isVisibleTo(window) and not section.hold.isChecked()
    before, n_before = document.answer, window.authoring.undo_stack.index()
    section.hold.setFocus()
    QTest.keyClick(section.hold, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: document.answer is not before, timeout=WAIT_MS)
    assert document.holds and document.answer.holds
    held = document.answer
    window.authoring.undo_stack.setIndex(n_before)
    qtbot.waitUntil(lambda: document.answer is not held, timeout=WAIT_MS)
    assert not document.holds and not document.answer.holds and not section.hold.isChecked()


def test_an_engine_of_a_newer_workstation_is_kept_and_told(animated, qtbot):
    authoring = animated.authoring
    state = replace(authoring.document.state(), engine="dream")
    authoring.document.load(state)
    assert animated.control.engine.chosen.currentText() == "dream"
    authoring.synthesise()
    qtbot.waitUntil(lambda: "no engine 'dream'" in animated.message.text, timeout=WAIT_MS)
    assert authoring.document.engine == "dream"
