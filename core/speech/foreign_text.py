"""Texts in other languages: words, and how espeak-ng, where it is installed, says them.

espeak-ng (GPL) is run as a program of its own and never linked; without it transcripts come as phones with times.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import unicodedata

from core.errors import UserFacingError
from core.speech.lexicon import Lexicon
from core.speech.phone_names import phones_named
from core.speech.phoneme import PAU
from core.speech.script_marks import without_script_marks

PROGRAM = "espeak-ng"
_LANGUAGE = re.compile(r"[a-z]{2,3}(-[a-z0-9]{1,8}){0,3}", re.IGNORECASE)
# letters and marks of a word, digits (espeak-ng reads numbers, and pinyin has its tones in them), and inner apostrophes
_WORD = re.compile(r"[^\W_]+(?:['’\-][^\W_]+)*")
_SWITCH = re.compile(r"\([a-z0-9\-]+\)")
_TONAL = ("cmn", "yue", "hak")
_PATIENCE_S = 10.0
_LONGEST_WORD = 60


def foreign_words(text: str) -> list[str]:
    """Return the words of a text in any language; Chinese characters and kana are a word each."""
    text = unicodedata.normalize("NFC", without_script_marks(text)[0])
    words: list[str] = []
    for word in _WORD.findall(text):
        words += list(word) if any(_is_ideograph(letter) for letter in word) else [word]
    return words


def espeak_pronunciations(words: list[str], language: str) -> tuple[Lexicon, list[str]]:
    """Return how each word is said, in our phones, and a warning for each sound that has no exact counterpart.

    language : as espeak-ng names its voices: de, fr-fr, cmn-latn-pinyin
    Raises `UserFacingError` when espeak-ng is not installed, does not know the language, or cannot say a word.
    """
    if not _LANGUAGE.fullmatch(language):
        raise UserFacingError(
            f"'{language[:40]}' is not a language.", "Name it as espeak-ng does, such as de or fr-fr."
        )
    program = shutil.which(PROGRAM)
    if program is None:
        raise UserFacingError(
            f"Text in the language '{language}' is read by espeak-ng, which is not installed.",
            "Install it (Debian package espeak-ng), or give the phones with their times in a TextGrid.",
        )
    distinct = list(dict.fromkeys(words))
    sounds = {word: _sounds(program, word, language) for word in distinct}
    names = [sound for word in distinct for sound in sounds[word]]
    places = [f"The word '{word}'" for word in distinct for _ in sounds[word]]
    phones, warnings = phones_named(names, places)
    said, lexicon = iter(phones), {}
    for word in distinct:
        variant = tuple(phone for _, phone in zip(sounds[word], said) if phone != PAU)
        if not variant:
            raise UserFacingError(f"espeak-ng does not say the word '{word[:40]}' in '{language}'.")
        lexicon[word] = [variant]
    return lexicon, warnings


def _sounds(program: str, word: str, language: str) -> list[str]:
    """IPA symbols of one word, without stress, tones and boundaries."""
    command = [program, "-q", "--ipa", "--sep=_", "-b", "1", "-v", language, "--", word[:_LONGEST_WORD]]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_PATIENCE_S, check=False)
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        raise UserFacingError(f"espeak-ng did not answer for the word '{word[:40]}'.") from error
    if done.returncode:
        raise UserFacingError(
            f"espeak-ng knows no language '{language}'.", "`espeak-ng --voices` lists those it knows."
        )
    spoken = _SWITCH.sub(" ", done.stdout.decode("utf-8", errors="replace"))
    # espeak-ng takes the digit of the third tone for its letter for ɜ
    marks = r"[\d.ˈˌɜ]" if language.lower().startswith(_TONAL) else r"[\d.ˈˌ]"
    sounds = (re.sub(marks, "", sound) for sound in re.split(r"[_\s]+", spoken))
    return [sound for sound in sounds if sound]


def _is_ideograph(letter: str) -> bool:
    return unicodedata.name(letter, "").startswith(("CJK UNIFIED", "HIRAGANA", "KATAKANA"))
