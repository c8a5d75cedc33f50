"""The live window: the face at the left; what it listens to, expression, delay and recording at the right."""

from __future__ import annotations

import time
from pathlib import Path

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QPushButton, QSplitter, QVBoxLayout, QWidget

from app.authoring import Authoring
from app.emotion_colours import emotion_colours
from app.live.microphone import InputDevice
from app.live.session import TimedFrame
from app.panels.control.section import Section, combo_box, quiet_button
from app.panels.face_view import FaceView
from app.panels.live.delay import DelayTable
from app.panels.live.driver import LiveDriver
from app.panels.live.expression import ExpressionChoice
from app.panels.live.meter import Meter
from app.panels.pane import Choice, Pane, label, toggle
from app.panels.tool_window import ToolWindow
from app.settings import last_folder, remember_folder
from app.texts import FILTER_SOUND
from app.texts import live as texts
from app.theme import STEP
from core.document.change import Change
from core.document.project_file import SUFFIX
from core.iface.speaking import SpeakingFace
from core.speech.emotion import EMOTIONS
from gpu.gl.face import Style

_SIZE = (1040, 720)
_CONTROLS_PX = 320
_METER_MS, _FIGURES_EVERY = 40, 6
_QUIET_S = 2.5
_FILE = "file"
_ADDRESS = "live/stream"


