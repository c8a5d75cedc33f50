"""How quick a compute backend is, tried out in a process of its own: ``python -m gpu.trial BACKEND``.

Drivers crash and hang; only the trial then ends.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.search.compute import NumpyKernels, SearchKernels

TRIAL_NODES = 2048  # 16 MiB of transitions: more than a cache of one core holds, and quick on any device
_REPEATS = 3
_LIMIT_S = 90  # the first build of a program may take many seconds


def tried(backend: str) -> list[dict[str, object]]:
    """Try a backend in a process of its own.

    returns : a dict a device, of its `DeviceReport` and ``step_s``, seconds a step each way over `TRIAL_NODES` nodes;
        or {backend, missing}, a sentence that says why there is no figure
    """
    command = [sys.executable, "-m", "gpu.trial", backend]
    try:
        done = subprocess.run(
            command, cwd=Path(__file__).parents[1], capture_output=True, text=True, errors="replace",
            timeout=_LIMIT_S, check=False,
        )  # fmt: skip
        found = json.loads(done.stdout)
        if isinstance(found, list) and all(isinstance(each, dict) for each in found):
            return found
        trouble = "said nothing of use"
    except subprocess.TimeoutExpired:
        trouble = f"gave no answer within {_LIMIT_S} s"
    except OSError as error:
        trouble = f"could not be started ({error.strerror})"
    except json.JSONDecodeError:
        trouble = f"ended with code {done.returncode}"
    return [{"backend": backend, "missing": f"The trial of {backend} {trouble}."}]


def measured(kernels: SearchKernels) -> dict[str, object]:
    """Measure ``kernels`` in this process; returns one entry of `tried`."""
    rng = np.random.default_rng(2008)
    costs = rng.random(TRIAL_NODES)
    kernels.prepare(rng.random((TRIAL_NODES, TRIAL_NODES), np.float32))
    seconds = []
    for _ in range(_REPEATS + 1):
        began = time.perf_counter()
        kernels.min_plus(costs)
        kernels.min_plus_both(costs, costs)
        seconds.append(time.perf_counter() - began)
    kernels.release()
    return {**kernels.report.as_dict(), "step_s": min(seconds[1:])}


def _opened(backend: str) -> Iterator[SearchKernels]:
    if backend == "numpy":
        yield NumpyKernels()
    elif backend == "glsl":
        from gpu.glsl.min_plus import GlslKernels

        yield GlslKernels()
    else:
        from gpu.opencl.min_plus import OpenClKernels, able_devices

        trouble, n_opened = None, 0
        for device in able_devices():
            try:
                kernels = OpenClKernels(device)
            except UserFacingError as error:
                trouble = error
                continue
            n_opened += 1
            yield kernels
        if not n_opened:
            raise trouble or UserFacingError("There is no OpenCL device with double precision on this machine.")


def _main(backend: str) -> None:
    found: list[dict[str, object]] = []
    try:
        found.extend(measured(kernels) for kernels in _opened(backend))
    except ImportError as error:
        found.append({"backend": backend, "missing": f"{backend} cannot be loaded ({error})."})
    except UserFacingError as error:
        found.append({"backend": backend, "missing": error.message})
    print(json.dumps(found))


if __name__ == "__main__":
    _main(sys.argv[1])
