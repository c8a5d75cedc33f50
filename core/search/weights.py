"""The weights of the search's cost terms."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace

import numpy as np

from core.errors import UserFacingError


@dataclass(frozen=True)
class SearchWeights:
    """α1..α6 and PNT of Deng and Neumann 2008, tables 1 and 2, equations 5 and 7.

    pnt : penalty unit, in the unit of PVC (mm²/s² as VGap)
    alpha1 : a transition to a node without captured predecessor, in pnt
    alpha2 : direct smoothing cost (s³ · mm²/s⁴ to mm²/s²)
    alpha3 : position gap within PVC (1/s²)
    alpha4 : discount (0..1) for a phone of the right viseme class
    alpha5 : a phone that does not match, in pnt
    alpha6 : emotion mismatch, in pnt

    Beyond the paper; 0 turns each off:

    context_before, context_after : a neighbour, one phone before or after, that does not match, in pnt
    context_decay : what each further phone counts, as a share (0..1) of the one nearer by
    duration : a node warped to e times its length, or to 1/e of it, in pnt (squared log ratio)
    """

    pnt: float
    alpha1: float = 2.0
    alpha2: float = 1.0
    alpha3: float = 1.0
    alpha4: float = 0.3
    alpha5: float = 5.0
    alpha6: float = 2.0
    context_before: float = 0.0
    context_after: float = 0.0
    context_decay: float = 0.7
    duration: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not np.isfinite(value) or value < 0:
                raise UserFacingError(f"The search weight {field.name} is {value}; it must be 0 or more.")

    @property
    def in_context(self) -> SearchWeights:
        """The same with what the paper does not have, as it did best on the tuning parts of GRID and the demo."""
        return replace(self, context_before=1.0, context_after=1.0, context_decay=0.4, duration=4.0)

    @property
    def as_printed(self) -> SearchWeights:
        """The same without what the paper does not have."""
        return replace(self, context_before=0.0, context_after=0.0, duration=0.0)

    def as_dict(self) -> dict[str, float]:
        """Return plain numbers by name."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, float]) -> SearchWeights:
        """Inverse of `as_dict`; unknown names raise `TypeError`."""
        return cls(**{name: float(value) for name, value in values.items()})
