"""The errors of the workstation: one root, two families."""

from __future__ import annotations


class WorkstationError(Exception):
    """Root of every error that this project raises."""


class UserFacingError(WorkstationError):
    """Something a user can mend: a bad file, a missing device, a wrong request.

    The message is one clear sentence that says what is wrong and where; ``remedy``, when there is one,
    is a second sentence that says what to do about it. The command line prints both and exits with 2.
    """

    def __init__(self, message: str, remedy: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.message} {self.remedy}".strip()
