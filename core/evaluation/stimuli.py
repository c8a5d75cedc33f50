"""A perception study's stimuli, and in which order each participant meets them (Hong, Wen and Huang 2002, VII-C)."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from core.errors import UserFacingError

SYNTHETIC, CAPTURED = "synthetic", "captured"
FACES = (SYNTHETIC, CAPTURED)
SILENT, AUDIO, BIMODAL = "silent", "audio", "bimodal"
PAPER, ONCE = "paper", "once"
DESIGNS = (PAPER, ONCE)
NOT_SURE = "not sure"
GROUPS = ("A", "B")
MOST_PARTICIPANTS = 10_000
_SHUFFLES = 400


@dataclass(frozen=True)
class Stimulus:
    """What is shown or heard once.

    code : its name, which tells nothing
    kind : `SILENT` (a face without sound), `AUDIO` (the sound alone) or `BIMODAL`
    track : the audio that is heard, or whose words the silent face says
    expression, face : None for audio alone; face is `SYNTHETIC` or `CAPTURED`
    """

    code: str
    kind: str
    track: str
    expression: str | None = None
    face: str | None = None


@dataclass(frozen=True)
class Trial:
    """One stimulus for one participant.

    participant : from 1; group : of `GROUPS`; trial : from 1 through all parts; part : from 1
    """

    participant: int
    group: str
    trial: int
    part: int
    stimulus: Stimulus


@dataclass(frozen=True)
class StudyPlan:
    """What a study asks for.

    tracks : names of the audios; expressions : that every audio is shown in; faces : of `FACES`, one or both
    n_participants : an even number, half of them in each group
    design : `PAPER`, where everybody meets every combination and audio alone is heard once; or `ONCE`, where every
        audio is heard once by a participant in all, in one combination, which the others meet in turn
    """

    tracks: tuple[str, ...]
    expressions: tuple[str, ...]
    faces: tuple[str, ...] = FACES
    n_participants: int = 20
    seed: int = 2002
    design: str = PAPER

    def __post_init__(self) -> None:
        for names, what in ((self.tracks, "audio"), (self.expressions, "expression"), (self.faces, "kind of face")):
            if not names:
                raise UserFacingError(f"A study needs one {what} or more.")
            if len(set(names)) < len(names):
                raise UserFacingError(f"A study names the {what} '{_repeated(names)[:60]}' twice.")
        if self.n_participants < 2 or self.n_participants % 2:
            raise UserFacingError(f"{self.n_participants} participants do not make two equal groups.",
                                  "Ask for an even number of them.")  # fmt: skip
        if self.n_participants > MOST_PARTICIPANTS:
            raise UserFacingError(f"A study has at most {MOST_PARTICIPANTS} participants.")
        if self.design not in DESIGNS:
            raise UserFacingError(f"There is no design '{self.design[:40]}'.", f"Choose {' or '.join(DESIGNS)}.")

    @property
    def balanced_by(self) -> int:
        """Multiples of so many participants meet all combinations equally often, in each group."""
        n_cells = len(self.faces) * len(self.expressions)
        # a silent film is of one audio, and which one goes round; heard once, the combinations go round
        return 2 * (len(self.tracks) if self.design == PAPER else math.lcm(len(self.tracks), 1 + n_cells))


def stimuli_of(plan: StudyPlan) -> list[Stimulus]:
    """Return all stimuli, silent, audio and bimodal ones in the plan's order; their codes are dealt by its seed."""
    combinations = [(SILENT, track, e, f) for track, e, f in _films(plan)]
    combinations += [(AUDIO, track, None, None) for track in plan.tracks]
    combinations += [(BIMODAL, track, e, f) for track, e, f in _films(plan)]
    numbers = list(range(1, len(combinations) + 1))
    _dice(plan, "codes").shuffle(numbers)
    digits = max(2, len(str(len(numbers))))
    return [Stimulus(f"s{number:0{digits}d}", *what) for number, what in zip(numbers, combinations)]