class LiveWindow(ToolWindow):
    """Non-modal; closed, it listens no more.

    project_asked(path) : a recording that was saved is to be opened
    """

    project_asked = Signal(object)

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.driver = LiveDriver(self.jobs, self)
        self._file: Path | None = None
        self._saved: Path | None = None
        self._unpainted: TimedFrame | None = None
        self._ticks = 0
        self._clipped_before = 0
        self._arrange()
        self._join()
        self._tick = QTimer(self, interval=_METER_MS)
        self._tick.timeout.connect(self._on_tick)
        self._show_devices(())
        self.refresh()

    # Making

    def _arrange(self) -> None:
        self.view = FaceView()
        self.pane = Pane(texts.TITLE.upper(), self.view, texts.NOT_LISTENING)
        self.style_choice = Choice([texts.DOTS, texts.FACE])
        self.pane.header.addWidget(self.style_choice)
        controls = QWidget()
        column = QVBoxLayout(controls)
        column.setContentsMargins(STEP + 4, STEP, STEP + 4, STEP)
        column.setSpacing(STEP)
        for section in (self._listening(), self._expression(), self._delay(), self._recording(), self._stream()):
            column.addWidget(section)
        column.addStretch(1)
        controls.setFixedWidth(_CONTROLS_PX)
        body = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        body.addWidget(self.pane)
        body.addWidget(controls)
        body.setStretchFactor(0, 1)
        self.fill(body)

    def _listening(self) -> Section:
        section = Section(texts.LISTEN_TO)
        self.sources = combo_box(texts.SOURCE_TIP)
        self.refresh_button = quiet_button(texts.REFRESH, texts.REFRESH_TIP, self.driver.find_devices)
        section.title_row.addWidget(self.refresh_button)
        self.listen_button = QPushButton(texts.LISTEN, toolTip=texts.LISTEN_TIP)
        self.listen_button.setProperty("role", "primary")
        self.meter = Meter()
        section.column.addWidget(self.sources)
        section.column.addWidget(self.listen_button)
        section.column.addWidget(self.meter)
        return section

    def _expression(self) -> Section:
        section = Section(texts.EXPRESSION)
        self.expression = ExpressionChoice()
        section.column.addWidget(self.expression)
        return section

    def _delay(self) -> Section:
        section = Section(texts.DELAY)
        self.delay = DelayTable()
        section.column.addWidget(self.delay)
        return section

    def _recording(self) -> Section:
        section = Section(texts.RECORDING)
        self.recorded = label()
        section.title_row.addWidget(self.recorded)
        self.record_button = QPushButton(texts.RECORD, toolTip=texts.RECORD_TIP)
        self.keep_button = QPushButton(texts.KEEP, toolTip=texts.KEEP_TIP)
        self.open_button = QPushButton(texts.OPEN, toolTip=texts.OPEN_TIP)
        row = QHBoxLayout()
        row.addWidget(self.keep_button, 1)
        row.addWidget(self.open_button)
        section.column.addWidget(self.record_button)
        section.column.addLayout(row)
        return section

    def _stream(self) -> Section:
        section = Section(texts.STREAM)
        self.sent = label()
        section.title_row.addWidget(self.sent)
        self.address = QLineEdit(placeholderText=texts.STREAM_HINT, toolTip=texts.STREAM_TIP)
        self.address.setText(self._settings.value(_ADDRESS, ""))
        self.send_button = toggle(texts.SEND, texts.SEND_TIP, self.on_send)
        row = QHBoxLayout()
        row.addWidget(self.address, 1)
        row.addWidget(self.send_button)
        section.column.addLayout(row)
        return section

    def _join(self) -> None:
        driver = self.driver
        driver.devices_found.connect(self._show_devices)
        driver.learned.connect(self.on_learned)
        driver.heard.connect(self.on_heard)
        driver.changed.connect(self.refresh)
        driver.noted.connect(self.status.say)
        driver.failed.connect(self.message.say)
        driver.saved.connect(self.on_saved)
        self.view.frameSwapped.connect(self._on_painted)
        self.expression.asked.connect(driver.ask)
        self.meter.clip_cleared.connect(self._on_clip_cleared)
        self.sources.activated.connect(lambda _: self.on_source())
        self.style_choice.group.idClicked.connect(lambda _: self._dress())
        self.listen_button.clicked.connect(self.on_listen)
        self.record_button.clicked.connect(self.on_record)
        self.keep_button.clicked.connect(self.ask_keep)
        self.open_button.setVisible(self.parent() is not None)
        self.open_button.clicked.connect(lambda: self.project_asked.emit(self._saved))
        self.address.returnPressed.connect(lambda: self.send_button.setChecked(True))
        self.address.textEdited.connect(lambda _: self.send_button.setChecked(False))
        keys = {"Space": self.on_listen, "R": self.on_record, "Ctrl+S": self.ask_keep, "Ctrl+W": self.close}
        for e, emotion in enumerate(EMOTIONS):
            keys[str(e + 1)] = lambda emotion=emotion: self.expression.choose(emotion)
        for key, done in keys.items():
            QShortcut(QKeySequence(key), self, activated=done)
        self.authoring.document.changed.connect(self.on_document_changed)
        self.authoring.rig_changed.connect(self._show_face)
        emotion_colours.changed.connect(self.expression.renew)

    # Reactions

    def open_now(self) -> None:
        """Show the window, in front."""
        super().open_now()
        self._show_face()
        self.driver.use(self.authoring.document.database)
        self.driver.find_devices()
        self.listen_button.setFocus()

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Learn from another database."""
        if change & Change.NODES and self.isVisible():
            self.driver.use(self.authoring.document.database)
            self._show_face()
            self.refresh()

    def on_source(self) -> None:
        """Listen to what was chosen in the list; while it listens, at once."""
        if self.sources.currentData() == _FILE and not self._ask_file():
            return
        if self.driver.is_listening:
            self._listen()

    def _ask_file(self) -> bool:
        name, _ = QFileDialog.getOpenFileName(self, texts.OPEN_SOUND, last_folder(self._settings, "speech"),
                                              FILTER_SOUND)  # fmt: skip
        if name:
            self.choose_file(Path(name))
            remember_folder(self._settings, "speech", self._file)
        elif self._file is None:
            self.sources.setCurrentIndex(0)
        return bool(name)

    def choose_file(self, path: Path) -> None:
        """Choose a sound file to speak with."""
        self._file = path
        place = self.sources.findData(_FILE)
        self.sources.setItemText(place, path.name)
        self.sources.setCurrentIndex(place)

    def on_listen(self) -> None:
        """Listen, or stop."""
        if self.driver.is_listening:
            self.driver.stop()
        else:
            self._listen()

    def _listen(self) -> None:
        self.message.hide()
        self.delay.forget()
        self._clipped_before = 0 if self.driver.session is None else self.driver.session.n_clipped
        chosen = self.sources.currentData()
        self.driver.use(self.authoring.document.database)
        if chosen == _FILE and self._file is None and not self._ask_file():
            return
        self.driver.listen(*((None, self._file) if self.sources.currentData() == _FILE else (chosen, None)))

    def on_learned(self, face: SpeakingFace) -> None:
        """Offer the emotions that the face has learned."""
        self.expression.offer(face.expressions)

    def on_heard(self, frame: TimedFrame) -> None:
        """Show a frame; of frames that come faster than they are painted, the newest."""
        database = self.authoring.document.database
        if database is None:
            return
        self._unpainted = frame
        self.pane.show_content()
        self.view.show_pose(frame.live.positions - database.markers.rest)

    def _on_painted(self) -> None:
        frame, self._unpainted = self._unpainted, None
        if frame is not None:
            painted_s = time.perf_counter() - frame.made_s
            self.delay.add(frame.capture_s, frame.look_ahead_s, frame.live.compute_s, painted_s)
            self.expression.show_strengths(frame.live.strengths)

    def on_record(self) -> None:
        """Record, or end the recording and ask where it goes."""
        if self.driver.recorded_s is None:
            self.driver.record()
        else:
            self.driver.end_recording()
            self.ask_keep()

    def ask_keep(self) -> None:
        """Choose where the recording goes as a project."""
        if self.driver.take is None:
            return
        start = Path(last_folder(self._settings, "project")) / (time.strftime(texts.FILE_NAME) + SUFFIX)
        name, _ = QFileDialog.getSaveFileName(self, texts.KEEP.rstrip("…"), str(start), texts.FILTER_PROJECT)
        if name:
            path = Path(name) if Path(name).suffix.lower() == SUFFIX else Path(name + SUFFIX)
            remember_folder(self._settings, "project", path)
            self.driver.save(path, self.authoring.document.face)

    def on_saved(self, path: Path) -> None:
        """Offer to open it."""
        self._saved = path
        self.refresh()

    def on_send(self, is_on: bool) -> None:
        """Send frames to the address, or send no more."""
        if not is_on:
            self.driver.stop_sending()
            return
        self._settings.setValue(_ADDRESS, self.address.text())
        self.driver.use(self.authoring.document.database)
        self.driver.send_to(self.address.text())
        if not self.driver.is_sending:
            self.send_button.setChecked(False)

    def _on_clip_cleared(self) -> None:
        self._clipped_before = self.driver.session.n_clipped

    # Showing

    def refresh(self) -> None:
        """Show what goes on."""
        driver, is_listening = self.driver, self.driver.is_listening
        self.listen_button.setText(texts.STOP if is_listening else texts.LISTEN)
        records = driver.recorded_s is not None
        self.record_button.setEnabled(driver.source is not None)
        self.record_button.setText(texts.RECORD_STOP if records else texts.RECORD)
        self.keep_button.setEnabled(driver.take is not None)
        self.open_button.setEnabled(self._saved is not None)
        if not records:
            seconds = 0.0 if driver.take is None else driver.take.audio.duration_s
            self.recorded.setText(_clock(seconds) if seconds else "")
        self.send_button.blockSignals(True)
        self.send_button.setChecked(driver.is_sending)
        self.send_button.blockSignals(False)
        has_database = self.authoring.document.database is not None
        if self.pane.is_empty:
            self.pane.show_empty(texts.NOT_LISTENING if has_database else texts.NO_DATABASE)
        if is_listening and self.isVisible():
            self._tick.start()
        else:
            self._tick.stop()
            self.meter.show_level(-90.0, -90.0)
            self.pane.info.setText("")

    def _show_devices(self, devices: tuple[InputDevice, ...]) -> None:
        chosen = self.sources.currentData()
        self.sources.clear()
        self.sources.addItem(texts.DEFAULT_ITEM, None)
        for device in devices:
            self.sources.addItem(texts.DEVICE_ITEM.format(name=device.name, host=device.host), device)
        self.sources.insertSeparator(self.sources.count())
        self.sources.addItem(texts.FILE_ITEM if self._file is None else self._file.name, _FILE)
        place = next((n for n in range(self.sources.count()) if self.sources.itemData(n) == chosen), 0)
        self.sources.setCurrentIndex(max(0, place))

    def _show_face(self) -> None:
        database = self.authoring.document.database
        self.view.set_markers(None if database is None else database.markers)
        rig = self.authoring.rig if database is not None else None
        self.view.set_rig(rig)
        self.style_choice.button("face").setEnabled(rig is not None)
        self._dress()

    def _dress(self) -> None:
        self.view.set_style(Style.TEXTURED if self.style_choice.key == "face" else Style.MARKERS)

    def _on_tick(self) -> None:
        session, source = self.driver.session, self.driver.source
        if session is None or source is None or session.level is None:
            self._tell_quiet(source is not None and session is not None)
            return
        level, recorded_s = session.level, self.driver.recorded_s
        self.meter.show_level(level.rms_db, level.peak_db)
        self.meter.light_clip(session.n_clipped > self._clipped_before)
        if recorded_s is not None:
            self.recorded.setText(_clock(recorded_s))
            if session.recording_is_full:
                self.status.say(texts.FULL)
                self.on_record()
        self._ticks += 1
        if self._ticks % _FIGURES_EVERY == 0:
            self.delay.renew(session.n_overflows + session.drops.dropouts)
            self.sent.setText(texts.SENT.format(n=self.driver.n_sent) if self.driver.n_sent else "")
            self._tell_quiet(True)

    def _tell_quiet(self, is_on: bool) -> None:
        session, source, said = self.driver.session, self.driver.source, ""
        if is_on and source is not None:
            if time.perf_counter() - session.last_block_s > _QUIET_S:
                said = texts.NO_SOUND_YET.format(source=source.name)
            elif session.level is not None and session.level.silent_s > _QUIET_S:
                said = texts.SILENT.format(source=source.name)
        self.pane.info.setText(said)

    @property
    def has_unsaved_take(self) -> bool:
        """Whether closing for good would lose a recording."""
        return self.driver.take is not None or self.driver.recorded_s is not None

    def shut_down(self) -> None:
        """Stop all jobs and free the view, for good; the main window closes."""
        self.authoring.document.changed.disconnect(self.on_document_changed)
        emotion_colours.changed.disconnect(self.expression.renew)
        self._tick.stop()
        self.driver.shut_down()
        self.jobs.shut_down()
        self.view.release()
        self.close()

    # Qt

    def closeEvent(self, event) -> None:
        """Listen no more; what was recorded waits, unless the window stands alone: then it is told once."""
        self.driver.stop()
        alone = self.parent() is None and not self.driver.records_at_once
        if alone and self.driver.take is not None and self.message.text != texts.CLOSE_LOSES:
            self.message.say(texts.CLOSE_LOSES)
            event.ignore()
            return
        self.send_button.setChecked(False)
        super().closeEvent(event)


def _clock(seconds: float) -> str:
    minutes = int(seconds // 60)
    return texts.RECORDED.format(minutes=minutes, seconds=seconds - 60 * minutes)
