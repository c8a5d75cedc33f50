"""From speech, with or without its text, to phonemes on the time axis (pocketsphinx, American English)."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio
from core.progress import SILENT, Progress
from core.speech.loudness import FRAME_S, holds_no_speech, levels_db, loud_frames, stretches
from core.speech.phone_names import phones_named
from core.speech.pronunciation import Pronouncer, Pronunciation
from core.speech.script_marks import without_script_marks
from core.speech.sphinx import (
    SHORTEST_PHONE_S,
    SPHINX_RATE_HZ,
    HeardWord,
    SphinxAligner,
    SphinxRecogniser,
    SphinxSound,
)
from core.speech.spoken_words import spoken_words
from core.speech.stop_closure import with_short_closures
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

Lexicon = Mapping[str, Sequence[tuple[str, ...]]]

# Stretches for recognition: long enough for the language model and the level of the voice, short enough to be quick.
_SHORTEST_STRETCH_S, _LONGEST_STRETCH_S = 5.0, 15.0
# Pieces for phones: the aligner's memory grows with the square of the length (1.4 GB at 5 minutes).
_SHORTEST_PIECE_S, _LONGEST_PIECE_S = 8.0, 40.0
_SHORTEST_PAUSE_S = 0.1
# Sound as loud as speech, for this long inside a silence of the alignment, is speech that the text does not have.
_UNEXPLAINED_S = 0.8
# Mean mismatch (see `HeardWord`) at which a text is another one: over 20 GRID clips a wrong sentence had 47 or more,
# the right one 24 or less, and 46 or less below noise at 10 dB. A run of words above the second is worth a warning.
_WRONG_TEXT = 48.0
_DOUBTFUL_WORD = 45.0
_SHORTEST_DOUBT_S = 0.3
_MOST_WORDS_IN_MESSAGE = 6
_LONGEST_MARK = 40
_MOST_WARNINGS_OF_A_KIND = 3


def said_as(word: str) -> tuple[str, ...]:
    """Return the phones that an alignment without a lexicon would look for, in our names.

    Raises `UserFacingError` when it cannot be read as English.
    """
    variants = Pronouncer(SphinxAligner().dictionary).pronounce(word).variants
    return tuple(phones_named(variants[0], [word] * len(variants[0]))[0])


def align(
    audio: Audio, text: str, lexicon: Lexicon | None = None, progress: Progress = SILENT,
    words: Sequence[str] | None = None,
) -> Transcript:  # fmt: skip
    """Place ``text`` in ``audio``: words, and their phones from a dictionary, timed by forced alignment.

    lexicon : the user's own pronunciations (`core.speech.lexicon.read_lexicon`)
    words : the words that ``text`` is said in, where it is not English; ``lexicon`` has all of them

    The whole text is first placed word by word; then the phones, in pieces cut at pauses. Words that had to be
    guessed, marks of a script that nobody says, words that are hardly heard and loud sound that the text leaves out
    become warnings of the transcript.
    Raises `UserFacingError` when the text has no word, the sound no speech, or the two do not fit: it then says
    which words are not heard, and where.
    """
    words = spoken_words(text) if words is None else list(words)
    if not words:
        raise UserFacingError("The text has no word to speak.")
    sound = SphinxSound(audio)
    levels = levels_db(sound.samples, SPHINX_RATE_HZ)
    if holds_no_speech(levels):
        raise UserFacingError(f"{audio.name} is silent or a steady noise; there is no speech to place the text in.")
    aligner = SphinxAligner()
    pronouncer = Pronouncer(aligner.dictionary, lexicon)
    said = {word: pronouncer.pronounce(word) for word in dict.fromkeys(words)}
    said_in_order = [said[word] for word in words]
    shortest_s = SHORTEST_PHONE_S * sum(min(map(len, s.variants)) for s in said_in_order)
    if shortest_s > audio.duration_s:
        raise UserFacingError(
            f"The text does not fit {audio.name}: its {len(words)} words cannot be said in {audio.duration_s:.2f} s.",
            _REMEDY,
        )
    progress.step(0.05, "placing the words")
    for wide in (False, True):
        aligner = SphinxAligner(wide) if wide else aligner
        for i, pronunciation in enumerate(said_in_order):
            aligner.add_word(i, pronunciation.variants)
        if placed := aligner.place_words(sound, 0.0, sound.duration_s, range(len(words))):
            break
    else:
        raise UserFacingError(f"The text does not fit {audio.name}.", _REMEDY)
    placed = with_phones(aligner, sound, placed, said_in_order, progress.part(0.4, 1.0))
    _check_fit(placed, words, audio)
    warnings = [pronunciation.warning for pronunciation in said.values() if pronunciation.warning]
    warnings += _unspoken(text)
    warnings += _doubts(placed, words)[:_MOST_WARNINGS_OF_A_KIND]
    warnings += _left_out(levels, placed, audio)[:_MOST_WARNINGS_OF_A_KIND]
    return _transcript(placed, words, audio, warnings)


_REMEDY = "Correct the text, or leave it out to have the speech recognised."


def recognise(audio: Audio, lexicon: Lexicon | None = None, progress: Progress = SILENT) -> tuple[str, Transcript]:
    """Hear what is said in ``audio``: the text, and its words and phones over time.

    Works in stretches of 5 to 15 s that are cut at pauses. Silence and steady noise give an empty text and one
    ``pau``. The text is a machine's guess of American English; a warning says so.
    """
    sound = SphinxSound(audio)
    levels = levels_db(sound.samples, SPHINX_RATE_HZ)
    if holds_no_speech(levels):
        return "", Transcript.covering([], [], audio.duration_s, [f"No speech is heard in {audio.name}."])
    heard = _hear(sound, levels, progress.part(0.0, 0.9))
    words = [word.word for word in heard]
    aligner = SphinxAligner()
    pronouncer = Pronouncer(aligner.dictionary, lexicon)
    said = [pronouncer.pronounce(word) for word in words]
    for i, pronunciation in enumerate(said):
        aligner.add_word(i, pronunciation.variants)
    placed = [replace(word, index=i) for i, word in enumerate(heard)]
    placed = with_phones(aligner, sound, placed, said, progress.part(0.9, 1.0))
    text = " ".join(words)
    found = f"The text was recognised, not given: '{text}'." if text else f"No speech is heard in {audio.name}."
    return text, _transcript(placed, words, audio, [found])


def _hear(sound: SphinxSound, levels: np.ndarray, progress: Progress) -> list[HeardWord]:
    recogniser = SphinxRecogniser()
    heard: list[HeardWord] = []
    for start_s, end_s in stretches(levels, _SHORTEST_STRETCH_S, _LONGEST_STRETCH_S):
        progress.step(start_s / sound.duration_s, "listening")
        heard += recogniser.words(sound, start_s, min(end_s, sound.duration_s))
    return heard


def with_phones(
    aligner: SphinxAligner,
    sound: SphinxSound,
    placed: Sequence[HeardWord],
    said: Sequence[Pronunciation],
    progress: Progress,
) -> list[HeardWord]:
    """Time the phones of placed words; a piece that does not align keeps the words' times and phones spread evenly."""
    result: list[HeardWord] = []
    for start_s, end_s, piece in _pieces(placed, sound.duration_s):
        progress.step(start_s / sound.duration_s, "placing the phonemes")
        timed = aligner.place_phones(sound, start_s, end_s, [word.index for word in piece])
        if len(timed) < len(piece):
            timed = [replace(word, phones=_spread(word, said[word.index])) for word in piece]
        result += timed
    return with_short_closures(result)


