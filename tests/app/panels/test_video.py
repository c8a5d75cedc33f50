"""The video pane follows the one playhead, whichever film it shows."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from core.media.video import FRAME_RATES, write_video

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 20_000


@pytest.fixture
def actor(tmp_path):
    """A film that is 20 shades brighter each tenth of a second, 25 pictures a second."""
    path = tmp_path / "actor.avi"
    shades = (np.full((48, 64, 3), 10 + 8 * (k // 2), np.uint8) for k in range(50))
    write_video(path, shades, 50, FRAME_RATES["25"], None)
    return path


def shade(window) -> int:
    image = window.video.video_view._image
    return image.pixelColor(image.width() // 2, image.height() // 2).red()


def shows(window, time_s):
    return lambda: abs(shade(window) - (10 + 8 * int(25 * time_s / 2 + 1e-6))) <= 3


def test_the_film_of_the_actor_goes_with_the_playhead_at_its_offset(animated, choose, actor, qtbot):
    QTest.mouseClick(animated.video.source.button("reference"), LEFT)
    assert animated.video.is_empty
    assert "actor" in animated.video.empty_text
    choose(actor)
    QTest.mouseClick(animated.video.open_button, LEFT)
    qtbot.waitUntil(lambda: animated.video.video_view.has_frame, timeout=WAIT_MS)
    for time_s in (0.8, 0.2, 0.5):
        animated.authoring.seek(time_s)
        qtbot.waitUntil(shows(animated, time_s), timeout=WAIT_MS)
    animated.video.offset.setValue(0.4)
    assert animated.authoring.document.reference_video.offset_s == 0.4
    qtbot.waitUntil(shows(animated, 0.9), timeout=WAIT_MS)
    QTest.keyClick(animated, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(shows(animated, 0.5), timeout=WAIT_MS)
    QTest.keyClick(animated, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert animated.authoring.document.reference_video is None
    assert animated.video.source.key == "composed"


def test_a_film_that_cannot_be_read_is_said_in_the_pane(animated, choose, tmp_path, qtbot):
    broken = tmp_path / "broken.mp4"
    broken.write_bytes(b"no film")
    QTest.mouseClick(animated.video.source.button("reference"), LEFT)
    choose(broken)
    QTest.mouseClick(animated.video.open_button, LEFT)
    qtbot.waitUntil(lambda: "broken.mp4" in animated.video.empty_text, timeout=WAIT_MS)


def test_both_panes_have_one_transport(animated, qtbot):
    qtbot.waitUntil(lambda: animated.authoring.film.path is not None, timeout=WAIT_MS)
    animated.video.transport.seek_asked.emit(0.3)
    assert animated.authoring.view.playhead_s == pytest.approx(0.3)
    assert animated.motion.transport.time.text() == animated.video.transport.time.text()
