"""Which compute backend answers the search. Opened once, by `app`, never on import."""

from __future__ import annotations

import logging

from core.errors import UserFacingError
from core.search.compute import NumpyKernels, SearchKernels
from gpu.fallback import FallbackKernels

BACKENDS = ("auto", "numpy", "opencl", "glsl")
log = logging.getLogger("gpu")


def open_kernels(backend: str = "auto") -> tuple[FallbackKernels, str]:
    """Open a compute backend and return it with one sentence about what it is, and for ``auto`` why.

    ``auto`` takes the quickest, which is measured once and remembered (`gpu.choice`), so its first call takes some
    seconds. Whatever is opened goes on with numpy if its device fails later. Raises `UserFacingError` for an unknown
    backend, or when the one that was asked for by name is not there.
    """
    if backend not in BACKENDS:
        raise UserFacingError(f"There is no compute backend '{backend}'.", f"Choose one of {', '.join(BACKENDS)}.")
    if backend == "auto":
        kernels, sentence = _open_quickest()
    else:
        kernels = _open(backend)
        sentence = describe(kernels)
    log.info(sentence)
    return FallbackKernels(kernels), sentence


def describe(kernels: SearchKernels) -> str:
    """One line for the status bar: driver, device, and whether it is software."""
    report = kernels.report
    kind = "software" if report.software else "hardware"
    return f"{report.backend} · {report.device} ({', '.join(filter(None, (kind, report.api, report.driver)))})"


def _open_quickest() -> tuple[SearchKernels, str]:
    from gpu.choice import forget, quickest

    entries = quickest()
    best = entries[0]
    try:
        kernels = _open(best["backend"], best["device"])
    except UserFacingError as error:
        forget()
        return NumpyKernels(), f"{error} The search runs on numpy."
    others = {}
    for entry in entries[1:]:
        if "step_s" in entry and entry["backend"] != best["backend"]:
            others.setdefault(entry["backend"], f"{entry['backend']} {1e3 * entry['step_s']:.1f}")
    if others:
        figures = f"{1e3 * best['step_s']:.1f} ms a trial step; {', '.join(others.values())}"
        return kernels, f"{describe(kernels)}, the quickest here ({figures})"
    missing = " ".join(str(entry["missing"]) for entry in entries if "missing" in entry)
    return kernels, f"{missing} The search runs on {describe(kernels)}."


def _open(backend: str, device_name: str = "") -> SearchKernels:
    """Open a backend, on the device of that name when there are several."""
    if backend == "numpy":
        return NumpyKernels()
    try:
        if backend == "glsl":
            from gpu.glsl.min_plus import GlslKernels

            return GlslKernels()
        from gpu.opencl.min_plus import OpenClKernels, able_devices

        named = [d for d in able_devices() if d.name.strip() == device_name]
        return OpenClKernels(named[0] if named else None)
    except ImportError as error:
        raise UserFacingError(f"{backend} cannot be loaded ({error}).") from error
