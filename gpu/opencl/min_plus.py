"""The search's min-plus step in OpenCL (PoCL on a CPU, or any device with double precision)."""

from __future__ import annotations

import numpy as np

from core.errors import UserFacingError
from core.search.compute import DeviceReport
from gpu.sources import shader_source

_LANES = 16  # columns that a work-item takes at once; rows are padded to a multiple


class OpenClKernels:
    """`core.search.compute.SearchKernels` on an OpenCL device. Reference: `NumpyKernels`; text: min_plus.cl."""

    def __init__(self) -> None:
        import pyopencl as cl

        self._cl = cl
        device, self._context, program = _first_that_builds(cl, shader_source("opencl/min_plus.cl"))
        self._queue = cl.CommandQueue(self._context)
        self._kernel = cl.Kernel(program, "min_plus")
        software = bool(device.type & cl.device_type.CPU)
        self.report = DeviceReport("opencl", device.name.strip(), device.platform.name.strip(), software)
        self._distance_map = self._front = self._arrived = None
        self._n_nodes = self._stride = 0

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`; raises `UserFacingError` when the device has not enough memory."""
        cl = self._cl
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
        padded = np.zeros((self._n_nodes, self._stride), np.float32)
        padded[:, : self._n_nodes] = transition
        flags = cl.mem_flags
        self._distance_map = cl.Buffer(self._context, flags.READ_ONLY | flags.COPY_HOST_PTR, hostbuf=padded)
        self._front = cl.Buffer(self._context, flags.READ_ONLY, self._stride * 8)
        self._arrived = cl.Buffer(self._context, flags.WRITE_ONLY, self._n_nodes * 8)

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        cl = self._cl
        padded = np.full(self._stride, np.inf)
        padded[: self._n_nodes] = front
        arrived = np.empty(self._n_nodes)
        cl.enqueue_copy(self._queue, self._front, padded)
        self._kernel(
            self._queue, (self._n_nodes,), None, self._distance_map, self._front, self._arrived,
            np.uint32(self._n_nodes), np.uint32(self._stride),
        )  # fmt: skip
        cl.enqueue_copy(self._queue, arrived, self._arrived)
        return arrived

    def release(self) -> None:
        """See `SearchKernels.release`."""
        for buffer in (self._distance_map, self._front, self._arrived):
            if buffer is not None:
                buffer.release()
        self._distance_map = self._front = self._arrived = None


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
