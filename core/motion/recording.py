"""One captured sentence as a studio delivers it, before anything was done to it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.speech.transcript import Transcript

# At home in a file name on every system, in a node's name `sentence:order`, and in the database.
_NAME = re.compile(r"(?!\.)[^\x00-\x1f\x7f/\\]{1,100}(?<!\.)")


def is_sentence_name(name: str) -> bool:
    """Whether a sentence can be called ``name``, whatever system its files travel to."""
    return _NAME.fullmatch(name) is not None


@dataclass(frozen=True)
class Recording:
    """Marker motion of one sentence with its sound and transcript.

    sentence : its name, unique in a corpus
    emotion : one of `core.speech.emotion.EMOTIONS`
    positions : float32, shape (n_frames, n_markers, 3), millimetres, any space; NaN where a marker is missing
    marker_names : one a marker
    rate_hz : frames a second
    transcript : phonemes on the same time axis (frame f is at f / rate_hz)
    text : what is said
    audio : the sound file, or None
    """

    sentence: str
    emotion: str
    positions: np.ndarray
    marker_names: tuple[str, ...]
    rate_hz: float
    transcript: Transcript
    text: str = ""
    audio: Path | None = None
