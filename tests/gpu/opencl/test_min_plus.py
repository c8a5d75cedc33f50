"""OpenCL against the numpy reference. PoCL is a dependency on Linux: nothing here skips when it is missing."""

import pytest

from gpu.opencl import min_plus
from gpu.opencl.min_plus import OpenClKernels


@pytest.fixture(scope="module", params=[False, True], ids=["processors", "graphics cards"])
def opencl(request):
    """Both texts, whatever device there is."""
    kernels = OpenClKernels(wide=request.param)
    yield kernels
    kernels.release()


@pytest.mark.parametrize("n_nodes", [1, 15, 16, 17, 333, 1100])
def test_one_step(opencl, steps_equal_the_reference, n_nodes):
    steps_equal_the_reference(opencl, n_nodes)


def test_one_step_with_narrow_registers(steps_equal_the_reference, monkeypatch):
    monkeypatch.setattr(min_plus, "_registers_of", lambda device: (4, 8))
    kernels = OpenClKernels()
    for n_nodes in (1, 16, 333):
        steps_equal_the_reference(kernels, n_nodes)
    kernels.release()


def test_fifty_random_utterances(opencl, utterances_equal_the_reference):
    utterances_equal_the_reference(opencl, 50)


def test_random_edits(opencl, edits_equal_the_reference):
    edits_equal_the_reference(opencl, 40)


def test_the_driver_is_named(opencl):
    assert opencl.report.backend == "opencl"
    assert opencl.report.device and opencl.report.api
