"""Two engines are compared by mouse and keys; what is shown is what core says of them, and a cancel leaves nothing."""

from __future__ import annotations

import csv
import threading
import time
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.authoring import Authoring, whole_emotion
from app.comparison_words import in_figures
from app.loading import SpeechRequest
from app.panels.compare.pens import PAINT
from app.panels.compare.window import CompareWindow
from app.texts import compare as texts
from app.theme import apply_theme
from core.document.document import ProjectState
from core.document.edits import SetDatabase, SetSpeech
from core.document.live_engine import LiveEngine
from core.document.parts import Speech
from core.errors import UserFacingError
from core.evaluation.side_by_side import CAPTURED
from core.media.audio import load_audio
from core.motion.database import open_database
from core.search.compute import NumpyKernels
from core.synthesis.registry import make_engine

WAIT_MS = 20_000
LEFT = Qt.MouseButton.LeftButton
MIDDLE_S = 0.7  # of the sentence


@pytest.fixture(scope="module")
def database(mouth_database_path):
    return open_database(mouth_database_path)


@pytest.fixture(scope="module")
def engines(database):
    """Engines that all windows of this file ask, as the panes of one window do."""
    return {
        name: LiveEngine(partial(make_engine, name, database, NumpyKernels())) for name in ("search", "animeme")
    }  # fmt: skip


@pytest.fixture
def speech(database, held_out_speech_path):
    """A sentence that was held out."""
    recording = database.held_out_recordings("test")[1]
    return Speech(load_audio(held_out_speech_path), recording.transcript, recording.text)


@pytest.fixture
def opened(qtbot, qapp, settings_folder, monkeypatch, database, engines, speech):
    """The compare window by itself, with both motions made."""
    apply_theme(qapp)
    monkeypatch.setattr(Authoring, "live_engine", lambda _self, name: engines[name])
    authoring = Authoring(None)
    authoring.push(SetDatabase.on(authoring.document, database, {}))
    authoring.push(SetSpeech.on(authoring.document, speech, "speech"))
    window = CompareWindow(authoring)
    window.open_now()
    with qtbot.waitActive(window):
        window.activateWindow()
    settled(qtbot, window)
    yield window
    window.shut_down()
    authoring.shut_down()
    window.deleteLater()
    qapp.processEvents()


def settled(qtbot, window):
    qtbot.waitUntil(lambda: window.compared is not None and not window._is_stale, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: window.jobs.is_idle, timeout=WAIT_MS)


def click(widget):
    QTest.mouseClick(widget, LEFT, pos=widget.rect().center())


def pick(box, title):
    """Choose an entry of a list by typing its first letter."""
    box.setFocus()
    QTest.keyClicks(box, title[0])
    assert box.currentText() == title


def point_at(graph, time_s):
    """Move the pointer over the graph, without a button."""
    at = QPointF(graph.scale.x(time_s), graph.height() / 2)
    event = QMouseEvent(QEvent.Type.MouseMove, at, graph.mapToGlobal(at), Qt.MouseButton.NoButton,
                        Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier)  # fmt: skip
    QApplication.sendEvent(graph, event)


def turn_wheel(widget, at, notches):
    event = QWheelEvent(at, widget.mapToGlobal(at), QPoint(), QPoint(0, 120 * notches), Qt.MouseButton.NoButton,
                        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False)  # fmt: skip
    QApplication.sendEvent(widget, event)


def course(window, measure, of=""):
    return next(c.values_mm for c in window.compared.beside.courses if (c.measure, c.of) == (measure, of))


def seen(view):
    picture = view.grabFramebuffer()
    return np.frombuffer(picture.constBits(), np.uint8).reshape(picture.height(), -1, 4)[:, :, 2::-1].astype(int)


