"""The capture of a sentence, to lay beside its synthesis."""

from __future__ import annotations

import re

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio, audio_from_bytes
from core.motion.captured_sentence import CapturedSentence
from core.motion.database import MotionDatabase
from core.motion.head_space import in_head_space
from core.motion.recording import Recording
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion

_SAME_LENGTH_S = 0.02


def find_captured(database: MotionDatabase, text: str, duration_s: float) -> CapturedSentence | Recording | None:
    """Return the sentence in which ``text`` was said in ``duration_s``, or None if that was not captured.

    A sentence is known by its words and its length: one of the database's own, or the recording of one that was held
    out.
    """
    wanted = _words(text)

    def is_it(said: str, transcript: Transcript) -> bool:
        return abs(transcript.duration_s - duration_s) < _SAME_LENGTH_S and _words(said) == wanted

    for sentence in database.sentences:
        if is_it(sentence.text, sentence.transcript):
            return sentence
    for split, names in database.held_out.items():
        for recording in database.held_out_recordings(split) if names else ():
            if is_it(recording.text, recording.transcript):
                return recording
    return None


def own_motion(database: MotionDatabase, sentence: CapturedSentence) -> MarkerMotion:
    """Return the motion of one of the database's own sentences, through its principal components."""
    frames = database.frames[sentence.start_frame : sentence.stop_frame]
    positions = database.pca.positions(frames.astype(float)).astype(np.float32)
    return MarkerMotion(positions, database.rate_hz, database.markers)


def capture_of(database: MotionDatabase, text: str, duration_s: float) -> MarkerMotion | None:
    """Return how the actor moved in the sentence that `find_captured` finds, or None.

    The motion has the rate of the database, or the rate of the capture for a sentence that was held out.
    """
    found = find_captured(database, text, duration_s)
    if not isinstance(found, Recording):
        return None if found is None else own_motion(database, found)
    face = in_head_space(found, database.markers, database.with_scale).face
    return MarkerMotion(face.astype(np.float32), found.rate_hz, database.markers)


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
