"""The system's graphics libraries by name, so that nobody has to search for them."""

from __future__ import annotations

import ctypes
import sys
from functools import cache

_LINUX = {"libgl": "libGL.so.1", "libx11": "libX11.so.6", "libegl": "libEGL.so.1"}


@cache
def library_names(*wanted: str) -> dict[str, str]:
    """Return keyword arguments for `moderngl.create_context`: the file names of ``libgl``, ``libx11``, ``libegl``.

    Without them it has a program of the system search for each, which takes the main thread a tenth of a second on a
    busy machine. Empty where one of them is not there under its usual name.
    """
    if not sys.platform.startswith("linux"):
        return {}
    names = {which: _LINUX[which] for which in wanted}
    try:
        for name in names.values():
            ctypes.CDLL(name)
    except OSError:
        return {}
    return names
