"""Keeps the open project on disk: each edit is there when it returns, so nothing has to be saved."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app import texts
from app.authoring import Authoring
from app.loading import OpenedDatabase
from app.project_jobs import (
    OpenedProject,
    close_unwanted,
    database_differences,
    find_database,
    is_unnamed,
    make_unnamed,
    open_project,
)
from app.settings import forget_project, last_project, remember_project, window_settings
from core.document.change import ANSWER, Change
from core.document.content import ProjectContent
from core.document.project_file import SUFFIX, ProjectFile
from core.errors import UserFacingError

_VIEW_AFTER_MS = 1000


class ProjectKeeper(QObject):
    """Writes the document of an `Authoring` into its project file, and opens others.

    opened() : another project is on show, or the same under another name
    began_empty() : the one that was to be opened first cannot be, so an empty one is on show
    """

    opened = Signal()
    began_empty = Signal()

    def __init__(self, authoring: Authoring, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.authoring = authoring
        self.file: ProjectFile | None = None
        self._settings = window_settings()
        self._failed = ""
        self._view_soon = QTimer(self, singleShot=True, interval=_VIEW_AFTER_MS)
        self._view_soon.timeout.connect(self.save)
        authoring.document.changed.connect(self._on_document_changed)
        for signal in (authoring.view.slot_selected, authoring.view.map_chosen, authoring.view.playhead_moved):
            signal.connect(self._on_view_changed)

    # What is open

    @property
    def name(self) -> str:
        """What the window calls the project; nothing before one is open."""
        if self.file is None:
            return ""
        return texts.UNNAMED_PROJECT if is_unnamed(self.file.path) else self.file.path.stem

    def start(self, path: Path | None) -> bool:
        """Open ``path``, or what was open last, or an empty project; tells whether it is an empty one."""
        path = path or last_project(self._settings)
        if path is not None:
            self.open(path)
            return False
        return self.new()

    def new(self) -> bool:
        """Begin an empty project, in the data folder until it gets a name; tells whether that worked."""
        try:
            file = make_unnamed()
        except UserFacingError as error:
            self.authoring.failed.emit(error.message, error.remedy)
            return True
        self._show(OpenedProject(file, None, ()), is_new=True)
        return True

    def open(self, path: Path) -> None:
        """Open a project in the background; the one that is open stays if that fails."""
        if self.file is not None and path.exists() and path.samefile(self.file.path):
            return
        self.authoring.jobs.start(
            "project", texts.OPENING_PROJECT, path, open_project, self._show,
            lambda error: self._on_open_failed(path, error), close_unwanted,
        )  # fmt: skip

    def _on_open_failed(self, path: Path, error: UserFacingError) -> None:
        self.authoring.failed.emit(error.message, error.remedy)
        forget_project(self._settings, path)
        if self.file is None:
            self.new()
            self.began_empty.emit()

    def _show(self, project: OpenedProject, is_new: bool = False) -> None:
        authoring, document = self.authoring, self.authoring.document
        self._let_go()
        content, database, shared = project.file.content, document.database, document.shared_removals
        if is_new:
            content = ProjectContent(face=document.face, database=document.database_reference)
        same_database = database is not None and content.database == document.database_reference
        self.file = project.file
        authoring.undo_stack.clear()
        authoring.jobs.cancel("speech")
        authoring.jobs.cancel("database")
        document.load(content.state(project.audio, database if same_database else None))
        authoring.follow_later()
        self._look_as(content)
        if same_database:
            document.read_curation(shared)
            authoring.synthesise()
        else:
            self.find_database(content)
        remember_project(self._settings, project.file.path)
        for sentence in project.said:
            authoring.failed.emit(sentence, "")
        self.opened.emit()

    def _look_as(self, content: ProjectContent) -> None:
        view, seen = self.authoring.view, content.view
        view.select_slot(seen.slot)
        self.authoring.seek(seen.playhead_s)
        if seen.map_phone is not None:
            view.show_map(seen.map_phone)

    def find_database(self, content: ProjectContent) -> None:
        """Open the database that ``content`` refers to, in the background."""
        if content.database is None:
            return

        def found(opened: OpenedDatabase) -> None:
            self.authoring.take_engine(opened)
            self.authoring.document.take_database(opened.database, opened.removals)
            difference = database_differences(content, opened)
            if difference:
                self.authoring.failed.emit(difference, "")

        request = content.database, self.file.path
        self.authoring.jobs.start("database", texts.OPENING_DATABASE, request, find_database, found)

    # Saving

    def save(self) -> bool:
        """Write what changed since the last time; tells whether all is on disk. What refuses is said once."""
        if self.file is None:
            return False
        document = self.authoring.document
        content = ProjectContent.of(document, self.authoring.view, self.file.content.others)
        try:
            self.file.save(content, None if document.speech is None else document.speech.audio)
        except UserFacingError as error:
            if self._failed != error.message:
                self._failed = error.message
                self.authoring.failed.emit(error.message, error.remedy or texts.SAVE_A_COPY_REMEDY)
            return False
        self._failed = ""
        return True

    def say_saved(self) -> None:
        """Answer the habit of saving."""
        if self.file is not None and self.save():
            self.authoring.noted.emit(texts.SAVED_ALREADY.format(path=self.file.path))

    def save_copy(self, path: Path) -> None:
        """Write a copy; an unnamed project goes on under that name."""
        if self.file is None:
            return
        path = path if path.suffix.lower() == SUFFIX else path.with_name(path.name + SUFFIX)
        self.save()
        unnamed = self.file.path
        try:
            self.file.copy_to(path)
            if is_unnamed(unnamed):
                file = ProjectFile.open(path)
                self.file.close()
                self.file = file
                forget_project(self._settings, unnamed)
                unnamed.unlink(missing_ok=True)
        except UserFacingError as error:
            self.authoring.failed.emit(error.message, error.remedy)
            return
        remember_project(self._settings, path, is_open=self.file.path == path)
        self.authoring.noted.emit(texts.COPY_SAVED.format(path=path))
        self.opened.emit()

    def close(self) -> None:
        """Remember what was looked at and let go of the file."""
        self._view_soon.stop()
        self._let_go()

    def _let_go(self) -> None:
        if self.file is None:
            return
        self.save()
        file, self.file = self.file, None
        holds_nothing = file.content.sound is None and not file.versions()
        file.close()
        if holds_nothing and is_unnamed(file.path):
            forget_project(self._settings, file.path)
            file.path.unlink(missing_ok=True)

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        if change & ~ANSWER:
            self.save()

    def _on_view_changed(self, *_: object) -> None:
        if self.file is not None and not self._view_soon.isActive():
            self._view_soon.start()
