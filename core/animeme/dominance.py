"""How strongly a phoneme rules a control, before, during and after it is said (Kuo et al. 2012, equation 7).

The paper's dominance function of phoneme j, with centre μ, duration d and boundary t_b = μ ± d/2 nearest to t, is

    D(t) = exp{ −( (t − μ) / (d σ1 + ε) )² }                                          while it is said,
    D(t) = exp{ −( (t − t_b) / (d σ2 + ε) + (t_b − μ) / (d σ1 + ε) )² }               before and after,

with σ1 for how it keeps its own shape and σ2 for how far it reaches into its neighbours. It is 1 at the centre and
continuous at the boundary. Offsets are taken without their sign here: the function is symmetric.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

EPSILON_S = 1e-3
# What σ2 counts where it counts seconds: about one phone, so that σ = 1 is a fair start in both.
REACH_S = 0.1
SPREADS = ("duration", "time")


class DominanceSlopes(NamedTuple):
    """Dominance and its derivatives by σ1 (``by_keep``) and σ2 (``by_reach``)."""

    value: np.ndarray
    by_keep: np.ndarray
    by_reach: np.ndarray


def dominance(
    offset_s: np.ndarray, duration_s: np.ndarray, keep: np.ndarray, reach: np.ndarray, spread: str = "duration"
) -> np.ndarray:
    """Equation 7; dimensionless, in (0, 1].

    offset_s : t − μ, seconds
    duration_s : d, seconds, > 0
    keep, reach : σ1 and σ2 of the phoneme, > 0
    spread : ``duration`` lets σ2 count durations of the phoneme itself, as printed: a long vowel or silence reaches
        far. ``time`` lets it count tenths of a second, whatever the duration
    All arrays broadcast.
    """
    x, _, _, _, _ = _exponent(offset_s, duration_s, keep, reach, spread)
    return np.exp(-(x * x))


def dominance_slopes(
    offset_s: np.ndarray, duration_s: np.ndarray, keep: np.ndarray, reach: np.ndarray, spread: str = "duration"
) -> DominanceSlopes:
    """Equation 7 with its derivatives by σ1 and σ2, for the Gauss–Newton steps of equations 8 and 9."""
    x, inside, outside, (keep_s, unit_keep_s), (reach_s, unit_reach_s) = _exponent(
        offset_s, duration_s, keep, reach, spread
    )
    value = np.exp(-(x * x))
    steep = 2.0 * x * value  # −dD/dx
    return DominanceSlopes(
        value, steep * inside * unit_keep_s / keep_s**2, steep * outside * unit_reach_s / reach_s**2
    )  # fmt: skip


def held(offset_s: np.ndarray, duration_s: np.ndarray, longest_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return offset and duration of a phoneme whose middle is held for what it lasts beyond ``longest_s``.

    The Gaussian stretches with the phoneme, but its neighbours do not, so a dragged sound fades from its centre to
    either side (the paper's stated weakness). Here its onset and its offset keep the length that they were learnt at,
    and between them time stands still: dominance 1, the animeme at its middle. Shorter phonemes stay as they are.
    """
    excess_s = np.maximum(duration_s - longest_s, 0.0)
    beyond_s = np.maximum(np.abs(offset_s) - excess_s / 2, 0.0)
    return np.where(excess_s > 0, np.copysign(beyond_s, offset_s), offset_s), duration_s - excess_s


def _exponent(offset_s, duration_s, keep, reach, spread: str):
    """x of D = exp(−x²), its two parts in seconds, and for each σ its width and what one of it is worth, seconds."""
    away_s = np.abs(offset_s)
    inside_s = np.minimum(away_s, duration_s / 2)
    outside_s = away_s - inside_s
    unit_s = duration_s if spread == "duration" else REACH_S
    keep_s, reach_s = duration_s * keep + EPSILON_S, unit_s * reach + EPSILON_S
    return inside_s / keep_s + outside_s / reach_s, inside_s, outside_s, (keep_s, duration_s), (reach_s, unit_s)
