"""How long work tells how far it is, and how it is asked to stop."""

from __future__ import annotations

from core.errors import WorkstationError


class Cancelled(WorkstationError):
    """Raised inside a job whose user changed her mind; not an error."""


class Progress:
    """A progress sink. This base class is silent; the command line and the window bring their own.

    ``step`` may raise `Cancelled`, so long work calls it often and holds nothing half-written across it.
    """

    def step(self, fraction: float, message: str = "") -> None:
        """Report that ``fraction`` (0..1) of the work is done; ``message`` names what comes now."""

    def part(self, start: float, stop: float) -> Progress:
        """Return a sink for one stage, whose own 0..1 covers ``start``..``stop`` of this one."""
        return _Part(self, start, stop)


class _Part(Progress):
    def __init__(self, whole: Progress, start: float, stop: float) -> None:
        self._whole, self._start, self._stop = whole, start, stop

    def step(self, fraction: float, message: str = "") -> None:
        self._whole.step(self._start + (self._stop - self._start) * fraction, message)


SILENT = Progress()
