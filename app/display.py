"""Whether there is a screen to open a window on. Qt itself aborts the process where there is none."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

from core.errors import UserFacingError

_REMEDY = "Without one, `efase demo` and `efase synth` do the work."
_PATIENCE_S = 3.0


def require_display() -> None:
    """Raise `UserFacingError` when no display can be reached; macOS, Windows and Qt's own platforms always have one."""
    if sys.platform in ("darwin", "win32") or os.environ.get("QT_QPA_PLATFORM", "xcb").partition(":")[0] != "xcb":
        return
    wayland = os.environ.get("WAYLAND_DISPLAY")
    if wayland and "QT_QPA_PLATFORM" not in os.environ:
        folder = Path(os.environ.get("XDG_RUNTIME_DIR", "/"))
        if _answers(socket.AF_UNIX, str(folder / wayland)):
            return
    display = os.environ.get("DISPLAY")
    if not display:
        raise UserFacingError("There is no display to open the window on.", _REMEDY)
    if not _x_server_answers(display):
        raise UserFacingError(f"The display '{display}' does not answer, so the window cannot be opened.", _REMEDY)


def _x_server_answers(display: str) -> bool:
    """Knock where ``[host]:number[.screen]`` points: a local socket without a host, port 6000 + number with one."""
    host, _, rest = display.rpartition(":")
    number = rest.partition(".")[0]
    if not number.isdecimal():
        return False
    if host in ("", "unix"):
        path = f"/tmp/.X11-unix/X{number}"
        # Linux servers also listen on a socket without a file
        return _answers(socket.AF_UNIX, path) or _answers(socket.AF_UNIX, f"\0{path}")
    return _answers(socket.AF_INET, (host, 6000 + int(number)))


def _answers(family: int, address: str | tuple[str, int]) -> bool:
    try:
        with socket.socket(family, socket.SOCK_STREAM) as knock:
            knock.settimeout(_PATIENCE_S)
            knock.connect(address)
    except (OSError, OverflowError):
        return False
    return True
