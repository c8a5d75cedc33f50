"""The window of key lip shapes: the shapes at the left, captured and posed side by side, the controls at the right."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFileDialog,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSpinBox,
    QSplitter,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.authoring import Authoring
from app.panels.pane import label
from app.panels.poses.control_sliders import ControlSliders
from app.panels.poses.draft import PosingDraft
from app.panels.poses.faces import CapturedPane, PosedPane
from app.panels.poses.work import rig_of_file
from app.panels.tool_window import ToolWindow
from app.settings import last_folder, remember_folder
from app.texts import poses as texts
from app.theme import STEP
from core.document.change import Change
from core.face.characters import CHARACTERS, DEFAULT

_SIZE = (1480, 820)
_LIST_PX, _CONTROLS_PX = 232, 376
_FEWEST, _MOST, _USUAL = 2, 24, 7
_FOLDER = "poses"


class KeyPosesWindow(ToolWindow):
    """Non-modal; it keeps its poses while it is closed."""

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.draft = PosingDraft(self.jobs, self)
        self._arrange()
        self._join()
        self.refresh()
        self.resize(self.sizeHint())  # Qt by itself takes two thirds of the screen at most

    def _arrange(self) -> None:
        self.captured, self.posed = CapturedPane(), PosedPane()
        self.controls = ControlSliders()
        middle = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        for pane in (self._shapes(), self.captured, self.posed, self._controls()):
            middle.addWidget(pane)
        middle.setStretchFactor(1, 1)
        middle.setStretchFactor(2, 1)
        faces_px = (_SIZE[0] - _LIST_PX - _CONTROLS_PX) // 2
        middle.setSizes([_LIST_PX, faces_px, faces_px, _CONTROLS_PX])
        self.fill(middle)

    def _shapes(self) -> QWidget:
        """Lay out the list and what fills it."""
        self.list = QListWidget(toolTip=texts.KEYS_TIP)
        self.list.setEditTriggers(
            QAbstractItemView.EditTrigger.DoubleClicked | QAbstractItemView.EditTrigger.EditKeyPressed
        )
        self.count = QSpinBox(minimum=_FEWEST, maximum=_MOST, value=_USUAL, toolTip=texts.COUNT_TIP)
        self.count.setFixedWidth(6 * STEP)
        # the platform's arrows do not show on our ground
        self.count.setStyleSheet("QSpinBox::up-button, QSpinBox::down-button { width: 0; border: none; }")
        self.find_button = QPushButton(texts.FIND, toolTip=texts.FIND_TIP)
        self.add_button = QPushButton(texts.ADD, toolTip=texts.ADD_TIP)
        self.remove_button = QPushButton(texts.REMOVE, toolTip=texts.REMOVE_TIP)
        self.load_button = QPushButton(texts.LOAD, toolTip=texts.LOAD_TIP)
        self.save_button = QPushButton(texts.SAVE, toolTip=texts.SAVE_TIP)
        row = QHBoxLayout()
        row.addWidget(self.find_button, 1)
        row.addWidget(self.count)
        made = QWidget()
        column = QVBoxLayout(made)
        column.setContentsMargins(STEP + 4, STEP, STEP, STEP)
        column.setSpacing(STEP)
        column.addWidget(label(texts.KEYS, "title"))
        column.addWidget(self.list, 1)
        column.addLayout(row)
        for button in (self.add_button, self.remove_button):
            column.addWidget(button)
        column.addSpacing(STEP)
        for button in (self.load_button, self.save_button):
            column.addWidget(button)
        return made

    def _controls(self) -> QWidget:
        """Lay out the sliders and what changes them all."""
        self.guess_button = QToolButton(text=texts.GUESS, toolTip=texts.GUESS_TIP)
        self.reset_button = QToolButton(text=texts.RESET, toolTip=texts.RESET_TIP)
        self.undo_button = QToolButton(text=texts.UNDO.lower(), toolTip=texts.UNDO_TIP)
        self.redo_button = QToolButton(text=texts.REDO.lower(), toolTip=texts.REDO_TIP)
        row = QHBoxLayout()
        row.addWidget(label(texts.CONTROLS, "title"), 1)
        for button in (self.guess_button, self.reset_button, self.undo_button, self.redo_button):
            row.addWidget(button)
        made = QWidget()
        column = QVBoxLayout(made)
        column.setContentsMargins(STEP, STEP, STEP, STEP)
        column.setSpacing(STEP)
        column.addLayout(row)
        column.addWidget(self.controls, 1)
        return made

    def _join(self) -> None:
        draft, undo = self.draft, self.draft.undo_stack
        draft.changed.connect(self.refresh)
        draft.failed.connect(self.message.say)
        draft.noted.connect(self.status.say)
        undo.indexChanged.connect(self.message.hide)  # what was wrong before the change is old
        undo.cleanChanged.connect(self.on_clean)
        for button, can, now in (
            (self.undo_button, undo.canUndoChanged, undo.canUndo()),
            (self.redo_button, undo.canRedoChanged, undo.canRedo()),
        ):
            button.setEnabled(now)
            can.connect(button.setEnabled)
        self.list.currentRowChanged.connect(lambda _: self._show_shape())
        self.list.itemChanged.connect(lambda item: draft.rename(self.list.row(item), item.text().strip()))
        self.controls.moved.connect(self.on_moved)
        self.posed.characters.activated.connect(lambda _: self.on_character())
        for button, done in (
            (self.find_button, self.on_find), (self.add_button, self.on_add), (self.remove_button, self.on_remove),
            (self.load_button, self.ask_load), (self.save_button, self.ask_save), (self.guess_button, self.on_guess),
            (self.reset_button, self.on_reset), (self.undo_button, undo.undo), (self.redo_button, undo.redo),
        ):  # fmt: skip
            button.clicked.connect(done)
        for key, done in {
            "Ctrl+Z": undo.undo, "Ctrl+Shift+Z": undo.redo, "Ctrl+O": self.ask_load, "Ctrl+S": self.ask_save,
            "Ctrl+F": self.controls.search.setFocus, "Ctrl+W": self.close,
        }.items():  # fmt: skip
            QShortcut(QKeySequence(key), self, activated=done)
        QShortcut(QKeySequence("Delete"), self.list, self.on_remove, context=Qt.ShortcutContext.WidgetShortcut)
        self.authoring.document.changed.connect(self.on_document_changed)
        self.authoring.rig_changed.connect(self._show_captures)

    # Reactions

    def open_now(self) -> None:
        """Show the window, in front, with the character of the main window to begin with."""
        super().open_now()
        if self.draft.posing.face is None and not self.jobs.is_running("rig"):
            face = self.authoring.document.face
            self.draft.open_rig(face.name if face is not None and face.name in CHARACTERS else DEFAULT)

    def on_clean(self, is_clean: bool) -> None:
        """Say in the title whether there is something to save."""
        self.setWindowModified(not is_clean)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show captures of another database."""
        if change & Change.NODES:
            self._show_captures()

    def on_find(self) -> None:
        """Choose key lip shapes among the captures."""
        self.draft.find(self.authoring.document.database, self.count.value())

    def on_add(self) -> None:
        """Take the frame at the playhead."""
        self.draft.add(self.authoring.document.motion, self.authoring.view.playhead_s)

    def on_remove(self) -> None:
        """Take the chosen shape away."""
        if self.row >= 0:
            self.draft.remove(self.row)

    def on_guess(self) -> None:
        """Pose the chosen shape by least squares."""
        database = self.authoring.document.database
        if self.row >= 0:
            self.draft.guess(self.row, None if database is None else database.markers)

    def on_reset(self) -> None:
        """Put the chosen pose to rest."""
        if self.row >= 0:
            self.draft.reset(self.row)

    def on_moved(self, name: str, value: float, gesture: int | None) -> None:
        """Move a control of the chosen pose."""
        if self.row >= 0:
            self.draft.set_control(self.row, name, value, gesture)

    def on_character(self) -> None:
        """Pose another character, or a rig that is asked for."""
        name, face = self.posed.asked, self.draft.posing.face
        if name in CHARACTERS:
            self.draft.open_rig(name)
            return
        if face is not None and name == face.face.name:
            return
        chosen, _ = QFileDialog.getOpenFileName(self, texts.RIG_FILE, last_folder(self._settings, "face"),
                                                texts.FILTER_RIG)  # fmt: skip
        if chosen:
            remember_folder(self._settings, "face", Path(chosen))
            self.draft.open_rig(rig_of_file(Path(chosen)))
        else:
            self.posed.show_face(face)

    def ask_load(self) -> None:
        """Choose poses to go on with."""
        name, _ = QFileDialog.getOpenFileName(self, texts.LOAD, last_folder(self._settings, _FOLDER),
                                              texts.FILTER_POSES)  # fmt: skip
        if name:
            remember_folder(self._settings, _FOLDER, Path(name))
            self.draft.load(Path(name), self.authoring.document.database)

    def ask_save(self) -> None:
        """Choose where the poses are kept."""
        if not self.draft.posing.keys:
            self.message.say(texts.NONE_YET)
            return
        rig = Path(self.draft.posing.poses.rig).stem
        start = Path(last_folder(self._settings, _FOLDER)) / texts.FILE_NAME.format(rig=rig)
        name, _ = QFileDialog.getSaveFileName(self, texts.SAVE, str(start), texts.FILTER_POSES)
        if name:
            path = Path(name) if Path(name).suffix else Path(f"{name}.json")
            remember_folder(self._settings, _FOLDER, path)
            self.draft.save(path)

    # Showing

    @property
    def row(self) -> int:
        """The chosen shape; -1 for none."""
        return self.list.currentRow()

    def refresh(self) -> None:
        """Show the poses as they are now."""
        posing = self.draft.posing
        self.list.blockSignals(True)
        self._list_keys(posing.keys)
        self.list.blockSignals(False)
        self.posed.show_face(posing.face)
        if posing.face is not None:
            self.controls.show_controls(posing.face.rig.names)
        self._show_captures()

    def _list_keys(self, keys: tuple[str, ...]) -> None:
        before, row = tuple(self.list.item(n).text() for n in range(self.list.count())), self.row
        if len(keys) == len(before):
            for n, key in enumerate(keys):
                self.list.item(n).setText(key)
            return
        self.list.clear()
        for key in keys:
            item = QListWidgetItem(key)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsEditable)
            self.list.addItem(item)
        if len(keys) == len(before) + 1:  # the new one is what is posed next
            row = next((n for n, key in enumerate(before) if key != keys[n]), len(before))
        self.list.setCurrentRow(min(max(row, 0), len(keys) - 1))

    def _show_captures(self) -> None:
        database = self.authoring.document.database
        markers = None if database is None else database.markers
        self.captured.show_on(markers, self.authoring.rig if markers is not None else None)
        self._show_shape()

    def _show_shape(self) -> None:
        posing, row, database = self.draft.posing, self.row, self.authoring.document.database
        is_one = 0 <= row < len(posing.keys)
        moved = posing.captured(row, database.markers) if is_one and database is not None else None
        self.captured.show_shape(moved, texts.NO_DATABASE if is_one else texts.NONE_YET)
        values = posing.poses.values[row] if is_one else None
        self.posed.show_values(values)
        self.controls.show_values(values)
        for button in (self.find_button, self.add_button):
            button.setEnabled(posing.face is not None)
        for button in (self.remove_button, self.guess_button, self.reset_button, self.save_button):
            button.setEnabled(is_one)

    @property
    def has_unsaved_poses(self) -> bool:
        """Whether closing for good would lose key lip shapes."""
        return bool(self.draft.posing.keys) and not self.draft.undo_stack.isClean()

    def shut_down(self) -> None:
        """Stop all jobs and free the views, for good; the main window closes."""
        self.authoring.document.changed.disconnect(self.on_document_changed)
        self.jobs.shut_down()
        for pane in (self.captured, self.posed):
            pane.view.release()
        self.close()
