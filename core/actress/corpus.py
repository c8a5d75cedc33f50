"""The synthetic demo corpus: what the actress says, and her recordings of it."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

from core.actress.capture import capture, head_motion, markers_of
from core.actress.expression import manners
from core.actress.performance import bundled_marker_units, frame_times_s, perform
from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.motion.marker_set import MarkerSet
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

RATE_HZ = 120.0
CORPUS_NAME = "synthetic actress"


class SpokenSentence(NamedTuple):
    """One bundled sentence: its name, emotion and text, its sound, and its phone and word labels (xwaves)."""

    sentence: str
    emotion: str
    text: str
    audio: Path
    phone_labels: Path
    word_labels: Path


def database_sentences() -> list[SpokenSentence]:
    """Return the sentences that the demo database is built of."""
    return _sentences("database")


def demo_sentences() -> list[SpokenSentence]:
    """Return the sentences to synthesise from, one an emotion; their texts are in no database sentence."""
    return _sentences("demo")


def transcript_of(spoken: SpokenSentence) -> Transcript:
    """Read the bundled labels of a sentence; its duration is that of the sound."""
    phonemes = [PhonemeUtterance(*label) for label in _labels(spoken.phone_labels)]
    words = [WordUtterance(*label) for label in _labels(spoken.word_labels) if label[0] != "pau"]
    return Transcript.covering(phonemes, words, phonemes[-1].end_s)


def actress_marker_set() -> MarkerSet:
    """Return the markers that are kept, with their rest pose, groups and landmarks."""
    units = bundled_marker_units()
    kept = [name for name, keep in zip(units.markers.names, units.kept) if keep]
    groups = {group: tuple(name for name in members if name in kept) for group, members in units.markers.groups.items()}
    landmarks = {landmark: name for landmark, name in units.markers.landmarks.items() if name in kept}
    return MarkerSet(tuple(kept), units.markers.rest[units.kept], groups, landmarks)


def kept_markers() -> tuple[str, ...]:
    """Return the names of the markers to keep of those that were captured (90 of 102, as in the paper)."""
    return actress_marker_set().names


def record(spoken: SpokenSentence, rate_hz: float = RATE_HZ) -> Recording:
    """Let the actress speak one sentence on the capture stage; all her markers, in stage space, with noise and gaps.

    The same sentence gives the same bytes every time.
    """
    units = bundled_marker_units()
    transcript = transcript_of(spoken)
    activations = perform(transcript, spoken.emotion, spoken.sentence, rate_hz)
    times_s = frame_times_s(transcript.duration_s, rate_hz)
    turns, shifts_mm = head_motion(transcript, manners()[spoken.emotion], times_s, Chance(f"{spoken.sentence} head"))
    positions = capture(markers_of(activations, units), turns, shifts_mm, Chance(f"{spoken.sentence} capture"))
    return Recording(
        spoken.sentence, spoken.emotion, positions, units.markers.names, rate_hz, transcript, spoken.text, spoken.audio
    )


def recordings(progress: Progress = SILENT) -> list[Recording]:
    """Return the whole corpus, 12 sentences in each of the four emotions, made anew in a few seconds."""
    sentences = database_sentences()
    made = []
    for i, spoken in enumerate(sentences):
        progress.step(i / len(sentences), f"the synthetic actress says {spoken.sentence}")
        made.append(record(spoken))
    progress.step(1.0, "the synthetic corpus is ready")
    return made


def _sentences(role: str) -> list[SpokenSentence]:
    with open(DEMO_FOLDER / "sentences.csv", encoding="utf-8", newline="") as lines:
        return [
            SpokenSentence(
                row["sentence"],
                row["emotion"],
                row["text"],
                DEMO_FOLDER / "audio" / f"{row['sentence']}.flac",
                DEMO_FOLDER / "labels" / f"{row['sentence']}.lab",
                DEMO_FOLDER / "words" / f"{row['sentence']}.lab",
            )
            for row in csv.DictReader(lines)
            if row["role"] == role
        ]


def _labels(path: Path) -> list[tuple[str, float, float]]:
    """Read a bundled xwaves file: (label, start_s, end_s), each label beginning where the one before ends."""
    labels, start_s = [], 0.0
    for line in path.read_text(encoding="utf-8").partition("#\n")[2].splitlines():
        end, _, name = line.split()
        labels.append((name, start_s, float(end)))
        start_s = float(end)
    return labels
