"""What a character looks like beyond its shape: colours of skin, hair and eyes, and the marks of age."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Look:
    """Colours are linear RGB, 0..1; the rest are strengths from 0 to 1 unless said otherwise.

    skin, lips, brows, hair, iris : colours
    hair_mm : how far the hair stands off the scalp; 0 leaves the scalp bare. Faces without the mask ``hair`` have none
    brow_weight : how thick and dense the brows are; 1 is a young woman's
    lash_weight : how dark and long the lashes are
    lip_tint : how much the colour of the lips differs from the skin
    stubble, freckles, blush : what they say
    age : wrinkles, mottled skin, paler eyes
    """

    skin: Colour = (0.520, 0.275, 0.185)
    lips: Colour = (0.400, 0.105, 0.095)
    brows: Colour = (0.050, 0.028, 0.018)
    hair: Colour = (0.050, 0.028, 0.018)
    iris: Colour = (0.085, 0.120, 0.110)
    hair_mm: float = 0.0
    brow_weight: float = 1.0
    lash_weight: float = 1.0
    lip_tint: float = 0.72
    stubble: float = 0.0
    freckles: float = 0.0
    blush: float = 0.5
    age: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return what `from_dict` reads."""
        return asdict(self)

    @classmethod
    def from_dict(cls, stored: dict[str, object]) -> Look:
        """Inverse of `as_dict`; raises `ValueError` or `TypeError` for anything else."""
        values: dict[str, object] = {}
        for field in fields(cls):
            value = stored[field.name]
            if isinstance(field.default, tuple):
                red, green, blue = value
                values[field.name] = (float(red), float(green), float(blue))
            else:
                values[field.name] = float(value)
        return cls(**values)
