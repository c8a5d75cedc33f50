"""The tracking window: the film with its points, what to do next beside it, and below how sure the tracker was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.authoring import Authoring
from app.panels.pane import ElidedLabel, label
from app.panels.tool_window import ToolWindow
from app.panels.tracking.canvas import ShownPoints, VideoCanvas
from app.panels.tracking.draft import TrackingDraft
from app.panels.tracking.guide import GuidePicture
from app.panels.tracking.trust_strip import UNSURE, TrustStrip
from app.panels.transport import Transport
from app.settings import last_folder, remember_folder
from app.texts import tracking as texts
from app.theme import STEP
from app.video_frames import VideoFrames
from core.document.change import Change
from core.speech.emotion import EMOTIONS
from core.tracking.capture import SUFFIXES
from core.tracking.face_model import ANY, CLICKED

_SIZE = (1240, 780)
_SIDE_PX = 264
_FOLDER = "video"


class TrackingWindow(ToolWindow):
    """Non-modal; it keeps its film and points while it is closed.

    import_asked(paths) : take these files into the import window
    """

    import_asked = Signal(list)

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.draft = TrackingDraft(self.jobs, self)
        self.frame = 0
        self._frames = VideoFrames(self.jobs, "picture", self)
        self._clock = QTimer(self)
        self._arrange()
        self._join()
        self.draft.use_database(authoring.document.database)
        self.refresh()

    def _arrange(self) -> None:
        self.canvas, self.strip, self.guide = VideoCanvas(), TrustStrip(), GuidePicture()
        self._empty = label(texts.EMPTY, "empty")
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._stack = QStackedWidget()
        for widget in (self._empty, self.canvas):
            self._stack.addWidget(widget)
        self.transport = Transport(texts.PLAY_TIP)
        self.here, self.unsure_button = ElidedLabel(), QToolButton(text=texts.UNSURE, toolTip=texts.UNSURE_TIP)
        said = QHBoxLayout()
        said.setContentsMargins(STEP + 4, 0, STEP + 4, 0)
        said.addWidget(label(texts.TRUST, "title", texts.STRIP_TIP))
        said.addSpacing(STEP)
        said.addWidget(self.here, 1)
        said.addWidget(self.unsure_button)
        below = QHBoxLayout()
        below.setContentsMargins(STEP, 0, STEP + 4, 0)
        below.addWidget(self.transport)
        left = QVBoxLayout()
        left.setSpacing(STEP // 2)
        left.addWidget(self._stack, 1)
        left.addLayout(below)
        left.addLayout(said)
        left.addWidget(self.strip)
        middle = QHBoxLayout()
        middle.setSpacing(0)
        middle.addLayout(left, 1)
        middle.addWidget(self._side())
        self.fill(middle)

    def _side(self) -> QWidget:
        """Lay out what is to be done, from top to bottom."""
        self.open_button = QPushButton(texts.OPEN, toolTip=texts.OPEN_TIP)
        self.name, self.facts = ElidedLabel(mode=Qt.TextElideMode.ElideMiddle), label()
        self.what = QLabel(wordWrap=True)
        self.what.setMinimumHeight(48)
        self.what.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.anew_button = QToolButton(text=texts.ANEW, toolTip=texts.ANEW_TIP)
        self.undo_button = QToolButton(text=texts.UNDO, toolTip=texts.UNDO_TIP)
        self.redo_button = QToolButton(text=texts.REDO, toolTip=texts.REDO_TIP)
        self.load_button = QToolButton(text=texts.LOAD, toolTip=texts.LOAD_TIP)
        self.save_start_button = QToolButton(text=texts.SAVE_START, toolTip=texts.SAVE_START_TIP)
        self.expression, self.units = QComboBox(toolTip=texts.EXPRESSION_TIP), ElidedLabel()
        for name in (ANY, *EMOTIONS):
            self.expression.addItem(texts.ANY if name == ANY else name, name)
        self.units.setToolTip(texts.UNITS_TIP)
        self.track_button = QPushButton(texts.TRACK, toolTip=texts.TRACK_TIP)
        self.track_button.setProperty("role", "primary")
        self.save_button = QPushButton(texts.SAVE, toolTip=texts.SAVE_TIP)
        self.import_button = QPushButton(texts.IMPORT, toolTip=texts.IMPORT_TIP)
        self.state = QLabel(wordWrap=True)
        self.state.setProperty("role", "small")
        side = QWidget()
        side.setFixedWidth(_SIDE_PX)
        column = QVBoxLayout(side)
        column.setContentsMargins(STEP + 4, STEP, STEP + 4, STEP)
        column.setSpacing(STEP)
        for widget in (label(texts.VIDEO, "title"), self.open_button, self.name, self.facts):
            column.addWidget(widget)
        column.addSpacing(STEP)
        column.addLayout(_row(label(texts.START, "title"), None, self.undo_button, self.redo_button))
        for widget in (self.guide, self.what):
            column.addWidget(widget)
        column.addLayout(_row(self.anew_button, None, self.load_button, self.save_start_button))
        column.addSpacing(STEP)
        for widget in (label(texts.UNITS, "title"), self.expression, self.units):
            column.addWidget(widget)
        column.addStretch(1)
        for widget in (self.state, self.track_button, self.save_button, self.import_button):
            column.addWidget(widget)
        return side

    def _join(self) -> None:
        draft, undo, canvas = self.draft, self.draft.undo_stack, self.canvas
        draft.changed.connect(self.refresh)
        draft.opened.connect(self.on_opened)
        draft.failed.connect(self.message.say)
        draft.noted.connect(self.status.say)
        undo.indexChanged.connect(lambda _: self.message.hide())  # what was wrong before the change is old
        for button, can, done in ((self.undo_button, undo.canUndoChanged, undo.undo),
                                  (self.redo_button, undo.canRedoChanged, undo.redo)):  # fmt: skip
            button.setEnabled(False)
            can.connect(button.setEnabled)
            button.clicked.connect(done)
        self._frames.arrived.connect(self.on_picture)
        self._frames.failed.connect(lambda why: self.message.say(why))
        self._clock.timeout.connect(self.on_tick)
        canvas.clicked.connect(draft.click)
        canvas.click_moved.connect(draft.move_click)
        canvas.point_moved.connect(lambda name, x, y: draft.correct(self.frame, name, x, y))
        canvas.pointed.connect(self.on_pointed)
        self.strip.picture_asked.connect(self.seek)
        self.transport.play_asked.connect(self.play_or_pause)
        self.transport.step_asked.connect(lambda by: self.seek(self.frame + by))
        self.transport.end_asked.connect(lambda is_end: self.seek(self.n_frames - 1 if is_end else 0))
        self.transport.seek_asked.connect(self.on_seek)
        self.expression.activated.connect(lambda _: draft.set_expression(self.expression.currentData()))
        for button, done in (
            (self.open_button, self.ask_open), (self.anew_button, draft.click_anew), (self.load_button, self.ask_load),
            (self.save_start_button, self.ask_save_start), (self.track_button, self.on_track),
            (self.save_button, self.ask_save), (self.import_button, self.on_import),
            (self.unsure_button, self.next_unsure),
        ):  # fmt: skip
            button.clicked.connect(done)
        self._add_keys()
        self.authoring.document.changed.connect(self.on_document_changed)
        self.jobs.started.connect(lambda *_: self._enable())
        self.jobs.ended.connect(lambda *_: self._enable())

    def _add_keys(self) -> None:
        canvas, undo = self.canvas, self.draft.undo_stack
        for key, done in {
            "Ctrl+O": self.ask_open, "Ctrl+S": self.ask_save, "Ctrl+Z": undo.undo, "Ctrl+Shift+Z": undo.redo,
            "Ctrl+Return": self.on_track, "Ctrl+W": self.close, "F8": self.next_unsure, "Space": self.play_or_pause,
            "Left": lambda: self.seek(self.frame - 1), "Right": lambda: self.seek(self.frame + 1),
            "Home": lambda: self.seek(0), "End": lambda: self.seek(self.n_frames - 1),
            "[": lambda: canvas.choose_next(-1), "]": lambda: canvas.choose_next(1),
            "Alt+Left": lambda: canvas.nudge(-1, 0), "Alt+Right": lambda: canvas.nudge(1, 0),
            "Alt+Up": lambda: canvas.nudge(0, -1), "Alt+Down": lambda: canvas.nudge(0, 1),
        }.items():  # fmt: skip
            QShortcut(QKeySequence(key), self, activated=done)

    @property
    def has_unsaved_track(self) -> bool:
        """Whether something was tracked that no capture holds."""
        return self.draft.has_unsaved_track

    # Time

    @property
    def n_frames(self) -> int:
        """Pictures that were tracked, or that the film promises."""
        if self.draft.track is not None:
            return len(self.draft.track.points)
        return 0 if self.draft.format is None else max(self.draft.format.n_frames, 1)

    @property
    def rate_hz(self) -> float:
        """Pictures a second."""
        return 25.0 if self.draft.format is None else self.draft.format.rate_hz

    def time_s(self, frame: int) -> float:
        """When a picture is shown, as the file says."""
        track = self.draft.track
        known = track is not None and frame < len(track.times_s)
        return float(track.times_s[frame]) if known else frame / self.rate_hz

    def seek(self, frame: int) -> None:
        """Show another picture."""
        self.frame = int(np.clip(frame, 0, max(self.n_frames - 1, 0)))
        if self.draft.video is not None:
            self._frames.ask(self.time_s(self.frame) + 1e-3)
        self._show_frame()

    def on_seek(self, time_s: float) -> None:
        """Follow the slider."""
        self.seek(int(time_s * self.rate_hz + 1e-3))

    def play_or_pause(self) -> None:
        """Play from here, or stop."""
        if self._clock.isActive() or not self.n_frames:
            self._clock.stop()
        else:
            if self.frame >= self.n_frames - 1:
                self.seek(0)
            self._clock.start(max(1, round(1000 / self.rate_hz)))
        self.transport.show_playing(self._clock.isActive())

    def on_tick(self) -> None:
        """Show the next picture."""
        if self.frame >= self.n_frames - 1:
            self._clock.stop()
            self.transport.show_playing(False)
        else:
            self.seek(self.frame + 1)

    def next_unsure(self) -> None:
        """Go to the next picture that wants a look, round and round."""
        track = self.draft.track
        poor = [] if track is None else np.flatnonzero((track.frame_trust < UNSURE) | track.lost).tolist()
        if not poor:
            self.status.say(texts.NO_UNSURE)
            return
        self.seek(next((f for f in poor if f > self.frame), poor[0]))

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Take the units of another database."""
        if change & Change.NODES:
            self.draft.use_database(self.authoring.document.database)

    def on_opened(self) -> None:
        """Show the first picture of another film."""
        form = self.draft.format
        self._clock.stop()
        self.transport.show_playing(False)
        self.canvas.show_film((form.width, form.height))
        self._frames.set_video(self.draft.video)
        self.seek(0)

    def on_picture(self, image) -> None:
        """Show a picture that was read."""
        self.canvas.show_picture(image)

    def on_track(self) -> None:
        """Track, with what was clicked."""
        self.message.hide()
        if not self.jobs.is_running("model"):
            self.draft.run()

    def on_import(self) -> None:
        """Hand the saved capture to the import window."""
        if self.draft.captures:
            self.import_asked.emit(list(self.draft.captures))

    def on_pointed(self, name: str) -> None:
        """Say how sure a point is."""
        track = self.draft.track
        if not name or track is None or self.frame >= len(track.points) or name not in track.request.model.names:
            self.status.hint(name)
            return
        row = track.request.model.names.index(name)
        self.status.hint(texts.POINT_TIP.format(name=name, trust=track.trust[self.frame, row],
                                                drift=_drift(track.drift_px[self.frame, row])))  # fmt: skip

    def ask_open(self) -> None:
        """Choose a film."""
        name, _ = QFileDialog.getOpenFileName(self, texts.OPEN, last_folder(self._settings, _FOLDER),
                                              texts.FILTER_VIDEO)  # fmt: skip
        if name:
            self.open_video(Path(name))

    def open_video(self, path: Path) -> None:
        """Open a film."""
        remember_folder(self._settings, _FOLDER, path)
        self.message.hide()
        self.draft.open(path)

    def ask_load(self) -> None:
        """Choose clicks to go on with."""
        name, _ = QFileDialog.getOpenFileName(self, texts.LOAD, last_folder(self._settings, _FOLDER),
                                              texts.FILTER_START)  # fmt: skip
        if name:
            self.draft.load(Path(name))

    def ask_save_start(self) -> None:
        """Choose where clicks and corrections are kept."""
        path = self._ask_target(texts.SAVE_START, texts.FILTER_START, ".json")
        if path is not None:
            self.draft.save_start(path)

    def ask_save(self) -> None:
        """Choose where the capture goes."""
        if self.draft.track is None:
            self.message.say(texts.TRACK_FIRST)
            return
        path = self._ask_target(texts.SAVE, texts.FILTER_CAPTURE, SUFFIXES[0])
        if path is not None:
            self.draft.save(path)

    def _ask_target(self, title: str, kinds: str, suffix: str) -> Path | None:
        start = Path(last_folder(self._settings, _FOLDER)) / f"{self.draft.video.stem}{suffix}"
        name, _ = QFileDialog.getSaveFileName(self, title, str(start), kinds)
        if not name:
            return None
        return Path(name) if Path(name).suffix else Path(f"{name}{suffix}")

    # Showing

    def refresh(self) -> None:
        """Show film, clicks and track as they are now."""
        draft, form = self.draft, self.draft.format
        self._stack.setCurrentWidget(self._empty if form is None else self.canvas)
        self.name.setText("" if draft.video is None else draft.video.name)
        self.facts.setText("" if form is None else texts.FACTS.format(
            width=form.width, height=form.height, rate=form.rate_hz, seconds=self.n_frames / self.rate_hz))  # fmt: skip
        self.transport.set_duration(self.n_frames / self.rate_hz)
        self.expression.setCurrentIndex(max(0, self.expression.findData(draft.start.expression)))
        database = self.authoring.document.database
        self.units.setText(texts.UNITS_DEMO if database is None else texts.UNITS_OF.format(name=database.name))
        corrected = tuple(sorted(f for f, places in draft.start.corrections.items() if places))
        self.strip.show_track(draft.track, self.n_frames, corrected)
        self.state.setText("" if draft.track is None else texts.STATE.format(
            n=len(draft.track.points), lost=int(draft.track.lost.sum()), corrected=len(corrected),
            unsure=int(((draft.track.frame_trust < UNSURE) & ~draft.track.lost).sum())))  # fmt: skip
        self.setWindowModified(draft.has_unsaved_track)
        self.frame = min(self.frame, max(self.n_frames - 1, 0))
        self._enable()
        self._show_frame()

    def _enable(self) -> None:
        draft = self.draft
        busy = self.jobs.is_running("track") or self.jobs.is_running("model")
        behind = draft.track is not None and draft.is_behind
        self.track_button.setText(texts.TRACK_FROM.format(frame=draft.first_behind) if behind and draft.first_behind
                                  else texts.TRACK)  # fmt: skip
        self.track_button.setEnabled(draft.laid is not None and not busy and (draft.track is None or behind))
        self.save_button.setEnabled(draft.track is not None)
        self.import_button.setEnabled(bool(draft.captures))
        self.unsure_button.setEnabled(draft.track is not None)
        for button in (self.load_button, self.save_start_button, self.anew_button):
            button.setEnabled(draft.video is not None)
        self.expression.setEnabled(draft.video is not None)

    def _show_frame(self) -> None:
        draft, frame = self.draft, self.frame
        self.strip.show_frame(frame)
        self.transport.show_time(frame / self.rate_hz + 1e-9, self.rate_hz, f"{self.rate_hz:g}")
        asked = draft.next_click if draft.video is not None else None
        at_first = frame == 0
        self.guide.show_points(asked, frozenset(draft.start.clicks))
        self.what.setText(self._what_next(asked))
        track = draft.track
        tracked = track is not None and frame < len(track.points)
        model = track.request.model if tracked and not at_first else draft.model
        clicks = tuple(draft.start.clicks.items()) if at_first else ()
        self.canvas.show_points(
            ShownPoints(() if model is None else model.names, draft.points(frame),
                        track.trust[frame] if tracked and not at_first else None,
                        track.drift_px[frame] if tracked else None,
                        frozenset(draft.start.corrections.get(frame, {})), clicks),
            wants_click=asked is not None and at_first and draft.video is not None,
        )  # fmt: skip
        self.here.setText(self._here() if tracked else "")

    def _what_next(self, asked: str | None) -> str:
        if self.draft.video is None:
            return ""
        if asked is not None:
            what = texts.CLICK_OF.format(n=CLICKED.index(asked) + 1, what=texts.CLICK[asked])
            return what if self.frame == 0 else texts.TO_FIRST
        return texts.LAID if self.draft.track is None else texts.TRACKED

    def _here(self) -> str:
        track, frame = self.draft.track, self.frame
        if track.lost[frame]:
            return texts.HERE_LOST.format(frame=frame)
        return texts.HERE.format(frame=frame, trust=track.frame_trust[frame], drift=_drift(track.frame_drift_px[frame]))

    def shut_down(self) -> None:
        """Stop all jobs, for good; the main window closes."""
        self._clock.stop()
        self.authoring.document.changed.disconnect(self.on_document_changed)
        self.jobs.shut_down()
        self._frames.set_video(None)
        self.close()

    # Qt

    def closeEvent(self, event) -> None:
        """Stop playing."""
        self._clock.stop()
        self.transport.show_playing(False)
        super().closeEvent(event)


def _row(*widgets: QWidget | None) -> QHBoxLayout:
    """Widgets side by side; None is what gives way."""
    row = QHBoxLayout()
    row.setSpacing(STEP // 2)
    for widget in widgets:
        if widget is None:
            row.addStretch(1)
        else:
            row.addWidget(widget)
    return row


def _drift(px: float) -> str:
    return texts.DRIFT.format(px=px) if np.isfinite(px) else texts.NO_DRIFT
