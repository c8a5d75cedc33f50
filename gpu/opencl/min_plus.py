"""The search's min-plus step in OpenCL (PoCL on a CPU, or any device with double precision)."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import numpy as np

from core.errors import UserFacingError
from core.search.compute import DeviceFailed, DeviceReport
from gpu.sources import shader_source

_COLUMNS = 16  # rows are padded to a multiple of as many columns
_GROUPS_A_CORE = 4  # when one core is slower, the others take over some of its stripes
_THREADS = 128  # of a graphics card, to a row
_STRIPES = 64  # of rows, so that a graphics card has threads enough for the columns


class OpenClKernels:
    """`core.search.compute.SearchKernels` on an OpenCL device.

    Reference: `NumpyKernels`; text: min_plus.cl for processors, min_plus_wide.cl for graphics cards.

    device : as `able_devices` lists them; the first that compiles the search when absent
    wide : which of the two texts; by the kind of device when absent
    Raises `UserFacingError` when there is no such device.
    """

    def __init__(self, device=None, wide: bool | None = None) -> None:
        import pyopencl as cl

        self._cl = cl
        devices = able_devices() if device is None else [device]
        device, self._context, program, self._rows, self._wide = _first_that_builds(cl, devices, wide)
        self._queue = cl.CommandQueue(self._context)
        names = ("arrive", "leave") if self._wide else ("min_plus", "min_plus_both")
        self._forward, self._backward = (cl.Kernel(program, name) for name in names)
        self._gather = cl.Kernel(program, "least_of_columns")
        self.report = report_of(device)
        self._n_groups = _STRIPES if self._wide else _GROUPS_A_CORE * device.max_compute_units
        self._buffers: dict[str, object] = {}
        self._n_nodes = self._stride = 0
        self._front = np.zeros(0)

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`; raises `DeviceFailed` when the device has not enough memory."""
        self.release()
        self._n_nodes = len(transition)
        self._stride = -(-self._n_nodes // _COLUMNS) * _COLUMNS
        n_rows = -(-self._n_nodes // self._rows) * self._rows
        asked = n_rows * self._stride * 4
        offered = self._context.devices[0].max_mem_alloc_size
        if asked > offered:
            raise DeviceFailed(
                f"The OpenCL device offers {offered >> 20} MiB in one piece, and the transition matrix needs "
                f"{asked >> 20} MiB."
            )
        padded = np.zeros((n_rows, self._stride), np.float32)
        padded[: self._n_nodes, : self._n_nodes] = transition
        self._front = np.full(self._stride, np.inf)
        cl, flags = self._cl, self._cl.mem_flags
        # a processor reads the matrix where it lies
        held = flags.USE_HOST_PTR if self.report.software else flags.COPY_HOST_PTR
        row, column = self._n_nodes * 8, self._stride * 8
        with self._failing():
            self._buffers = {
                "DistanceMap": cl.Buffer(self._context, flags.READ_ONLY | held, hostbuf=padded),
                "PrevCostBufferMap": cl.Buffer(self._context, flags.READ_ONLY, column),
                "NextCostBufferMap": cl.Buffer(self._context, flags.READ_ONLY, row),
                "CostValueMap": cl.Buffer(self._context, flags.READ_WRITE, row),
                "CostBuffMap": cl.Buffer(self._context, flags.READ_WRITE, self._n_groups * column),
                "LeavingValueMap": cl.Buffer(self._context, flags.READ_WRITE, column),
            }

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        with self._failing():
            self._write_front(front)
            self._enqueue_forward()
            return self._read("CostValueMap")

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `SearchKernels.min_plus_both`."""
        behind = np.ascontiguousarray(behind, float)
        with self._failing():
            self._write_front(front)
            self._cl.enqueue_copy(self._queue, self._buffers["NextCostBufferMap"], behind, is_blocking=False)
            self._enqueue_both()
            return self._read("CostValueMap"), self._read("LeavingValueMap")

    def _enqueue_forward(self) -> None:
        maps, n_nodes, stride = self._buffers, np.uint32(self._n_nodes), np.uint32(self._stride)
        given = maps["DistanceMap"], maps["PrevCostBufferMap"], maps["CostValueMap"]
        if self._wide:
            self._forward(self._queue, (self._n_nodes * _THREADS,), (_THREADS,), *given, stride)
        else:
            self._forward(self._queue, (self._n_groups,), (1,), *given, n_nodes, stride)

    def _enqueue_both(self) -> None:
        maps, n_nodes, stride = self._buffers, np.uint32(self._n_nodes), np.uint32(self._stride)
        if self._wide:
            self._enqueue_forward()
            self._backward(
                self._queue, (self._stride, self._n_groups), None, maps["DistanceMap"], maps["NextCostBufferMap"],
                maps["CostBuffMap"], n_nodes, stride,
            )  # fmt: skip
        else:
            self._backward(
                self._queue, (self._n_groups,), (1,), maps["DistanceMap"], maps["PrevCostBufferMap"],
                maps["NextCostBufferMap"], maps["CostValueMap"], maps["CostBuffMap"], n_nodes, stride,
            )  # fmt: skip
        self._gather(
            self._queue, (self._stride,), None, maps["CostBuffMap"], maps["LeavingValueMap"],
            np.uint32(self._n_groups), stride,
        )  # fmt: skip

    def _write_front(self, front: np.ndarray) -> None:
        self._front[: self._n_nodes] = front
        self._cl.enqueue_copy(self._queue, self._buffers["PrevCostBufferMap"], self._front, is_blocking=False)

    def _read(self, name: str) -> np.ndarray:
        values = np.empty(self._n_nodes)
        self._cl.enqueue_copy(self._queue, values, self._buffers[name])
        return values

    def release(self) -> None:
        """See `SearchKernels.release`."""
        for buffer in self._buffers.values():
            buffer.release()
        self._buffers = {}

    @contextlib.contextmanager
    def _failing(self) -> Iterator[None]:
        try:
            yield
        except self._cl.Error as error:
            raise DeviceFailed(f"The OpenCL device {self.report.device} failed ({_reason(error)}).") from error


def able_devices() -> list:
    """List the OpenCL devices with double precision, GPUs first; raises `UserFacingError` without a platform.

    A driver may list a device that it cannot compile for: the PoCL wheel, made before Zen 5, knows no such processor,
    where Debian's PoCL does. So only the program itself tells.
    """
    import pyopencl as cl

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
    return sorted(able, key=lambda d: not d.type & cl.device_type.GPU)


def report_of(device) -> DeviceReport:
    """Name a device and its driver."""
    import pyopencl as cl

    platform = device.platform
    return DeviceReport(
        backend="opencl",
        device=device.name.strip(),
        api=" ".join(device.version.split()[:2]),
        driver=f"{platform.name.strip()} {device.driver_version.strip()}",
        software=bool(device.type & cl.device_type.CPU),
    )


def _first_that_builds(cl, devices: list, wide: bool | None):
    """Return (device, context, program, rows side by side, whether it is wide) of the first that compiles."""
    refusals = []
    for device in devices:
        is_wide = not device.type & cl.device_type.CPU if wide is None else wide
        lanes, rows = _registers_of(device)
        if is_wide:
            source = shader_source("opencl/min_plus_wide.cl", {"THREADS": _THREADS})
        else:
            source = shader_source("opencl/min_plus.cl", {"ROWS": rows, "LANES": lanes})
        try:
            context = cl.Context([device])
            return device, context, cl.Program(context, source).build(), rows, is_wide
        except cl.Error as error:
            refusals.append(f"{device.name.strip()}: {_reason(error)}")
    if refusals:
        raise UserFacingError(f"No OpenCL driver here can compile the search ({'; '.join(refusals)}).")
    raise UserFacingError("There is no OpenCL device with double precision on this machine.")


def _registers_of(device) -> tuple[int, int]:
    """Doubles to a vector, and rows side by side: as many as 32 wide or 16 narrow registers hold in a step."""
    # PoCL 3.0, which is what its wheel holds, crashes on vectors of 64 bytes
    crashes = device.platform.name.startswith("Portable") and device.driver_version.startswith("3.0")
    return (8, 16) if device.native_vector_width_double >= 8 and not crashes else (4, 8)


def _reason(error: Exception) -> str:
    """The compiler's own line of a build error, or the first line there is."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()] or [type(error).__name__]
    return next((line for line in lines if "error:" in line), lines[0])[:160]
