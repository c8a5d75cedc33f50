"""GLSL compute against the numpy reference, on Mesa's llvmpipe here and on zink over lavapipe in a process of its own.

Both drivers are installed by set-up: nothing here skips when one is missing.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from core.search.compute import DeviceFailed
from gpu.glsl.min_plus import GlslKernels

ROOT = Path(__file__).resolve().parents[3]
ZINK = {"EGL_PLATFORM": "surfaceless", "MESA_LOADER_DRIVER_OVERRIDE": "zink", "LIBGL_ALWAYS_SOFTWARE": "1"}


@pytest.fixture(scope="module")
def glsl():
    kernels = GlslKernels()
    yield kernels
    kernels.release()


@pytest.mark.parametrize("n_nodes", [1, 63, 64, 65, 333])
def test_one_step(glsl, steps_equal_the_reference, n_nodes):
    steps_equal_the_reference(glsl, n_nodes)


def test_a_matrix_in_pieces_gives_the_same(glsl, steps_equal_the_reference, monkeypatch):
    monkeypatch.setattr(glsl, "_most_bytes", 4 * 200 * 7)
    steps_equal_the_reference(glsl, 200)
    assert len(glsl._pieces) == 29


def test_random_utterances(glsl, utterances_equal_the_reference):
    utterances_equal_the_reference(glsl, 10)


def test_random_edits(glsl, edits_equal_the_reference):
    edits_equal_the_reference(glsl, 10)


def test_an_error_of_opengl_is_a_failed_device():
    kernels = GlslKernels()
    kernels.prepare(np.ones((8, 8), np.float32))
    with kernels._ctx:
        kernels._maps["CostValueMap"].bind_to_storage_buffer(10_000)  # OpenGL notes an error and goes on
    with pytest.raises(DeviceFailed, match="The OpenGL device"):
        kernels.min_plus(np.ones(8))
    assert np.array_equal(kernels.min_plus(np.ones(8)), np.full(8, 2.0))
    kernels.release()


def test_the_driver_is_named(glsl):
    assert glsl.report.backend == "glsl"
    if os.environ.get("EFASE_TEST_EXPECTS_ZINK"):
        assert "zink" in glsl.report.device


@pytest.mark.skipif("EFASE_TEST_EXPECTS_ZINK" in os.environ, reason="this is the process that it starts")
def test_the_same_on_software_vulkan():
    environment = {**os.environ, **ZINK, "EFASE_TEST_EXPECTS_ZINK": "1"}
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        environment.pop(name, None)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xvfb", str(Path(__file__))]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:]
    assert " passed" in done.stdout
