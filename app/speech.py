"""Speech as a user gives it: a sound file, and what is said in it if she knows."""

from __future__ import annotations

from dataclasses import dataclass
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
) -> LoadedSpeech:
    """Load a sound file, unless the sound is at hand, and align it.

    text : what is said, or the path of a text file with it; aligned by force
    phones : a TextGrid, label or plain phone file instead; without either the speech is recognised first
    lexicon : pronunciations of names and coined words
    strict : refuse phones that are not in our set instead of taking the nearest
    Raises `UserFacingError` naming the file that is wrong.
    """
    from core.speech.transcript_files import read_transcript

    if text is not None and phones is not None:
        raise UserFacingError("A text and a phone file were given; one of them says what is spoken.")
    audio = sound if isinstance(sound, Audio) else load_audio(sound)
    if phones is not None:
        transcript = read_transcript(phones, audio.duration_s, strict=strict)
        return LoadedSpeech(audio, transcript, " ".join(w.word for w in transcript.words), False)
    words = read_lexicon(lexicon) if lexicon is not None else None
    if text is not None:
        said = read_text(text)
        return LoadedSpeech(audio, _aligned(audio, said, words, progress), said, False)
    said, transcript = _recognised(audio, words, progress)
    return LoadedSpeech(audio, transcript, said, True)


def _aligned(audio: Audio, text: str, lexicon: Lexicon | None, progress: Progress) -> Transcript:
    from core.speech.aligner import align

    if audio.duration_s <= _LONGEST_ALIGNED_HERE_S:
        return align(audio, text, lexicon, progress)
    return run_apart(align, (audio, text, lexicon), progress, _DIED)


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
