"""Menus and their dialogs, by real clicks and keys: recent projects, versions, first frame, theme, focus."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QInputDialog, QLineEdit, QMenu

from app.emotion_colours import OKABE_ITO, PAPER, emotion_colours
from app.project_jobs import is_unnamed
from app.theme import DARK, LIGHT, theme

WAIT_MS = 20_000
LEFT = Qt.MouseButton.LeftButton


def click_in(menu: QMenu, text: str) -> None:
    """Open a menu of the bar, or of another menu, and click the entry that begins with ``text``."""
    menu.popup(menu.parentWidget().mapToGlobal(menu.parentWidget().rect().center()))
    action = next(a for a in menu.actions() if a.text().replace("&", "").startswith(text))
    QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(action).center())


def answer_dialog(qtbot, typed: str) -> None:
    """Type into the next dialog and press Return, while it is open."""

    def answer() -> None:
        dialog = QApplication.activeModalWidget()
        if not isinstance(dialog, QInputDialog):
            QTimer.singleShot(20, answer)
            return
        field = dialog.findChild(QLineEdit)
        field.selectAll()
        QTest.keyClicks(field, typed)
        QTest.keyClick(field, Qt.Key.Key_Return)

    QTimer.singleShot(0, answer)


def test_a_recent_project_is_opened_from_its_menu(open_window, qtbot, choose, tmp_path):
    window = open_window()
    window.keeper.new()
    choose(tmp_path / "first.efase")
    click_in(window.project_menu.recent.parentWidget(), "Save a copy")
    qtbot.waitUntil(lambda: window.keeper.name == "first", timeout=WAIT_MS)
    QTest.keyClick(window, Qt.Key.Key_N, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: window.keeper.file is not None and is_unnamed(window.keeper.file.path), timeout=WAIT_MS)
    click_in(window.project_menu.recent, "first")
    qtbot.waitUntil(lambda: window.keeper.name == "first", timeout=WAIT_MS)


def test_versions_are_kept_switched_and_forgotten_from_their_menu(animated, qtbot):
    window, document = animated, animated.authoring.document
    window.keeper.new()
    kept = window.project_menu.kept
    answer_dialog(qtbot, "calm")
    click_in(kept, "Keep")
    assert window.versions.names() == ["calm"]
    window.authoring.set_frame_rate("25")
    click_in(kept, "Switch to “calm”")
    assert document.output.frame_rate == "30"
    kept.aboutToShow.emit()
    forget = next(a.menu() for a in kept.actions() if a.menu() is not None)
    click_in(forget, "calm")
    assert window.versions.names() == []


def test_the_first_frame_is_asked_for_set_and_undone(animated, qtbot):
    authoring = animated.authoring
    answer_dialog(qtbot, "86400")
    animated.actions.by_name["start_frame"].trigger()
    assert authoring.document.output.start_frame == 86400 == animated.timeline.ruler.first_frame
    assert "86400" in authoring.undo_stack.undoText()
    authoring.undo_stack.undo()
    assert authoring.document.output.start_frame == 0


@pytest.fixture
def dark_again(qapp):
    yield
    from app.theme import apply_theme

    emotion_colours.choose(PAPER)
    apply_theme(qapp, "dark")
    emotion_colours.put_on()


def test_another_theme_dresses_the_window_at_once(animated, dark_again):
    def ground(widget, x=3, y=3):
        return widget.grab().toImage().pixelColor(x, y).lightness()

    widgets = (animated.control, animated.timeline, animated.isomap.canvas, animated.motion.plot)
    assert all(ground(widget) < 80 for widget in widgets)
    play = animated.motion.transport.play_button
    before = play.icon().pixmap(16).toImage()
    animated.on_theme("light")
    assert theme().ground == LIGHT.ground
    assert all(ground(widget) > 180 for widget in widgets)
    assert play.icon().pixmap(16).toImage() != before
    assert animated.isomap.view.in_use.opts["pen"].color().name() == LIGHT.accent
    animated.on_theme("dark")
    assert all(ground(widget) < 80 for widget in widgets) and theme().ground == DARK.ground


def test_the_emotions_of_the_control_panel_follow_the_palette_at_once(animated, dark_again):
    def colours(icon):
        image = icon.pixmap(20).toImage()
        return {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(image.height())}

    chosen, brush = animated.control.emotion.chosen, animated.timeline_pane.bar.brush
    assert DARK.emotion["anger"] in colours(chosen.itemIcon(2)) & colours(brush.button("anger").icon())
    emotion_colours.choose(OKABE_ITO)
    assert theme().emotion["anger"] != DARK.emotion["anger"]
    assert theme().emotion["anger"] in colours(chosen.itemIcon(2)) & colours(brush.button("anger").icon())


def test_the_canvas_that_takes_the_keys_has_a_ring_around_it(animated, qtbot):
    canvases = [animated.timeline, animated.isomap.canvas, animated.motion.face_view, animated.preview.face_view]
    for canvas in canvases:
        canvas.setFocus()
        qtbot.waitUntil(canvas.hasFocus, timeout=WAIT_MS)
        assert [other.focus_ring.isVisible() for other in canvases] == [other is canvas for other in canvases]
        assert canvas.focus_ring.size() == canvas.size()
    QTest.mouseClick(animated.isomap.canvas.viewport(), LEFT, pos=animated.isomap.canvas.rect().center())
    assert animated.isomap.canvas.focus_ring.isVisible()  # the ring leaves clicks to what is below
