"""What a choice of files and folders holds: which belong together, and what is missing."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError
from core.importing.plan import ImportPlan, MendLimits, SentencePlan
from core.motion.marker_table import MarkerTable, read_marker_table
from core.motion.motion_files import SUFFIXES as MOTION_SUFFIXES
from core.motion.readers.blendshape_files import take_name
from core.motion.readers.tracked_points import OUTER_EYE_MM, is_tracked_points_folder, read_tracked_points
from core.motion.recording import is_sentence_name
from core.progress import SILENT, Progress
from core.speech.emotion import emotion_named
from core.speech.text_file import read_text

SOUND_SUFFIXES = (".wav", ".flac", ".ogg")
TIMED_SUFFIXES = (".textgrid", ".lab")
_TEXT_SUFFIX = ".txt"
_WEIGHTS_SUFFIX = ".npy"
_TIMED_LINE = re.compile(r"\s*[0-9]+(\.[0-9]*)?[\s,;]+[0-9]+(\.[0-9]*)?[\s,;]+\S")
_TABLES = ("corpus.csv", "markers.csv")
_MOST_FILES = 100_000


@dataclass(frozen=True)
class FoundSentence:
    """Files of one sentence, found by the stem that their names share.

    emotion : read from the names of file and folder, or "neutral"; missing : ``motion``, ``audio``, ``transcript``
    """

    plan: SentencePlan
    missing: tuple[str, ...]


@dataclass(frozen=True)
class Survey:
    """What was found.

    sentences : those with motion, in the order of their corpus, else of their names
    motionless : sentences that have sound or a transcript, but no motion; they cannot be imported
    unused : files of no known kind, and second files of one kind
    table : the marker table (``markers.csv``), when one lies there
    with_scale : the motion is points tracked in video, without true scale
    """

    sentences: tuple[FoundSentence, ...]
    motionless: tuple[FoundSentence, ...]
    unused: tuple[str, ...]
    table: MarkerTable | None = None
    with_scale: bool = False

    def plan(self, name: str) -> ImportPlan:
        """Return the plan that imports all of it as it is, under the capture's own marker names."""
        plans = tuple(found.plan for found in self.sentences)
        if self.table is None:
            return ImportPlan(name, plans)
        origin = self.table.groups.get("origin", ())
        return ImportPlan(
            name, plans, {marker: marker for marker in self.table.kept}, origin[0] if origin else None,
            self.table.groups.get("rigid", ()), self.table.groups, self.table.landmarks, self.with_scale,
            OUTER_EYE_MM if self.with_scale else None, mending=MendLimits(faults=not self.with_scale),
        )  # fmt: skip


def survey(paths: Iterable[str | Path], progress: Progress = SILENT) -> Survey:
    """Look at files and folders (and the folders in them) and put together what is named alike.

    A folder of tracked points (``tracks.npz``) and one with a ``corpus.csv`` are taken as they describe themselves.
    Nothing but those tables and the first line of text files is read. Raises `UserFacingError` for a path that is not
    there, and for a choice without any motion or sound.
    """
    described: list[FoundSentence] = []
    files: list[Path] = []
    tables: list[MarkerTable] = []
    with_scale = False
    for path in map(Path, paths):
        if not path.exists():
            raise UserFacingError(f"There is no file or folder '{path}'.")
        path = path.parent if path.name in ("tracks.npz", "corpus.csv") else path
        if path.is_dir() and is_tracked_points_folder(path):
            described += _tracked(path, tables, progress)
            with_scale = True
        elif path.is_dir() and (path / "corpus.csv").is_file():
            described += _listed(path, tables)
        elif path.is_dir():
            files += _below(path)
        else:
            files.append(path)
    found, unused = _by_stem(files, tables)
    everything = [*described, *sorted(found, key=lambda s: s.plan.name)]
    with_motion = tuple(s for s in everything if "motion" not in s.missing)
    if not everything:
        raise UserFacingError("The chosen files hold neither motion nor sound.",
                              f"Motion is read from {', '.join(MOTION_SUFFIXES)}.")  # fmt: skip
    if with_scale and len(with_motion) != len([s for s in described if s.plan.take]):
        raise UserFacingError("Points tracked in video and other captures cannot share one database.",
                              "Import them one after the other, into two.")  # fmt: skip
    return Survey(with_motion, tuple(s for s in everything if "motion" in s.missing), tuple(unused),
                  tables[0] if tables else None, with_scale)  # fmt: skip


def _below(folder: Path) -> list[Path]:
    files = []
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.name.startswith("."):
            files.append(path)
        if len(files) > _MOST_FILES:
            raise UserFacingError(f"'{folder}' holds more than {_MOST_FILES} files.", "Choose a folder of captures.")
    return files


