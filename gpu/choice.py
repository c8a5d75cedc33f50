"""Which compute backend is the quickest here: measured once, remembered until a driver changes."""

from __future__ import annotations

import json
import logging
import os
import sys
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.folders import cache_dir
from core.media.swap_in import swapped_in
from core.search.compute import NumpyKernels
from gpu.trial import measured, tried

_VERSION = 1
_DRIVER_SETTINGS = ("LIBGL_ALWAYS_SOFTWARE", "MESA_LOADER_DRIVER_OVERRIDE", "OCL_ICD_VENDORS", "POCL_DEVICES",
                    "CUDA_VISIBLE_DEVICES")  # fmt: skip
_EGL_VENDORS = Path("usr/share/glvnd/egl_vendor.d")  # a driver's package renews its file here
log = logging.getLogger("gpu")


def quickest() -> list[dict[str, object]]:
    """Return what was measured, the quickest first, then what is missing; entries as `gpu.trial.tried` gives them.

    Measured on the first call on a machine, and again when its drivers changed or the file of the figures is damaged;
    that takes some seconds, so call it off the main thread. A cache folder that cannot be written is no hindrance.
    """
    path, drivers = cache_dir() / "compute.json", installed_drivers()
    remembered = _read(path, drivers)
    if remembered is not None:
        return remembered
    log.info("measuring the compute backends")
    entries = [measured(NumpyKernels()), *tried("opencl"), *tried("glsl")]
    entries.sort(key=lambda entry: entry.get("step_s", np.inf))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with swapped_in(path) as beside:
            beside.write_text(json.dumps({"version": _VERSION, "drivers": drivers, "measured": entries}, indent=1))
    except (OSError, UserFacingError) as error:
        log.info("the choice of a compute backend cannot be remembered: %s", error)
    return entries


def forget() -> None:
    """Measure again the next time, as when a remembered device is gone."""
    (cache_dir() / "compute.json").unlink(missing_ok=True)


def installed_drivers() -> list[str]:
    """Name every driver that can be named without opening it, with its version, and what chooses among them."""
    drivers = [f"numpy {np.__version__}", f"{sys.platform} {os.cpu_count()} cores"]
    try:
        from gpu.opencl.min_plus import able_devices, report_of

        drivers += [f"{r.device} / {r.api} / {r.driver}" for r in map(report_of, able_devices())]
    except (ImportError, UserFacingError) as error:
        drivers.append(str(error))
    root = Path(sys.executable).anchor
    for vendor in sorted((root / _EGL_VENDORS).glob("*.json")):
        drivers.append(f"{vendor.name} {vendor.stat().st_mtime:.0f}")
    return drivers + [f"{name}={os.environ[name]}" for name in _DRIVER_SETTINGS if name in os.environ]


def _read(path: Path, drivers: list[str]) -> list[dict[str, object]] | None:
    """What was remembered; None when there is nothing, or it is damaged, or of other drivers."""
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        if kept["version"] != _VERSION or kept["drivers"] != drivers:
            return None
        entries = kept["measured"]
        sound = all(_is_entry(entry) for entry in entries) and "step_s" in entries[0]
    except (OSError, ValueError, TypeError, KeyError, IndexError, RecursionError):
        return None
    return entries if sound else None


def _is_entry(entry: dict[str, object]) -> bool:
    if entry["backend"] not in ("numpy", "opencl", "glsl"):
        return False
    if "step_s" not in entry:
        return isinstance(entry["missing"], str)
    return isinstance(entry["step_s"], float) and isinstance(entry["device"], str)
