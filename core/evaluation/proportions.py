"""Confidence intervals of a share: so many of so many."""

from __future__ import annotations

import math

from core.errors import UserFacingError

INTERVALS = ("wilson", "exact")
CONFIDENCE = 0.95


def share_interval(count: int, of: int, kind: str = "wilson", confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return the interval (0..1) in which the true share lies, given that ``count`` of ``of`` were seen.

    kind : ``wilson``, whose cover is near ``confidence`` on average and which suits small studies (Wilson 1927; Brown,
        Cai and DasGupta 2001 recommend it); ``exact``, never below it and therefore wider (Clopper and Pearson 1934)

    With nobody asked it is (0, 1). Raises `UserFacingError` for an interval that there is not.
    """
    if kind not in INTERVALS:
        raise UserFacingError(f"There is no interval '{kind[:40]}'.", f"Choose one of {', '.join(INTERVALS)}.")
    if not 0 <= count <= of or not 0.0 < confidence < 1.0:
        raise ValueError(f"{count} of {of} at {confidence}")
    if of == 0:
        return 0.0, 1.0
    return _wilson(count, of, confidence) if kind == "wilson" else _exact(count, of, confidence)


def _wilson(count: int, of: int, confidence: float) -> tuple[float, float]:
    from scipy.special import ndtri

    z = float(ndtri(0.5 + confidence / 2))
    share, per = count / of, z * z / of
    middle = (share + per / 2) / (1 + per)
    half = z * math.sqrt(share * (1 - share) / of + per / (4 * of)) / (1 + per)
    # at the ends the formula gives them to the last digit but one
    return (0.0 if count == 0 else middle - half), (1.0 if count == of else middle + half)


def _exact(count: int, of: int, confidence: float) -> tuple[float, float]:
    from scipy.special import betaincinv

    tail = (1 - confidence) / 2
    low = 0.0 if count == 0 else float(betaincinv(count, of - count + 1, tail))
    high = 1.0 if count == of else float(betaincinv(count + 1, of - count, 1 - tail))
    return low, high
