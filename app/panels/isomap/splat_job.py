"""The splat image under the dots, drawn in the background."""

from __future__ import annotations

import logging
import time
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.manifold.splat import splat_image
from core.progress import Progress

log = logging.getLogger("isomap")

# the widest picture that a software driver draws while the animator waits for it
MOST_PX = 384
_CARD_PX = 1024
# ρ follows the map: where its frames lie densest, the sum of equation 3 comes to this before it is clamped
_DENSEST = 1.25
_HIGHEST_RHO = 0.6
_TRIAL_RHO = 1e-4


@dataclass(frozen=True)
class SplatRequest:
    """What is in view.

    points : shape (n, 2), map units; colours : shape (n, 3), 0..1
    sigma_px : σ in pixels of the screen
    rho_gain : how many times the ρ that suits the map
    bounds : left, bottom, right, top in map units; size : of the view on screen, pixels
    """

    points: np.ndarray
    colours: np.ndarray
    sigma_px: float
    rho_gain: float
    bounds: tuple[float, float, float, float]
    size: tuple[int, int]


@dataclass(frozen=True)
class Splats:
    """The picture, float32, shape (height, width, 3), 0..1, where it belongs, and the ρ it was drawn with."""

    image: np.ndarray
    bounds: tuple[float, float, float, float]
    rho: float


def draw_splats(request: SplatRequest, progress: Progress) -> Splats:
    """Draw equation 3 with a GL context of its own, or by numpy on a machine without GL; a job."""
    image = _summed(request, progress)
    # equation 3 is linear in ρ until it is clamped, so one trial tells the picture of any ρ
    brightest = max(float(image.max(initial=0.0)), 1e-12) / _TRIAL_RHO
    rho = min(request.rho_gain * _DENSEST / brightest, _HIGHEST_RHO)
    return Splats(np.minimum(image * (rho / _TRIAL_RHO), 1.0), request.bounds, rho)


def _summed(request: SplatRequest, progress: Progress) -> np.ndarray:
    from gpu.gl.offscreen import OffscreenRenderer
    from gpu.gl.splats import SplatRenderer

    def between(share: float) -> None:
        progress.step(share)
        time.sleep(0)  # the driver holds Python's lock while it draws; the window gets its turn here

    try:
        with OffscreenRenderer(1, 1, samples=0) as offscreen:
            arguments = _arguments(request, MOST_PX if offscreen.is_software else _CARD_PX)
            renderer = SplatRenderer(offscreen.ctx)
            try:
                return renderer.image(*arguments, between=between)
            finally:
                renderer.release()
    except UserFacingError as error:
        log.info("splats by numpy: %s", error.message)
        return splat_image(*_arguments(request, MOST_PX))


def _arguments(request: SplatRequest, most_px: int) -> tuple:
    width, height = request.size
    scale = min(1.0, most_px / max(width, height))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return (request.points, request.colours, request.sigma_px * scale, _TRIAL_RHO, request.bounds, size)
