"""What no listener can tell: the synthetic actress says a sentence twice, and never moves in the same way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from core.actress.capture import capture, head_motion, markers_of
from core.actress.corpus import RATE_HZ, SpokenSentence, transcript_of
from core.actress.expression import manners
from core.actress.performance import bundled_marker_units, frame_times_s, perform
from core.actress.randomness import Chance
from core.iface.heard_takes import HeardTake
from core.iface.measures import nearness
from core.motion.recording import Recording


def said_again(spoken: SpokenSentence, seed: str, rate_hz: float = RATE_HZ) -> Recording:
    """Let the actress say a bundled sentence as `core.actress.corpus.record` does, varied by ``seed``.

    The sound stays the same, and so do phones and times; effort, targets, expression, blinks, head and noise vary.
    """
    transcript, units = transcript_of(spoken), bundled_marker_units()
    times_s = frame_times_s(transcript.duration_s, rate_hz)
    face = markers_of(perform(transcript, spoken.emotion, seed, rate_hz), units)
    head = head_motion(transcript, manners()[spoken.emotion], times_s, Chance(f"{seed} head"))
    positions = capture(face, *head, Chance(f"{seed} capture"))
    return Recording(
        spoken.sentence, spoken.emotion, positions, units.markers.names, rate_hz, transcript, spoken.text, spoken.audio
    )


def ceiling(takes: Sequence[np.ndarray], largest_mm: np.ndarray) -> float:
    """Return the highest R (equation 6) that can be expected of an estimate from sound alone: √R between two takes.

    With d = s + n, s what the sound tells and n what it does not, the best estimate is s and its R to any take is
    √(tr C_ss / tr C_dd), while the R of two takes, whose n are independent, is tr C_ss / tr C_dd.

    takes : displacements of the same speech, each of shape (n_frames, n_points, 3), mm; with more than two, all pairs
        are taken and their R averaged
    """
    pairs = [(a, b) for i, a in enumerate(takes) for b in takes[:i]]
    if not pairs:
        raise ValueError("a ceiling needs two takes")
    return float(np.sqrt(max(0.0, np.mean([nearness(a, b, largest_mm).r for a, b in pairs]))))


class Reached(NamedTuple):
    """How far an estimate came, in one emotion.

    ceiling : see `ceiling`; r : R of the estimate, mean over the same takes; share : r over the ceiling
    """

    ceiling: float
    r: float
    share: float


def reached(
    spoken: Sequence[np.ndarray], takes: Sequence[Sequence[HeardTake]], largest_mm: np.ndarray,
    points: np.ndarray | None = None,
) -> dict[str, Reached]:  # fmt: skip
    """Measure estimates beside sentences that were said more than once, emotion by emotion.

    spoken : displacements estimated for each sentence, mm
    takes : the sentences, said once, said again, ...; frames count that are used every time
    points : rows of the points to measure; all when None
    """
    chosen = np.arange(len(largest_mm)) if points is None else points
    found = {}
    for emotion in dict.fromkeys(take.emotion for take in takes[0]):
        rows = [s for s, take in enumerate(takes[0]) if take.emotion == emotion]
        used = [np.logical_and.reduce([said[s].used for said in takes]) for s in rows]
        again = [
            np.concatenate([said[s].displacements[u][:, chosen] for s, u in zip(rows, used)]).astype(float)
            for said in takes
        ]
        estimated = np.concatenate([spoken[s][u][:, chosen] for s, u in zip(rows, used)]).astype(float)
        top = ceiling(again, largest_mm[chosen])
        r = float(np.mean([nearness(captured, estimated, largest_mm[chosen]).r for captured in again]))
        found[emotion] = Reached(top, r, r / top if top > 0 else 0.0)
    return found
