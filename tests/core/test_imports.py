"""Core knows nothing of windows and devices: proved on the real package names, in a fresh process."""

import subprocess
import sys

FORBIDDEN = ("PySide6", "shiboken6", "pyqtgraph", "moderngl", "glcontext", "OpenGL", "pyopencl", "app", "gpu")

SCRIPT = f"""
import importlib, pkgutil, sys
import core
names = [m.name for m in pkgutil.walk_packages(core.__path__, "core.")]
for name in names:
    importlib.import_module(name)
found = sorted(m for m in sys.modules if m.split(".")[0] in {FORBIDDEN!r})
print(len(names), *found)
"""


def test_no_core_module_loads_qt_gl_or_cl():
    answer = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True).stdout.split()
    assert int(answer[0]) > 30
    assert answer[1:] == []
