"""Which compute backend answers the search. Opened once, by `app`, never on import."""

from __future__ import annotations

import logging

from core.errors import UserFacingError
from core.search.compute import NumpyKernels, SearchKernels

BACKENDS = ("auto", "numpy", "opencl", "glsl")
log = logging.getLogger("gpu")


def open_kernels(backend: str = "auto") -> tuple[SearchKernels, str]:
    """Open a compute backend and return it with one sentence about what it is.

    ``auto`` takes OpenCL when it is there and falls back to numpy, saying why. Raises `UserFacingError` for an unknown
    backend, or when the one that was asked for by name is not there.
    """
    if backend not in BACKENDS:
        raise UserFacingError(f"There is no compute backend '{backend}'.", f"Choose one of {', '.join(BACKENDS)}.")
    try:
        kernels = {"numpy": NumpyKernels, "glsl": _open_glsl}.get(backend, _open_opencl)()
    except UserFacingError as error:
        if backend != "auto":
            raise
        sentence = f"{error} The search runs on numpy."
        log.info(sentence)
        return NumpyKernels(), sentence
    log.info(describe(kernels))
    return kernels, describe(kernels)


def describe(kernels: SearchKernels) -> str:
    """One line for the status bar: driver, device, and whether it is software."""
    report = kernels.report
    return f"{report.backend} · {report.device} ({'software' if report.software else 'hardware'}, {report.api})"


def _open_opencl() -> SearchKernels:
    try:
        from gpu.opencl.min_plus import OpenClKernels
    except ImportError as error:
        raise UserFacingError(f"OpenCL cannot be loaded ({error}).") from error
    return OpenClKernels()


def _open_glsl() -> SearchKernels:
    try:
        from gpu.glsl.min_plus import GlslKernels
    except ImportError as error:
        raise UserFacingError(f"OpenGL cannot be loaded ({error}).") from error
    return GlslKernels()
