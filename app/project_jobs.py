"""What is read in the background when a project is opened. Functions for `app.jobs`."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from app import texts
from app.loading import OpenedDatabase, open_motion_database
from core.document.content import ProjectContent
from core.document.parts import DatabaseReference
from core.document.pins_met import what_pins_met
from core.document.project_file import SUFFIX, ProjectFile, ReadOnlyProject, read_project
from core.document.project_lock import ProjectLocked
from core.errors import UserFacingError
from core.folders import data_dir
from core.media.audio import Audio
from core.progress import Progress


@dataclass(frozen=True)
class OpenedProject:
    """A project that is open; ``said`` are sentences for the user about what had to be done for it."""

    file: ProjectFile
    audio: Audio | None
    said: tuple[str, ...]


def unnamed_folder() -> Path:
    """Return where projects lie that were given no name yet."""
    return data_dir() / "projects"


def is_unnamed(path: Path) -> bool:
    """Whether the user never gave the project a place."""
    return path.parent.absolute() == unnamed_folder().absolute()


def make_unnamed() -> ProjectFile:
    """Make an empty project in the data folder; raises `UserFacingError` when it cannot be written."""
    folder = unnamed_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(f"The folder '{folder}' cannot be made: {error.strerror}.") from error
    stem = time.strftime("unnamed-%Y%m%d-%H%M%S")
    number = 0
    while (path := folder / f"{stem}{f'-{number}' if number else ''}{SUFFIX}").exists():
        number += 1
    return ProjectFile.create(path)


def open_project(path: Path, progress: Progress) -> OpenedProject:
    """Open a project; one that cannot be written, or is open elsewhere, as an unnamed copy.

    Raises `UserFacingError` when nothing of it can be read.
    """
    progress.step(0.1, texts.OPENING_PROJECT)
    try:
        file = ProjectFile.open(path)
    except (ReadOnlyProject, ProjectLocked) as error:
        content, audio = read_project(path)
        file = make_unnamed()
        file.save(content, audio)
        return OpenedProject(file, audio, (texts.OPENED_AS_COPY.format(why=error.message),))
    try:
        audio = file.audio(file.content)
        if audio is not None:
            audio.digest  # noqa: B018  computed here, off the main thread
        return OpenedProject(file, audio, file.said)
    except BaseException:
        file.close()
        raise


def close_unwanted(opened: OpenedProject) -> None:
    """Let go of a project that came too late."""
    opened.file.close()


def let_go(file: ProjectFile) -> bool:
    """Close a project for good; tells whether it held nothing and had no name, so that it was deleted."""
    if is_unnamed(file.path) and file.content.sound is None and not file.versions():
        delete(file)
        return True
    file.close()
    return False


def delete(file: ProjectFile) -> None:
    """Close a project and delete it."""
    file.close()
    file.path.unlink(missing_ok=True)


def copied(file: ProjectFile, path: Path, content: ProjectContent, audio: Audio | None) -> ProjectFile:
    """Return a copy, open, with ``content`` as its newest state even where ``file`` itself could not take it.

    Raises `UserFacingError` when the copy cannot be written.
    """
    file.copy_to(path)
    copy = ProjectFile.open(path)
    try:
        copy.save(content, audio)
    except BaseException:
        copy.close()
        raise
    return copy


def find_database(request: tuple[DatabaseReference, Path], progress: Progress) -> OpenedDatabase:
    """Open the motion database that a project refers to: where it was, or beside the project under its name.

    Raises `UserFacingError` when it is in neither place.
    """
    reference, project = request
    if reference.path is None:
        return open_motion_database(None, progress)
    was = Path(reference.path)
    found = next((path for path in (was, project.with_name(was.name)) if path.is_file()), None)
    if found is None:
        raise UserFacingError(
            texts.DATABASE_MISSING.format(name=reference.name, path=was), texts.DATABASE_MISSING_REMEDY
        )
    return open_motion_database(found, progress)


def database_differences(content: ProjectContent, opened: OpenedDatabase) -> str:
    """Return a sentence about a database that is not what the project was made with, or nothing."""
    is_other = content.database is not None and content.database.content_hash != opened.database.content_hash
    sentences = [texts.DATABASE_CHANGED.format(name=opened.database.name)] if is_other else []
    return " ".join(sentences + what_pins_met(content, opened.database))
