"""The motion units page: how many at the left, the face in the middle, units and keyframes as sliders at the right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QHBoxLayout,
    QPushButton,
    QSplitter,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.authoring import Authoring
from app.figures import unit_names, unit_poses
from app.panels.face_view import FaceView
from app.panels.pane import Choice, ElidedLabel, Pane, label, toggle
from app.panels.tool_window import ToolWindow
from app.panels.units.coverage_curve import CoverageCurve
from app.panels.units.draft import UnitsDraft
from app.panels.units.how_many import HowMany
from app.panels.units.sliders import SliderList, ValueSlider
from app.panels.units.work import FigureRequest, LearnRequest, draw
from app.settings import last_folder, remember_folder
from app.texts import units as texts
from app.theme import STEP
from core.document.change import Change
from core.iface.motion_unit import NEUTRAL, PAPER_EXPRESSION, PAPER_UTTERANCE
from gpu.gl.face import Style

_SIZE = (1280, 800)
_SETTINGS_PX, _SLIDERS_PX = 264, 400
_DEVIATIONS, _UNIT_STEP = 3.0, 0.05
_WEIGHTS, _WEIGHT_STEP = (-1.0, 2.0), 0.01
_FOLDER = "figures"


class UnitsWindow(ToolWindow):
    """Non-modal; learns from the database of the main window while it is open."""

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.draft = UnitsDraft(self.jobs, self)
        self._arrange()
        self._join()
        self.refresh()

    # Making

    def _arrange(self) -> None:
        self.view = FaceView()
        self.pane = Pane(texts.FACE_PANE, self.view, texts.NO_DATABASE)
        self.style = Choice([texts.DOTS, texts.FACE])
        self.pane.header.addWidget(self.style)
        middle = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        for widget in (self._made_settings(), self.pane, self._made_sliders()):
            middle.addWidget(widget)
        middle.setStretchFactor(1, 1)
        middle.setSizes([_SETTINGS_PX, _SIZE[0] - _SETTINGS_PX - _SLIDERS_PX, _SLIDERS_PX])
        self.fill(middle)

    def _made_settings(self) -> QWidget:
        self.database = ElidedLabel()
        self.speech = HowMany(texts.SPEECH_UNITS, PAPER_UTTERANCE, 7, by_share=True)
        self.beyond = HowMany(texts.EXPRESSION_UNITS, PAPER_EXPRESSION, 2, by_share=False)
        self.expression = QComboBox(toolTip=texts.EXPRESSION_TIP)
        self.intensity = ValueSlider(0.0, 1.0, 0.01, texts.INTENSITY_TIP)
        self.intensity.show_value(1.0)
        self.intensity.setAccessibleName(texts.INTENSITY)
        self.intensity_label = label(texts.INTENSITY, "plain")
        self.curve = CoverageCurve()
        self.save_keyframes = QPushButton(texts.SAVE_KEYFRAMES, toolTip=texts.SAVE_KEYFRAMES_TIP)
        self.save_units = QPushButton(texts.SAVE_UNITS, toolTip=texts.SAVE_UNITS_TIP)
        made = QWidget()
        column = QVBoxLayout(made)
        column.setContentsMargins(STEP + 4, STEP, STEP + 4, STEP)
        column.setSpacing(STEP)
        column.addWidget(label(texts.SETTINGS, "title"))
        column.addWidget(self.database)
        column.addSpacing(STEP)
        column.addWidget(self.speech)
        column.addSpacing(STEP)
        column.addWidget(self.beyond)
        column.addSpacing(STEP)
        for widget in (label(texts.EXPRESSION, "plain"), self.expression, self.intensity_label, self.intensity):
            column.addWidget(widget)
        column.addStretch(1)
        column.addWidget(self.curve)
        column.addSpacing(STEP)
        column.addWidget(self.save_keyframes)
        column.addWidget(self.save_units)
        return made

    def _made_sliders(self) -> QWidget:
        self.units = SliderList(_UNIT_STEP, texts.UNIT_TIP, lambda value: texts.UNIT_VALUE.format(value=value + 0.0))
        self.weights = SliderList(_WEIGHT_STEP, texts.KEYFRAME_TIP, lambda value: f"{value + 0.0:.2f}")
        self.reset_button = QToolButton(text=texts.RESET, toolTip=texts.RESET_TIP)
        self.rest_button = QToolButton(text=texts.REST, toolTip=texts.REST_TIP)
        self.source = Choice([texts.DRAWN, texts.CAPTURED])
        self.form = Choice([texts.PRINTED, texts.DISPLACEMENT])
        self.bounded = toggle(texts.BOUNDED, texts.BOUNDED_TIP, lambda _: self.on_form())
        self.off = ElidedLabel()
        made = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False, handleWidth=1)
        made.addWidget(_section(texts.UNITS, (self.reset_button, self.rest_button), self.units))
        forms = QHBoxLayout()
        forms.setSpacing(STEP)
        forms.addWidget(self.form)
        forms.addWidget(self.bounded)
        forms.addStretch(1)
        keyframes = _section(texts.KEYFRAMES, (self.source,), self.weights, forms)
        keyframes.layout().addWidget(self.off)
        made.addWidget(keyframes)
        return made

    def _join(self) -> None:
        draft, document = self.draft, self.authoring.document
        draft.changed.connect(self.refresh)
        self.jobs.failed.connect(self.message.say)
        self.units.moved.connect(draft.set_unit)
        self.weights.moved.connect(draft.set_keyframe)
        self.reset_button.clicked.connect(self.on_reset)
        self.rest_button.clicked.connect(self.on_rest)
        self.style.group.idClicked.connect(lambda _: self._dress())
        for choice in (self.source, self.form):
            choice.group.idClicked.connect(lambda _: self.on_form())
        self.expression.activated.connect(lambda _: self.on_expression())
        self.intensity.set_to.connect(lambda _: self.on_expression())
        for how_many in (self.speech, self.beyond):
            how_many.asked.connect(self.learn)
        self.save_keyframes.clicked.connect(self.ask_save_keyframes)
        self.save_units.clicked.connect(self.ask_save_units)
        for key, done in {"Ctrl+0": self.on_reset, "Ctrl+S": self.ask_save_keyframes, "Ctrl+W": self.close}.items():
            QShortcut(QKeySequence(key), self, activated=done)
        document.changed.connect(self.on_document_changed)
        self.authoring.rig_changed.connect(self._show_face)

    # Reactions

    def open_now(self) -> None:
        """Show the window, in front, with the units of the open database."""
        super().open_now()
        self._show_face()
        learned, document = self.draft.learned, self.authoring.document
        known = None if learned is None else (learned.request.database, learned.request.removed)
        if known is None or known[0] is not document.database or known[1] != document.removed:
            self.learn()

    def learn(self) -> None:
        """Learn units of the open database, as many as are asked for."""
        document = self.authoring.document
        if not self.isVisible():
            return
        if document.database is None:
            self.draft.learn(None)
            return
        request = LearnRequest(document.database, document.removed, self.speech.how_many,
                               self.beyond.how_many)  # fmt: skip
        self.draft.learn(request)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Learn from another database, or without the nodes that were removed."""
        if change & Change.NODES:
            self._show_face()
        if change & (Change.NODES | Change.CURATION):
            self.learn()

    def on_expression(self) -> None:
        """Add another expression, or more of it."""
        if self.draft.pose is not None:
            self.draft.set_expression(self.expression.currentData(), self.intensity.value() / 100.0)

    def on_form(self) -> None:
        """Weigh other keyframes, or otherwise."""
        self.draft.set_form(self.source.key, self.form.key == texts.DISPLACEMENT[0], self.bounded.isChecked())

    def on_reset(self) -> None:
        """Show the mean face."""
        if self.draft.pose is not None:
            self.draft.reset()

    def on_rest(self) -> None:
        """Show the neutral face, as near as units come."""
        if self.draft.pose is not None:
            self.draft.rest()

    def ask_save_keyframes(self) -> None:
        """Choose where the figure of the keyframes goes."""
        keyframes = self.draft.keyframes
        if keyframes is not None:
            learned, rig = self.draft.learned, self.authoring.rig
            is_captured = self.draft.source == texts.CAPTURED[0]
            title = texts.FIGURE_CAPTURED.format(name=learned.request.database.name)
            if not is_captured and rig is not None:
                title = texts.FIGURE_DRAWN.format(face=rig.face.name)
            what = {"keyframes": keyframes, "title": title, "drawn": learned.not_captured if is_captured else ()}
            self._save(texts.SAVE_KEYFRAMES, texts.FILE_KEYFRAMES, what)

    def ask_save_units(self) -> None:
        """Choose where the figure of the units goes."""
        pose = self.draft.pose
        if pose is not None:
            names = tuple(unit_names(pose.units, pose.expression))
            what = {"poses": unit_poses(pose.units, pose.expression), "names": names}
            self._save(texts.SAVE_UNITS, texts.FILE_UNITS, what)

    def _save(self, title: str, file_name: str, what: dict[str, object]) -> None:
        rig = self.authoring.rig
        if rig is None:
            self.message.say(texts.NEEDS_FACE, texts.CHOOSE_FACE)
            return
        start = Path(last_folder(self._settings, _FOLDER)) / file_name
        name, _ = QFileDialog.getSaveFileName(self, title, str(start), texts.FILTER_PICTURE)
        if name:
            path = Path(name) if Path(name).suffix.lower() == ".png" else Path(f"{name}.png")
            remember_folder(self._settings, _FOLDER, path)
            request = FigureRequest(path, rig, **what)
            self.jobs.start("figure", texts.DRAWING, request, draw,
                            lambda path: self.status.say(texts.SAVED.format(path=path)))  # fmt: skip

    # Showing

    def refresh(self) -> None:
        """Show what is posed now."""
        draft, learned = self.draft, self.draft.learned
        is_there = draft.pose is not None
        for widget in (self.expression, self.intensity, self.reset_button, self.rest_button, self.save_units):
            widget.setEnabled(is_there)
        self.save_keyframes.setEnabled(draft.keyframes is not None)
        if not is_there:
            self.database.setText("")
            self.off.setText("")
            self.curve.show_shares({}, {})
            self.units.show_values((), np.zeros(0), -1, 1)
            self.weights.show_values((), np.zeros(0), 0, 1)
            self._show_face()
            return
        self.database.setText(learned.request.database.name)
        self._show_covered()
        self._show_expressions()
        pose, keyframes = draft.pose, draft.keyframes
        names = unit_names(pose.units, pose.expression)
        self.units.show_values(names, pose.deviations, -_DEVIATIONS, _DEVIATIONS)
        for key in (texts.CAPTURED[0], texts.DRAWN[0]):
            self.source.button(key).setEnabled(key in learned.keyframes)
        self.source.button(draft.source).setChecked(True)
        bounds = (0.0, 1.0) if draft.bounded else _WEIGHTS
        self.weights.show_values(() if keyframes is None else keyframes.names, draft.weights, *bounds)
        self.off.setText(self._off_in_words() if keyframes is not None else "")
        self.view.show_pose(draft.moved.astype(np.float32))
        self.pane.show_content()

    def _off_in_words(self) -> str:
        draft = self.draft
        off = (texts.UNITS_OFF if draft.by_keyframes else texts.KEYFRAMES_OFF).format(off=draft.off_mm)
        drawn = draft.learned.not_captured if draft.source == texts.CAPTURED[0] else ()
        return " · ".join([off, texts.NOT_CAPTURED.format(names=", ".join(drawn))] if drawn else [off])

    def _show_covered(self) -> None:
        units = self.draft.learned.units
        spoken = units.utterance
        self.speech.show_covered(texts.COVERED_SPEECH.format(count=len(spoken.units), share=100 * spoken.coverage),
                                 len(spoken.units), spoken.coverage)  # fmt: skip
        name = self.draft.pose.expression
        if name not in units.expressions:
            name = next(iter(units.expressions), None)
        if name is None:
            self.beyond.covered.setText(texts.NO_EXPRESSIONS)
        else:
            shown = units.expressions[name]
            sentence = texts.COVERED_EXPRESSION.format(name=name, count=len(shown.units), share=100 * shown.coverage)
            self.beyond.show_covered(sentence, len(shown.units), shown.coverage)
        self.beyond.setEnabled(name is not None)
        counts = {name: len(found.units) for name, found in units.expressions.items()} | {NEUTRAL: len(spoken.units)}
        self.curve.show_shares(self.draft.learned.shares, counts)

    def _show_expressions(self) -> None:
        names = [NEUTRAL, *self.draft.learned.units.expressions]
        if [self.expression.itemData(n) for n in range(self.expression.count())] != names:
            self.expression.clear()
            for name in names:
                self.expression.addItem(name, name)
        self.expression.setCurrentIndex(names.index(self.draft.pose.expression))
        self.intensity.setEnabled(self.draft.pose.expression != NEUTRAL)
        self.intensity.show_value(self.draft.pose.intensity)
        self.intensity_label.setText(texts.INTENSITY_VALUE.format(intensity=self.draft.pose.intensity))

    def _show_face(self) -> None:
        database, rig = self.authoring.document.database, self.authoring.rig
        if database is None:
            self.pane.show_empty(texts.NO_DATABASE)
        elif self.isVisible():
            self.view.set_markers(database.markers)
            self.view.set_rig(rig)
            self.style.button(texts.FACE[0]).setEnabled(rig is not None)
            self._dress()
            learned = self.draft.learned
            if learned is not None and learned.request.database is database:
                self.view.show_pose(self.draft.moved.astype(np.float32))
                self.pane.show_content()
            else:
                self.pane.show_empty(self.draft.trouble or texts.LEARNING + "…")

    def _dress(self) -> None:
        self.view.set_style(Style.TEXTURED if self.style.key == texts.FACE[0] else Style.MARKERS)

    def shut_down(self) -> None:
        """Stop all jobs and free the view, for good; the main window closes."""
        self.authoring.document.changed.disconnect(self.on_document_changed)
        self.jobs.shut_down()
        self.view.release()
        self.close()


def _section(
    title: str, buttons: tuple[QWidget, ...], sliders: SliderList, below: QHBoxLayout | None = None
) -> QWidget:
    """A title with its buttons, a row of choices, and sliders."""
    made = QWidget()
    column = QVBoxLayout(made)
    column.setContentsMargins(STEP, STEP // 2, STEP, STEP // 2)
    column.setSpacing(STEP // 2)
    row = QHBoxLayout()
    row.addWidget(label(title, "title"), 1)
    for button in buttons:
        row.addWidget(button)
    column.addLayout(row)
    if below is not None:
        column.addLayout(below)
    column.addWidget(sliders, 1)
    return made
