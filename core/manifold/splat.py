"""The splat image of a phoneme Isomap: where its frames lie and how densely (numpy reference)."""

from __future__ import annotations

import numpy as np

CUT_SIGMAS = 3.0


def splat_image(
    points: np.ndarray,
    colours: np.ndarray,
    sigma_px: float,
    rho: float,
    bounds: tuple[float, float, float, float],
    size: tuple[int, int],
) -> np.ndarray:
    """Return ``I(P) = Σ_i N(Q_i, σ; |Q_i − P|) · ρ · I(Q_i)``, clamped to 1 per channel (eFASE, equation 3).

    N is used unnormalised, ``exp(−d² / 2σ²)``, so that ρ is the brightness of a single point; it is cut to 0 outside
    a square of 3 σ to each side.

    points : Q, shape (n, 2), map units, x to the right and y up; a point that is not finite is left out
    colours : I(Q), shape (n, 3), 0..1
    sigma_px : σ > 0, pixels
    rho : ρ, 0 < ρ < 1
    bounds : left, bottom, right, top of the picture in map units
    size : width, height in pixels
    returns : float32, shape (height, width, 3), 0..1, top row first
    """
    at_px, colours = splat_inputs(points, colours, sigma_px, rho, bounds, size)
    width, height = size
    image = np.zeros((height, width, 3))
    reach = CUT_SIGMAS * sigma_px
    low = np.maximum(np.ceil(at_px - reach - 0.5), 0).astype(int)
    high = np.minimum(np.floor(at_px + reach - 0.5) + 1, (width, height)).astype(int)
    for (x, y), (left, top), (right, bottom), colour in zip(at_px, low, high, colours, strict=True):
        if left >= right or top >= bottom:
            continue
        across = np.exp(-((np.arange(left, right) + 0.5 - x) ** 2) / (2 * sigma_px**2))
        down = np.exp(-((np.arange(top, bottom) + 0.5 - y) ** 2) / (2 * sigma_px**2))
        image[top:bottom, left:right] += (down[:, None] * across)[:, :, None] * (rho * colour)
    return np.minimum(image, 1.0).astype(np.float32)


def splat_inputs(
    points: np.ndarray,
    colours: np.ndarray,
    sigma_px: float,
    rho: float,
    bounds: tuple[float, float, float, float],
    size: tuple[int, int],
) -> tuple[np.ndarray, np.ndarray]:
    """Check the arguments of `splat_image`; return finite points in pixels (y down) and their colours, float64."""
    points, colours = np.asarray(points, float), np.asarray(colours, float)
    if points.ndim != 2 or points.shape[1] != 2 or colours.shape != (len(points), 3):
        raise ValueError(f"points {points.shape} and colours {colours.shape} are not (n, 2) and (n, 3)")
    left, bottom, right, top = bounds
    if not (right > left and top > bottom):
        raise ValueError(f"bounds {bounds} hold no area")
    if not sigma_px > 0 or not 0 < rho < 1 or min(size) < 1:
        raise ValueError(f"sigma_px {sigma_px} > 0, rho {rho} in (0, 1) and size {size} > 0 are asked for")
    finite = np.isfinite(points).all(axis=1)
    points, colours = points[finite], colours[finite]
    width, height = size
    at_px = np.column_stack([(points[:, 0] - left) / (right - left) * width,
                             (top - points[:, 1]) / (top - bottom) * height])  # fmt: skip
    return at_px, colours
