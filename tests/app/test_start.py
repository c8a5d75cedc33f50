"""The window starts without what it does not need yet."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SLOW = ("sklearn", "pocketsphinx", "trimesh", "ezc3d", "av", "h5py", "joblib", "potpourri3d", "sounddevice", "pyopencl")


def test_the_window_loads_nothing_slow_and_opens_no_device():
    code = f"import sys, app.main, app.window; print(*[name for name in {SLOW!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []
