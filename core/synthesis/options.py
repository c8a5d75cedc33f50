"""What the search engine does beyond the paper, as one set of switches."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from core.errors import UserFacingError
from core.synthesis.silence import INTERPOLATIONS

CAPTURED = "captured"
SILENCES = (*INTERPOLATIONS, CAPTURED)


@dataclass(frozen=True)
class SynthesisOptions:
    """How paths are found and turned into motion. The defaults did best on the tuning parts of GRID and the demo.

    n_paths : near-optimal paths that are blended; 1 is the best path alone
    surcharge : what each use of a motion node by an earlier path costs a later one, in PNT
    temperature : a path that costs this much more, in PNT, counts 1/e as much in the blend
    silence : how silence is made: one of `SILENCES`
    jitter_window_s : captures are smoothed over this long; 0 leaves them as they are
    steady_sentences : take out what a captured sentence is off as a whole
    lip_weight : how much more than others the markers of the lips count where nodes join
    emotion_strength : make mixed emotions by blending motions of the pure ones, and not only by choosing nodes
    """

    n_paths: int = 5
    surcharge: float = 2.0
    temperature: float = 10.0
    silence: str = CAPTURED
    jitter_window_s: float = 0.0
    steady_sentences: bool = True
    lip_weight: float = 1.0
    emotion_strength: bool = True

    def __post_init__(self) -> None:
        if self.silence not in SILENCES:
            raise UserFacingError(f"Silence is made by one of {', '.join(SILENCES)}, not '{self.silence}'.")
        for field in fields(self):
            value = getattr(self, field.name)
            least = {"n_paths": 1, "lip_weight": 1e-3}.get(field.name, 0)
            if not isinstance(value, str) and not least <= value < float("inf"):
                raise UserFacingError(f"The synthesis option {field.name} is {value}; it must be {least} or more.")

    @property
    def single(self) -> SynthesisOptions:
        """The same with the best path alone; no mean takes out the jitter of its captures, so they are smoothed."""
        return replace(self, n_paths=1, jitter_window_s=0.15)


# Deng and Neumann (2008) as printed; with it go weights without context (`SearchWeights.as_printed`).
PAPER = SynthesisOptions(
    n_paths=1, silence="linear", jitter_window_s=0.0, steady_sentences=False, lip_weight=1.0, emotion_strength=False
)

# The search by the names that users choose it by: as it does best, its best path alone, as printed.
SEARCHES = {"search": SynthesisOptions(), "search-single": SynthesisOptions().single, "search-paper": PAPER}
