"""The real talker that the actress is calibrated on: GRID's s1, his figures and the sentences that he said.

Figures of him enter the project (``grid-figures.csv``: medians of each phone; ``grid-words.csv``: how long he holds
the phones of each word); his recordings do not. See `core.actress.calibration`.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from core.actress.mouth import MouthCourse, PhoneMeasure, measure_phones, mouth_course
from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.motion.marker_set import MarkerSet
from core.motion.normalise import normalise
from core.motion.rest_pose import choose_rest_pose
from core.progress import SILENT, Progress
from core.speech.phoneme import PAU
from core.speech.transcript import PhonemeUtterance, Transcript

RATE_HZ = 25.0
# The clips to calibrate on, of 480: the others stay untouched for whoever measures the product on GRID.
TRAIN_CLIPS, SPLIT_SEED = 400, 2008
# Between these percentiles of frames a mouth is said to move in width.
RANGE_PERCENTILES = (5, 95)
PLACES = 6
# What is kept of how long a phone lasts.
DURATION_PERCENTILES = (10, 50, 90)


class TalkerFigures(NamedTuple):
    """Medians of one talker's phones, each less the talker's own rest for gap, width and closure.

    width_range_mm : how far the mouth width ranges over all frames
    """

    medians: dict[str, PhoneMeasure]
    counts: dict[str, int]
    width_range_mm: float


def read_grid_clips(folder: Path, progress: Progress = SILENT) -> list[tuple[str, Transcript, MouthCourse]]:
    """Read name, transcript and mouth (less its rest) of the clips to calibrate on.

    Head motion is taken out and the outer eye corners set 90 mm apart, as the set's README proposes. Raises
    `UserFacingError` for a folder that is not laid out like GRID.
    """
    from dataclasses import replace

    from core.motion.readers.tracked_points import read_tracked_points

    corpus = read_tracked_points(folder, progress)
    names = sorted(recording.sentence for recording in corpus.recordings)
    order = np.random.default_rng(SPLIT_SEED).permutation(len(names))
    train = {names[i] for i in order[:TRAIN_CLIPS]}
    corpus = replace(corpus, recordings=[r for r in corpus.recordings if r.sentence in train])

    columns = np.array([corpus.recordings[0].marker_names.index(name) for name in corpus.kept_markers])
    markers = MarkerSet(corpus.kept_markers, np.zeros((len(columns), 3)), corpus.groups, corpus.landmarks)
    rigid = markers.group("rigid")
    some = replace(corpus, recordings=corpus.recordings[::10])
    rest = choose_rest_pose(some, columns, rigid, None)
    rest *= corpus.outer_eye_mm / outer_eye_mm(rest, markers)
    still = mouth_course(rest[None], markers, RATE_HZ)
    clips = []
    for r in corpus.recordings:
        face, _ = normalise(np.asarray(r.positions, float)[:, columns], rest, rigid, None, with_scale=True)
        clips.append((r.sentence, r.transcript, less_rest(mouth_course(face, markers, r.rate_hz), still)))
    return clips


def outer_eye_mm(rest: np.ndarray, markers: MarkerSet) -> float:
    """Return the distance of the outer eye corners of a rest pose."""
    left, right = (markers.landmark(name) for name in ("outer_eye_left", "outer_eye_right"))
    return float(np.linalg.norm(rest[left] - rest[right]))


def less_rest(mouth: MouthCourse, rest: MouthCourse) -> MouthCourse:
    """Return a course less the gap and width of the talker's resting mouth, of one frame."""
    return MouthCourse(mouth.gap_mm - rest.gap_mm[0], mouth.width_mm - rest.width_mm[0], mouth.rate_hz)


def figures_of(spoken: Sequence[tuple[Transcript, MouthCourse]]) -> TalkerFigures:
    """Measure all phones of a talker and take their medians."""
    found: dict[str, list[PhoneMeasure]] = defaultdict(list)
    for transcript, mouth in spoken:
        for phone, measure in measure_phones(transcript, mouth):
            found[phone].append(measure)
    low, high = np.percentile(np.concatenate([mouth.width_mm for _, mouth in spoken]), RANGE_PERCENTILES)
    return TalkerFigures(
        {phone: PhoneMeasure(*map(float, np.median(measures, axis=0))) for phone, measures in found.items()},
        {phone: len(measures) for phone, measures in found.items()},
        float(high - low),
    )


