"""Two hundred things that an animator does, by mouse and keys, for the watchdog to watch."""

from __future__ import annotations

import random
import time
from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QEventLoop, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.watchdog import Watchdog
from app.window import MainWindow

_LEFT = Qt.MouseButton.LeftButton
_CTRL, _SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
_SEED = 6
_MOVE_MS, _GLANCE_MS, _LOOK_MS = 16, 60, 500
_LONGEST_HOVER_MS = 1000
# by then a dialog that nobody closes is in the way
_STUCK_MS = 30_000

# what, how often, and how long the animator looks at it afterwards
ACTIONS = {
    "hover the map": (60, _GLANCE_MS), "select a phoneme": (20, _GLANCE_MS), "step a frame": (20, _GLANCE_MS),
    "undo": (14, _LOOK_MS), "redo": (8, _LOOK_MS), "scrub": (10, _GLANCE_MS), "pin": (8, _LOOK_MS),
    "paint an emotion": (8, _LOOK_MS), "orbit the face": (8, _GLANCE_MS), "zoom the timeline": (8, _GLANCE_MS),
    "zoom the map": (6, _GLANCE_MS), "another style": (5, _GLANCE_MS), "colour the map": (4, _LOOK_MS),
    "other splats": (3, _LOOK_MS), "play or pause": (4, _LOOK_MS), "drag a boundary": (3, _LOOK_MS),
    "next suspect": (3, _LOOK_MS), "PCA map": (2, _LOOK_MS), "spectrogram": (2, _LOOK_MS), "plot": (2, _LOOK_MS),
    "commands": (1, _LOOK_MS), "export dialog": (1, _LOOK_MS),
}  # fmt: skip


def script() -> list[str]:
    """Return all actions in the order in which they are done, the same each time."""
    actions = [action for action, (count, _) in ACTIONS.items() for _ in range(count)]
    random.Random(_SEED).shuffle(actions)
    return actions


