"""Keeps the open project on disk: each edit is on its way there when it returns, so nothing has to be saved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import wait as wait_for
from pathlib import Path
from typing import Any, TypeVar

from PySide6.QtCore import QCoreApplication, QEventLoop, QObject, Qt, QTimer, Signal

from app import texts
from app.authoring import Authoring
from app.loading import OpenedDatabase
from app.project_jobs import (
    OpenedProject,
    close_unwanted,
    copied,
    database_differences,
    delete,
    find_database,
    is_unnamed,
    let_go,
    make_unnamed,
    open_project,
)
from app.settings import forget_project, last_project, remember_project, window_settings
from core.document.change import ANSWER, Change
from core.document.content import ProjectContent
from core.document.document import EMPTY
from core.document.pins_met import NodeContent
from core.document.project_file import SUFFIX, ProjectFile
from core.document.project_writer import ProjectWriter
from core.errors import UserFacingError
from core.media.audio import Audio

_VIEW_AFTER_MS = 1000
# a wait for the disk is silent for as long as this, and the window goes on painting from then on
_SILENT_S = 0.05
_PAINT_EVERY_S = 0.02

Answer = TypeVar("Answer")


class _Voice(QObject):
    """Carries to the main thread how a write ended: an error or None, and whether the user asked to hear of it."""

    written = Signal(object, bool)


class ProjectKeeper(QObject):
    """Writes the document of an `Authoring` into its project file, and opens others.

    A thread writes, so that no edit waits for the disk; what needs the file itself (`ask`) is done after all edits.

    opened() : another project is on show, or the same under another name
    began_empty() : the one that was to be opened first cannot be, so an empty one is on show
    """

    opened = Signal()
    began_empty = Signal()

    def __init__(self, authoring: Authoring, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.authoring = authoring
        self.file: ProjectWriter | None = None
        self._others: Mapping[str, Any] = EMPTY
        self._tied: Mapping[str, NodeContent] = EMPTY
        self._settings = window_settings()
        self._voice = _Voice()
        self._voice.written.connect(self._on_written, Qt.ConnectionType.QueuedConnection)
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
            with ThreadPoolExecutor(1) as thread:
                file = self._waited(thread.submit(make_unnamed))
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
        self.file, self._others, self._tied = ProjectWriter(project.file), content.others, content.tied
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

    def save(self, tells: bool = False) -> None:
        """Have what changed since the last time written; what refuses is said once.

        tells : say it, too, once all is on disk
        """
        if self.file is not None:
            saved = self.file.save(*self._shown())
            saved.add_done_callback(lambda done: self._voice.written.emit(done.exception(), tells))

    def _shown(self) -> tuple[ProjectContent, Audio | None]:
        document = self.authoring.document
        content = ProjectContent.of(document, self.authoring.view, self._others, self._tied)
        self._tied = content.tied
        return content, None if document.speech is None else document.speech.audio

    def _on_written(self, error: BaseException | None, tells: bool) -> None:
        if error is None:
            self._failed = ""
            if tells and self.file is not None:
                self.authoring.noted.emit(texts.SAVED_ALREADY.format(path=self.file.path))
        elif self._failed != str(error):
            self._failed = str(error)
            self.authoring.failed.emit(*_told(error))

    def ask(self, do: Callable[[ProjectFile], Answer]) -> Answer:
        """Return ``do(file)``, done after all edits so far; raises `UserFacingError` as it does.

        The window goes on painting, and takes no input until the answer is there.
        """
        return self._waited(self.file.ask(do))

    def save_now(self) -> None:
        """Return when all that is on show is on disk; raises `UserFacingError` when it cannot be."""
        self._waited(self.file.save(*self._shown()))

    def last_save_refused(self) -> str:
        """Have all that is on show written; return a sentence about why it cannot be, or nothing once it is on disk."""
        if self.file is None:
            return ""
        try:
            self.save_now()
        except Exception as error:  # whatever it is, the user is to decide before the window is gone
            return " ".join(_told(error)).strip()
        return ""

    def _waited(self, answer: Future[Answer]) -> Answer:
        if not wait_for([answer], _SILENT_S).done:
            started, ended = self.authoring.jobs.started, self.authoring.jobs.ended
            started.emit("saving", texts.SAVING)
            while not wait_for([answer], _PAINT_EVERY_S).done:
                QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)
            ended.emit("saving")
        return answer.result()

    def say_saved(self) -> None:
        """Answer the habit of saving, once all is on disk."""
        self.save(tells=True)

    def save_copy(self, path: Path) -> None:
        """Write a copy of what is on show; an unnamed project goes on under that name."""
        if self.file is None:
            return
        path = path if path.suffix.lower() == SUFFIX else path.with_name(path.name + SUFFIX)
        self.save()
        shown, unnamed = self._shown(), self.file.path
        try:
            copy = self.ask(lambda file: copied(file, path, *shown))
            if is_unnamed(unnamed):
                old, self.file = self.file, ProjectWriter(copy)
                forget_project(self._settings, unnamed)
                self._waited(old.close(delete))
            else:
                copy.close()
        except UserFacingError as error:
            self.authoring.failed.emit(error.message, error.remedy)
            return
        remember_project(self._settings, path, is_open=self.file.path == path)
        self.authoring.noted.emit(texts.COPY_SAVED.format(path=path))
        self.opened.emit()

    def close(self) -> None:
        """Remember what was looked at and let go of the file, once all is written."""
        self._view_soon.stop()
        self._let_go()

    def _let_go(self) -> None:
        if self.file is None:
            return
        self.save()
        file, self.file = self.file, None
        if self._waited(file.close(let_go)):
            forget_project(self._settings, file.path)

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        if change & ~ANSWER:
            self.save()

    def _on_view_changed(self, *_: object) -> None:
        if self.file is not None and not self._view_soon.isActive():
            self._view_soon.start()


def _told(error: BaseException) -> tuple[str, str]:
    if isinstance(error, UserFacingError):
        return error.message, error.remedy or texts.SAVE_A_COPY_REMEDY
    return texts.UNEXPECTED.format(what=texts.SAVING.lower(), error=type(error).__name__), texts.SAVE_A_COPY_REMEDY
