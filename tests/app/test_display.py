"""No display is one sentence, not an abort of Qt."""

import os
import socket
import subprocess
import sys

import pytest

from app import display
from core.errors import UserFacingError

linux_only = pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="these always have a display")


@pytest.fixture
def environment(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM", "XDG_RUNTIME_DIR"):
        monkeypatch.delenv(name, raising=False)
    return monkeypatch


@linux_only
@pytest.mark.parametrize(
    ("shown", "words"),
    [(None, "no display"), ("", "no display"), (":9731", "':9731' does not answer"), ("nonsense", "does not answer"),
     ("127.0.0.1:53000", "does not answer"), (":99999999999999999999", "does not answer")],
)  # fmt: skip
def test_what_cannot_be_reached_is_said(environment, shown, words):
    if shown is not None:
        environment.setenv("DISPLAY", shown)
    with pytest.raises(UserFacingError, match=words):
        display.require_display()


@linux_only
def test_a_display_over_the_network_is_found(environment):
    with socket.create_server(("127.0.0.1", 0)) as server:
        environment.setenv("DISPLAY", f"127.0.0.1:{server.getsockname()[1] - 6000}.0")
        display.require_display()


@linux_only
def test_a_wayland_socket_is_found(environment, tmp_path):
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "wayland-7"))
        server.listen()
        environment.setenv("XDG_RUNTIME_DIR", str(tmp_path))
        environment.setenv("WAYLAND_DISPLAY", "wayland-7")
        display.require_display()


def test_qts_own_platforms_need_none(environment):
    environment.setenv("QT_QPA_PLATFORM", "offscreen")
    display.require_display()


@linux_only
def test_the_command_ends_with_a_sentence():
    quiet = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")}
    command = [sys.executable, "-c", "from app.cli import main; main()"]
    done = subprocess.run(command, env=quiet, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("efase: There is no display") and done.stderr.count("\n") == 1
