"""The window in which two engines say the same: their faces above, curves and figures of both below."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QComboBox, QFileDialog, QHBoxLayout, QSplitter, QToolButton, QVBoxLayout, QWidget

from app import texts as common_texts
from app.authoring import Authoring
from app.comparison_film import FilmRequest, compose_apart
from app.comparison_words import how_fair, title_of
from app.emotion_colours import emotion_colours
from app.export import VideoSettings
from app.panels.compare.choices import EngineChoices, usual_beside
from app.panels.compare.faces import ComparedFaces
from app.panels.compare.figures import FiguresTable
from app.panels.compare.graph import CompareGraph
from app.panels.compare.lanes import lanes_of
from app.panels.compare.work import (
    Compared,
    CompareRequest,
    ControlsRequest,
    compare,
    find_capture,
    find_controls,
    write_curves,
)
from app.panels.pane import Choice, ElidedLabel, label
from app.panels.tool_window import ToolWindow
from app.panels.transport import Transport
from app.settings import last_folder, remember_folder
from app.texts import compare as texts
from app.theme import STEP
from core.document.change import ASKED_OF_THE_SEARCH, Change
from core.evaluation.known_capture import KnownCapture
from core.evaluation.side_by_side import CAPTURED, SideBySide
from core.media.video import FRAME_RATES
from core.rig.control_layer import LIP_CONTROLS
from core.rig.control_track import ControlTrack
from core.synthesis.registry import DEFAULT_ENGINE, weights_of
from gpu.gl.face import Style

_SIZE = (1480, 960)
_FIGURES_PX, _LANE_CHOICE_PX = 448, 152
_AFTER_MS = 300
_FILM_PX = (1280, 720)
_FOLDER = "compare"


class CompareWindow(ToolWindow):
    """Non-modal, under the playhead of the main window; closed, it does nothing.

    compared : what is on show, or None
    """

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.compared: Compared | None = None
        self.capture: KnownCapture | None = None
        self._capture_of: tuple | None = None
        self._controls: dict[str, ControlTrack] | None = None
        self._is_stale, self._was_open, self._note = True, False, ""
        self._soon = QTimer(self, singleShot=True, interval=_AFTER_MS)
        self._arrange()
        self._join()
        self._show_markers()
        self._show()
        self.resize(self.sizeHint())  # Qt by itself takes two thirds of the screen at most

    def _arrange(self) -> None:
        self.faces = ComparedFaces()
        self.graph = CompareGraph(self.authoring)
        self.figures = FiguresTable()
        self.transport = Transport(common_texts.PLAY_TIP)
        upper = QWidget()
        column = _column(upper)
        column.addWidget(self._header())
        column.addWidget(self.faces, 1)
        row = QHBoxLayout()
        row.setContentsMargins(STEP, 0, STEP, 0)
        row.addWidget(self.transport)
        column.addLayout(row)
        lower = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        lower.addWidget(self._curves())
        lower.addWidget(self._figures())
        lower.setStretchFactor(0, 1)
        lower.setSizes([_SIZE[0] - _FIGURES_PX, _FIGURES_PX])
        whole = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False, handleWidth=1)
        whole.addWidget(upper)
        whole.addWidget(lower)
        whole.setStretchFactor(0, 1)
        self.fill(whole)

    def _header(self) -> QWidget:
        """Lay out who is compared, and how it is shown."""
        self.choices = EngineChoices()
        self.again_button = QToolButton(text=texts.AGAIN, toolTip=texts.AGAIN_TIP)
        self.again_button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        about = ElidedLabel()
        about.setText(texts.LAYERS)
        self.layout_choice = Choice([texts.OVERLAID, texts.BESIDE])
        self.style_choice = Choice([
            (Style.MARKERS.value, common_texts.MARKERS, common_texts.MARKERS_TIP),
            (Style.WIREFRAME.value, common_texts.WIREFRAME, common_texts.WIREFRAME_TIP),
            (Style.SHADED.value, common_texts.SHADED, common_texts.SHADED_TIP),
            (Style.TEXTURED.value, common_texts.TEXTURED, common_texts.TEXTURED_TIP),
        ])  # fmt: skip
        row = QHBoxLayout()
        row.setContentsMargins(STEP + 4, STEP // 2, STEP, STEP // 2)
        row.setSpacing(STEP)
        row.addWidget(self.choices)
        row.addWidget(self.again_button)
        row.addWidget(about, 1)
        row.addWidget(self.layout_choice)
        row.addSpacing(STEP)
        row.addWidget(self.style_choice)
        made = QWidget()
        made.setLayout(row)
        return made

    def _curves(self) -> QWidget:
        """Lay out the graph and what it shows."""
        self.second = QComboBox(toolTip=texts.SECOND_TIP)
        self.second.setProperty("role", "small")
        self.second.setFixedWidth(_LANE_CHOICE_PX)
        self.second.addItem(texts.WIDTH, "")
        for control in LIP_CONTROLS:
            self.second.addItem(control, control)
        self.error_choice = Choice([texts.ERROR_OF_FACE, texts.ERROR_OF_LIPS])
        row = QHBoxLayout()
        row.setContentsMargins(STEP + 4, STEP // 2, STEP, STEP // 2)
        row.setSpacing(STEP)
        row.addWidget(label(texts.CURVES, "title"))
        row.addStretch(1)
        row.addWidget(self.second)
        row.addWidget(label(texts.ERROR))
        row.addWidget(self.error_choice)
        made = QWidget()
        column = _column(made)
        column.addLayout(row)
        column.addWidget(self.graph, 1)
        return made

    def _figures(self) -> QWidget:
        """Lay out the table and what can be written."""
        self.curves_button = QToolButton(text=texts.SAVE_CURVES, toolTip=texts.SAVE_CURVES_TIP)
        self.film_button = QToolButton(text=texts.SAVE_FILM, toolTip=texts.SAVE_FILM_TIP)
        self.fairness = label("")
        self.fairness.setWordWrap(True)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        row.addWidget(label(texts.FIGURES, "title"), 1)
        for button in (self.curves_button, self.film_button):
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            row.addWidget(button)
        made = QWidget()
        column = QVBoxLayout(made)
        column.setContentsMargins(STEP, STEP // 2, STEP, STEP)
        column.setSpacing(STEP // 2)
        column.addLayout(row)
        column.addWidget(self.figures, 1)
        column.addWidget(self.fairness)
        return made

    def _join(self) -> None:
        authoring, view = self.authoring, self.authoring.view
        self._soon.timeout.connect(self._renew)
        self.jobs.failed.connect(self._on_failed)
        self.jobs.ended.connect(self._on_ended)
        self.choices.changed.connect(self.ask_soon)
        self.again_button.clicked.connect(self.compare_again)
        self.layout_choice.group.idClicked.connect(lambda _: self._on_layout())
        self.style_choice.group.idClicked.connect(lambda _: self._on_style())
        self.error_choice.group.idClicked.connect(lambda _: self._show_lanes())
        self.second.activated.connect(lambda _: self._on_second())
        self.curves_button.clicked.connect(self.ask_curves)
        self.film_button.clicked.connect(self.ask_film)
        self.transport.play_asked.connect(authoring.play_or_pause)
        self.transport.step_asked.connect(authoring.step_frame)
        self.transport.end_asked.connect(self._to_end)
        self.transport.seek_asked.connect(authoring.seek)
        authoring.player.playing_changed.connect(self.transport.show_playing)
        authoring.document.changed.connect(self.on_document_changed)
        authoring.rig_changed.connect(self._show_markers)
        view.playhead_moved.connect(self.on_playhead_moved)
        emotion_colours.changed.connect(self.graph.renew)  # another theme comes with it
        for key, done in {
            "Space": authoring.play_or_pause, "J": lambda: authoring.shuttle(-1), "K": lambda: authoring.shuttle(0),
            "L": lambda: authoring.shuttle(1), "Left": lambda: authoring.step_frame(-1),
            "Right": lambda: authoring.step_frame(1), "Home": lambda: self._to_end(False),
            "End": lambda: self._to_end(True), "X": self.choices.swap, "O": self.toggle_layout, "F": self.frame_view,
            "0": self.graph.zoom_all, "Ctrl+Return": self.compare_again, "Ctrl+S": self.ask_curves,
            "Ctrl+E": self.ask_film, "Ctrl+W": self.close,
        }.items():  # fmt: skip
            QShortcut(QKeySequence(key), self, activated=done)

    # What is asked for

    def open_now(self) -> None:
        """Show the window, in front; the first time with the engine of the project and another one."""
        if not self._was_open:
            self._was_open = True
            asked = self.authoring.document.engine
            one = asked if self.choices.offers(asked) else DEFAULT_ENGINE
            self.choices.choose(one, usual_beside(one))
        super().open_now()
        self.on_playhead_moved(self.authoring.view.playhead_s)
        if self._is_stale:
            self._soon.start(0)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Follow the project."""
        if change & Change.NODES:
            self._show_markers()
        if change & (ASKED_OF_THE_SEARCH | Change.SPEECH):
            self.ask_soon()

    def ask_soon(self) -> None:
        """Compare anew, a moment after the last change; a window that is closed waits until it is open."""
        self._is_stale = True
        for kind in ("capture", "compare", "controls"):
            self.jobs.cancel(kind)
        if self.isVisible():
            self._soon.start(_AFTER_MS)

    def compare_again(self) -> None:
        """Compare now."""
        self.ask_soon()
        self._soon.start(0)

    # Comparing

    def _renew(self) -> None:
        document = self.authoring.document
        self.message.hide()
        if document.speech is None or document.database is None:
            self._show_nothing()
            return
        transcript = document.speech.transcript
        text = document.speech.text or " ".join(word.word for word in transcript.words)
        wanted = document.database, text, transcript.duration_s
        if self._capture_of is not None and self._capture_of[0] is wanted[0] and self._capture_of[1:] == wanted[1:]:
            self._compare()
            return

        def found(capture: KnownCapture | None) -> None:
            self._capture_of, self.capture = wanted, capture
            self._compare()

        self.jobs.start("capture", texts.FINDING_CAPTURE, wanted, find_capture, found)

    def _compare(self) -> None:
        took_over = self.choices.offer_capture(self.capture is not None)
        self._note = texts.CAPTURED_NONE_TIP if took_over else ""
        document, authoring, names = self.authoring.document, self.authoring, self.choices.names
        made = [name for name in names if name != CAPTURED]
        request = CompareRequest(
            names, {name: authoring.live_engine(name) for name in made},
            {name: weights_of(name, document.database, document.weights) for name in made},
            document.speech_input(), self.capture,
        )  # fmt: skip
        if self.compared is None:
            self.faces.show_empty(texts.COMPARING_WITH)
        self.jobs.start("compare", texts.COMPARING, request, compare, self._on_compared)

    def _on_compared(self, compared: Compared) -> None:
        self.compared, self._controls, self._is_stale = compared, None, False
        self.status.say(" · ".join(part for part in (self._note, *compared.warnings) if part))
        self._show()
        self._find_controls()

    def _on_failed(self, sentence: str, remedy: str) -> None:
        self.message.say(sentence, remedy)
        if self.compared is None:
            self.faces.show_empty(sentence)

    def _on_ended(self, kind: str) -> None:
        """What was cancelled comes no more."""
        if kind in ("capture", "compare") and self.compared is None:
            self.faces.show_empty(texts.STOPPED)

    def _on_second(self) -> None:
        self._show_lanes()
        self._find_controls()

    def _find_controls(self) -> None:
        """Look for the control curves, once, when one is to be seen."""
        if not self.second.currentData() or self._controls is not None or self.compared is None:
            return
        beside = self.compared.beside
        motions = dict(zip(beside.names, beside.motions))
        if beside.truth is not None and CAPTURED not in motions:
            motions[CAPTURED] = SideBySide.of((CAPTURED,) * 2, (None, None), beside.transcript, beside.truth).motions[0]
        request = ControlsRequest(motions, self.authoring.document.database)

        def found(controls: dict[str, ControlTrack]) -> None:
            self._controls = controls
            self._show_lanes()

        self.jobs.start("controls", texts.FINDING_CONTROLS, request, find_controls, found)

    # Showing

    def _show_markers(self) -> None:
        database, rig = self.authoring.document.database, self.authoring.rig
        self.faces.show_on(None if database is None else database.markers, rig)
        for key in (Style.WIREFRAME.value, Style.SHADED.value, Style.TEXTURED.value):
            self.style_choice.button(key).setEnabled(rig is not None)

    def _show_nothing(self) -> None:
        self.compared = None
        self._show()

    def _show(self) -> None:
        compared = self.compared
        for button in (self.curves_button, self.film_button):
            button.setEnabled(compared is not None)
        self._show_lanes()
        if compared is None:
            self.faces.show_empty(texts.WAITING)
            self.figures.show_agreements((), ("", ""))
            self.fairness.setText("")
            self.transport.set_duration(0.0)
            return
        beside = compared.beside
        self.faces.say(*(title_of(name) for name in beside.names))
        self.figures.show_agreements(beside.agreements, beside.names)
        self.fairness.setText(how_fair(self.capture))
        self.transport.set_duration(beside.transcript.duration_s)
        self.on_playhead_moved(self.authoring.view.playhead_s)

    def _show_lanes(self) -> None:
        compared = self.compared
        if compared is None:
            self.graph.show_lanes((), None, 1.0)
            return
        beside, of_lips = compared.beside, self.error_choice.key == texts.ERROR_OF_LIPS[0]
        lanes = lanes_of(beside, of_lips, self.second.currentData(), self._controls)
        self.graph.show_lanes(lanes, beside.transcript, beside.rate_hz)

    def on_playhead_moved(self, time_s: float) -> None:
        """Show both faces at the playhead."""
        if self.compared is None or not self.isVisible():
            return
        authoring, beside = self.authoring, self.compared.beside
        self.transport.show_time(time_s, authoring.fps, authoring.document.output.frame_rate)
        frame = min(round(time_s * beside.rate_hz), beside.n_frames - 1)
        one, other = (motion.positions[frame] - motion.markers.rest for motion in beside.motions)
        self.faces.show_poses(one, other, self.compared.tracks.at(frame))

    def _to_end(self, is_end: bool) -> None:
        self.authoring.seek(self.authoring.player.duration_s if is_end else 0.0)

    def toggle_layout(self) -> None:
        """Lay one over the other, or beside it again."""
        self.layout_choice.choose(texts.BESIDE[0] if self.faces.is_overlaid else texts.OVERLAID[0])

    def _on_layout(self) -> None:
        self.faces.overlay(self.layout_choice.key == texts.OVERLAID[0])
        self.on_playhead_moved(self.authoring.view.playhead_s)

    def _on_style(self) -> None:
        self.faces.set_style(Style(self.style_choice.key))

    def frame_view(self) -> None:
        """Look from the front, all in view."""
        for view in self.faces.views:
            view.frame_view()

    # Exports

    def ask_curves(self) -> None:
        """Choose where the table of curves goes."""
        path = self._ask_path(texts.CURVES_NAME, texts.SAVE_CURVES_TIP, texts.FILTER_CURVES, (".csv",))
        if path is not None:
            request = self.compared.beside, path
            self.jobs.start("curves", texts.WRITING_CURVES, request, write_curves, self._on_saved)

    def ask_film(self) -> None:
        """Choose where the film goes."""
        path = self._ask_path(texts.FILM_NAME, texts.SAVE_FILM_TIP, texts.FILTER_FILM, (".avi", ".mp4"))
        if path is None:
            return
        document, beside, rig = self.authoring.document, self.compared.beside, self.authoring.rig
        asked = "face" if self.style_choice.key == Style.TEXTURED.value else self.style_choice.key
        style = "markers" if rig is None else asked
        output = document.output
        settings = VideoSettings(FRAME_RATES[output.frame_rate], *_FILM_PX, style, output.start_frame)
        titles = tuple(title_of(name) for name in beside.names)
        request = FilmRequest(beside.motions, titles, document.speech.audio, beside.transcript, rig, settings, path)
        self.jobs.start("film", texts.WRITING_FILM, request, compose_apart, self._on_saved)

    def _ask_path(self, name: str, title: str, pattern: str, suffixes: tuple[str, ...]) -> Path | None:
        if self.compared is None:
            return None
        one, other = self.compared.beside.names
        start = Path(last_folder(self._settings, _FOLDER)) / name.format(one=one, other=other)
        chosen, _ = QFileDialog.getSaveFileName(self, title, str(start), pattern)
        if not chosen:
            return None
        path = Path(chosen) if Path(chosen).suffix.lower() in suffixes else Path(chosen + suffixes[0])
        remember_folder(self._settings, _FOLDER, path)
        return path

    def _on_saved(self, path: Path) -> None:
        self.status.say(texts.SAVED.format(path=path))

    # Ending

    def _stop(self) -> None:
        self._soon.stop()
        for kind in ("capture", "compare", "controls", "curves", "film"):
            self.jobs.cancel(kind)

    def shut_down(self) -> None:
        """Stop all jobs and free the views, for good; the main window closes."""
        self.authoring.document.changed.disconnect(self.on_document_changed)
        self._stop()
        self.jobs.shut_down()
        for view in self.faces.views:
            view.release()
        self.close()

    # Qt

    def closeEvent(self, event) -> None:
        """Leave nothing running."""
        self._stop()
        super().closeEvent(event)


def _column(widget: QWidget) -> QVBoxLayout:
    column = QVBoxLayout(widget)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    return column