def _pieces(placed: Sequence[HeardWord], duration_s: float) -> Iterator[tuple[float, float, Sequence[HeardWord]]]:
    """Cut between words: at the first pause after 8 s, or without one after 40 s at the longest gap."""
    start_s, first = 0.0, 0
    while first < len(placed):
        last = len(placed) - 1
        if placed[last].end_s - start_s > _LONGEST_PIECE_S:
            reach = [
                i
                for i in range(first, last)
                if i == first or _SHORTEST_PIECE_S <= placed[i].end_s - start_s <= _LONGEST_PIECE_S
            ]
            gaps = [placed[i + 1].start_s - placed[i].end_s for i in reach]
            pause = next((i for i, gap in zip(reach, gaps) if gap >= _SHORTEST_PAUSE_S and i > first), None)
            last = reach[int(np.argmax(gaps))] if pause is None else pause
        end_s = duration_s if last == len(placed) - 1 else (placed[last].end_s + placed[last + 1].start_s) / 2
        yield start_s, end_s, placed[first : last + 1]
        start_s, first = end_s, last + 1


def _spread(word: HeardWord, said: Pronunciation) -> tuple[tuple[str, float, float], ...]:
    phones = said.variants[0]
    edges = np.linspace(word.start_s, word.end_s, len(phones) + 1)
    return tuple((phone, float(a), float(b)) for phone, a, b in zip(phones, edges, edges[1:]))


