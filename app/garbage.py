"""Collects Python's cyclic garbage on the main thread only.

Python collects in whatever thread happens to allocate. An object of Qt's that dies so in a worker takes Qt's lock and
then waits for Python's, while the main thread holds Python's and waits for Qt's: the window stands still for ever.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

_EVERY_MS = 500


class MainThreadGarbage(QObject):
    """Takes Python's garbage collector over until `stop`."""

    _n_alive = 0

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        gc.disable()
        gc.freeze()  # modules and what the window is made of stay; looking at them again takes a tenth of a second
        MainThreadGarbage._n_alive += 1
        self._timer = QTimer(self, interval=_EVERY_MS)
        self._timer.timeout.connect(self.collect)
        self._timer.start()

    def collect(self) -> None:
        """Collect the oldest generation that is due."""
        due = [generation for generation, (count, threshold) in enumerate(zip(gc.get_count(), gc.get_threshold()))
               if count > threshold]  # fmt: skip
        if due:
            gc.collect(due[-1])

    def stop(self) -> None:
        """Give it back; a second time does nothing."""
        if not self._timer.isActive():
            return
        self._timer.stop()
        MainThreadGarbage._n_alive -= 1
        if MainThreadGarbage._n_alive == 0:
            gc.unfreeze()
            gc.enable()