def _tracked(folder: Path, tables: list[MarkerTable], progress: Progress) -> list[FoundSentence]:
    corpus = read_tracked_points(folder, progress)
    tables.append(MarkerTable(corpus.kept_markers, dict(corpus.groups), dict(corpus.landmarks)))
    return [
        FoundSentence(SentencePlan(r.sentence, str(folder / "tracks.npz"), str(r.audio),
                                   str(folder / "textgrid" / f"{r.sentence}.TextGrid"), r.text, r.emotion, r.sentence),
                      ())
        for r in corpus.recordings
    ]  # fmt: skip


def _listed(folder: Path, tables: list[MarkerTable]) -> list[FoundSentence]:
    index = folder / "corpus.csv"
    if (folder / "markers.csv").is_file():
        tables.append(read_marker_table(folder / "markers.csv"))
    sentences = []
    beside = _below(folder)
    for row in csv.DictReader(io.StringIO(read_text(index, "list of sentences"))):
        name = (row.get("sentence") or "").strip()
        if not is_sentence_name(name):
            raise UserFacingError(f"'{index}': '{name}' cannot be the name of a sentence.")
        by_kind = kinds_of([p for p in beside if p.stem == name])
        for kind in ("motion", "audio", "transcript"):
            if row.get(kind):
                by_kind[kind] = folder / row[kind].strip()
        sentences.append(_found(name, by_kind, emotion_named(row.get("emotion") or "neutral"), row.get("text") or ""))
    return sentences


def kinds_of(files: Sequence[Path], unused: list[str] | None = None) -> dict[str, Path]:
    """Return the first file of each kind (motion, audio, transcript, text); ``unused`` gets the others."""
    by_kind: dict[str, Path] = {}
    for path in files:
        kind = _kind(path)
        if kind is None or kind in by_kind:
            if unused is not None:
                unused.append(str(path))
            continue
        by_kind[kind] = path
    return by_kind


def _kind(path: Path) -> str | None:
    suffix = path.suffix.lower()
    if path.name in _TABLES:
        return None
    if suffix in MOTION_SUFFIXES or (suffix == _WEIGHTS_SUFFIX and "name" not in path.stem):
        return "motion"
    if suffix in SOUND_SUFFIXES:
        return "audio"
    if suffix in TIMED_SUFFIXES:
        return "transcript"
    if suffix == _TEXT_SUFFIX:
        return "transcript" if _TIMED_LINE.match(_first_line(path)) else "text"
    return None


def _first_line(path: Path) -> str:
    try:
        return next((line for line in read_text(path, "text").split("\n") if line.strip()), "")
    except UserFacingError:
        return ""


def _by_stem(files: Sequence[Path], tables: list[MarkerTable]) -> tuple[list[FoundSentence], list[str]]:
    for path in files:
        if path.name == "markers.csv":
            tables.append(read_marker_table(path))
    unused: list[str] = []
    # of one capture exported twice, the binary file is the whole one
    order = {suffix: i for i, suffix in enumerate(MOTION_SUFFIXES)}
    files = sorted(files, key=lambda p: (order.get(p.suffix.lower(), 99), str(p)))
    stems: dict[str, list[Path]] = {}
    for path in files:
        stem = take_name(path)
        if _kind(path) is None:
            if path.name != "markers.csv":
                unused.append(str(path))
        else:
            stems.setdefault(stem, []).append(path)
    found = []
    for stem, members in stems.items():
        by_kind = kinds_of(members, unused)
        if not set(by_kind) & {"motion", "audio"}:
            unused += [str(path) for path in by_kind.values()]
            continue
        name = re.sub(r"[\x00-\x1f\x7f/\\]", "_", stem)[:100].strip(".") or "take"
        said = ""
        if "text" in by_kind:
            said = " ".join(read_text(by_kind["text"], "text").split())
        found.append(_found(name, by_kind, _emotion(members[0]), said))
    return found, unused


def _found(name: str, by_kind: dict[str, Path], emotion: str, text: str) -> FoundSentence:
    named = {kind: str(by_kind[kind]) if kind in by_kind else None for kind in ("motion", "audio", "transcript")}
    missing = tuple(kind for kind, path in named.items() if path is None and not (kind == "transcript" and text))
    plan = SentencePlan(name, named["motion"] or "", named["audio"], named["transcript"], text, emotion)
    return FoundSentence(plan, missing)


def _emotion(path: Path) -> str:
    """The emotion that the names of file and folder tell, the file's first."""
    for part in (path.stem, path.parent.name):
        for word in re.findall(r"[a-z]+", part.lower()):
            try:
                return emotion_named(word)
            except UserFacingError:
                continue
    return "neutral"
