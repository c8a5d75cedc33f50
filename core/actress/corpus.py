"""The synthetic demo corpus: what the actress says, and her recordings of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from core.actress.capture import capture, head_motion, markers_of
from core.actress.expression import manners
from core.actress.faults import PlantedFault, contaminate, plant
from core.actress.labels import read_transcripts
from core.actress.performance import bundled_marker_units, frame_times_s, gaze, perform
from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER, bundled_lines
from core.motion.marker_set import MarkerSet
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.speech.transcript import Transcript

RATE_HZ = 120.0
CORPUS_NAME = "synthetic actress"


class SpokenSentence(NamedTuple):
    """One bundled sentence: its name, emotion and text, and its sound.

    phone_labels : the phones as a file of an aligner (xwaves); demo sentences only, else None
    """

    sentence: str
    emotion: str
    text: str
    audio: Path
    phone_labels: Path | None


def database_sentences() -> list[SpokenSentence]:
    """Return the sentences that the demo database is built of."""
    return _sentences("database")


def demo_sentences() -> list[SpokenSentence]:
    """Return the sentences to synthesise from, one an emotion; their texts are in no database sentence."""
    return _sentences("demo")


def tuning_sentences() -> list[SpokenSentence]:
    """Return six sentences an emotion to tune the search with; their texts are in no database sentence."""
    return _sentences("tuning")


def comparison_sentences() -> list[SpokenSentence]:
    """Return three sentences an emotion to compare methods on; their texts are in no other sentence."""
    return _sentences("comparison")


def transcript_of(spoken: SpokenSentence) -> Transcript:
    """Return what a bundled sentence says and when; its duration is that of the sound."""
    return _bundled_transcripts()[spoken.sentence]


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


@dataclass(frozen=True)
class Performance:
    """All that the actress does in one sentence, before any marker is seen.

    activations : float64, shape (n_frames, n_units), 0..1, columns as ``bundled_marker_units().names``
    gaze_deg : float64, shape (n_frames, 2), of the eyes in the head: yaw (her left), pitch (up)
    head_rotation, head_shift_mm : of the head on the stage, see `core.actress.capture.head_motion`
    """

    transcript: Transcript
    activations: np.ndarray
    gaze_deg: np.ndarray
    head_rotation: np.ndarray
    head_shift_mm: np.ndarray


def perform_details(spoken: SpokenSentence, rate_hz: float = RATE_HZ) -> Performance:
    """Let the actress speak one sentence; the tracks that markers do not show are only here."""
    transcript = transcript_of(spoken)
    times_s = frame_times_s(transcript.duration_s, rate_hz)
    turns, shifts_mm = head_motion(transcript, manners()[spoken.emotion], times_s, Chance(f"{spoken.sentence} head"))
    return Performance(
        transcript,
        perform(transcript, spoken.emotion, spoken.sentence, rate_hz),
        gaze(transcript, spoken.emotion, spoken.sentence, rate_hz),
        turns,
        shifts_mm,
    )


@cache
def planted_faults() -> tuple[PlantedFault, ...]:
    """Return which motion nodes of the database's recordings are contaminated on purpose, and how.

    This list is for measuring detectors; no recording and no database holds it.
    """
    transcripts = {spoken.sentence: transcript_of(spoken) for spoken in database_sentences()}
    return plant(transcripts, actress_marker_set())


def record(spoken: SpokenSentence, rate_hz: float = RATE_HZ) -> Recording:
    """Let the actress speak one sentence on the capture stage; all her markers, in stage space, as a studio gets them:

    with noise, gaps and the faults of `planted_faults`.

    The same sentence gives the same bytes every time.
    """
    units = bundled_marker_units()
    names = units.markers.names
    done = perform_details(spoken, rate_hz)
    face = markers_of(done.activations, units)
    chance = Chance(f"{spoken.sentence} capture")
    positions = capture(face, done.head_rotation, done.head_shift_mm, chance)
    faults = [fault for fault in planted_faults() if fault.sentence == spoken.sentence]
    positions = contaminate(positions, names, rate_hz, faults)
    return Recording(
        spoken.sentence, spoken.emotion, positions, names, rate_hz, done.transcript, spoken.text, spoken.audio
    )


def recordings(progress: Progress = SILENT) -> list[Recording]:
    """Return the whole database corpus, 45 sentences in each of the four emotions, made anew in a few seconds."""
    sentences = database_sentences()
    made = []
    for i, spoken in enumerate(sentences):
        progress.step(i / len(sentences), f"the synthetic actress says {spoken.sentence}")
        made.append(record(spoken))
    progress.step(1.0, "the synthetic corpus is ready")
    return made


@cache
def _bundled_transcripts() -> dict[str, Transcript]:
    return read_transcripts(DEMO_FOLDER / "labels.csv")


def _sentences(role: str) -> list[SpokenSentence]:
    return [
        SpokenSentence(
            line.sentence,
            line.emotion,
            line.text,
            DEMO_FOLDER / "audio" / f"{line.sentence}.ogg",
            DEMO_FOLDER / "labels" / f"{line.sentence}.lab" if role == "demo" else None,
        )
        for line in bundled_lines()
        if line.role == role
    ]
