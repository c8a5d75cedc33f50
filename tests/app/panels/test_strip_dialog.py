"""A film strip from the window, by its buttons."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.panels import strip_work
from app.texts import strips as texts
from core.media.picture import read_picture

WAIT_MS = 20_000


def click(widget):
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=widget.rect().center())


def check(box):
    box.click()


@pytest.fixture
def here(monkeypatch):
    """Draw in this process."""
    monkeypatch.setattr(strip_work, "run_apart", lambda work, given, progress, died: work(*given, progress))


def test_a_strip_is_asked_for_and_written(animated, here, tmp_path, qtbot):
    window = animated
    window.actions.by_name["strip"].trigger()
    dialog = window.strip_dialog
    assert dialog.isVisible() and dialog.export_button.isEnabled()
    check(dialog.rows["anger"])
    dialog.size.setCurrentText("64x80")
    dialog.when.choose(texts.CHOSEN[0])
    window.authoring.seek(0.25)
    click(dialog.add_button)
    QTest.keyClicks(dialog.times, ", 0.6")
    dialog.path.setText(str(tmp_path / "strip.png"))
    click(dialog.export_button)
    qtbot.waitUntil(lambda: "strip.png" in window.status.note, timeout=WAIT_MS)
    height, width, _ = read_picture(tmp_path / "strip.png").shape
    assert 2 * 64 < width < 3 * 64 + 160 and 2 * 80 < height < 3 * 80

    # what cannot be is told in the dialog, and nothing begins
    dialog.open_for()
    for field, text, sentence in (
        (dialog.times, "0.2 9", "9 s lies outside"), (dialog.times, "soon", "'soon' is no moment"),
        (dialog.path, str(tmp_path / "strip.jpg"), "no .png"),
    ):  # fmt: skip
        before = field.text()
        field.setText(text)
        click(dialog.export_button)
        assert sentence in dialog.message.text() and dialog.isVisible()
        field.setText(before)
    for box in dialog.rows.values():
        box.setChecked(False)
    click(dialog.export_button)
    assert dialog.message.text() == texts.NEEDS_ROW
    check(dialog.rows[texts.CAPTURE])
    click(dialog.export_button)
    qtbot.waitUntil(lambda: "no capture of these words" in window.message.text, timeout=WAIT_MS)


def test_without_motion_it_says_what_is_missing(open_window):
    window = open_window()
    window.actions.by_name["strip"].trigger()
    assert window.strip_dialog.message.text() == texts.NEEDS_MOTION
    assert not window.strip_dialog.export_button.isEnabled()
