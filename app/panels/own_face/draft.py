"""The points that a user sets: edits with undo, and the jobs that read, fit and save."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.jobs import JobRunner
from app.panels.own_face.work import (
    FitRequest,
    Fitted,
    OpenedScan,
    ScanRequest,
    StillFace,
    fit,
    open_generic,
    open_photo,
    open_scan,
    read_points,
    save,
)
from app.texts import own_face as texts
from core.errors import UserFacingError
from core.face.own_face_points import PointFile, feature_points, generic_points, save_points
from core.face.similarity import fit_similarity

_FEWEST_FOR_GUESS = 4
TITLES = {point.key: point.title for point in feature_points()}


@dataclass(frozen=True)
class Points:
    """What is set: on the scan (its unit), elsewhere on the generic face (mm), on the photo (pixels)."""

    on_scan: Mapping[str, np.ndarray] = field(default_factory=dict)
    moved: Mapping[str, np.ndarray] = field(default_factory=dict)
    on_photo: Mapping[str, np.ndarray] = field(default_factory=dict)


class OwnFaceDraft(QObject):
    """A scan, a photo if there is one, the generic face, the points on all, and the fitted face.

    Every change of points can be taken back; a job that is cancelled or fails changes nothing.

    changed() : something else is to be shown; fitted_changed() : another fitted face, or none
    failed(sentence, remedy), noted(sentence) : for the window's lines
    """

    changed = Signal()
    scan_changed = Signal()
    photo_changed = Signal()
    generic_changed = Signal()
    fitted_changed = Signal()
    failed = Signal(str, str)
    noted = Signal(str)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.points = Points()
        self.scan: OpenedScan | None = None
        self.photo: tuple[Path, np.ndarray] | None = None
        self.generic: StillFace | None = None
        self.fitted: Fitted | None = None
        self.saved_path: Path | None = None
        self.undo_stack = QUndoStack(self)
        self._jobs = jobs
        jobs.failed.connect(self.failed)

    def show(self, points: Points) -> None:
        """Take other points; without undo, for the commands on the stack."""
        self.points = points
        self.changed.emit()

    def _push(self, points: Points, text: str) -> None:
        self.undo_stack.push(_Replace(self, points, text))

    # Scan, photo, generic face

    def open_scan(self, path: Path) -> None:
        """Fit to another scan; points on the old one go."""

        def opened(scan: OpenedScan) -> None:
            other = self.scan is not None and self.scan.path != scan.path
            self.scan = scan
            if other:
                self.undo_stack.clear()
                self.show(replace(self.points, on_scan={}, on_photo={}))
                self._take_photo(None)
            self._take(None)
            self.scan_changed.emit()
            self.changed.emit()
            if scan.scan.notes:
                self.noted.emit(" ".join(scan.scan.notes))

        self._jobs.start("scan", texts.READING_SCAN, ScanRequest(path), open_scan, opened)

    def turn_scan(self, quarter: np.ndarray) -> None:
        """Show the scan turned by ``quarter``, shape (3, 3); the points stay where they are on it."""
        if self.scan is None:
            return

        def opened(scan: OpenedScan) -> None:
            self.scan = scan
            self.scan_changed.emit()
            self.changed.emit()

        request = ScanRequest(self.scan.path, self.scan.scan, quarter @ self.scan.shown.turn)
        self._jobs.start("scan", texts.READING_SCAN, request, open_scan, opened)

    def open_photo(self, path: Path) -> None:
        """Paint with another photo; points on the old one go."""

        def opened(photo: tuple[Path, np.ndarray]) -> None:
            self._take_photo(photo)
            if self.points.on_photo:
                self._push(replace(self.points, on_photo={}), texts.OPEN_PHOTO.rstrip("…"))
            self.changed.emit()

        self._jobs.start("photo", texts.READING_PHOTO, path, open_photo, opened)

    def _take_photo(self, photo: tuple[Path, np.ndarray] | None) -> None:
        self.photo = photo
        self.photo_changed.emit()

    def open_generic(self, name: str) -> None:
        """Fit another of our characters."""

        def opened(still: StillFace) -> None:
            self.generic = still
            self._take(None)
            if self.points.moved:  # they were moved on another head
                self.undo_stack.clear()
                self.points = replace(self.points, moved={})
            self.generic_changed.emit()
            self.changed.emit()

        self._jobs.start("generic", texts.OPENING_GENERIC, name, open_generic, opened, self._on_failed)

    def _on_failed(self, error: UserFacingError) -> None:
        self.failed.emit(error.message, error.remedy)
        self.generic_changed.emit()  # what was asked for is not what is shown

    # Points

    @property
    def generic_places(self) -> dict[str, np.ndarray]:
        """Where the points lie on the generic face, mm."""
        return {} if self.generic is None else generic_points(self.generic.face, self.points.moved)

    @property
    def missing(self) -> list[str]:
        """Keys of the points that a fit needs and that are not set."""
        return [point.key for point in feature_points() if point.is_needed and point.key not in self.points.on_scan]

    def place(self, key: str, at: np.ndarray) -> None:
        """Set a point on the scan, in its unit."""
        self._push(replace(self.points, on_scan={**self.points.on_scan, key: at}), _named(texts.EDIT_PLACE, key))

    def place_on_photo(self, key: str, at: np.ndarray) -> None:
        """Set a point on the photo, in its pixels."""
        self._push(replace(self.points, on_photo={**self.points.on_photo, key: at}), _named(texts.EDIT_PHOTO, key))

    def move(self, key: str, at: np.ndarray) -> None:
        """Put a point elsewhere on the generic face, mm."""
        self._push(replace(self.points, moved={**self.points.moved, key: at}), _named(texts.EDIT_MOVE, key))

    def remove(self, key: str, on_photo: bool = False) -> None:
        """Take a point off the scan, or off the photo."""
        name = "on_photo" if on_photo else "on_scan"
        places = getattr(self.points, name)
        if key in places:
            left = {other: at for other, at in places.items() if other != key}
            self._push(replace(self.points, **{name: left}), _named(texts.EDIT_REMOVE, key))

    def guess(self, key: str) -> np.ndarray | None:
        """Return where the points on the scan would have ``key``, in its unit; None while they say too little."""
        generic = self.generic_places
        keys = [k for k in self.points.on_scan if k in generic]
        if key not in generic or len(keys) < _FEWEST_FOR_GUESS:
            return None
        source = np.array([generic[k] for k in keys])
        spread = np.linalg.svd(source - source.mean(axis=0), compute_uv=False)
        if spread[1] < 0.2 * spread[0]:
            return None
        return fit_similarity(source, np.array([self.points.on_scan[k] for k in keys]))(generic[key])

    # Fit

    def fit(self) -> None:
        """Fit the generic face; the answer is `fitted`."""
        if self.scan is None or self.generic is None:
            self.failed.emit(texts.NO_SCAN, "")
            return
        if self.missing:
            self.failed.emit(texts.FIT_NEEDS, "")
            return

        def fitted(answer: Fitted) -> None:
            self._take(answer)
            self.noted.emit(" ".join(answer.notes))

        photo = None if self.photo is None else self.photo[1]
        request = FitRequest(
            self.generic.face, self.scan.scan, dict(self.points.on_scan), dict(self.points.moved),
            self.scan.path.stem, photo, dict(self.points.on_photo),
        )  # fmt: skip
        self._jobs.start("fit", texts.FITTING, request, fit, fitted)

    def _take(self, fitted: Fitted | None) -> None:
        if fitted is not self.fitted:
            self.fitted, self.saved_path = fitted, None
            self.fitted_changed.emit()

    # Files

    def save(self, path: Path) -> None:
        """Write the fitted face."""
        if self.fitted is None:
            return
        fitted = self.fitted

        def saved(where: Path) -> None:
            if self.fitted is fitted:
                self.saved_path = where
            self.fitted_changed.emit()
            self.noted.emit(texts.SAVED_FACE.format(path=where))

        face = replace(fitted.face, name=path.stem)
        self._jobs.start("save", texts.SAVING, (face, path), save, saved)

    def save_points(self, path: Path) -> None:
        """Write the points."""
        points = self.points
        try:
            save_points(path, PointFile(points.on_scan, {}, points.moved, points.on_photo))
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self.noted.emit(texts.SAVED_POINTS.format(path=path))

    def load_points(self, path: Path) -> None:
        """Go on with points in a file."""

        def loaded(answer: tuple[PointFile, str]) -> None:
            file, trouble = answer
            self._push(Points(file.points, file.moved, file.photo), texts.EDIT_LOAD)
            self.noted.emit(trouble or texts.LOADED_POINTS.format(path=path))

        scan = None if self.scan is None else self.scan.scan
        self._jobs.start("points", texts.READING_POINTS, (path, scan), read_points, loaded)


def _named(text: str, key: str) -> str:
    title = TITLES[key]
    return text.format(point=title[0].lower() + title[1:])


class _Replace(QUndoCommand):
    """Other points, as a whole."""

    def __init__(self, draft: OwnFaceDraft, after: Points, text: str) -> None:
        super().__init__(text)
        self._draft, self._before, self._after = draft, draft.points, after

    def redo(self) -> None:
        """Do it."""
        self._draft.show(self._after)

    def undo(self) -> None:
        """Take it back."""
        self._draft.show(self._before)
