"""What of Qt's dies as cyclic garbage dies on the main thread, whoever makes the garbage."""

from __future__ import annotations

import gc
import threading

import pytest
from PySide6.QtCore import QObject

from app.garbage import MainThreadGarbage


@pytest.fixture
def garbage(qapp):
    made = MainThreadGarbage()
    yield made
    made.stop()
    assert gc.isenabled()


class Cyclic:
    """An object in a cycle, which says where it dies."""

    def __init__(self, told: list[int]) -> None:
        self.itself, self.told, self.of_qt = self, told, QObject()

    def __del__(self) -> None:
        self.told.append(threading.get_ident())


def _litter() -> None:
    """Allocate far more than the collector's threshold, as a job does."""
    kept = [[i] for i in range(50 * gc.get_threshold()[0])]
    assert kept


def test_a_worker_that_allocates_does_not_collect_and_the_main_thread_does(garbage, qtbot):
    died: list[int] = []
    Cyclic(died)
    worker = threading.Thread(target=_litter)
    worker.start()
    worker.join()
    assert died == []
    kept: list[list] = []

    def is_dead() -> bool:
        kept.extend([i] for i in range(2 * gc.get_threshold()[0]))
        return bool(died)

    qtbot.waitUntil(is_dead, timeout=5000)
    assert died == [threading.get_ident()]
