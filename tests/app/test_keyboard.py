"""Whoever has no mouse reaches every pane and every control."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QWidget,
)

CONTROLS = (QAbstractButton, QComboBox, QLineEdit, QPlainTextEdit, QAbstractSlider)
MOST = 200


def reached_by_tab(window) -> set:
    window.timeline.setFocus()
    reached = set()
    for _ in range(MOST):
        focused = QApplication.focusWidget()
        if focused in reached:
            break
        reached.add(focused)
        QTest.keyClick(focused, Qt.Key.Key_Tab)
    return reached


def usable(window):
    """Controls that can be seen and used now; scroll bars and the insides of other controls follow those."""
    for control in window.findChildren(QWidget):
        if not isinstance(control, CONTROLS):
            continue
        inside = isinstance(control.parentWidget(), CONTROLS) or "qt_" in control.objectName()
        is_bar = type(control).__name__ == "QScrollBar"
        if control.isVisible() and control.isEnabled() and not inside and not is_bar:
            yield control


def test_tab_reaches_every_pane_and_every_control(animated):
    reached = reached_by_tab(animated)
    missed = []
    for control in usable(animated):
        # in a group of which one is chosen Tab stops at one, and arrows go on from there
        group = control.group() if isinstance(control, QAbstractButton) else None
        alike = [control] if group is None else group.buttons()
        if not any(one in reached for one in alike):
            missed.append(control.toolTip() or getattr(control, "text", str)() or type(control).__name__)
    assert missed == []
    for pane in (animated.timeline, animated.isomap.canvas, animated.motion.face_view, animated.preview.face_view):
        assert pane in reached


def test_shift_and_arrows_turn_the_face_that_has_the_focus(animated):
    view = animated.motion.face_view
    view.setFocus()
    before = view.camera
    QTest.keyClick(view, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert view.camera.azimuth_deg == before.azimuth_deg + 5
    QTest.keyClick(view, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    assert view.camera == before
    assert animated.preview.face_view.camera.azimuth_deg == 0
