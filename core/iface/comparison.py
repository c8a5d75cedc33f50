"""A speaking face beside the captures: what is trained on, what is tested on, and how near it comes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import UserFacingError
from core.iface.heard_takes import HeardTake
from core.iface.lessons import units_of
from core.iface.measures import Nearness, largest_displacements, nearness
from core.iface.motion_unit import NEUTRAL, PAPER_UTTERANCE, MotionUnits
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress

SHARE = 0.8  # of the data to train on, as the paper
SEED = 2002
GAP_S = 2.0
PAPER_EXPRESSION_UNITS = 2

# Takes of displacements of these markers from their rest pose to a face.
Trainer = Callable[[Sequence[HeardTake], MarkerSet, Progress], SpeakingFace]


@dataclass(frozen=True)
class Part:
    """What a face is trained on, and what it is tested on; the same takes may be in both, with other frames used."""

    train: Sequence[HeardTake]
    test: Sequence[HeardTake]


def split_by_frame(takes: Sequence[HeardTake], share: float = SHARE, seed: int = SEED) -> Part:
    """Draw ``share`` of all frames to train on, the rest to test on: the paper's split.

    Nearly every test frame has neighbours that were trained on, 33 ms away.
    """
    usable = [np.flatnonzero(take.used) for take in takes]
    total = sum(map(len, usable))
    is_trained = np.zeros(total, bool)
    is_trained[np.random.default_rng(seed).permutation(total)[: round(share * total)]] = True
    stops = np.cumsum([len(frames) for frames in usable])
    train, test = [], []
    for take, frames, drawn in zip(takes, usable, np.split(is_trained, stops[:-1])):
        for part, chosen in ((train, drawn), (test, ~drawn)):
            used = np.zeros(len(take), bool)
            used[frames[chosen]] = True
            part.append(replace(take, used=used))
    return Part(train, test)


def split_by_time(takes: Sequence[HeardTake], share: float = SHARE, gap_s: float = GAP_S) -> Part:
    """Train on the first ``share`` of every take, test on its end; ``gap_s`` before the cut belong to neither.

    Raises `UserFacingError` for a take so short that nothing is left to train on.
    """
    train, test = [], []
    for take in takes:
        frames, cut = np.arange(len(take)), round(share * len(take))
        heard = take.used & (frames < cut - round(gap_s * RATE_HZ))
        if not heard.any() or not take.used[cut:].any():
            raise UserFacingError(f"Take '{take.name}' is too short to be split by time.")
        train.append(replace(take, used=heard))
        test.append(replace(take, used=take.used & (frames >= cut)))
    return Part(train, test)


def estimates(face: SpeakingFace, takes: Sequence[HeardTake]) -> list[np.ndarray]:
    """Let ``face`` speak what is heard, in the emotion of each take; displacements from its neutral pose, mm."""
    spoken = []
    for take in takes:
        strengths = {} if take.emotion == NEUTRAL else {take.emotion: 1.0}
        spoken.append(face.motion(take.features, strengths) - face.neutral)
    return spoken


def by_emotion(
    takes: Sequence[HeardTake], spoken: Sequence[np.ndarray], largest_mm: np.ndarray, points: np.ndarray | None = None
) -> dict[str, Nearness]:
    """Measure the frames of ``takes`` that are used, emotion by emotion, as the columns of the paper's tables are.

    points : rows of the points to measure; all when None
    """
    chosen = np.arange(len(largest_mm)) if points is None else points
    found = {}
    for emotion in dict.fromkeys(take.emotion for take in takes):
        said = [(take, d) for take, d in zip(takes, spoken) if take.emotion == emotion]
        captured = np.concatenate([take.displacements[take.used][:, chosen] for take, _ in said])
        estimated = np.concatenate([d[take.used][:, chosen] for take, d in said])
        if len(captured):
            found[emotion] = nearness(captured.astype(float), estimated.astype(float), largest_mm[chosen])
    return found


def through_units(takes: Sequence[HeardTake], units: MotionUnits) -> list[HeardTake]:
    """Return ``takes`` as the paper's truth was: tracked by motion units, so that only what they span is left."""
    kept = [units.deformations(units.parameters(t.displacements, t.emotion), t.emotion) for t in takes]
    return [replace(take, displacements=moved) for take, moved in zip(takes, kept)]


@dataclass(frozen=True)
class Yardstick:
    """What estimates are measured with; learned from the part that is trained on, so that a test part sets no scale.

    largest_mm : see `core.iface.measures.largest_displacements`
    mouth : rows of the markers of lips and jaw; none when the marker set does not tell them
    units : motion units, as many as the paper's
    """

    largest_mm: np.ndarray
    mouth: np.ndarray
    units: MotionUnits

    @classmethod
    def of(cls, takes: Sequence[HeardTake], markers: MarkerSet) -> Yardstick:
        """Make it of the used frames of ``takes``."""
        largest_mm = largest_displacements(np.concatenate([take.displacements[take.used] for take in takes]))
        mouth = np.union1d(markers.group("lips"), markers.group("jaw")).astype(int)
        return cls(largest_mm, mouth, units_of(takes, PAPER_UTTERANCE, PAPER_EXPRESSION_UNITS))

    @property
    def scopes(self) -> dict[str, np.ndarray | None]:
        """Which markers are measured, by name; None for all."""
        return {"all markers": None, **({"lips and jaw": self.mouth} if len(self.mouth) else {})}

    def measure(self, takes: Sequence[HeardTake], spoken: Sequence[np.ndarray]) -> dict[str, dict[str, Nearness]]:
        """Measure displacements ``spoken`` for ``takes``, by scope, then by emotion.

        Besides `scopes` there is ``tracked``: all markers, of captures brought `through_units` as the paper's were.
        """
        found = {name: by_emotion(takes, spoken, self.largest_mm, points) for name, points in self.scopes.items()}
        return found | {"tracked": by_emotion(through_units(takes, self.units), spoken, self.largest_mm)}


@dataclass(frozen=True)
class Compared:
    """One trained face on one split; ``train`` and ``test`` as `Yardstick.measure` gives them."""

    face: SpeakingFace
    train: Mapping[str, Mapping[str, Nearness]]
    test: Mapping[str, Mapping[str, Nearness]]


def compare(trainer: Trainer, part: Part, markers: MarkerSet, progress: Progress = SILENT) -> Compared:
    """Train on one half of ``part`` and measure on both."""
    face = trainer(part.train, markers, progress.part(0.0, 0.9))
    progress.step(0.9, "measuring")
    yardstick = Yardstick.of(part.train, markers)
    train, test = (yardstick.measure(takes, estimates(face, takes)) for takes in (part.train, part.test))
    progress.step(1.0, "measured")
    return Compared(face, train, test)
