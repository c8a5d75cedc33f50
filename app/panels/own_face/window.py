"""The window of own faces: the guided list at the left, the scan and the generic face side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QPushButton, QSplitter, QVBoxLayout, QWidget

from app.authoring import Authoring
from app.panels.own_face.draft import OwnFaceDraft
from app.panels.own_face.guide import Guide
from app.panels.own_face.panes import FacePane, ScanPane
from app.panels.own_face.point_view import Place
from app.panels.tool_window import ToolWindow
from app.settings import last_folder, remember_folder
from app.texts import own_face as texts
from app.theme import STEP
from core.document.parts import FaceChoice
from core.face.characters import CHARACTERS, DEFAULT
from core.face.face_file import FACE_SUFFIX
from core.face.own_face_points import feature_points

_SIZE = (1480, 820)
_GUIDE_PX = 312
_TIP = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
_ROUND = np.array([[0, 0, 1.0], [0, 1.0, 0], [-1.0, 0, 0]])
_FOLDER, _FACE_FOLDER = "scan", "face"


class OwnFaceWindow(ToolWindow):
    """Non-modal; it keeps its points while it is closed."""

    def __init__(self, authoring: Authoring, parent: QWidget | None = None) -> None:
        super().__init__(authoring, texts.TITLE, _SIZE, parent)
        self.draft = OwnFaceDraft(self.jobs, self)
        self._arrange()
        self._join()
        self.refresh()

    def _arrange(self) -> None:
        self.guide, self.scan_pane, self.face_pane = Guide(), ScanPane(), FacePane()
        self.fit_button = QPushButton(texts.FIT, toolTip=texts.FIT_TIP)
        self.fit_button.setProperty("role", "primary")
        self.save_button = QPushButton(texts.SAVE_FACE, toolTip=texts.SAVE_FACE_TIP)
        self.use_button = QPushButton(texts.USE_FACE, toolTip=texts.USE_FACE_TIP)
        row = QHBoxLayout()
        row.setContentsMargins(STEP + 4, 0, STEP, STEP)
        row.setSpacing(STEP)
        row.addWidget(self.fit_button, 1)
        for button in (self.save_button, self.use_button):
            row.addWidget(button)
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.guide, 1)
        column.addLayout(row)
        middle = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        for pane in (left, self.scan_pane, self.face_pane):
            middle.addWidget(pane)
        middle.setStretchFactor(1, 1)
        middle.setStretchFactor(2, 1)
        views_px = (_SIZE[0] - _GUIDE_PX) // 2
        middle.setSizes([_GUIDE_PX, views_px, views_px])
        self.fill(middle)

    def _join(self) -> None:
        draft, undo, guide = self.draft, self.draft.undo_stack, self.guide
        draft.changed.connect(self.refresh)
        draft.scan_changed.connect(lambda: self.scan_pane.show_scan(draft.scan))
        draft.photo_changed.connect(lambda: self.scan_pane.show_photo(None if draft.photo is None else draft.photo[1]))
        draft.generic_changed.connect(self._show_generic)
        draft.fitted_changed.connect(self._show_fitted)
        draft.failed.connect(self.message.say)
        draft.noted.connect(self.status.say)
        undo.indexChanged.connect(self.message.hide)  # what was wrong before the change is old
        for button, can in ((guide.undo_button, undo.canUndoChanged), (guide.redo_button, undo.canRedoChanged)):
            button.setEnabled(False)
            can.connect(button.setEnabled)
        guide.chosen.connect(lambda _: self.refresh())
        self.scan_pane.view.placed.connect(self.on_scan_clicked)
        self.scan_pane.photo_view.placed.connect(self.on_photo_clicked)
        self.scan_pane.shown.group.idClicked.connect(lambda _: self.refresh())
        self.face_pane.view.placed.connect(self.on_generic_clicked)
        self.face_pane.changed.connect(self.refresh)
        self.face_pane.characters.activated.connect(lambda _: self.on_character())
        for button, done in (
            (guide.skip_button, self.on_skip), (guide.remove_button, self.on_remove),
            (guide.undo_button, undo.undo), (guide.redo_button, undo.redo),
            (guide.load_button, self.ask_load), (guide.save_button, self.ask_save_points),
            (self.scan_pane.open_button, self.ask_scan), (self.scan_pane.photo_button, self.ask_photo),
            (self.fit_button, draft.fit), (self.save_button, self.ask_save), (self.use_button, self.on_use),
        ):  # fmt: skip
            button.clicked.connect(done)
        for button, turn in ((self.scan_pane.over_button, _TIP), (self.scan_pane.round_button, _ROUND)):
            button.clicked.connect(lambda _=False, quarter=turn: draft.turn_scan(quarter))
        for key, done in {
            "Ctrl+Z": undo.undo, "Ctrl+Shift+Z": undo.redo, "Ctrl+O": self.ask_scan, "Ctrl+L": self.ask_load,
            "Ctrl+S": self.ask_save, "Ctrl+Return": draft.fit, "Space": self.on_skip, "Delete": self.on_remove,
            "Ctrl+W": self.close,
        }.items():  # fmt: skip
            QShortcut(QKeySequence(key), self, activated=done)

    # Reactions

    def open_now(self) -> None:
        """Show the window, in front, with a generic face."""
        super().open_now()
        if self.draft.generic is None and not self.jobs.is_running("generic"):
            face = self.authoring.document.face
            self.draft.open_generic(face.name if face is not None and face.name in CHARACTERS else DEFAULT)

    def on_scan_clicked(self, shown: np.ndarray) -> None:
        """Set the chosen point on the scan and go on with the next."""
        key = self.guide.key
        self.draft.place(key, self.draft.scan.shown.original(shown))
        self.guide.go_on(self.draft.points.on_scan)

    def on_photo_clicked(self, pixel: np.ndarray) -> None:
        """Set the chosen point on the photo and go on with the next."""
        self.draft.place_on_photo(self.guide.key, pixel)
        self.guide.go_on(self.draft.points.on_photo)

    def on_generic_clicked(self, place: np.ndarray) -> None:
        """Put the chosen point elsewhere on the generic face."""
        self.draft.move(self.guide.key, place)

    def on_skip(self) -> None:
        """Go on with the next point that is not set."""
        self.guide.go_on(self._is_set)

    def on_remove(self) -> None:
        """Take the chosen point away."""
        self.draft.remove(self.guide.key, self.scan_pane.on_photo)

    def on_character(self) -> None:
        """Fit another of our characters."""
        name = self.face_pane.characters.currentData()
        if self.draft.generic is None or name != self.draft.generic.face.name:
            self.draft.open_generic(name)

    def on_use(self) -> None:
        """Show the saved face in the main window."""
        if self.draft.saved_path is not None:
            self.authoring.set_face(FaceChoice(str(self.draft.saved_path)))

    def _ask_open(self, title: str, pattern: str, folder: str) -> Path | None:
        name, _ = QFileDialog.getOpenFileName(self, title, last_folder(self._settings, folder), pattern)
        if not name:
            return None
        remember_folder(self._settings, folder, Path(name))
        return Path(name)

    def _ask_new(self, title: str, pattern: str, folder: str, name: str) -> Path | None:
        start = Path(last_folder(self._settings, folder)) / name
        chosen, _ = QFileDialog.getSaveFileName(self, title, str(start), pattern)
        if not chosen:
            return None
        path, suffix = Path(chosen), Path(name).suffix
        path = path if path.suffix.lower() == suffix else Path(f"{chosen}{suffix}")
        remember_folder(self._settings, folder, path)
        return path

    def ask_scan(self) -> None:
        """Choose a scan."""
        path = self._ask_open(texts.OPEN_SCAN, texts.FILTER_SCAN, _FOLDER)
        if path is not None:
            self.draft.open_scan(path)

    def ask_photo(self) -> None:
        """Choose a photo."""
        path = self._ask_open(texts.OPEN_PHOTO, texts.FILTER_PHOTO, _FOLDER)
        if path is not None:
            self.draft.open_photo(path)

    def ask_load(self) -> None:
        """Choose points to go on with."""
        if self.draft.scan is None:
            self.message.say(texts.NO_SCAN)
            return
        path = self._ask_open(texts.LOAD_POINTS, texts.FILTER_POINTS, _FOLDER)
        if path is not None:
            self.draft.load_points(path)

    def ask_save_points(self) -> None:
        """Choose where the points are kept."""
        stem = "scan" if self.draft.scan is None else self.draft.scan.path.stem
        path = self._ask_new(texts.SAVE_POINTS, texts.FILTER_POINTS, _FOLDER, f"{stem}-points.json")
        if path is not None:
            self.draft.save_points(path)

    def ask_save(self) -> None:
        """Choose where the fitted face goes."""
        if self.draft.fitted is None:
            return
        stem = self.draft.scan.path.stem
        path = self._ask_new(texts.SAVE_FACE, texts.FILTER_FACE, _FACE_FOLDER, f"{stem}{FACE_SUFFIX}")
        if path is not None:
            self.draft.save(path)

    # Showing

    @property
    def _is_set(self) -> dict[str, np.ndarray]:
        points = self.draft.points
        return points.on_photo if self.scan_pane.on_photo else points.on_scan

    @property
    def has_unsaved_face(self) -> bool:
        """Whether a face was fitted and not saved."""
        return self.draft.fitted is not None and self.draft.saved_path is None

    def refresh(self) -> None:
        """Show the points as they are now."""
        draft, chosen = self.draft, self.guide.key
        doubtful = () if draft.fitted is None else draft.fitted.own.doubtful
        self.guide.show_set(self._is_set, () if self.scan_pane.on_photo else doubtful)
        numbers = {point.key: str(n + 1) for n, point in enumerate(feature_points())}
        if draft.scan is not None:
            places = [
                Place(key, draft.scan.shown.shown(at[None])[0], label=numbers[key], is_chosen=key == chosen,
                      needs_look=key in doubtful)
                for key, at in draft.points.on_scan.items()
            ]  # fmt: skip
            guess = None if chosen in draft.points.on_scan else draft.guess(chosen)
            if guess is not None:
                places.append(Place(chosen, draft.scan.shown.shown(guess[None])[0], label="", is_guess=True))
            self.scan_pane.view.show_places(tuple(places))
        self.scan_pane.photo_view.show_places(tuple(
            Place(key, at, label=numbers[key], is_chosen=key == chosen) for key, at in draft.points.on_photo.items()
        ))  # fmt: skip
        self.face_pane.view.show_places(tuple(
            Place(key, at, label=numbers[key], is_chosen=key == chosen)
            for key, at in (draft.generic_places.items() if self.face_pane.on_generic else ())
        ))  # fmt: skip
        self.guide.remove_button.setEnabled(chosen in self._is_set)
        self.guide.save_button.setEnabled(bool(draft.points.on_scan))
        self.fit_button.setEnabled(draft.scan is not None and draft.generic is not None and not draft.missing)
        self.save_button.setEnabled(draft.fitted is not None)
        self.use_button.setEnabled(draft.saved_path is not None)

    def _show_generic(self) -> None:
        if self.draft.generic is not None:
            self.face_pane.show_generic(self.draft.generic)

    def _show_fitted(self) -> None:
        self.face_pane.show_fitted(self.draft.fitted)
        self.setWindowModified(self.has_unsaved_face)
        self.refresh()

    def shut_down(self) -> None:
        """Stop all jobs and free the views, for good; the main window closes."""
        self.jobs.shut_down()
        for pane in (self.scan_pane, self.face_pane):
            pane.view.release()
        self.close()
