"""The audio of a perception study: captured sentences, or sounds of one's own, and what was captured of their words."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from app.speech import load_speech
from app.texts import stimuli as texts
from core.errors import UserFacingError
from core.evaluation.stimuli import CAPTURED, FACES, SYNTHETIC
from core.media.audio import Audio
from core.motion.capture import captured_speech
from core.motion.captured_sentence import CapturedSentence
from core.motion.database import MotionDatabase
from core.speech.text_file import read_text
from core.speech.transcript import Transcript

_TRACKS = 3  # as in the paper


@dataclass(frozen=True)
class Track:
    """One audio of the study.

    takes : expression to the captured sentence of the same words, where there is one
    films : expression to a film of a real speaker who says them; empty: the takes are shown
    """

    name: str
    audio: Audio
    transcript: Transcript
    text: str
    takes: Mapping[str, CapturedSentence]
    films: Mapping[str, Path] = field(default_factory=dict)


def captured_tracks(names: Sequence[str], expressions: Sequence[str], database: MotionDatabase) -> list[Track]:
    """Take the sound of captured sentences, by name.

    Without names: of the first three whose words were captured neutrally and in all ``expressions``; their neutral
    take, as the paper's audio tells no emotion. Raises `UserFacingError` for a name that there is not, and where
    nothing was captured in all expressions.
    """
    by_words: dict[tuple[str, ...], list[CapturedSentence]] = {}
    for sentence in database.sentences:
        by_words.setdefault(words_of(sentence.text), []).append(sentence)
    if names:
        chosen = [database.sentence(name) for name in names]
    else:
        whole = [takes for takes in by_words.values() if {"neutral", *expressions} <= {t.emotion for t in takes}]
        chosen = [next(t for t in takes if t.emotion == "neutral") for takes in whole[:_TRACKS]]
    if not chosen:
        raise UserFacingError(
            f"No sentence of the database '{database.name}' was captured in {', '.join(expressions)} alike.",
            "Name sentences with --sentence, or give sounds of your own with --table.",
        )
    tracks = []
    for sentence in chosen:
        audio, transcript, text, _ = captured_speech(database, sentence.name)
        takes = {take.emotion: take for take in reversed(by_words[words_of(text)])}
        takes[sentence.emotion] = sentence
        tracks.append(Track(sentence.name, audio, transcript, text, takes))
    return tracks


def own_tracks(table: Path, database: MotionDatabase) -> list[Track]:
    """Read sounds and their texts from a table ``audio,text`` and perhaps ``phones``, files beside it.

    Raises `UserFacingError` that names the line.
    """
    try:
        reader = csv.DictReader(io.StringIO(read_text(table, "table of sounds")))
        rows = [(reader.line_num, {k: (v or "").strip() for k, v in row.items() if k}) for row in reader]
    except csv.Error as error:
        raise UserFacingError(f"'{table}' cannot be read as a table.") from error
    for column in ("audio", "text"):
        if column not in (reader.fieldnames or ()):
            raise UserFacingError(f"'{table}' has no column '{column}' in its header.")
    tracks = []
    for line, row in rows:
        if not row["audio"] or not row["text"]:
            raise UserFacingError(f"'{table}', line {line}: a sound and its text are needed.")
        try:
            if row.get("phones"):
                speech = load_speech(table.parent / row["audio"], phones=table.parent / row["phones"])
            else:
                speech = load_speech(table.parent / row["audio"], row["text"])
        except UserFacingError as error:
            raise UserFacingError(f"'{table}', line {line}: {error.message}", error.remedy) from error
        takes = {s.emotion: s for s in reversed(database.sentences) if words_of(s.text) == words_of(row["text"])}
        tracks.append(Track(Path(row["audio"]).stem, speech.audio, speech.transcript, row["text"], takes))
    return tracks


def faces_of(
    asked: Sequence[str], tracks: Sequence[Track], expressions: Sequence[str]
) -> tuple[tuple[str, ...], list[str]]:
    """Return the kinds of face to show, and sentences to warn with.

    asked : of `FACES`; empty: both where there are captures of all words in all expressions, else the synthetic one
    Raises `UserFacingError` for a kind that there is not, and for captures that are asked for and lacking.
    """
    for name in asked:
        if name not in FACES:
            raise UserFacingError(f"There is no face '{name[:40]}' in a study.", f"Choose among {', '.join(FACES)}.")
    lacking = [(t.name, e) for t in tracks for e in expressions if e not in (t.films or t.takes)]
    if lacking and CAPTURED in asked:
        track, expression = lacking[0]
        raise UserFacingError(f"The words of '{track}' were not captured in {expression}.",
                              "Leave the captured faces out, or choose other sentences.")  # fmt: skip
    if asked:
        return tuple(dict.fromkeys(asked)), []
    if lacking:
        return (SYNTHETIC,), [texts.NO_CAPTURES.format(track=lacking[0][0], expression=lacking[0][1])]
    return FACES, []


def words_of(text: str) -> tuple[str, ...]:
    """Return the words of a text, by which sentences are known to say the same."""
    return tuple(re.findall(r"[\w']+", text.lower()))
