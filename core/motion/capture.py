"""The capture of a sentence, to lay beside its synthesis."""

from __future__ import annotations

import re

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio, audio_from_bytes
from core.motion.database import MotionDatabase
from core.motion.head_space import in_head_space
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion

_SAME_LENGTH_S = 0.02


def capture_of(database: MotionDatabase, text: str, duration_s: float) -> MarkerMotion | None:
    """Return how the actor moved when she said ``text`` in ``duration_s``, or None if that was not captured.

    A sentence is known by its words and its length: one of the database's own, or one that was held out. The motion
    has the rate of the database, or the rate of the capture for a sentence that was held out.
    """
    wanted = _words(text)
    for sentence in database.sentences:
        if _words(sentence.text) == wanted and abs(sentence.transcript.duration_s - duration_s) < _SAME_LENGTH_S:
            frames = database.frames[sentence.start_frame : sentence.stop_frame]
            return MarkerMotion(
                database.pca.positions(frames.astype(float)).astype(np.float32), database.rate_hz, database.markers
            )
    for split, names in database.held_out.items():
        if not names:
            continue
        for recording in database.held_out_recordings(split):
            same_length = abs(recording.transcript.duration_s - duration_s) < _SAME_LENGTH_S
            if same_length and _words(recording.text) == wanted:
                face = in_head_space(recording, database.markers, database.with_scale).face
                return MarkerMotion(face.astype(np.float32), recording.rate_hz, database.markers)
    return None


def captured_names(database: MotionDatabase) -> dict[str, str]:
    """Return all sentences with a capture, name to what is said; those that were held out come first."""
    named = {}
    for split, names in database.held_out.items():
        if names:
            named |= {recording.sentence: recording.text for recording in database.held_out_recordings(split)}
    return named | {sentence.name: sentence.text for sentence in database.sentences}


def captured_speech(database: MotionDatabase, name: str) -> tuple[Audio, Transcript, str, str]:
    """Return (sound, transcript, text, emotion) of a captured sentence.

    Raises `UserFacingError` for an unknown one and for one without sound.
    """
    found = next((s for s in database.sentences if s.name == name), None)
    if found is None:
        for split, names in database.held_out.items():
            if name in names:
                found = next(r for r in database.held_out_recordings(split) if r.sentence == name)
    if found is None:
        raise UserFacingError(f"The database '{database.name}' has no sentence '{name}'.")
    flac = database.audio_bytes(name)
    if flac is None:
        raise UserFacingError(f"The database '{database.name}' keeps no sound of the sentence '{name}'.")
    return audio_from_bytes(flac, name), found.transcript, found.text, found.emotion


def _words(text: str) -> list[str]:
    return re.findall(r"[\w']+", text.lower())
