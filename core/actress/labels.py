"""Phone and word labels of the demo corpus in one table.

A row of ``labels.csv`` is a sentence; its labels follow each other from 0 s, each written ``name:end`` in seconds.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from core.speech.phoneme import PAU
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance


class SentenceLabels(NamedTuple):
    """What is said in a sentence, with the second at which each phone and word ends; silence is ``pau``."""

    phones: Sequence[tuple[str, float]]
    words: Sequence[tuple[str, float]]


def write_labels(path: Path, labels: Mapping[str, SentenceLabels]) -> None:
    """Write the table; sentence name to its labels."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("sentence", "phones", "words"))
        for sentence, of in labels.items():
            writer.writerow((sentence, *(" ".join(f"{name}:{end_s:.4f}" for name, end_s in row) for row in of)))


def read_transcripts(path: Path) -> dict[str, Transcript]:
    """Read the table; a sentence lasts as long as its labels."""
    transcripts = {}
    with open(path, encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            phonemes = [PhonemeUtterance(*label) for label in _spans(row["phones"])]
            words = [WordUtterance(*label) for label in _spans(row["words"]) if label[0] != PAU]
            transcripts[row["sentence"]] = Transcript.covering(phonemes, words, phonemes[-1].end_s)
    return transcripts


def _spans(labels: str) -> list[tuple[str, float, float]]:
    spans, start_s = [], 0.0
    for label in labels.split():
        name, _, end = label.rpartition(":")
        spans.append((name, start_s, float(end)))
        start_s = float(end)
    return spans