def trials_of(plan: StudyPlan) -> list[Trial]:
    """Return everybody's trials, participant by participant, in the order in which they are met.

    Participants 1, 3, 5 … are group A and meet synthetic faces with sound before captured ones, the others group B the
    other way round. Parts: silent faces; audio alone; the first kind of face with sound; the other one. Within a part
    the order is random, another one for each participant, without the same audio twice in a row where that can be.
    With one kind of face, a participant of group B meets what their partner of group A meets, each part backwards.
    """
    found = {(s.kind, s.track, s.expression, s.face): s for s in stimuli_of(plan)}
    trials = []
    for p in range(plan.n_participants):
        parts = [[found[what] for what in part] for part in _parts(plan, p)]
        ordered = [stimulus for part in parts for stimulus in part]
        part_of = [n for n, part in enumerate(parts, 1) for _ in part]
        trials += [
            Trial(p + 1, GROUPS[p % 2], t, part, stimulus)
            for t, (part, stimulus) in enumerate(zip(part_of, ordered), 1)
        ]
    return trials


def _parts(plan: StudyPlan, p: int) -> list[list[tuple]]:
    pair, group = divmod(p, 2)
    mirrored = group == 1 and len(plan.faces) == 1
    dice = _dice(plan, f"order of {p - 1 if mirrored else p}")
    faces = plan.faces[::-1] if group == 1 else plan.faces
    parts = [_silent(plan, pair)]
    if plan.design == PAPER:
        parts.append([(AUDIO, track, None, None) for track in plan.tracks])
        parts += [[(BIMODAL, track, e, f) for track in plan.tracks for e in plan.expressions] for f in faces]
    else:
        heard = _heard_once(plan, pair)
        parts.append([what for what in heard if what[0] == AUDIO])
        parts += [[what for what in heard if what[3] == f] for f in faces]
    parts = [_shuffled(part, dice) for part in parts]
    return [part[::-1] for part in parts] if mirrored else parts


def _silent(plan: StudyPlan, pair: int) -> list[tuple]:
    """One silent film of each face in each expression; whose words it says goes round from pair to pair."""
    cells = [(e, f) for f in plan.faces for e in plan.expressions]
    n_tracks = len(plan.tracks)
    return [(SILENT, plan.tracks[(pair + c) % n_tracks], e, f) for c, (e, f) in enumerate(cells)]


def _heard_once(plan: StudyPlan, pair: int) -> list[tuple]:
    """Each audio in one combination, which goes round from pair to pair (a Latin square)."""
    cells = [(AUDIO, None, None)] + [(BIMODAL, e, f) for f in plan.faces for e in plan.expressions]
    _dice(plan, "cells").shuffle(cells)
    chosen = [(track, cells[(t + pair) % len(cells)]) for t, track in enumerate(plan.tracks)]
    return [(kind, track, e, f) for track, (kind, e, f) in chosen]


def _shuffled(part: Sequence[tuple], dice: random.Random) -> list[tuple]:
    """A random order, the first found (or the best) without the same audio twice in a row."""
    best, fewest = list(part), len(part) + 1
    for _ in range(_SHUFFLES):
        order = list(part)
        dice.shuffle(order)
        repeats = sum(a[1] == b[1] for a, b in itertools.pairwise(order))
        if repeats < fewest:
            best, fewest = order, repeats
        if repeats == 0:
            break
    return best


def _films(plan: StudyPlan) -> Iterator[tuple[str, str, str]]:
    return ((track, e, f) for track in plan.tracks for f in plan.faces for e in plan.expressions)


def _dice(plan: StudyPlan, purpose: str) -> random.Random:
    # text is hashed by SHA-512, so that every Python and every machine throws the same
    return random.Random(f"{plan.seed} {purpose}")


def _repeated(names: Sequence[str]) -> str:
    return next(name for name in names if names.count(name) > 1)
