"""A corpus folder: one row of ``corpus.csv`` a sentence, with its motion, sound and transcript files."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.audio import load_audio
from core.motion.corpus import Corpus
from core.motion.marker_table import MarkerTable, read_marker_table
from core.motion.motion_files import read_motion
from core.motion.readers.tracked_points import is_tracked_points_folder, read_tracked_points
from core.motion.recording import Recording, is_sentence_name
from core.progress import SILENT, Progress
from core.speech.emotion import emotion_named
from core.speech.text_file import read_text
from core.speech.transcript_files import read_transcript

_SUFFIXES = {
    "motion": (".c3d", ".trc", ".csv", ".tsv"),
    "audio": (".wav", ".flac", ".ogg"),
    "transcript": (".TextGrid", ".textgrid", ".lab", ".txt"),
}


def read_corpus(folder: Path, progress: Progress = SILENT) -> Corpus:
    """Read a corpus folder; one laid out as tracked points of video (``tracks.npz``) is read as it lies.

    ``corpus.csv`` has the columns sentence, emotion and, where a file is not named after its sentence, motion, audio,
    transcript (paths within the folder), and text. ``markers.csv`` (see `core.motion.marker_table`) is optional.
    Raises `UserFacingError` naming the file and line that is wrong.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise UserFacingError(f"There is no corpus folder at '{folder}'.")
    if is_tracked_points_folder(folder):
        return read_tracked_points(folder, progress)
    index = folder / "corpus.csv"
    if not index.is_file():
        raise UserFacingError(
            f"'{folder}' has no corpus.csv, so it is not a corpus folder.", "The layout is described in docs/corpus.md."
        )
    rows = _rows(index)
    recordings = []
    for number, (line, row) in enumerate(rows):
        progress.step(number / len(rows), f"reading {row['sentence']}")
        recordings.append(_recording(folder, index, line, row))
    table_path = folder / "markers.csv"
    names = recordings[0].marker_names
    table = read_marker_table(table_path) if table_path.is_file() else MarkerTable(names, {}, {})
    return Corpus(folder.resolve().name, recordings, table.kept, table.groups, table.landmarks)


def _rows(index: Path) -> list[tuple[int, dict[str, str]]]:
    try:
        reader = csv.DictReader(io.StringIO(read_text(index, "list of sentences")))
        rows = [(reader.line_num, {k: (v or "").strip() for k, v in row.items() if k}) for row in reader]
        columns = reader.fieldnames or ()
    except csv.Error as error:
        raise UserFacingError(f"'{index}' cannot be read as a table.") from error
    for column in ("sentence", "emotion"):
        if column not in columns:
            raise UserFacingError(f"'{index}' has no column '{column}' in its header.")
    if not rows:
        raise UserFacingError(f"'{index}' lists no sentence.")
    lines: dict[str, int] = {}
    for line, row in rows:
        if lines.setdefault(row["sentence"], line) != line:
            first = lines[row["sentence"]]
            raise UserFacingError(f"Line {line} of '{index}': '{row['sentence']}' is already named in line {first}.")
    return rows


def _recording(folder: Path, index: Path, line: int, row: dict[str, str]) -> Recording:
    sentence = row["sentence"]
    if not is_sentence_name(sentence):
        raise UserFacingError(f"Line {line} of '{index}': '{sentence}' cannot be the name of a sentence.")
    try:
        emotion = emotion_named(row["emotion"])
        files = {kind: _find(folder, sentence, kind, row.get(kind, "")) for kind in _SUFFIXES}
    except UserFacingError as error:
        raise UserFacingError(f"Line {line} of '{index}': {error.message}", error.remedy) from error
    except (OSError, RuntimeError) as error:  # a name too long for the system, links that run in a circle
        raise UserFacingError(f"Line {line} of '{index}': the system cannot look up a file that it names.") from error
    positions, names, rate_hz = read_motion(files["motion"])
    audio = load_audio(files["audio"])
    transcript = read_transcript(files["transcript"], audio.duration_s)
    return Recording(sentence, emotion, np.asarray(positions, np.float32), tuple(names), rate_hz, transcript,
                     row.get("text", ""), files["audio"])  # fmt: skip


def _find(folder: Path, sentence: str, kind: str, named: str) -> Path:
    if named:
        path = (folder / named).resolve()
        if not path.is_relative_to(folder.resolve()):
            raise UserFacingError(f"the {kind} file '{named}' lies outside the corpus folder.")
        if not path.is_file():
            raise UserFacingError(f"the {kind} file '{named}' is missing.")
        return path
    for suffix in _SUFFIXES[kind]:
        path = folder / f"{sentence}{suffix}"
        if path.is_file():
            return path
    raise UserFacingError(f"there is no {kind} file for '{sentence}' ({', '.join(_SUFFIXES[kind])}).")