def pause(milliseconds: int) -> None:
    """Let the window live for a while."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


class ScriptedAnimator:
    """Does the script in a window that shows a sentence and its motion.

    hover_s : how long each hover took from the move of the mouse to the picture of the face
    stuck : actions that did not come to an end by themselves
    """

    def __init__(self, window: MainWindow, watchdog: Watchdog) -> None:
        self.window, self.watchdog = window, watchdog
        self.hover_s: list[float] = []
        self.stuck: list[str] = []
        self._random = random.Random(_SEED)
        self._do: dict[str, Callable[[], None]] = {
            "hover the map": self.hover, "select a phoneme": self.select, "step a frame": self.step,
            "undo": lambda: self._key(Qt.Key.Key_Z, _CTRL), "redo": lambda: self._key(Qt.Key.Key_Z, _CTRL | _SHIFT),
            "scrub": self.scrub, "pin": self.pin, "paint an emotion": self.paint, "orbit the face": self.orbit,
            "zoom the timeline": lambda: self._wheel(window.timeline),
            "zoom the map": lambda: self._wheel(window.isomap.canvas.viewport()),
            "another style": lambda: self._click(self._random.choice(window.motion.style.group.buttons())),
            "colour the map": self.colour, "other splats": self.splats,
            "play or pause": lambda: self._key(Qt.Key.Key_Space), "drag a boundary": self.drag_boundary,
            "next suspect": lambda: self._key(Qt.Key.Key_F8), "PCA map": lambda: self._click(window.isomap.pca_button),
            "spectrogram": lambda: self._click(window.timeline_pane.bar.spectrogram),
            "plot": lambda: self._click(window.motion.plot_button), "commands": self.commands,
            "export dialog": self.export_dialog,
        }  # fmt: skip

    def perform(self, actions: list[str], begins: Callable[[int, str], None] = lambda _i, _action: None) -> None:
        """Do ``actions``, one after the other; ``begins`` hears the number and name of each."""
        for i, action in enumerate(actions):
            begins(i, action)
            self.watchdog.action = action
            stuck = QTimer(singleShot=True, interval=_STUCK_MS)
            stuck.timeout.connect(self._end_stuck)
            stuck.start()
            self._do[action]()
            pause(ACTIONS[action][1])
            stuck.stop()

    def _end_stuck(self) -> None:
        """Close the dialog that keeps an action from its end."""
        self.stuck.append(self.watchdog.action)
        dialog = QApplication.activeModalWidget() or QApplication.activePopupWidget()
        if dialog is not None:
            dialog.close()

    # What is done

    def hover(self) -> None:
        """Point at the map and wait for the face."""
        shown = self.window.isomap.view.shown
        place = shown.points[self._random.randrange(len(shown.points))]
        view, swapped = self.window.preview.face_view, []
        before = self.window.preview.pick

        def on_swapped() -> None:
            if self.window.preview.pick is not before:
                swapped.append(time.perf_counter())
                loop.quit()

        loop = QEventLoop()
        view.frameSwapped.connect(on_swapped)
        QTimer.singleShot(_LONGEST_HOVER_MS, loop, loop.quit)
        began_s = time.perf_counter()
        QTest.mouseMove(self.window.isomap.canvas.viewport(), self._on_map(place))
        if not swapped:
            loop.exec()
        view.frameSwapped.disconnect(on_swapped)
        if swapped:
            self.hover_s.append(swapped[0] - began_s)

    def select(self) -> None:
        """Click a phoneme that has a map."""
        maps = self.window.authoring.document.database.maps
        slots = [slot for slot, utterance in enumerate(self._phonemes) if utterance.phone in maps]
        self._click(self.window.timeline, self._middle(self._random.choice(slots), "phonemes"))

    def step(self) -> None:
        """Press an arrow."""
        self._key(self._random.choice((Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Right)))

    def scrub(self) -> None:
        """Drag the playhead."""
        slots = self._random.sample(range(len(self._phonemes)), 2)
        self._drag(self.window.timeline, *(self._middle(slot, "wave") for slot in slots), moves=12)

    def pin(self) -> None:
        """Double click a node of the map."""
        shown = self.window.isomap.view.shown
        at = self._on_map(shown.points[self._random.randrange(len(shown.points))])
        canvas = self.window.isomap.canvas.viewport()
        self._click(canvas, at)
        QTest.mouseDClick(canvas, _LEFT, pos=at)

    def paint(self) -> None:
        """Paint over some phonemes."""
        first = self._random.randrange(len(self._phonemes) - 6)
        self._key(self._random.choice((Qt.Key.Key_1, Qt.Key.Key_2, Qt.Key.Key_3, Qt.Key.Key_4)))
        self._drag(self.window.timeline, self._middle(first, "emotion"), self._middle(first + 5, "emotion"))

    def orbit(self) -> None:
        """Turn a face."""
        view = self._random.choice((self.window.motion.face_view, self.window.preview.face_view))
        middle = view.rect().center()
        self._drag(view, middle, middle + QPoint(self._random.randrange(-80, 80), 10), moves=10)

    def colour(self) -> None:
        """Colour the map by something else."""
        combo = self.window.isomap.controls.colour
        QTest.keyClick(combo, Qt.Key.Key_Down if combo.currentIndex() + 1 < combo.count() else Qt.Key.Key_Home)
        combo.activated.emit(combo.currentIndex())

    def splats(self) -> None:
        """Move a slider of the splat image."""
        slider = self._random.choice((self.window.isomap.controls.sigma, self.window.isomap.controls.rho))
        for _ in range(4):
            QTest.keyClick(slider, self._random.choice((Qt.Key.Key_Left, Qt.Key.Key_Right)))
            pause(_MOVE_MS)

    def drag_boundary(self) -> None:
        """Move the end of a phoneme a little."""
        slot = self._random.randrange(3, len(self._phonemes) - 3)
        area, scale = self.window.timeline.lanes()["phonemes"], self.window.timeline.scale
        edge = QPoint(round(scale.x(self._phonemes[slot].end_s)), round(area.center().y()))
        self._drag(self.window.timeline, edge, edge + QPoint(6, 0))

    def commands(self) -> None:
        """Look a command up and think better of it."""
        self._key(Qt.Key.Key_K, _CTRL)
        pause(_GLANCE_MS)
        QTest.keyClicks(QApplication.focusWidget() or self.window, "exp")
        pause(_GLANCE_MS)
        QTest.keyClick(QApplication.focusWidget() or self.window, Qt.Key.Key_Escape)

    def export_dialog(self) -> None:
        """Open and close it."""
        self._key(Qt.Key.Key_E, _CTRL)
        pause(_LOOK_MS)
        self.window.export_dialog.close()

    # How

    @property
    def _phonemes(self) -> tuple:
        return self.window.authoring.document.speech.transcript.phonemes

    def _middle(self, slot: int, lane: str) -> QPoint:
        timeline, utterance = self.window.timeline, self._phonemes[slot]
        x = timeline.scale.x((utterance.start_s + utterance.end_s) / 2)
        area = timeline.time_area()
        return QPoint(round(min(max(x, area.left() + 2), area.right() - 2)), round(timeline.lanes()[lane].center().y()))

    def _on_map(self, place: np.ndarray) -> QPoint:
        view = self.window.isomap.view
        at = view.canvas.mapFromScene(view.box.mapViewToScene(QPointF(*map(float, place))))
        area = view.canvas.viewport().rect().adjusted(2, 2, -2, -2)
        return QPoint(min(max(at.x(), area.left()), area.right()), min(max(at.y(), area.top()), area.bottom()))

    def _key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        QTest.keyClick(self.window.timeline, key, modifiers)

    def _click(self, widget: QWidget, at: QPoint | None = None) -> None:
        QTest.mouseClick(widget, _LEFT, pos=widget.rect().center() if at is None else at)

    def _drag(self, widget: QWidget, start: QPoint, end: QPoint, moves: int = 5) -> None:
        QTest.mousePress(widget, _LEFT, pos=start)
        for share in np.linspace(1 / moves, 1.0, moves):
            QTest.mouseMove(widget, start + (end - start) * float(share))
            pause(_MOVE_MS)
        QTest.mouseRelease(widget, _LEFT, pos=end)

    def _wheel(self, widget: QWidget) -> None:
        at = QPointF(widget.rect().center())
        turn = QPoint(0, self._random.choice((-120, 120)))
        event = QWheelEvent(
            at, QPointF(widget.mapToGlobal(at.toPoint())), QPoint(), turn, Qt.MouseButton.NoButton,
            _CTRL if widget is self.window.timeline else Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase,
            False,
        )  # fmt: skip
        QApplication.sendEvent(widget, event)
