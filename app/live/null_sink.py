"""A PulseAudio server of our own with a sink that nobody hears: what is played into it can be recorded again."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from core.errors import UserFacingError

_TOOLS = ("pulseaudio", "pactl")
_START_LIMIT_S = 10.0


@contextlib.contextmanager
def null_sink() -> Iterator[subprocess.Popen]:
    """Run the server while the block runs; processes started in it play and record there. Yields the server's process.

    Its only input is the monitor of its only output. Raises `UserFacingError` where PulseAudio is not installed or
    does not start.
    """
    if not all(map(shutil.which, _TOOLS)):
        raise UserFacingError(
            "PulseAudio is not installed.", "Install pulseaudio, pulseaudio-utils and libasound2-plugins."
        )
    with tempfile.TemporaryDirectory(prefix="efase-sound-") as folder, contextlib.ExitStack() as ends:
        socket = Path(folder) / "native"
        before = {name: os.environ.get(name) for name in ("PULSE_SERVER", "PULSE_RUNTIME_PATH", "PULSE_STATE_PATH")}
        ends.callback(_restore, before)
        os.environ.update(PULSE_RUNTIME_PATH=folder, PULSE_STATE_PATH=folder)
        os.environ.pop("PULSE_SERVER", None)
        server = subprocess.Popen(
            ["pulseaudio", "-n", "--exit-idle-time=-1", "--daemonize=no", "--use-pid-file=no",
             "-L", f"module-native-protocol-unix socket={socket} auth-anonymous=1",
             "-L", "module-null-sink sink_name=out rate=48000 channels=1"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        ends.callback(server.wait)
        ends.callback(server.kill)
        os.environ["PULSE_SERVER"] = f"unix:{socket}"
        _wait_until_it_answers(server)
        yield server


def _wait_until_it_answers(server: subprocess.Popen) -> None:
    end_s = time.monotonic() + _START_LIMIT_S
    while subprocess.run(["pactl", "info"], capture_output=True, check=False).returncode:
        if server.poll() is not None or time.monotonic() > end_s:
            raise UserFacingError("A PulseAudio server does not start here.")
        time.sleep(0.1)


def _restore(before: dict[str, str | None]) -> None:
    for name, value in before.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