def word_durations(transcripts: Sequence[Transcript]) -> list[tuple[int, str, int, str]]:
    """Return how each word is said: place in the sentence (1..6), word, how often, and its commonest form.

    A phone is written ``phone:short/usual/long``, the seconds that it lasts (`DURATION_PERCENTILES`). Place 0 and 7
    are the silences before and after.
    """
    said: dict[tuple[int, str], dict[tuple[str, ...], list[list[float]]]] = defaultdict(lambda: defaultdict(list))
    for transcript in transcripts:
        for place, word in enumerate(transcript.words, 1):
            inside = [u for u in transcript.phonemes if word.start_s - 1e-3 < (u.start_s + u.end_s) / 2 < word.end_s]
            if place <= PLACES and inside and all(u.phone != PAU for u in inside):
                said[place, word.word][tuple(u.phone for u in inside)].append([u.end_s - u.start_s for u in inside])
        for place, u in ((0, transcript.phonemes[0]), (PLACES + 1, transcript.phonemes[-1])):
            if u.phone == PAU:
                said[place, PAU][(PAU,)].append([u.end_s - u.start_s])
    rows = []
    for (place, word), forms in sorted(said.items()):
        phones, durations_s = max(forms.items(), key=lambda form: (len(form[1]), form[0]))
        lasting_s = np.percentile(durations_s, DURATION_PERCENTILES, axis=0).T
        labels = (f"{phone}:" + "/".join(f"{s:.3f}" for s in row) for phone, row in zip(phones, lasting_s))
        rows.append((place, word, sum(map(len, forms.values())), " ".join(labels)))
    return rows


def sentences_like_grid(count: int, folder: Path = DEMO_FOLDER) -> list[Transcript]:
    """Return ``count`` sentences of GRID's grammar, each word as often as its talker says it and timed as he does."""
    words: dict[int, list[str]] = defaultdict(list)
    with open(folder / "grid-words.csv", encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            words[int(row["place"])] += [row["phones"]] * int(row["count"])
    chance = Chance("sentences like GRID's")
    shuffled = {place: [said[i] for i in chance.normal(len(said)).argsort()] for place, said in words.items()}
    sentences = []
    for n in range(count):
        phonemes, now_s = [], 0.0
        for place in range(PLACES + 2):
            for label in shuffled[place][n % len(shuffled[place])].split():
                phone, _, lasting = label.partition(":")
                lasting_s = [float(seconds) for seconds in lasting.split("/")]
                end_s = now_s + float(np.interp(chance.between(0, 100), DURATION_PERCENTILES, lasting_s))
                phonemes.append(PhonemeUtterance(phone, now_s, end_s))
                now_s = end_s
        sentences.append(Transcript.covering(phonemes, [], now_s))
    return sentences


def write_figures(
    figures: TalkerFigures, words: Sequence[tuple[int, str, int, str]], folder: Path = DEMO_FOLDER
) -> None:
    """Write ``grid-figures.csv`` and ``grid-words.csv``."""
    with open(folder / "grid-figures.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("phone", "count", *PhoneMeasure._fields))
        for phone in sorted(figures.medians, key=lambda phone: -figures.counts[phone]):
            writer.writerow((phone, figures.counts[phone], *(f"{value:.2f}" for value in figures.medians[phone])))
        writer.writerow(("width range", "", "", f"{figures.width_range_mm:.2f}", "", ""))
    with open(folder / "grid-words.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("place", "word", "count", "phones"))
        writer.writerows(words)


def stored_figures(folder: Path = DEMO_FOLDER) -> TalkerFigures:
    """Read the figures that `write_figures` wrote."""
    medians: Mapping[str, PhoneMeasure]
    medians, counts, width_range_mm = {}, {}, 0.0
    with open(folder / "grid-figures.csv", encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            if row["phone"] == "width range":
                width_range_mm = float(row["width_mm"])
                continue
            medians[row["phone"]] = PhoneMeasure(*(float(row[name]) for name in PhoneMeasure._fields))
            counts[row["phone"]] = int(row["count"])
    return TalkerFigures(medians, counts, width_range_mm)
