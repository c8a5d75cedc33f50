"""The open project's file and the one thread that touches it, so that nobody else waits for the disk."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

from core.document.content import ProjectContent
from core.document.project_file import ProjectFile
from core.media.audio import Audio

# A slow disk may fall behind a drag. States beyond these are passed over for the next one, which holds all that they
# hold: so what a kill can lose does not grow with the drag.
MOST_WAITING = 16

Answer = TypeVar("Answer")


class ProjectWriter:
    """Does what is asked of a project file in the order of asking, one after the other, on a thread of its own.

    path : of the file
    """

    def __init__(self, file: ProjectFile) -> None:
        self.path: Path = file.path
        self._file = file
        self._thread = ThreadPoolExecutor(1, "project-file")
        self._n_saves = 0
        self._asked_after: set[int] = set()

    def save(self, content: ProjectContent, audio: Audio | None = None) -> Future[bool]:
        """Write a state, in a transaction of its own; see `ProjectFile.save` for what the future may raise.

        The future is True once the state is on disk: only then may anybody be told so. False: it was passed over for a
        later one, whose future tells.
        """
        self._n_saves += 1
        return self._thread.submit(self._write, self._n_saves, content, audio)

    def _write(self, number: int, content: ProjectContent, audio: Audio | None) -> bool:
        if self._n_saves - number > MOST_WAITING and number not in self._asked_after:
            return False
        self._file.save(content, audio)
        return True

    def ask(self, do: Callable[[ProjectFile], Answer]) -> Future[Answer]:
        """Have ``do(file)`` done once all states that were saved so far are written."""
        self._asked_after.add(self._n_saves)
        return self._thread.submit(do, self._file)

    def close(self, do: Callable[[ProjectFile], Answer] = ProjectFile.close) -> Future[Answer]:
        """Have the file closed by ``do(file)`` as the last thing; nothing can be asked any more."""
        closed = self.ask(do)
        self._thread.shutdown(wait=False)
        return closed
