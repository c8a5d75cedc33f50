"""A device that fails in mid-work: the same answer, and one sentence."""

import numpy as np
import pyopencl as cl
import pytest

from core.search.best_path import find_path
from core.search.compute import DeviceFailed, DeviceReport, NumpyKernels
from core.search.constraints import SearchRequest
from core.search.session import SearchSession
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from gpu.fallback import FallbackKernels
from gpu.opencl.min_plus import OpenClKernels


class Failing(NumpyKernels):
    """Works ``n_good`` times, then its device is gone, for whatever is asked of it."""

    report = DeviceReport("opencl", "a card", "OpenCL 3.0", False)

    def __init__(self, n_good):
        super().__init__()
        self.n_left = n_good

    def _count(self):
        self.n_left -= 1
        if self.n_left < 0:
            raise DeviceFailed("The OpenCL device a card failed (OUT_OF_RESOURCES).")

    def prepare(self, transition):
        self._count()
        super().prepare(transition)

    def min_plus(self, front):
        self._count()
        return super().min_plus(front)

    def min_plus_both(self, front, behind):
        self._count()
        return super().min_plus_both(front, behind)

    def release(self):
        self._count()
        super().release()


@pytest.fixture
def problem(random_motion):
    frames, nodes = random_motion(21, n_sentences=12, phones_each=10)
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), default_weights(frames, nodes, 120.0))
    rng = np.random.default_rng(21)
    request = SearchRequest(rng.integers(0, 44, 9), rng.dirichlet(np.ones(4), 9), {2: 5}, frozenset({7, 8}))
    return costs, request


@pytest.mark.parametrize("n_good", range(10))
def test_a_search_that_loses_its_device_ends_with_the_same_path(problem, caplog, n_good):
    costs, request = problem
    kernels = FallbackKernels(Failing(n_good))
    kernels.prepare(costs.matrix)
    answer = find_path(request, costs, kernels)
    reference = NumpyKernels()
    reference.prepare(costs.matrix)
    expected = find_path(request, costs, reference)
    assert answer.nodes.tolist() == expected.nodes.tolist() and answer.cost == expected.cost
    lost = n_good < 9  # one preparation and eight steps
    assert kernels.report.backend == ("numpy" if lost else "opencl")
    assert kernels.report.lost == (
        "The OpenCL device a card failed (OUT_OF_RESOURCES). The search goes on with numpy." if lost else ""
    )
    assert [record.message for record in caplog.records if record.name == "gpu"] == (
        [kernels.report.lost] if lost else []
    )


@pytest.mark.parametrize("n_good", [0, 1, 3, 7])
def test_prices_after_a_loss_are_those_of_the_reference(problem, n_good):
    costs, request = problem
    found = []
    for kernels in (NumpyKernels(), FallbackKernels(Failing(n_good))):
        kernels.prepare(costs.matrix)
        session = SearchSession(request, costs, kernels)
        found.append([session.prices(slot) for slot in range(request.n_slots)])
    assert np.array_equal(*found)


def test_a_kernel_of_opencl_that_fails_is_a_lost_device(problem):
    costs, request = problem
    opencl = OpenClKernels()
    kernels = FallbackKernels(opencl)
    kernels.prepare(costs.matrix)
    flags = cl.mem_flags
    opencl._buffers["PrevCostBufferMap"] = cl.Buffer(opencl._context, flags.READ_ONLY, 8)  # the driver refuses a front
    reference = NumpyKernels()
    reference.prepare(costs.matrix)
    assert np.array_equal(find_path(request, costs, kernels).nodes, find_path(request, costs, reference).nodes)
    assert kernels.report.lost.startswith(f"The OpenCL device {opencl.report.device} failed (")
    kernels.release()


def test_too_little_memory_at_the_device_is_no_end(monkeypatch):
    opencl = OpenClKernels()

    class Small:
        devices = (type("Device", (), {"max_mem_alloc_size": 1 << 20})(),)

    matrix = np.ones((600, 600), np.float32)
    monkeypatch.setattr(opencl, "_context", Small())
    kernels = FallbackKernels(opencl)
    kernels.prepare(matrix)
    assert np.array_equal(kernels.min_plus(np.arange(600.0)), np.ones(600))
    assert "offers 1 MiB in one piece, and the transition matrix needs 1 MiB" in kernels.report.lost
