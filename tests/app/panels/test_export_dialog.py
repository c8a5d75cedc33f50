"""Exporting from the window writes what the dialog says, and remembers it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.panels.export_dialog import ExportDialog
from core.media.video import probe

LEFT = Qt.MouseButton.LeftButton
WAIT_MS = 60_000


@pytest.fixture
def dialog(animated) -> ExportDialog:
    QTest.keyClick(animated, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    assert animated.export_dialog.isVisible()
    return animated.export_dialog


def test_the_selected_part_is_written_at_the_size_that_was_asked_for(dialog, animated, tmp_path, qtbot):
    animated.authoring.select_slot(2)
    dialog.open_for()
    QTest.mouseClick(dialog.span.button("selected"), LEFT)
    dialog.size.setCurrentText("320x240")
    dialog.path.setText(str(tmp_path / "part.avi"))
    QTest.mouseClick(dialog.export_button, LEFT)
    qtbot.waitUntil(lambda: not animated.authoring.jobs.is_running("export"), timeout=WAIT_MS)
    facts = probe(tmp_path / "part.avi")
    chosen = animated.authoring.document.speech.transcript.phonemes[2]
    assert (facts.width, facts.height) == (320, 240)
    assert facts.video_duration_s == pytest.approx(chosen.end_s - chosen.start_s, abs=1 / 30)
    again = ExportDialog(animated.authoring, animated.settings)
    qtbot.addWidget(again)
    assert again.size.currentText() == "320x240"
    assert again.path.text() == dialog.path.text()


def test_another_form_changes_the_name_and_what_can_be_asked(dialog):
    dialog.kind.setCurrentIndex(dialog.kind.findData(".c3d"))
    assert dialog.path.text().endswith(".c3d")
    assert not dialog.size.isEnabled()


def test_what_cannot_be_written_is_said_in_the_dialog(dialog, tmp_path):
    dialog.path.setText(str(tmp_path / "no folder" / "x.avi"))
    QTest.mouseClick(dialog.export_button, LEFT)
    assert dialog.isVisible()
    assert "no folder" in dialog.message.text()
    dialog.path.setText(str(tmp_path / "x.avi"))
    dialog.size.setCurrentText("huge")
    QTest.mouseClick(dialog.export_button, LEFT)
    assert "huge" in dialog.message.text()