def test_the_main_window_opens_it_by_a_key_on_its_own_project(
    open_window, qtbot, mouth_database_path, held_out_speech_path
):
    main = open_window()
    authoring = main.authoring
    authoring.open_database(mouth_database_path)
    authoring.load_speech(SpeechRequest.beside(held_out_speech_path))
    qtbot.waitUntil(lambda: authoring.can_synthesise, timeout=WAIT_MS)
    authoring.set_engine("search-single")
    QTest.keyClick(main, Qt.Key.Key_M, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    settled(qtbot, main.tools.compare)
    assert main.tools.compare.compared.beside.names == ("search-single", "animeme")
    assert main.tools.compare.fairness.text() == texts.HELD_OUT
    authoring.synthesise()
    qtbot.waitUntil(lambda: authoring.document.answer is not None, timeout=WAIT_MS)
    shown = main.tools.compare.compared.beside.motions[0].positions
    np.testing.assert_allclose(shown, authoring.document.motion.positions[: len(shown)], atol=1e-3)


def test_it_opens_with_the_engine_of_the_project_and_another_and_shows_how_they_agree(opened):
    beside = opened.compared.beside
    assert beside.names == opened.choices.names == ("search", "animeme")
    assert opened.figures.columns == ("A – B", "A – captured", "B – captured")
    for measure, (_, unit, _) in texts.FIGURE_ROWS.items():
        assert opened.figures.rows[measure] == tuple(in_figures(getattr(a, measure), unit) for a in beside.agreements)
    assert opened.figures.rows["rms_mm"][0] != in_figures(0.0, "mm")
    assert opened.fairness.text() == texts.HELD_OUT and opened.message.text == ""
    assert [lane.title for lane in opened.graph.lanes] == [texts.GAP, texts.WIDTH, texts.DIFFERENCE, texts.LIP_ERROR]
    assert opened.faces.one.info.whole_text == "Constrained search"


def test_pointing_reads_values_and_a_click_takes_the_playhead_there(opened, qtbot):
    graph, view = opened.graph, opened.authoring.view
    for time_s in (0.31, 1.05):
        point_at(graph, time_s)
        frame = round(graph.read_at_s * opened.compared.beside.rate_hz)
        read = dict(graph.readings(graph.read_at_s)[0])
        assert abs(graph.read_at_s - time_s) < 0.01
        for key, of in (("one", "search"), ("other", "animeme"), ("captured", CAPTURED)):
            assert read[key] == pytest.approx(course(opened, "lip gap", of)[frame])
    assert view.playhead_s == 0.0
    at = QPoint(round(graph.scale.x(MIDDLE_S)), graph.height() // 2)
    QTest.mouseClick(graph, LEFT, pos=at)
    assert view.playhead_s == pytest.approx(MIDDLE_S, abs=0.01)
    assert opened.transport.slider.value() == pytest.approx(1000 * MIDDLE_S, abs=10)
    QTest.mousePress(graph, LEFT, pos=at)
    QTest.mouseMove(graph, QPoint(round(graph.scale.x(1.2)), at.y()))
    QTest.mouseRelease(graph, LEFT, pos=QPoint(round(graph.scale.x(1.2)), at.y()))
    assert view.playhead_s == pytest.approx(1.2, abs=0.01)
    QTest.keyClick(opened, Qt.Key.Key_Right)
    assert view.playhead_s == pytest.approx(round(1.2 * 30 + 1) / 30, abs=1e-6)


def test_the_wheel_zooms_about_the_pointer_and_0_shows_all(opened):
    graph = opened.graph
    at = QPointF(graph.scale.x(MIDDLE_S), 60.0)
    before = graph.scale.px_per_s
    turn_wheel(graph, at, 4)
    assert graph.scale.px_per_s > 2 * before
    assert graph.scale.x(MIDDLE_S) == pytest.approx(at.x(), abs=0.5)
    QTest.keyClick(opened, Qt.Key.Key_0)
    assert graph.scale.px_per_s == pytest.approx(before)


def test_both_faces_move_together(opened, qtbot):
    one, other = opened.faces.views[:2]
    qtbot.waitUntil(lambda: seen(one).max() > 100 and seen(other).max() > 100, timeout=WAIT_MS)
    before = seen(one), seen(other)
    opened.authoring.seek(MIDDLE_S)
    frame = round(MIDDLE_S * opened.compared.beside.rate_hz)
    for view, motion, was in zip((one, other), opened.compared.beside.motions, before):
        np.testing.assert_allclose(view._displacements, motion.positions[frame] - motion.markers.rest)
        assert (seen(view) != was).any()
    QTest.mousePress(one, LEFT, pos=QPoint(40, 40))
    QTest.mouseMove(one, QPoint(90, 40))
    QTest.mouseRelease(one, LEFT, pos=QPoint(90, 40))
    assert one.camera.azimuth_deg == other.camera.azimuth_deg != 0.0
    QTest.keyClick(opened, Qt.Key.Key_F)
    assert one.camera.azimuth_deg == other.camera.azimuth_deg == 0.0


def test_overlaid_they_are_two_colours_in_one_picture(opened, qtbot):
    QTest.keyClick(opened, Qt.Key.Key_O)
    assert opened.faces.is_overlaid and opened.layout_choice.key == "overlaid"
    beside = opened.compared.beside
    lips_apart = np.abs(course(opened, "lip gap", "search") - course(opened, "lip gap", "animeme"))
    assert lips_apart.max() > 1.9  # a marker is drawn as wide
    opened.resize(1000, 1200)  # so that it shows
    turn_wheel(opened.faces.overlaid, QPointF(10, 10), 3)
    opened.authoring.seek(lips_apart.argmax() / beside.rate_hz)

    def shares():
        """Pixels whose colour leans to that of A, and to that of B."""
        picture = seen(opened.faces.overlaid)
        lean = picture - picture.mean(axis=2, keepdims=True)
        wanted = [np.array(PAINT[key]) - np.mean(PAINT[key]) for key in ("one", "other")]
        return [int((lean @ (colour / np.linalg.norm(colour)) > 25).sum()) for colour in wanted]

    qtbot.waitUntil(lambda: min(shares()) > 5, timeout=WAIT_MS)
    click(opened.layout_choice.button("beside"))
    assert not opened.faces.is_overlaid


def test_choosing_what_the_other_one_is_swaps_them(opened, qtbot):
    before = course(opened, "lip gap", "search")
    pick(opened.choices.one, "Dominated animemes")
    assert opened.choices.names == ("animeme", "search")
    settled(qtbot, opened)
    assert opened.compared.beside.names == ("animeme", "search")
    np.testing.assert_allclose(course(opened, "lip gap", "search"), before, atol=1e-4)
    opened.graph.setFocus()
    QTest.keyClick(opened, Qt.Key.Key_X)
    assert opened.choices.names == ("search", "animeme")


def test_the_capture_can_be_one_of_the_two_as_long_as_there_is_one(opened, qtbot, speech):
    pick(opened.choices.other, texts.CAPTURED)
    settled(qtbot, opened)
    assert opened.figures.columns == ("A – captured",)
    truth = opened.capture.truth
    np.testing.assert_allclose(opened.compared.beside.motions[1].positions, truth.positions, atol=1e-4)
    assert [line.key for line in opened.graph.lanes[0].lines] == ["one", "captured"]
    other = replace(speech, text="nobody said this before the cameras")
    opened.authoring.push(SetSpeech.on(opened.authoring.document, other, "speech"))
    qtbot.waitUntil(lambda: opened.fairness.text() == texts.NOT_CAPTURED, timeout=WAIT_MS)
    assert CAPTURED not in opened.choices.names and opened.status.note == texts.CAPTURED_NONE_TIP
    assert opened.figures.columns == ("A – B",)
    captured = opened.choices.one.findData(CAPTURED)
    assert not opened.choices.one.model().item(captured).isEnabled()


def test_edits_are_followed_once_they_pause(opened, qtbot, engines):
    started = []
    opened.jobs.started.connect(lambda kind, _: started.append(kind))
    before, authoring = opened.compared, opened.authoring
    for emotion in ("anger", "happiness", "sadness"):
        authoring.set_emotion(whole_emotion(emotion), emotion)
    qtbot.waitUntil(lambda: opened.compared is not before, timeout=WAIT_MS)
    assert started.count("compare") == 1
    asked = authoring.document.speech_input()
    assert [m.emotion for m in asked.modifiers] == ["sadness"]
    made = engines["search"].answer(asked).motion
    shown = opened.compared.beside.motions[0].positions
    np.testing.assert_allclose(shown, made.positions[: len(shown)], atol=1e-3)


class Endless:
    """An engine that works until it is told to stop."""

    def __init__(self):
        self.at_work, self.stopped = threading.Event(), threading.Event()

    def answer(self, _speech, _weights, progress):
        self.at_work.set()
        try:
            while True:
                progress.step(0.5, "at work")
                time.sleep(0.01)
        finally:
            self.stopped.set()


def test_a_window_that_is_closed_in_the_middle_leaves_nothing_running(opened, qtbot, monkeypatch, engines):
    endless, live_engine = Endless(), Authoring.live_engine
    monkeypatch.setattr(Authoring, "live_engine", lambda _self, name: endless if name == "animeme" else engines[name])
    click(opened.again_button)
    qtbot.waitUntil(endless.at_work.is_set, timeout=WAIT_MS)
    assert opened.status.job == texts.COMPARING
    QTest.keyClick(opened, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(endless.stopped.is_set, timeout=WAIT_MS)
    assert not opened.isVisible() and opened.jobs.is_idle
    started = []
    opened.jobs.started.connect(lambda kind, _: started.append(kind))
    opened.authoring.set_emotion(whole_emotion("anger"), "anger")
    qtbot.wait(600)
    assert started == []
    monkeypatch.setattr(Authoring, "live_engine", live_engine)
    before = opened.compared
    opened.open_now()
    qtbot.waitUntil(lambda: opened.compared is not before, timeout=WAIT_MS)


def test_a_cancel_stops_it_and_compare_again_makes_it(opened, qtbot, monkeypatch):
    endless, live_engine = Endless(), Authoring.live_engine
    monkeypatch.setattr(Authoring, "live_engine", lambda _self, _name: endless)
    click(opened.choices.swap_button)
    qtbot.waitUntil(endless.at_work.is_set, timeout=WAIT_MS)
    click(opened.status.cancel_button)
    qtbot.waitUntil(endless.stopped.is_set, timeout=WAIT_MS)
    monkeypatch.setattr(Authoring, "live_engine", live_engine)
    QTest.keyClick(opened, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: opened.compared.beside.names == ("animeme", "search"), timeout=WAIT_MS)


def test_an_engine_that_cannot_says_so_in_one_sentence(opened, qtbot, monkeypatch):
    class Deaf:
        def answer(self, _speech, _weights, _progress):
            raise UserFacingError("It listens to the sound, and there is none.")

    monkeypatch.setattr(Authoring, "live_engine", lambda _self, _name: Deaf())
    before = opened.compared
    click(opened.again_button)
    qtbot.waitUntil(lambda: opened.message.text != "", timeout=WAIT_MS)
    assert opened.message.text == "Constrained search: It listens to the sound, and there is none."
    assert opened.compared is before and opened.jobs.is_idle


def test_without_speech_it_says_what_to_do(opened, qtbot):
    opened.authoring.document.load(ProjectState())
    qtbot.waitUntil(lambda: opened.compared is None, timeout=WAIT_MS)
    assert opened.faces.one.is_empty and opened.faces.one.empty_text == texts.WAITING
    assert not opened.film_button.isEnabled() and opened.jobs.is_idle and opened.graph.lanes == ()
    QTest.keyClick(opened, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)  # asks for no file
    assert opened.message.text == ""


def test_curves_and_film_are_written_where_they_are_asked_for(opened, choose, qtbot, tmp_path):
    import av

    choose(tmp_path / "curves")
    QTest.keyClick(opened, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: "curves.csv" in opened.status.note, timeout=WAIT_MS)
    rows = list(csv.DictReader((tmp_path / "curves.csv").read_text().splitlines()))
    np.testing.assert_allclose([float(row["difference_mm"]) for row in rows], course(opened, "difference"), atol=1e-4)
    choose(tmp_path / "both.avi")
    click(opened.film_button)
    qtbot.waitUntil(lambda: "both.avi" in opened.status.note, timeout=WAIT_MS)
    with av.open(str(tmp_path / "both.avi")) as container:
        n_pictures = sum(1 for _ in container.decode(video=0))
    assert n_pictures == 42
