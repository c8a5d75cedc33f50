"""The plot shows displacement and velocity as anybody would work them out."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.panels.marker_plot import trajectory
from core.motion.marker_set import MarkerSet
from core.synthesis.marker_motion import MarkerMotion


def test_a_marker_on_a_parabola_has_a_straight_velocity():
    rest = np.array([[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]])
    times_s = np.arange(100) / 50.0
    positions = np.repeat(rest[None], 100, axis=0)
    positions[:, 0, 1] += 4.0 * times_s**2
    motion = MarkerMotion(positions, 50.0, MarkerSet(("a", "b"), rest))
    place_mm, speed = trajectory(motion, 0, 1)
    assert place_mm == pytest.approx(4.0 * times_s**2)
    assert speed[1:-1] == pytest.approx(8.0 * times_s[1:-1])
    assert not trajectory(motion, 1, 1)[1].any()


def test_the_plot_opens_with_the_lower_lip_and_follows_the_playhead(animated):
    QTest.mouseClick(animated.motion.plot_button, Qt.MouseButton.LeftButton)
    plot = animated.motion.plot
    assert plot.isVisible()
    markers = animated.authoring.document.database.markers
    lip = markers.landmark("lower_lip")
    assert plot.marker.currentIndex() == (0 if lip is None else lip)
    times_s, place_mm = plot._synthesised_curves[0].getData()
    assert len(times_s) == len(animated.motion.motion.positions)
    assert place_mm == pytest.approx(trajectory(animated.motion.motion, plot.marker.currentIndex(), 1)[0])
    animated.authoring.seek(0.4)
    assert plot._playheads[0].value() == pytest.approx(0.4)


def test_a_captured_sentence_is_shown_beside_its_synthesis(animated, qtbot):
    database = animated.authoring.document.database
    sentence = database.sentences[0]
    assert not animated.motion.captured_button.isEnabled()
    from core.document.edits import SetSpeech
    from core.document.parts import Speech
    from core.media.audio import Audio

    silence = Audio(np.zeros(round(16_000 * sentence.transcript.duration_s), np.float32), 16_000)
    speech = Speech(silence, sentence.transcript, sentence.text)
    animated.authoring.push(SetSpeech.on(animated.authoring.document, speech))
    qtbot.waitUntil(lambda: animated.motion.captured is not None, timeout=20_000)
    assert animated.motion.captured_button.isEnabled()
    captured = database.pca.positions(database.frames[sentence.start_frame : sentence.stop_frame].astype(float))
    assert animated.motion.captured.positions == pytest.approx(captured, abs=1e-3)