def _transcript(placed: Sequence[HeardWord], words: Sequence[str], audio: Audio, warnings: Sequence[str]) -> Transcript:
    phonemes = [PhonemeUtterance(phone, a, b) for word in placed for phone, a, b in word.phones]
    said = [WordUtterance(words[word.index], word.start_s, word.end_s) for word in placed]
    return Transcript.covering(phonemes, said, audio.duration_s, warnings)


def _check_fit(placed: Sequence[HeardWord], words: Sequence[str], audio: Audio) -> None:
    spoken_s = sum(word.duration_s for word in placed)
    if spoken_s == 0:
        raise UserFacingError(f"The text does not fit {audio.name}: it leaves no time for a word.", _REMEDY)
    mismatch = sum(word.mismatch * word.duration_s for word in placed) / spoken_s
    if mismatch > _WRONG_TEXT:
        worst = max(_doubtful_runs(placed), key=lambda run: run[-1].end_s - run[0].start_s)
        raise UserFacingError(f"The text does not fit {audio.name}: {_quoted(worst, words)} is not heard.", _REMEDY)


def _unspoken(text: str) -> list[str]:
    _, marks = without_script_marks(text)
    more = ", ..." if len(marks) > _MOST_WORDS_IN_MESSAGE else ""
    quoted = ", ".join(f"'{mark[:_LONGEST_MARK]}'" for mark in marks[:_MOST_WORDS_IN_MESSAGE])
    return [f"Not taken as spoken: {quoted}{more}."] if marks else []


def _doubts(placed: Sequence[HeardWord], words: Sequence[str]) -> list[str]:
    return [
        f"{_quoted(run, words)} is hardly heard; does the text fit there?"
        for run in _doubtful_runs(placed)
        if sum(word.duration_s for word in run) >= _SHORTEST_DOUBT_S
    ]


def _doubtful_runs(placed: Sequence[HeardWord]) -> list[list[HeardWord]]:
    groups = itertools.groupby(placed, key=lambda word: word.mismatch > _DOUBTFUL_WORD)
    return [list(run) for is_doubtful, run in groups if is_doubtful]


def _quoted(run: Sequence[HeardWord], words: Sequence[str]) -> str:
    text = " ".join(words[word.index] for word in run[:_MOST_WORDS_IN_MESSAGE])
    more = " ..." if len(run) > _MOST_WORDS_IN_MESSAGE else ""
    return f"'{text}{more}' from {run[0].start_s:.2f} to {run[-1].end_s:.2f} s"


def _left_out(levels: np.ndarray, placed: Sequence[HeardWord], audio: Audio) -> list[str]:
    loud = loud_frames(levels)
    edges = [0.0, *(edge for word in placed for edge in (word.start_s, word.end_s)), audio.duration_s]
    return [
        f"From {start_s:.2f} to {end_s:.2f} s there is speech in {audio.name} that the text leaves out."
        for start_s, end_s in zip(edges[::2], edges[1::2])
        if FRAME_S * loud[round(start_s / FRAME_S) : round(end_s / FRAME_S)].sum() >= _UNEXPLAINED_S
    ]
