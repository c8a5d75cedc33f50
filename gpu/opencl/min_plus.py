"""The search's min-plus step in OpenCL (PoCL on a CPU, or any device with double precision)."""

from __future__ import annotations

import numpy as np

from core.errors import UserFacingError
from core.search.compute import DeviceReport
from gpu.sources import shader_source

_LANES = 16  # rows are padded to a multiple of as many columns
_ROWS = 8  # rows that a work-item of the forward step owns


class OpenClKernels:
    """`core.search.compute.SearchKernels` on an OpenCL device. Reference: `NumpyKernels`; text: min_plus.cl."""

    def __init__(self) -> None:
        import pyopencl as cl

        self._cl = cl
        device, self._context, program = _first_that_builds(cl, shader_source("opencl/min_plus.cl", {"ROWS": _ROWS}))
        self._queue = cl.CommandQueue(self._context)
        self._forward = cl.Kernel(program, "min_plus")
        self._both = cl.Kernel(program, "min_plus_both")
        self._gather = cl.Kernel(program, "least_of_columns")
        software = bool(device.type & cl.device_type.CPU)
        self.report = DeviceReport("opencl", device.name.strip(), device.platform.name.strip(), software)
        # two groups a core keep every core busy when one is slower; each owns a stripe of rows
        self._n_groups = 2 * device.max_compute_units
        self._buffers: dict[str, object] = {}
        self._n_nodes = self._stride = 0

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`; raises `UserFacingError` when the device has not enough memory."""
        self.release()
        self._n_nodes = len(transition)
        self._stride = -(-self._n_nodes // _LANES) * _LANES
        asked = self._n_nodes * self._stride * 4
        offered = self._context.devices[0].max_mem_alloc_size
        if asked > offered:
            raise UserFacingError(
                f"The OpenCL device offers {offered >> 20} MiB in one piece, and the transition matrix needs "
                f"{asked >> 20} MiB.",
                "Use --backend numpy, or a smaller database.",
            )
        padded = np.zeros((-(-self._n_nodes // _ROWS) * _ROWS, self._stride), np.float32)
        padded[: self._n_nodes, : self._n_nodes] = transition
        cl, flags = self._cl, self._cl.mem_flags
        row, column = self._n_nodes * 8, self._stride * 8
        self._buffers = {
            "DistanceMap": cl.Buffer(self._context, flags.READ_ONLY | flags.COPY_HOST_PTR, hostbuf=padded),
            "PrevCostBufferMap": cl.Buffer(self._context, flags.READ_ONLY, column),
            "NextCostBufferMap": cl.Buffer(self._context, flags.READ_ONLY, row),
            "CostValueMap": cl.Buffer(self._context, flags.READ_WRITE, row),
            "CostBuffMap": cl.Buffer(self._context, flags.READ_WRITE, self._n_groups * column),
            "LeavingValueMap": cl.Buffer(self._context, flags.READ_WRITE, column),
        }

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        self._write_front(front)
        maps = self._buffers
        self._forward(
            self._queue, (-(-self._n_nodes // _ROWS),), None, maps["DistanceMap"], maps["PrevCostBufferMap"],
            maps["CostValueMap"], np.uint32(self._n_nodes), np.uint32(self._stride),
        )  # fmt: skip
        return self._read("CostValueMap")

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `SearchKernels.min_plus_both`."""
        self._write_front(front)
        maps, n_nodes, stride = self._buffers, np.uint32(self._n_nodes), np.uint32(self._stride)
        self._cl.enqueue_copy(self._queue, maps["NextCostBufferMap"], np.ascontiguousarray(behind, float))
        self._both(
            self._queue, (self._n_groups,), (1,), maps["DistanceMap"], maps["PrevCostBufferMap"],
            maps["NextCostBufferMap"], maps["CostValueMap"], maps["CostBuffMap"], n_nodes, stride,
        )  # fmt: skip
        self._gather(
            self._queue, (self._stride,), None, maps["CostBuffMap"], maps["LeavingValueMap"],
            np.uint32(self._n_groups), stride,
        )  # fmt: skip
        return self._read("CostValueMap"), self._read("LeavingValueMap")

    def _write_front(self, front: np.ndarray) -> None:
        padded = np.full(self._stride, np.inf)
        padded[: self._n_nodes] = front
        self._cl.enqueue_copy(self._queue, self._buffers["PrevCostBufferMap"], padded)

    def _read(self, name: str) -> np.ndarray:
        values = np.empty(self._n_nodes)
        self._cl.enqueue_copy(self._queue, values, self._buffers[name])
        return values

    def release(self) -> None:
        """See `SearchKernels.release`."""
        for buffer in self._buffers.values():
            buffer.release()
        self._buffers = {}


def _first_that_builds(cl, source: str):
    """Return (device, context, program) of the first able device, GPUs first; `UserFacingError` when there is none.

    A driver may list a device that it cannot compile for: the PoCL wheel, made before Zen 5, knows no such processor,
    where Debian's PoCL does. So the program itself is the test.
    """
    try:
        platforms = cl.get_platforms()
    except cl.Error as error:
        raise UserFacingError("There is no OpenCL platform on this machine.") from error
    devices = []
    for platform in platforms:
        try:
            devices += platform.get_devices()
        except cl.Error:  # a driver that is installed but finds no device of its own
            continue
    able = [d for d in devices if "cl_khr_fp64" in d.extensions and d.available]
    refusals = []
    for device in sorted(able, key=lambda d: not d.type & cl.device_type.GPU):
        context = cl.Context([device])
        try:
            return device, context, cl.Program(context, source).build()
        except cl.Error as error:
            refusals.append(f"{device.name.strip()}: {_reason(error)}")
    if refusals:
        raise UserFacingError(f"No OpenCL driver here can compile the search ({'; '.join(refusals)}).")
    raise UserFacingError("There is no OpenCL device with double precision on this machine.")


def _reason(error: Exception) -> str:
    """The compiler's own line of a build error, or the first line there is."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return next((line for line in lines if "error:" in line), lines[0])[:160]
