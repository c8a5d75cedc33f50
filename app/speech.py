"""Speech as a user gives it: a sound file, and what is said in it if she knows."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from pathlib import Path

from app.child_process import run_apart
from core.errors import UserFacingError
from core.media.audio import Audio, load_audio
from core.progress import SILENT, Progress
from core.speech import text_file
from core.speech.emotion import EmotionModifier, emotion_named
from core.speech.lexicon import Lexicon, read_lexicon
from core.speech.transcript import Transcript

# pocketsphinx holds Python's lock all the while it works: up to 0.2 s for alignment of sound this long, more than 1 s
# for recognition of any. Longer work goes to a process of its own, whose start takes half a second.
_LONGEST_ALIGNED_HERE_S = 6.0
_TEXT_FILES = (".txt", ".srt", ".vtt")
# How Word and OpenDocument files, RTF and PDF begin.
_DOCUMENTS = ("PK\x03\x04", "{\\rtf", "%PDF")
_DIED = "The process that listens to the speech ended before it was done."


@dataclass(frozen=True)
class LoadedSpeech:
    """Sound with its aligned transcript; ``recognised`` when nobody said what is said."""

    audio: Audio
    transcript: Transcript
    text: str
    recognised: bool


def load_speech(
    sound: Path | Audio,
    text: str | None = None,
    phones: Path | None = None,
    lexicon: Path | None = None,
    strict: bool = False,
    progress: Progress = SILENT,
    language: str | None = None,
    phone_table: str | Path | None = None,
) -> LoadedSpeech:
    """Load a sound file, unless the sound is at hand, and align it.

    text : what is said, or the path of a text file with it; aligned by force
    phones : a TextGrid, label or plain phone file instead; without either the speech is recognised first
    lexicon : pronunciations of names and coined words
    strict : refuse phones that are not in our set instead of taking the nearest
    language : what ``text`` is written in, as espeak-ng names it; English when None
    phone_table : what the names in ``phones`` stand for; see `core.speech.phone_table.read_phone_table`
    Raises `UserFacingError` naming the file that is wrong.
    """
    from core.speech.phone_table import read_phone_table
    from core.speech.transcript_files import read_transcript

    if text is not None and phones is not None:
        raise UserFacingError("A text and a phone file were given; one of them says what is spoken.")
    if phone_table is not None and phones is None:
        raise UserFacingError("A phone table was given, but no phones that it would tell of.")
    if language is not None and text is None:
        raise UserFacingError("Speech is recognised in English only.", "Give its text, or its phones in a TextGrid.")
    audio = sound if isinstance(sound, Audio) else load_audio(sound)
    if phones is not None:
        table, warnings = ({}, ()) if phone_table is None else read_phone_table(phone_table)
        transcript = read_transcript(phones, audio.duration_s, strict=strict, table=table)
        transcript = replace(transcript, warnings=(*warnings, *transcript.warnings))
        return LoadedSpeech(audio, transcript, " ".join(w.word for w in transcript.words), False)
    words = read_lexicon(lexicon) if lexicon is not None else None
    if text is not None:
        said = read_text(text)
        if language is not None:
            return LoadedSpeech(audio, _aligned_abroad(audio, said, language, words, progress), said, False)
        return LoadedSpeech(audio, _aligned(audio, said, words, progress), said, False)
    said, transcript = _recognised(audio, words, progress)
    return LoadedSpeech(audio, transcript, said, True)


def unheeded_speech(sound: Path) -> LoadedSpeech:
    """Load a sound whose words nobody asks for; its transcript is silent from start to end."""
    audio = load_audio(sound)
    return LoadedSpeech(audio, Transcript.covering([], [], audio.duration_s), "", False)


def _aligned(
    audio: Audio, text: str, lexicon: Lexicon | None, progress: Progress, words: list[str] | None = None
) -> Transcript:
    from core.speech.aligner import align

    if audio.duration_s <= _LONGEST_ALIGNED_HERE_S:
        return align(audio, text, lexicon, progress, words)
    return run_apart(functools.partial(align, words=words), (audio, text, lexicon), progress, _DIED)


def _aligned_abroad(audio: Audio, text: str, language: str, lexicon: Lexicon | None, progress: Progress) -> Transcript:
    from core.speech.foreign_text import espeak_pronunciations, foreign_words

    words = foreign_words(text)
    known = lexicon or {}
    pronounced, warnings = espeak_pronunciations([word for word in words if word.lower() not in known], language)
    transcript = _aligned(audio, text, {**pronounced, **known}, progress, words)
    return replace(transcript, warnings=(*warnings, *transcript.warnings))


def _recognised(audio: Audio, lexicon: Lexicon | None, progress: Progress) -> tuple[str, Transcript]:
    from core.speech.aligner import recognise

    return run_apart(recognise, (audio, lexicon), progress, _DIED)


def read_text(text: str) -> str:
    """Return ``text``, or what the file of that name holds."""
    path = Path(text)
    try:
        is_name = path.suffix.lower() in _TEXT_FILES or path.is_file()
    except (OSError, ValueError):  # a sentence can be too long for a file name
        is_name = False
    if not is_name:
        return text
    written = text_file.read_text(path, "text file")
    if "ooTextFile" in written[:200]:
        raise UserFacingError(f"'{path}' is a TextGrid, not a text.", "Give it as the phones.")
    if written.startswith(_DOCUMENTS):
        raise UserFacingError(f"'{path}' is a document, not plain text.", "Save it as plain text (.txt).")
    return written


def emotion_modifiers(emotion: str | None, file: Path | None, duration_s: float) -> list[EmotionModifier]:
    """Return the emotion spans that the options ask for; none is neutral."""
    from core.speech.emotion_files import read_emotions

    if file is not None:
        if emotion is not None:
            raise UserFacingError("An emotion and an emotion file were given; choose one of them.")
        return read_emotions(file)
    if emotion is None:
        return []
    return [EmotionModifier(0.0, duration_s, emotion_named(emotion), 1.0)]
