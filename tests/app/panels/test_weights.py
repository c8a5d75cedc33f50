"""The page of weights: sliders that the search follows, and that undo in one step."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt

from app.loading import SpeechRequest
from app.panels.weights import place_of, weight_at


@pytest.mark.parametrize("own", [3.0, 1e-4, 5e5])
def test_places_and_weights_are_inverse_and_the_middle_is_the_databases_own(own):
    assert weight_at("alpha5", 100, own) == pytest.approx(own)
    assert weight_at("alpha5", 0, own) == 0.0
    for place in (0, 1, 37, 100, 199, 200):
        assert place_of(weight_at("alpha5", place, own), own) == place
    assert weight_at("alpha4", 200, 0.3) == 1.0
    assert weight_at("context_before", 100, 0.0) == 1.0


@pytest.fixture
def at_work(open_window, qtbot, database_path, speech_path):
    window = open_window()
    authoring = window.authoring
    authoring.open_database(database_path)
    qtbot.waitUntil(lambda: authoring.document.database is not None, timeout=20_000)
    authoring.load_speech(SpeechRequest.beside(speech_path), then_synthesise=True)
    qtbot.waitUntil(lambda: authoring.document.answer is not None, timeout=30_000)
    qtbot.waitUntil(lambda: authoring.jobs.is_idle, timeout=30_000)
    return window


def test_a_slider_solves_anew_and_a_drag_is_one_step_of_undo(at_work, qtbot):
    window, authoring, page = at_work, at_work.authoring, at_work.control.engine.weights
    first, n_steps = authoring.document.answer, authoring.undo_stack.count()
    slider = page.sliders["alpha1"]
    slider.setSliderDown(True)
    for place in (120, 150, 180):
        slider.setSliderPosition(place)
    slider.setSliderDown(False)
    own = authoring.document.database.weights
    assert authoring.document.weights.alpha1 == pytest.approx(weight_at("alpha1", 180, own.alpha1))
    assert authoring.undo_stack.count() == n_steps + 1
    qtbot.waitUntil(lambda: authoring.document.answer is not first, timeout=20_000)
    assert window.control.cost.whole.text()
    authoring.undo_stack.undo()
    assert authoring.document.weights is None
    assert slider.value() == 100
    qtbot.waitUntil(lambda: authoring.jobs.is_idle, timeout=30_000)
    assert authoring.document.answer.path.cost == pytest.approx(first.path.cost)


def test_reset_takes_the_weights_of_the_database_again(at_work, qtbot):
    authoring, page = at_work.authoring, at_work.control.engine.weights
    assert not page.reset.isEnabled()
    page.sliders["pnt"].setValue(150)
    assert authoring.document.weights is not None and page.reset.isEnabled()
    qtbot.mouseClick(page.reset, Qt.MouseButton.LeftButton)
    assert authoring.document.weights is None
    assert page.sliders["pnt"].value() == 100


def test_the_page_is_folded_until_it_is_wanted(at_work):
    page = at_work.control.engine.weights
    assert not page.sliders["alpha1"].isVisible()
    page.head.click()
    assert page.sliders["alpha1"].isVisible()
