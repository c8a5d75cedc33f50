"""The characters that come with the workstation: five heads made from the same CC0 data by the same hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.face.look import Look

DEFAULT = "default"


@dataclass(frozen=True)
class Character:
    """A recipe for one head.

    description : one line for whoever chooses
    shape : MakeHuman targets, without folder ``targets`` and ending, to weights; ``both:`` stands for ``l-`` and ``r-``
    lips_closed : how far the lips must be brought together to touch at rest; in units of the two lip units
    look : colours
    """

    description: str
    shape: Mapping[str, float]
    lips_closed: float
    look: Look


def _macro(gender: str, age: str, build: str = "averagemuscle-averageweight", **origins: float) -> dict[str, float]:
    """Weights of MakeHuman's macro targets; origins default to the middle of the three types."""
    origins = origins or {"african": 1 / 3, "asian": 1 / 3, "caucasian": 1 / 3}
    shape = {f"macrodetails/{origin}-{gender}-{age}": weight for origin, weight in origins.items()}
    return shape | {f"macrodetails/universal-{gender}-{age}-{build}": 1.0}


def _between(young: Mapping[str, float], old: Mapping[str, float], share: float) -> dict[str, float]:
    """Mix two shapes; ``share`` of the second."""
    return {name: (1 - share) * young.get(name, 0.0) + share * old.get(name, 0.0) for name in [*young, *old]}


_ROSA = {"caucasian": 0.55, "asian": 0.30, "african": 0.15}
_OTTO = {"caucasian": 0.85, "asian": 0.10, "african": 0.05}


CHARACTERS: dict[str, Character] = {
    # the actress: her markers were placed on this shape, so it stays as it is
    DEFAULT: Character(
        "Ada, a young woman; the actress's own face",
        _macro("female", "young"),
        lips_closed=0.35,
        look=Look(
            lips=(0.390, 0.100, 0.092), hair=(0.040, 0.020, 0.011), brows=(0.036, 0.020, 0.013),
            iris=(0.085, 0.120, 0.110), hair_mm=7.0, brow_weight=1.25, freckles=0.25, blush=0.7,
        ),
    ),
    "ben": Character(
        "Ben, a young man",
        _macro("male", "young", african=0.62, asian=0.08, caucasian=0.30)
        | {"chin/chin-width-incr": 0.25, "both:eyes/eye-scale-incr": 0.15},
        lips_closed=0.35,
        look=Look(
            skin=(0.235, 0.108, 0.064), lips=(0.205, 0.066, 0.052), hair=(0.010, 0.008, 0.007),
            brows=(0.012, 0.009, 0.007), iris=(0.055, 0.026, 0.012), hair_mm=4.0, brow_weight=1.5, lash_weight=0.7,
            lip_tint=0.55, stubble=0.45, blush=0.25,
        ),
    ),
    "rosa": Character(
        "Rosa, an old woman",
        _between(_macro("female", "young", **_ROSA), _macro("female", "old", **_ROSA), 0.85),
        lips_closed=0.35,
        look=Look(
            skin=(0.560, 0.315, 0.230), lips=(0.400, 0.090, 0.090), hair=(0.440, 0.420, 0.400),
            brows=(0.200, 0.175, 0.155), iris=(0.110, 0.160, 0.190), hair_mm=10.0, brow_weight=0.85, lash_weight=0.55,
            lip_tint=0.85, blush=0.6, age=1.0,
        ),
    ),
    "otto": Character(
        "Otto, an old man",
        _between(_macro("male", "young", **_OTTO), _macro("male", "old", **_OTTO), 0.72)
        | {"nose/nose-scale-vert-incr": 0.25, "both:ears/ear-scale-incr": 0.30},
        lips_closed=0.35,
        look=Look(
            skin=(0.530, 0.262, 0.180), lips=(0.380, 0.130, 0.110), hair=(0.500, 0.490, 0.475),
            brows=(0.165, 0.150, 0.135), iris=(0.095, 0.150, 0.215), hair_mm=3.0, brow_weight=1.5, lash_weight=0.45,
            lip_tint=0.45, stubble=0.30, blush=0.65, age=0.9,
        ),
    ),
    "pip": Character(
        "Pip, a cartoon: big eyes, small chin, large ears",
        _macro("female", "child", caucasian=0.6, asian=0.4, african=0.0)
        | {
            "both:eyes/eye-scale-incr": 1.0, "nose/nose-scale-depth-incr": 0.3, "nose/nose-point-up": 0.8,
            "head/head-fat-incr": 0.35, "both:ears/ear-wing-incr": 1.0, "both:ears/ear-scale-incr": 0.8,
            "chin/chin-width-decr": 0.6, "head/head-scale-vert-incr": 0.3, "both:cheek/cheek-volume-incr": 0.5,
        },
        lips_closed=0.35,
        look=Look(
            skin=(0.600, 0.315, 0.215), lips=(0.460, 0.130, 0.110), hair=(0.330, 0.085, 0.022),
            brows=(0.230, 0.065, 0.020), iris=(0.060, 0.190, 0.080), hair_mm=16.0, brow_weight=1.2, freckles=1.0,
            blush=1.0,
        ),
    ),
}  # fmt: skip


def character_names() -> dict[str, str]:
    """Return the names that can be asked for, each with a line that says who it is; the default first."""
    return {name: character.description for name, character in CHARACTERS.items()}
