"""How far the aligner's boundaries lie from those that a corpus gives: words of GRID, phones of the demo corpus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path

import numpy as np

from core.actress.corpus import (
    SpokenSentence,
    comparison_sentences,
    database_sentences,
    demo_sentences,
    transcript_of,
    tuning_sentences,
)
from core.errors import UserFacingError
from core.evaluation.split import split_names
from core.media.audio import load_audio
from core.progress import SILENT, Progress
from core.speech.aligner import align
from core.speech.text_file import read_text
from core.speech.transcript import Transcript, WordUtterance
from core.speech.transcript_files import read_transcript

GRID_UNITS_PER_S = 25_000
_NO_WORD = ("sil", "sp")


@dataclass(frozen=True)
class BoundaryErrors:
    """Boundaries of one kind: the aligner's time less the corpus's, in seconds, shape (n,)."""

    kind: str
    errors_s: np.ndarray

    def figures(self) -> dict[str, object]:
        """Return {boundaries, n, median_ms, p90_ms, bias_ms, within_20ms, within_50ms}.

        Median, 90th percentile and shares are of the absolute error, the bias is the median of the signed one; all
        but ``n`` are None when there is no such boundary.
        """
        errors_ms = np.round(1000 * np.asarray(self.errors_s, float), 3)
        absolute_ms = np.abs(errors_ms)
        row: dict[str, object] = {"boundaries": self.kind, "n": len(errors_ms)}
        if not len(errors_ms):
            return row | dict.fromkeys(("median_ms", "p90_ms", "bias_ms", "within_20ms", "within_50ms"))
        return row | {
            "median_ms": float(np.median(absolute_ms)),
            "p90_ms": float(np.percentile(absolute_ms, 90)),
            "bias_ms": float(np.median(errors_ms)),
            "within_20ms": float(np.mean(absolute_ms <= 20)),
            "within_50ms": float(np.mean(absolute_ms <= 50)),
        }


def word_boundary_errors(aligned: Transcript, truth: Sequence[WordUtterance]) -> np.ndarray:
    """Return start and end errors of each word, seconds, shape (n_words, 2); both must say the same words."""
    if [word.word for word in aligned.words] != [word.word for word in truth]:
        raise ValueError("the two transcripts say different words")
    pairs = zip(aligned.words, truth)
    return np.array([(ours.start_s - true.start_s, ours.end_s - true.end_s) for ours, true in pairs]).reshape(-1, 2)


def phone_boundary_errors(aligned: Transcript, truth: Transcript) -> np.ndarray:
    """Return the error of each boundary between two phones that both transcripts have in a row, seconds, shape (n,).

    The two may disagree about phones (a dictionary's variant, a pause): such boundaries have no counterpart.
    """
    ours, true = aligned.phonemes, truth.phonemes
    matcher = SequenceMatcher(None, aligned.phones, truth.phones, autojunk=False)
    return np.array(
        [ours[a + i].end_s - true[b + i].end_s for a, b, size in matcher.get_matching_blocks() for i in range(size - 1)]
    )


def read_word_times(path: Path) -> list[WordUtterance]:
    """Read the words of one of GRID's own ``.align`` files (``start end word`` in 1/25000 s), silences left out.

    Raises `UserFacingError` naming the line that is none.
    """
    words = []
    for number, line in enumerate(read_text(path, "file of word times").splitlines(), start=1):
        columns = line.split()
        if len(columns) != 3 or not (columns[0].isdecimal() and columns[1].isdecimal()):
            raise UserFacingError(f"'{path}', line {number}: '{line[:40]}' is not 'start end word' in 1/25000 s.")
        if columns[2] not in _NO_WORD:
            words.append(
                WordUtterance(columns[2], int(columns[0]) / GRID_UNITS_PER_S, int(columns[1]) / GRID_UNITS_PER_S)
            )
    return words


def measure_grid(folder: Path, part: str, progress: Progress = SILENT) -> list[dict[str, object]]:
    """Align the clips of one part (``train``, ``tune``, ``test``) of a folder laid out like GRID; returns figures.

    The truth is ``align/*.align``. The set's TextGrids, made by another pocketsphinx alignment, are measured beside it
    where they exist; clips whose TextGrid has lost its first silence are also counted apart.
    Raises `UserFacingError` for files that are missing or broken.
    """
    names = [path.stem for path in (folder / "align").glob("*.align")]
    if not names:
        raise UserFacingError(f"'{folder}' has no word times in 'align/*.align'.")
    ours, theirs, cut = [], [], []
    clips = split_names(names)[part]
    for i, clip in enumerate(clips):
        progress.step(i / len(clips), clip)
        truth = read_word_times(folder / "align" / f"{clip}.align")
        audio = load_audio(folder / "audio" / f"{clip}.flac")
        ours.append(word_boundary_errors(align(audio, " ".join(word.word for word in truth)), truth))
        grid = folder / "textgrid" / f"{clip}.TextGrid"
        if grid.is_file():
            transcript = read_transcript(grid, audio.duration_s)
            if [word.word for word in transcript.words] != [word.word for word in truth]:
                raise UserFacingError(f"'{grid}' does not say the words of 'align/{clip}.align'.")
            theirs.append(word_boundary_errors(transcript, truth))
            cut += [ours[-1]] if transcript.words[0].start_s == 0 else []
    rows = {
        "word starts": [errors[:, 0] for errors in ours],
        "word ends": [errors[:, 1] for errors in ours],
        "starts of first words": [errors[:1, 0] for errors in ours],
        "starts of other words": [errors[1:, 0] for errors in ours],
        "word starts in clips whose TextGrid lacks its first silence": [errors[:, 0] for errors in cut],
        "word starts of the TextGrids": [errors[:, 0] for errors in theirs],
    }
    return [BoundaryErrors(kind, np.concatenate(errors or [np.zeros(0)])).figures() for kind, errors in rows.items()]


def measure_demo(part: str, progress: Progress = SILENT) -> list[dict[str, object]]:
    """Align the sentences of the demo corpus, whose synthetic voice Festival labelled; returns figures.

    part : ``train`` is the database's sentences, ``tune`` the tuning ones, ``test`` the demo and comparison ones
    """
    sentences = _demo_part(part)
    errors, n_boundaries, speaks = [], 0, {}
    for i, spoken in enumerate(sentences):
        progress.step(i / len(sentences), spoken.sentence)
        truth = transcript_of(spoken)
        errors.append(phone_boundary_errors(align(load_audio(spoken.audio), spoken.text), truth))
        speaks.setdefault(spoken.emotion, []).append(errors[-1])
        n_boundaries += len(truth.phonemes) - 1
    whole = BoundaryErrors("phone boundaries", np.concatenate(errors)).figures()
    rows = [whole | {"compared": whole["n"] / n_boundaries}]
    return rows + [
        BoundaryErrors(f"phone boundaries, {emotion}", np.concatenate(said)).figures()
        for emotion, said in speaks.items()
    ]


def _demo_part(part: str) -> list[SpokenSentence]:
    parts = {
        "train": database_sentences,
        "tune": tuning_sentences,
        "test": lambda: demo_sentences() + comparison_sentences(),
    }
    return parts[part]()
