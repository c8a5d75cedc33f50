"""What `efase stimuli` is told."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from app.export import VideoSettings
from core.evaluation.stimuli import PAPER
from core.face.characters import DEFAULT
from core.synthesis.registry import DEFAULT_ENGINE

PAPER_EXPRESSIONS = ("neutral", "happiness", "sadness")


@dataclass(frozen=True)
class StimuliJob:
    """Everything that `efase stimuli` was told.

    sentences : captured sentences whose sound is used, by name; empty: three that were captured in all expressions
    table : CSV ``audio,text`` and perhaps ``phones`` of sounds of one's own instead
    films : folder of films of a real speaker, ``AUDIO-EXPRESSION.mp4``, to be the captured faces; or None
    faces : of `core.evaluation.stimuli.FACES`; empty: both where there are captures of all, else the synthetic one
    film : suffix of the films
    """

    out: Path
    database: Path | None = None
    sentences: tuple[str, ...] = ()
    table: Path | None = None
    films: Path | None = None
    expressions: tuple[str, ...] = PAPER_EXPRESSIONS
    faces: tuple[str, ...] = ()
    engine: str = DEFAULT_ENGINE
    face: str = DEFAULT
    n_participants: int = 20
    seed: int = 2002
    design: str = PAPER
    video: VideoSettings = field(default_factory=VideoSettings)
    film: str = ".mp4"
