"""A film is clicked, tracked, corrected by dragging and saved, all by mouse and keys."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest

from core.motion.motion_files import read_motion
from core.tracking.face_model import CLICKED
from core.tracking.start_file import read_start
from tests.core.tracking.bent_sheet import bent_markers, clicks_on, film_of, sheet_markers, speaking_sheet

WAIT_MS = 30_000
_LEFT, _CTRL = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.ControlModifier


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """Fourteen pictures, two of them dark."""
    return film_of(speaking_sheet(n=14, dark=frozenset({8, 9})), tmp_path_factory.mktemp("film") / "sheet.avi")


@pytest.fixture(scope="module")
def model():
    from core.iface.motion_unit import MotionUnits
    from core.tracking.face_model import FaceModel

    learned = bent_markers(np.random.default_rng(3).normal(size=(200, 3)) * 3.0)
    return FaceModel.of(sheet_markers(), MotionUnits.fit({"neutral": learned}, 0.9999))


@pytest.fixture
def window(qtbot, qapp, settings_folder, film, model, monkeypatch):
    """The window with the film open, and the sheet's units in place of the demo's."""
    from app.authoring import Authoring
    from app.panels.tracking import draft as draft_module
    from app.panels.tracking.window import TrackingWindow
    from app.theme import apply_theme

    monkeypatch.setattr(draft_module, "learn_model", lambda request, progress: model)
    apply_theme(qapp)
    authoring = Authoring(None)
    made = TrackingWindow(authoring)
    made.resize(1000, 700)
    with qtbot.waitExposed(made):
        made.show()
    with qtbot.waitActive(made):
        made.activateWindow()
    made.open_video(film)
    qtbot.waitUntil(lambda: made.draft.model is not None and made.canvas.has_picture, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: made.jobs.is_idle, timeout=WAIT_MS)
    yield made
    made.shut_down()
    authoring.shut_down()
    made.deleteLater()
    qapp.processEvents()


def _click(window, place):
    QTest.mouseClick(window.canvas, _LEFT, pos=window.canvas.at(*place).toPoint())


def _drag(window, place, by):
    start = window.canvas.at(*place).toPoint()
    QTest.mousePress(window.canvas, _LEFT, pos=start)
    for share in (0.3, 0.7, 1.0):
        QTest.mouseMove(window.canvas, start + QPoint(round(share * by[0]), round(share * by[1])))
    QTest.mouseRelease(window.canvas, _LEFT, pos=start + QPoint(*by))


def _settle(window, qtbot):
    qtbot.waitUntil(lambda: window.jobs.is_idle, timeout=WAIT_MS)


@pytest.fixture
def clicked(window, model):
    """The same, clicked; each pair in the other order than is asked for, which does not matter."""
    for place in clicks_on(model).values():
        _click(window, place)
    return window


@pytest.fixture
def tracked(clicked, qtbot):
    QTest.mouseClick(clicked.track_button, _LEFT)
    qtbot.waitUntil(lambda: clicked.draft.track is not None, timeout=WAIT_MS)
    _settle(clicked, qtbot)
    return clicked


def test_each_click_is_asked_for_by_word_and_picture(window, model):
    said, ringed = [], []
    places = clicks_on(model)
    for name in CLICKED:
        said.append(window.what.text())
        ringed.append(window.guide.asked)
        assert not window.track_button.isEnabled()
        _click(window, places[name])
    assert ringed == list(CLICKED)
    assert len(set(said)) == 4
    assert window.guide.asked is None
    assert window.track_button.isEnabled()
    np.testing.assert_allclose(window.draft.laid[:4], list(places.values()), atol=1.0)


def test_undo_takes_one_click_back(clicked):
    QTest.keyClick(clicked, Qt.Key.Key_Z, _CTRL)
    assert len(clicked.draft.start.clicks) == 3
    assert clicked.draft.laid is None
    QTest.keyClick(clicked, Qt.Key.Key_Z, _CTRL | Qt.KeyboardModifier.ShiftModifier)
    assert clicked.draft.laid is not None


def test_a_ring_that_is_dragged_moves_all_points(clicked):
    before = clicked.draft.laid.copy()
    x, y = clicked.draft.start.clicks["outer_eye_left"]
    rim = clicked.canvas.at(x, y).toPoint() + QPoint(9, 0)
    QTest.mousePress(clicked.canvas, _LEFT, pos=rim)
    QTest.mouseMove(clicked.canvas, rim + QPoint(20, -10))
    QTest.mouseRelease(clicked.canvas, _LEFT, pos=rim + QPoint(20, -10))
    assert np.linalg.norm(clicked.draft.laid - before, axis=1).max() > 2.0
    assert clicked.draft.undo_stack.undoText() == "Move a click"


def test_tracking_shows_where_the_face_was_lost(tracked, qtbot):
    track = tracked.draft.track
    assert np.flatnonzero(track.lost).tolist() == [8, 9]
    assert "2 lost" in tracked.state.text()
    QTest.keyClick(tracked, Qt.Key.Key_F8)
    assert tracked.frame == 8
    assert "lost" in tracked.here.text()
    picture = tracked.strip.grab().toImage()
    column = round(tracked.strip._x(8.5))
    red = picture.pixelColor(column - 3, picture.height() - 10)
    assert red.red() > red.green() + 60
    QTest.mouseClick(tracked.strip, _LEFT, pos=QPoint(round(tracked.strip._x(3.5)), 30))
    assert tracked.frame == 3
    _settle(tracked, qtbot)


def test_a_drag_corrects_from_there_on(tracked, qtbot):
    before = tracked.draft.track
    QTest.keyClick(tracked, Qt.Key.Key_Home)
    for _ in range(5):
        QTest.keyClick(tracked, Qt.Key.Key_Right)
    assert tracked.frame == 5
    row = before.request.model.names.index("m3")
    _drag(tracked, before.points[5, row], (16, -12))
    qtbot.waitUntil(lambda: tracked.draft.track is not before, timeout=WAIT_MS)
    after = tracked.draft.track
    np.testing.assert_array_equal(after.points[:5], before.points[:5])
    moved = np.linalg.norm(after.points[5:, row] - before.points[5:, row], axis=1)
    assert moved[0] == pytest.approx(20 / (tracked.canvas._frame().width() / 320), abs=1.0)
    assert moved.min() > 0.6 * moved[0]
    assert tracked.strip._corrected == (5,)
    # taken back, the button offers to track on from there
    QTest.keyClick(tracked, Qt.Key.Key_Z, _CTRL)
    assert tracked.track_button.isEnabled()
    assert "5" in tracked.track_button.text()
    QTest.keyClick(tracked, Qt.Key.Key_Return, _CTRL)
    qtbot.waitUntil(lambda: tracked.draft.track is not after, timeout=WAIT_MS)
    np.testing.assert_array_equal(tracked.draft.track.points, before.points)


def test_a_press_without_a_drag_changes_nothing(tracked):
    _click(tracked, tracked.draft.track.points[0, 10])
    assert not tracked.draft.start.corrections


def test_keys_choose_and_move_a_point(tracked, qtbot):
    QTest.keyClick(tracked, Qt.Key.Key_Right)
    QTest.keyClick(tracked, Qt.Key.Key_BracketRight)
    name = tracked.canvas.chosen
    place = tracked.draft.points(1)[tracked.draft.model.names.index(name)]
    QTest.keyClick(tracked, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    np.testing.assert_allclose(tracked.draft.start.corrections[1][name], place - [0, 1], atol=1e-6)
    _settle(tracked, qtbot)


def test_the_wheel_goes_closer_to_what_is_under_the_pointer(window):
    canvas, place = window.canvas, (200.0, 90.0)
    at = canvas.at(*place)
    before = canvas.at(1, 0).x() - canvas.at(0, 0).x()
    for _ in range(3):
        canvas.wheelEvent(QWheelEvent(at, canvas.mapToGlobal(at), QPoint(), QPoint(0, 120), Qt.MouseButton.NoButton,
                                      Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False))  # fmt: skip
    np.testing.assert_allclose(canvas.place(at), place, atol=0.5)
    assert canvas.at(1, 0).x() - canvas.at(0, 0).x() == pytest.approx(1.25**3 * before)


def test_cancelling_keeps_what_was_there(clicked, qtbot):
    clicked.on_track()
    QTest.mouseClick(clicked.status.cancel_button, _LEFT)
    _settle(clicked, qtbot)
    assert clicked.draft.track is None
    assert clicked.track_button.isEnabled()


def test_capture_and_clicks_are_saved_and_offered_to_the_import(tracked, choose, tmp_path, qtbot):
    asked = []
    tracked.import_asked.connect(asked.append)
    assert tracked.has_unsaved_track
    assert not tracked.import_button.isEnabled()
    choose(tmp_path / "take.c3d", tmp_path / "start.json")
    QTest.mouseClick(tracked.save_button, _LEFT)
    qtbot.waitUntil(lambda: not tracked.has_unsaved_track, timeout=WAIT_MS)
    QTest.mouseClick(tracked.save_start_button, _LEFT)
    positions, names, rate_hz = read_motion(tmp_path / "take.c3d")
    assert (positions.shape, rate_hz) == ((14, 40, 3), pytest.approx(25.0))
    assert names == tracked.draft.model.names
    assert read_start(tmp_path / "start.json").clicks.keys() == set(CLICKED)
    QTest.mouseClick(tracked.import_button, _LEFT)
    assert asked == [[tmp_path / "take.c3d"]]


def test_a_file_that_is_no_film_is_one_sentence_and_the_old_film_stays(tracked, tmp_path, qtbot):
    (tmp_path / "no.mp4").write_text("no film")
    before = tracked.draft.track
    tracked.open_video(tmp_path / "no.mp4")
    qtbot.waitUntil(lambda: "no.mp4" in tracked.message.text, timeout=WAIT_MS)
    assert tracked.draft.track is before


def test_playing_goes_through_all_pictures(tracked, qtbot):
    QTest.keyClick(tracked, Qt.Key.Key_Home)
    seen = []
    tracked.strip.show_frame, show = (lambda f: (seen.append(f), show(f))), tracked.strip.show_frame
    QTest.keyClick(tracked, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: tracked.frame == 13 and not tracked._clock.isActive(), timeout=WAIT_MS)
    assert all(b - a == 1 for a, b in pairwise(dict.fromkeys(seen)))
    _settle(tracked, qtbot)
