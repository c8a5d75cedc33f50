"""A thread that must not be late asks the system to be served first."""

from __future__ import annotations

import contextlib
import os
import threading

_NICENESS = -11  # what sound servers ask for


def be_served_first() -> None:
    """Raise the priority of the calling thread where the system lets us; else leave it as it is."""
    if hasattr(os, "setpriority"):
        with contextlib.suppress(OSError):  # only who may, may
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)
