"""Let engines animate sentences that they have not seen, and measure them beside the captures."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from core.errors import UserFacingError
from core.evaluation.comparison import CapturedTruth, Comparison, Scores, by_phoneme, scores
from core.evaluation.measures import Roughness, lightly_smoothed
from core.media.audio import Audio, audio_from_bytes, load_audio
from core.motion.database import MotionDatabase
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.speech.emotion import EMOTIONS, EmotionModifier
from core.synthesis.engine import MotionEngine, SpeechInput


@dataclass(frozen=True, eq=False)
class EngineResult:
    """One engine over all sentences.

    per_emotion : emotion to the scores of its sentences; per_phoneme : see `by_phoneme`
    joins : mean roughness at phone boundaries, at the database's rate
    """

    comparisons: tuple[Comparison, ...]
    scores: Scores
    per_emotion: Mapping[str, Scores]
    per_phoneme: Mapping[str, Mapping[str, float]]
    joins: Roughness | None

    @property
    def seconds_per_sentence(self) -> float:
        """Mean time of a synthesis, preparation not counted."""
        return float(np.mean([c.seconds for c in self.comparisons]))

    @classmethod
    def of(cls, comparisons: Sequence[Comparison]) -> EngineResult:
        """Measure what an engine made."""
        pairs = [(c.truth, c.synthesised) for c in comparisons]
        emotions = [truth.recording.emotion for truth, _ in pairs]
        per_emotion = {
            emotion: scores([pair for pair, spoken in zip(pairs, emotions) if spoken == emotion])
            for emotion in EMOTIONS
            if emotion in emotions
        }
        return cls(
            tuple(comparisons), scores(pairs), per_emotion, by_phoneme(pairs),
            mean_roughness(c.joins for c in comparisons),
        )  # fmt: skip

    def as_dict(self) -> dict[str, object]:
        """Return it for ``--json``."""
        return {
            **asdict(self.scores),
            "seconds_per_sentence": self.seconds_per_sentence,
            "joins": None if self.joins is None else self.joins._asdict(),
            "per_emotion": {emotion: asdict(found) for emotion, found in self.per_emotion.items()},
            "per_phoneme": {phone: dict(row) for phone, row in self.per_phoneme.items()},
        }


@dataclass(frozen=True, eq=False)
class Evaluation:
    """What was measured, on which sentences.

    floor : see `noise_floor`
    captured_joins : mean roughness of the captures at phone boundaries
    """

    sentences: tuple[str, ...]
    floor: Scores
    captured_joins: Roughness | None
    engines: Mapping[str, EngineResult]

    def as_dict(self) -> dict[str, object]:
        """Return it for ``--json``."""
        return {
            "sentences": len(self.sentences),
            "engines": {name: result.as_dict() for name, result in self.engines.items()},
            "floor": {
                **asdict(self.floor),
                "joins": None if self.captured_joins is None else self.captured_joins._asdict(),
            },
        }


def evaluate(
    database: MotionDatabase,
    recordings: Sequence[Recording],
    engines: Mapping[str, MotionEngine],
    progress: Progress = SILENT,
) -> Evaluation:
    """Let each engine animate each recording's speech, and compare.

    Each sentence is spoken in its own emotion from start to end. Preparing an engine is not counted as its time. Raises
    `UserFacingError` for a recording that lacks markers of the database, or that the database itself is built of.
    """
    if not recordings:
        raise UserFacingError("There are no sentences to evaluate on.")
    seen = {sentence.name for sentence in database.sentences}
    for recording in recordings:
        if recording.sentence in seen:
            raise UserFacingError(
                f"The database '{database.name}' is built of sentence '{recording.sentence}', so nothing can be "
                "measured on it.",
                "Build it with `efase build --hold-out`, or evaluate on sentences that it does not hold.",
            )
    truths = [CapturedTruth.of(recording, database) for recording in recordings]
    speech = [_speech(recording, database) for recording in recordings]
    results = {}
    for i, (name, engine) in enumerate(engines.items()):
        stage = progress.part(i / len(engines), (i + 1) / len(engines))
        engine.prepare(stage.part(0.0, 0.3))
        comparisons = []
        for s, (truth, said) in enumerate(zip(truths, speech)):
            stage.step(0.3 + 0.7 * s / len(truths), f"{name}: {truth.recording.sentence}")
            began = time.perf_counter()
            motion = engine.synthesise(said).motion
            comparisons.append(Comparison.of(truth, motion, time.perf_counter() - began))
        results[name] = EngineResult.of(comparisons)
    progress.step(1.0, "measured")
    return Evaluation(tuple(r.sentence for r in recordings), noise_floor(truths),
                      mean_roughness(truth.joins for truth in truths), results)  # fmt: skip


def noise_floor(truths: Sequence[CapturedTruth]) -> Scores:
    """Measure what noise the captures hold: errors and r of the lightly smoothed capture, variance ratios of the raw.

    No engine can be expected to come nearer, and an engine that copies captures copies their noise.
    """
    smoothed = scores([(truth, lightly_smoothed(truth.positions)) for truth in truths])
    raw = scores([(truth, truth.positions) for truth in truths])
    return replace(
        smoothed, gap_variance_ratio=raw.gap_variance_ratio, velocity_variance_ratio=raw.velocity_variance_ratio,
        acceleration_variance_ratio=raw.acceleration_variance_ratio,
    )  # fmt: skip


def _speech(recording: Recording, database: MotionDatabase) -> SpeechInput:
    transcript = recording.transcript
    emotion = EmotionModifier(0.0, transcript.duration_s, recording.emotion)
    return SpeechInput(transcript, [emotion], audio=_sound(recording, database))


def _sound(recording: Recording, database: MotionDatabase) -> Audio | None:
    if recording.audio is not None:
        return load_audio(recording.audio)
    flac = database.audio_bytes(recording.sentence)
    return None if flac is None else audio_from_bytes(flac, f"the sound of '{recording.sentence}'")


def mean_roughness(found: Iterable[Roughness | None]) -> Roughness | None:
    """Mean over the sentences that have boundaries to measure; None when none has."""
    known = [roughness for roughness in found if roughness is not None]
    return Roughness(*(float(np.mean(column)) for column in zip(*known))) if known else None
