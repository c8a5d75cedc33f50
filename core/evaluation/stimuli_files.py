"""The files of a perception study: the key, the answer sheet, playlists; and answers read back."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError
from core.evaluation.stimuli import AUDIO, BIMODAL, NOT_SURE, SILENT, Stimulus, Trial
from core.speech.text_file import read_text

KEY_FILE, SHEET_FILE = "key.csv", "answers.csv"
KEY_COLUMNS = ("stimulus", "file", "kind", "audio", "text", "expression", "face")
SHEET_COLUMNS = ("participant", "group", "trial", "part", "stimulus", "answer")
_NOT_SURE = {NOT_SURE, "unsure", "not-sure", "notsure", "?"}
_MOST_ROWS = 1_000_000


@dataclass(frozen=True)
class Answer:
    """What a participant said of one stimulus: an expression's name, or `NOT_SURE`."""

    participant: str
    stimulus: Stimulus
    answer: str


@dataclass(frozen=True)
class Answers:
    """All answers of a study.

    given : in the order of the sheet; unanswered : how many trials have no answer
    expressions, tracks, faces : of the study, in the key's order
    texts : audio to what is said
    """

    given: tuple[Answer, ...]
    unanswered: int
    expressions: tuple[str, ...]
    tracks: tuple[str, ...]
    faces: tuple[str, ...]
    texts: Mapping[str, str]


def key_text(stimuli: Iterable[Stimulus], files: Mapping[str, str], texts: Mapping[str, str]) -> str:
    """Return the key as CSV: which code is what; ``files`` by code, ``texts`` by audio."""
    rows = [
        (s.code, files[s.code], s.kind, s.track, texts.get(s.track, ""), s.expression or "", s.face or "")
        for s in stimuli
    ]
    return _csv(KEY_COLUMNS, rows)


def sheet_text(trials: Iterable[Trial]) -> str:
    """Return the empty answer sheet as CSV, a row for each trial of each participant, in the order they are met."""
    return _csv(SHEET_COLUMNS, [(t.participant, t.group, t.trial, t.part, t.stimulus.code, "") for t in trials])


def playlist_text(trials: Iterable[Trial], files: Mapping[str, str]) -> str:
    """Return one participant's order as an M3U playlist, paths from the folder above it."""
    return "#EXTM3U\n" + "".join(f"../{files[t.stimulus.code]}\n" for t in trials)


def read_answers(sheet: Path, key: Path | None = None) -> Answers:
    """Read a filled answer sheet, and the key beside it (or ``key``); commas, semicolons or tabs between cells.

    Raises `UserFacingError` that names file and line: an unknown stimulus, an answer that is none of the study's
    expressions and not "not sure", a stimulus answered twice by one participant.
    """
    stimuli, texts = _read_key(sheet.with_name(KEY_FILE) if key is None else key)
    expressions = tuple(dict.fromkeys(s.expression for s in stimuli.values() if s.expression is not None))
    allowed = {name.lower(): name for name in expressions} | dict.fromkeys(_NOT_SURE, NOT_SURE)
    given, seen, unanswered = [], {}, 0
    for line, row in _rows(sheet, "answer sheet", ("participant", "stimulus", "answer")):
        place = f"'{sheet}', line {line}"
        code, who = row["stimulus"], row["participant"]
        if not who:
            raise UserFacingError(f"{place}: there is no participant.")
        if code not in stimuli:
            raise UserFacingError(f"{place}: the key knows no stimulus '{code[:40]}'.")
        if (who, code) in seen:
            raise UserFacingError(f"{place}: participant {who[:40]} has answered '{code}' in line {seen[who, code]}.")
        seen[who, code] = line
        said = " ".join(row["answer"].lower().split())
        if not said:
            unanswered += 1
        elif said not in allowed:
            raise UserFacingError(f"{place}: '{row['answer'][:40]}' is no answer of this study.",
                                  f"Answers are {', '.join([*expressions, NOT_SURE])}.")  # fmt: skip
        else:
            given.append(Answer(who, stimuli[code], allowed[said]))
    faces = tuple(dict.fromkeys(s.face for s in stimuli.values() if s.face is not None))
    return Answers(tuple(given), unanswered, expressions, tuple(texts), faces, texts)


def _read_key(path: Path) -> tuple[dict[str, Stimulus], dict[str, str]]:
    stimuli, texts = {}, {}
    for line, row in _rows(path, "key", KEY_COLUMNS):
        kind = row["kind"]
        if kind not in (SILENT, AUDIO, BIMODAL) or not row["stimulus"] or not row["audio"]:
            raise UserFacingError(f"'{path}', line {line}: this is no stimulus of a study.")
        if (kind == AUDIO) != (not row["expression"] and not row["face"]):
            raise UserFacingError(f"'{path}', line {line}: a face has an expression and a kind, sound alone neither.")
        if row["stimulus"] in stimuli:
            raise UserFacingError(f"'{path}', line {line}: the stimulus '{row['stimulus'][:40]}' is there twice.")
        stimuli[row["stimulus"]] = Stimulus(
            row["stimulus"], kind, row["audio"], row["expression"] or None, row["face"] or None
        )
        texts[row["audio"]] = row["text"]
    return stimuli, texts


def _rows(path: Path, what: str, columns: Sequence[str]) -> list[tuple[int, dict[str, str]]]:
    text = read_text(path, what)
    first = text.split("\n", 1)[0]
    separator = max(",;\t", key=first.count)
    try:
        reader = csv.DictReader(io.StringIO(text), delimiter=separator)
        header = [(name or "").strip().lower() for name in reader.fieldnames or ()]
        for column in columns:
            if column not in header:
                raise UserFacingError(f"'{path}' has no column '{column}' in its header.")
        reader.fieldnames = header
        rows = []
        for row in reader:
            cells = {name: (row.get(name) or "").strip() for name in columns}
            if any(cells.values()):
                rows.append((reader.line_num, cells))
            if len(rows) > _MOST_ROWS:
                raise UserFacingError(f"'{path}' is too long for the {what} of a study.")
    except csv.Error as error:
        raise UserFacingError(f"'{path}' cannot be read as a table.") from error
    if not rows:
        raise UserFacingError(f"'{path}' lists nothing.")
    return rows


def _csv(columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return written.getvalue()
