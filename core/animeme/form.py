"""Which animemes: as the paper prints them, as its rival has them, and as they do best on real speech."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace

from core.animeme.dominance import SPREADS
from core.errors import UserFacingError

HIGHEST_DEGREE = 8


@dataclass(frozen=True)
class AnimemeForm:
    """What a model is made of; the defaults are those that did best on GRID's tuning part (docs/animemes.md).

    degree : M of equation 2, of each phoneme's polynomial; 0 gives constant targets
    is_normalised : ΣDA/ΣD in place of equation 1's ΣDA
    spread : what σ2 counts; see `core.animeme.dominance.dominance`
    edge : a polynomial is followed to this many half durations from the centre and holds its value beyond; 0 is never
        (as printed, where t⁴ runs away from a phoneme while its dominance falls)
    neighbours : phonemes before and after the current one that are summed over
    context_degree, duration_degree, emotion_degree : how much of the polynomial depends on the neighbours, the duration
        and the emotion (see `core.animeme.levels`); −1 for nothing
    bilabial_emphasis : what an error counts while p, b or m is said: lips that do not meet are seen at once
    has_shared_widths : one σ1 and σ2 a phoneme for all controls, not one for each
    """

    degree: int = 4
    is_normalised: bool = True
    spread: str = "time"
    edge: float = 1.25
    neighbours: int = 8
    context_degree: int = 3
    duration_degree: int = 1
    emotion_degree: int = 2
    bilabial_emphasis: float = 3.0
    has_shared_widths: bool = True

    def __post_init__(self) -> None:
        if not 0 <= self.degree <= HIGHEST_DEGREE:
            raise UserFacingError(f"An animeme of degree {self.degree} cannot be.", f"Choose 0 to {HIGHEST_DEGREE}.")
        if self.spread not in SPREADS or self.neighbours < 1 or self.edge < 0 or self.bilabial_emphasis <= 0:
            raise ValueError(f"{self} is no form of an animeme")

    def as_dict(self) -> dict[str, object]:
        """Return it as plain JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, object]) -> AnimemeForm:
        """Inverse of `as_dict`; raises `ValueError` or `TypeError` for what is none."""
        kinds = {"int": int, "bool": bool, "str": str, "float": float}
        return cls(**{field.name: kinds[field.type](values[field.name]) for field in fields(cls)})


BEST = AnimemeForm()
PRINTED = AnimemeForm(4, False, "duration", 0.0, 8, -1, -1, 4, 1.0, True)
COHEN_MASSARO = replace(PRINTED, degree=0)
COHEN_MASSARO_NORMALISED = replace(COHEN_MASSARO, is_normalised=True)
FORMS: Mapping[str, AnimemeForm] = {
    "best": BEST, "printed": PRINTED, "cohen-massaro": COHEN_MASSARO,
    "cohen-massaro-normalised": COHEN_MASSARO_NORMALISED,
}  # fmt: skip
