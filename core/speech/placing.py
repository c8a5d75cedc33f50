"""What is said in a take and when: as its transcript tells, by alignment of its text, or heard by recognition."""

from __future__ import annotations

from pathlib import Path

from core.media.audio import Audio
from core.progress import SILENT, Progress
from core.speech.transcript import Transcript

GIVEN, ALIGNED, RECOGNISED, SILENCE = "given", "aligned", "recognised", "silence"


def placed_speech(
    audio: Audio | None, duration_s: float, transcript: str | Path | None = None, text: str = "",
    lexicon: str | Path | None = None, progress: Progress = SILENT,
) -> tuple[Transcript, str, str]:  # fmt: skip
    """Return the transcript, its text, and which of `GIVEN`, `ALIGNED`, `RECOGNISED`, `SILENCE` it is.

    audio : None leaves a text without a place: all is taken as silence, and a warning of the transcript says so
    duration_s : of the sound, or of the motion where there is none
    transcript : a file with times; it goes before ``text``, and that before recognition
    lexicon : a file of the user's own pronunciations

    Raises `UserFacingError` for files that cannot be used or do not fit the sound.
    """
    from core.speech.aligner import align, recognise
    from core.speech.lexicon import read_lexicon
    from core.speech.transcript_files import read_transcript

    if transcript is not None:
        given = read_transcript(transcript, duration_s)
        return given, text or " ".join(w.word for w in given.words if w.word), GIVEN
    if audio is None:
        said = " ".join(text.split())
        notes = [f"There is no sound to place '{said[:60]}' in: taken as silence."] if said else []
        return Transcript.covering([], [], duration_s, notes), "", SILENCE
    words = None if lexicon is None else read_lexicon(Path(lexicon))
    if text.strip():
        return align(audio, text, words, progress), text, ALIGNED
    heard, recognised = recognise(audio, words, progress)
    return recognised, heard, RECOGNISED if heard else SILENCE
