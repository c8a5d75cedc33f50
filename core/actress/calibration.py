"""Is the actress's mouth like a real one? Her phones beside those of GRID's talker, in the same sentences.

``python -m core.actress.calibration --grid FOLDER`` lets her speak the very phone labels of the real clips, at their
timing, neutral, looks at her as often as the camera looked at him (25 times a second) and prints lip gap, mouth
width, closure and peak speed of every phone beside his. It fails, exit status 1, if a median of a phone that he says
at least `ENOUGH` times lies beyond the tolerance. Without ``--grid`` his stored figures are taken and she speaks
sentences of the same grammar, timed as he times them, with a wider tolerance. ``--write`` stores his figures anew.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.actress.capture import markers_of
from core.actress.grid_talker import (
    RATE_HZ,
    TalkerFigures,
    figures_of,
    less_rest,
    outer_eye_mm,
    read_grid_clips,
    sentences_like_grid,
    stored_figures,
    word_durations,
    write_figures,
)
from core.actress.mouth import MouthCourse, PhoneMeasure, mouth_course
from core.actress.performance import bundled_marker_units, perform
from core.errors import UserFacingError
from core.speech.transcript import Transcript

# Once in eight clips. At 40 the check would take in ao, dh and hh, which miss: docs/demo-corpus.md says why.
ENOUGH = 50
TOLERANCE = 0.25
# Beside stored figures she speaks like sentences, not the same ones: medians shift with the neighbours that
# chance drew, so everything may lie twice as far.
STORED_TOLERANCE = 2 * TOLERANCE
# Differences below what the tracker's own jitter makes of a still mouth (0.24 mm in the gap, at 25 Hz) mean nothing.
FLOORS = PhoneMeasure(gap_mm=0.5, width_mm=0.0, closure_mm=0.5, speed_mm_s=10.0)
OUTER_EYE_MM = 90.0
STORED_SENTENCES = 400


def her_mouth(transcript: Transcript, seed: str) -> MouthCourse:
    """Let her speak a transcript, neutral, and measure her as GRID's talker was: 25 Hz, eyes 90 mm apart, less rest."""
    units = bundled_marker_units()
    scale = OUTER_EYE_MM / outer_eye_mm(units.markers.rest, units.markers)
    face = markers_of(perform(transcript, "neutral", seed, RATE_HZ), units) * scale
    still = mouth_course(units.markers.rest[None] * scale, units.markers, RATE_HZ)
    return less_rest(mouth_course(face, units.markers, RATE_HZ), still)


def her_figures(sentences: Sequence[tuple[str, Transcript]]) -> TalkerFigures:
    """Measure her in (name, transcript) ``sentences``."""
    return figures_of([(transcript, her_mouth(transcript, name)) for name, transcript in sentences])


def tolerances(real: TalkerFigures, phone: str, tolerance: float = TOLERANCE) -> PhoneMeasure:
    """Return how far a median of hers may lie from his.

    That share of his median, or the floor where it is smaller. Width changes by a tenth only, so a quarter of it
    would let anything pass: there it is the share of the range in which his moves.
    """
    floors = tolerance / TOLERANCE * np.array(FLOORS)
    allowed = PhoneMeasure(*np.maximum(tolerance * np.abs(real.medians[phone]), floors))
    return allowed._replace(width_mm=tolerance * real.width_range_mm)


def misses(real: TalkerFigures, hers: TalkerFigures, tolerance: float = TOLERANCE) -> list[tuple[str, str]]:
    """Return (phone, measure) wherever a median is out of tolerance, of phones that both say and he says often."""
    found = []
    for phone in compared_phones(real, hers):
        for name, his, her, allowed in zip(
            PhoneMeasure._fields, real.medians[phone], hers.medians[phone], tolerances(real, phone, tolerance)
        ):
            if abs(his - her) > allowed:
                found.append((phone, name))
    return found


def compared_phones(real: TalkerFigures, hers: TalkerFigures) -> list[str]:
    """Return the phones that are compared, the commonest first."""
    often = [phone for phone, count in real.counts.items() if count >= ENOUGH and phone in hers.medians]
    return sorted(often, key=lambda phone: -real.counts[phone])


def table(real: TalkerFigures, hers: TalkerFigures, tolerance: float = TOLERANCE) -> str:
    """Return the comparison as lines of text; ``!`` marks a miss, and brackets a phone that is too rare to judge."""
    missed = set(misses(real, hers, tolerance))
    often = set(compared_phones(real, hers))
    lines = [
        "             lip gap mm       width mm      closure mm     speed mm/s",
        "phone count  real   hers    real   hers    real   hers    real   hers",
    ]
    for phone in sorted(real.medians.keys() & hers.medians.keys(), key=lambda phone: -real.counts[phone]):
        name = phone if phone in often else f"({phone})"
        cells = []
        for field, his, her in zip(PhoneMeasure._fields, real.medians[phone], hers.medians[phone]):
            digits = 0 if field == "speed_mm_s" else 1
            cells.append(f"{his:7.{digits}f}{her:7.{digits}f}{'!' if (phone, field) in missed else ' '}")
        lines.append(f"{name:5} {real.counts[phone]:5}" + "".join(cells))
    return "\n".join(lines)


def main(words: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit status."""
    parser = argparse.ArgumentParser(prog="python -m core.actress.calibration", description=__doc__.partition("\n")[0])
    parser.add_argument("--grid", type=Path, help="folder of the GRID recordings; without it stored figures are used")
    parser.add_argument("--write", action="store_true", help="store the real talker's figures in resources/demo")
    told = parser.parse_args(words)
    tolerance = TOLERANCE if told.grid is not None else STORED_TOLERANCE
    if told.grid is None:
        real = stored_figures()
        sentences = [(f"like GRID {i}", s) for i, s in enumerate(sentences_like_grid(STORED_SENTENCES))]
        print(f"Stored figures of GRID's talker; she speaks {len(sentences)} sentences like his.")
    else:
        clips = read_grid_clips(told.grid)
        real = figures_of([(transcript, mouth) for _, transcript, mouth in clips])
        sentences = [(name, transcript) for name, transcript, _ in clips]
        print(f"GRID's talker and the synthetic actress in the same {len(clips)} sentences.")
        if told.write:
            write_figures(real, word_durations([transcript for _, transcript in sentences]))
    hers = her_figures(sentences)
    print(table(real, hers, tolerance))
    missed = misses(real, hers, tolerance)
    widening = tolerance / TOLERANCE
    print(
        f"{len(compared_phones(real, hers))} phones are said {ENOUGH} times or more; tolerance {tolerance:.0%} of his "
        f"median but at least {widening * FLOORS.gap_mm} mm and {widening * FLOORS.speed_mm_s:.0f} mm/s, and for width "
        f"{tolerance * real.width_range_mm:.1f} mm, {tolerance:.0%} of its range. Gap, width, closure less the rest."
    )
    print("Out of tolerance: " + (", ".join(f"{phone} {name}" for phone, name in missed) or "none"))
    return 1 if missed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except UserFacingError as error:
        sys.exit(str(error))
