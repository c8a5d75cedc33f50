"""The question that every engine answers: speech in, marker motion out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from core.media.audio import Audio
from core.progress import SILENT, Progress
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion


@dataclass(frozen=True)
class SpeechInput:
    """What an engine animates.

    transcript : aligned phonemes
    modifiers : emotion spans (soft)
    pins : slot to public node name (hard); only the search knows them
    removed : public names of nodes that must not be used
    audio : the sound itself, for engines that listen to it
    holds : keep dragged and sung sounds at their middle (`core.animeme.dominance.held`); only animemes know how
    """

    transcript: Transcript
    modifiers: Sequence[EmotionModifier] = ()
    pins: Mapping[int, str] = field(default_factory=dict)
    removed: frozenset[str] = frozenset()
    audio: Audio | None = None
    holds: bool = False


class EngineAnswer(Protocol):
    """Motion, and whatever else an engine has to say about it; a search adds the ``path`` that it took."""

    @property
    def motion(self) -> MarkerMotion:
        """The motion, from time 0 to the end of the transcript."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know of it, a sentence each."""


class MotionEngine(Protocol):
    """The constrained search, dominated animemes, iFACE, and the plain rivals that they are measured against."""

    name: str

    def prepare(self, progress: Progress = SILENT) -> None:
        """Do what is needed once, before the first sentence; calling it is not required."""

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> EngineAnswer:
        """Animate ``speech``; raises `UserFacingError` for what it cannot animate."""
