"""What an import is told to do: plain data that the assistant fills in, a file keeps and the command line reads."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.marker_set import LANDMARKS
from core.motion.recording import is_sentence_name
from core.speech.emotion import EMOTIONS
from core.speech.text_file import read_text

_FORMAT = "efase-import-plan 1"
OFFSETS = ("keep", "session", "each")
_LONGEST_OFFSET_S = 10.0


@dataclass(frozen=True)
class MendLimits:
    """How far mending may go.

    longest_gap_s : longer gaps stay open, and their frames are masked
    faults : look for spikes and swaps at all; off for points of a face model fitted to video, which cannot swap
    least_spike_mm : a smaller excursion is left alone, whatever is usual in the take
    least_deviations : robust standard deviations above the usual at which a jump counts
    """

    longest_gap_s: float = 0.5
    faults: bool = True
    least_spike_mm: float = 1.0
    least_deviations: float = 6.0


@dataclass(frozen=True)
class SentencePlan:
    """One sentence and its files.

    name : of the sentence; motion nodes are called ``name:order``
    motion : the motion file; take : its name inside a file of several takes (``tracks.npz``), else ""
    audio : the sound file, or None
    transcript : a TextGrid or label file with phones and times, which is respected, or None
    text : what is said; aligned by force when there is no transcript, and recognised when it is empty too
    emotion : one of `core.speech.emotion.EMOTIONS`
    offset_s : seconds by which the motion is late against the sound; taken out
    """

    name: str
    motion: str
    audio: str | None = None
    transcript: str | None = None
    text: str = ""
    emotion: str = "neutral"
    take: str = ""
    offset_s: float = 0.0


@dataclass(frozen=True)
class Reading:
    """What the motion files do not say of themselves; what is said here wins over them.

    rate_hz, unit, picture_px : as in `core.motion.motion_track.ReadOptions`
    axes : which captured axis points to the actor's left, up and forward, such as ``("x", "z", "-y")``
    shape_names : file that names the weights of arrays of blendshapes; shape_sheet : file that maps such names to
        ARKit's; or None
    """

    rate_hz: float | None = None
    unit: str | None = None
    picture_px: tuple[int, int] | None = None
    axes: tuple[str, str, str] = ("x", "y", "z")
    shape_names: str | None = None
    shape_sheet: str | None = None


@dataclass(frozen=True)
class ImportPlan:
    """An import, whole: `core.importing.run.run_import` needs nothing else.

    name : of the database
    sentences : what is imported
    markers : captured name to name in the database, in the database's order; what is not named is left out. Empty:
        all markers of the first sentence under their own names
    origin : database name of the marker put at zero, or None (the centroid of the rigid ones)
    rigid : database names of the near-rigid markers; fewer than three: all
    groups, landmarks : as in `core.motion.marker_set.MarkerSet`; ``origin`` and ``rigid`` above stand for the groups
    with_scale, outer_eye_mm : as in `core.motion.corpus.Corpus`, for tracked video
    reading : what is said of the motion files
    mending : its limits
    offsets : ``keep`` (only the sentences' own ``offset_s``), ``session`` (also take out the one offset that was
        measured over all sentences), ``each`` (also take out each sentence's measured offset where it is sure)
    rate_hz, n_dims : of the database
    hold_out : "", or how sentences are held out to measure with (see `core.evaluation.split.hold_out`)
    lexicon : file of pronunciations, or None
    like : a database of the same actor and markers, whose poses help to fill the gaps of short takes, or None
    """

    name: str
    sentences: tuple[SentencePlan, ...]
    markers: Mapping[str, str] = field(default_factory=dict)
    origin: str | None = None
    rigid: tuple[str, ...] = ()
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    landmarks: Mapping[str, str] = field(default_factory=dict)
    with_scale: bool = False
    outer_eye_mm: float | None = None
    reading: Reading = field(default_factory=Reading)
    mending: MendLimits = field(default_factory=MendLimits)
    offsets: str = "keep"
    rate_hz: float = 120.0
    n_dims: int = 25
    hold_out: str = ""
    lexicon: str | None = None
    like: str | None = None

    def to_json(self) -> str:
        """Serialise for a file; `from_json` is the inverse."""
        return json.dumps({"format": _FORMAT, **asdict(self)}, indent=2, ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str, source: str = "the import plan") -> ImportPlan:
        """Inverse of `to_json`; raises `UserFacingError` naming ``source`` and the field that is wrong."""
        try:
            data = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise UserFacingError(f"{source} is not JSON.") from error
        if not isinstance(data, dict) or data.pop("format", None) != _FORMAT:
            raise UserFacingError(f"{source} is no import plan of this version.", f"Its 'format' is '{_FORMAT}'.")
        try:
            sentences = tuple(SentencePlan(**entry) for entry in data.pop("sentences"))
            mending = MendLimits(**data.pop("mending", {}))
            told = data.pop("reading", {})
            picture_px = told.pop("picture_px", None)
            axes = tuple(told.pop("axes", ("x", "y", "z")))
            reading = Reading(picture_px=None if picture_px is None else tuple(picture_px), axes=axes, **told)
            groups = {name: tuple(members) for name, members in data.pop("groups", {}).items()}
            rigid = tuple(data.pop("rigid", ()))
            plan = cls(sentences=sentences, mending=mending, reading=reading, groups=groups, rigid=rigid, **data)
            check_plan(plan)
        except UserFacingError as error:
            raise UserFacingError(f"{source}: {error.message}", error.remedy) from error
        except (KeyError, TypeError, AttributeError, ValueError) as error:
            raise UserFacingError(f"{source} has a field that cannot be used ({error}).") from error
        return plan


def check_plan(plan: ImportPlan) -> None:
    """Raise `UserFacingError` for a plan that cannot be carried out, whatever the files hold."""
    if not plan.sentences:
        raise UserFacingError("The import has no sentence.")
    names = [s.name for s in plan.sentences]
    for sentence in plan.sentences:
        _check_sentence(sentence)
        if names.count(sentence.name) > 1:
            raise UserFacingError(f"Two sentences of the import are named '{sentence.name}'.")
    kept = list(plan.markers.values())
    if len(set(kept)) != len(kept):
        twice = next(name for name in kept if kept.count(name) > 1)
        raise UserFacingError(f"Two captured markers are mapped to '{twice}'.")
    parts = {**plan.groups, "rigid": plan.rigid, "origin": () if plan.origin is None else (plan.origin,)}
    for part, members in {**parts, "landmarks": tuple(plan.landmarks.values())}.items():
        stranger = next((m for m in members if kept and m not in kept), None)
        if stranger is not None:
            raise UserFacingError(f"'{stranger}' in '{part}' of the import is no marker of the database.")
    unknown = set(plan.landmarks) - set(LANDMARKS)
    if unknown:
        raise UserFacingError(f"'{min(unknown)}' is no landmark.")
    if plan.offsets not in OFFSETS:
        raise UserFacingError(f"'{plan.offsets}' says nothing of offsets.", f"Choose one of {', '.join(OFFSETS)}.")
    if sorted(axis.lstrip("-") for axis in plan.reading.axes) != ["x", "y", "z"]:
        raise UserFacingError(f"The axes of the import are {', '.join(plan.reading.axes)}; name x, y and z once each.")
    if np.linalg.det(axes_matrix(plan.reading.axes)) < 0:
        raise UserFacingError(f"The axes {', '.join(plan.reading.axes)} would turn the face into its mirror image.")
    limits = plan.mending
    numbers = {"rate_hz": (plan.rate_hz, 10.0, 1000.0), "n_dims": (plan.n_dims, 1, 300),
               "longest_gap_s": (limits.longest_gap_s, 0.0, 5.0),
               "least_spike_mm": (limits.least_spike_mm, 0.0, 1000.0),
               "least_deviations": (limits.least_deviations, 0.0, 1e6),
               "outer_eye_mm": (90.0 if plan.outer_eye_mm is None else plan.outer_eye_mm, 10.0, 500.0)}  # fmt: skip
    for name, (value, least, most) in numbers.items():
        if not isinstance(value, (int, float)) or not math.isfinite(value) or not least <= value <= most:
            raise UserFacingError(f"{name} of the import is {value!r}; it lies between {least:g} and {most:g}.")


def axes_matrix(axes: Sequence[str]) -> np.ndarray:
    """Return the matrix that turns captured row vectors by its transpose: row i is the captured axis of ``axes[i]``."""
    return np.array([np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis[0] == "-" else 1.0) for axis in axes])


def _check_sentence(sentence: SentencePlan) -> None:
    if not isinstance(sentence.name, str) or not is_sentence_name(sentence.name):
        raise UserFacingError(f"'{sentence.name}' cannot be the name of a sentence.")
    if sentence.emotion not in EMOTIONS:
        raise UserFacingError(f"'{sentence.emotion}' of sentence '{sentence.name}' is not an emotion.",
                              f"Known are {', '.join(EMOTIONS)}.")  # fmt: skip
    texts = (sentence.motion, sentence.text, sentence.take, sentence.audio or "", sentence.transcript or "")
    if not all(isinstance(text, str) for text in texts) or not sentence.motion:
        raise UserFacingError(f"Sentence '{sentence.name}' of the import does not name its files by text.")
    if not isinstance(sentence.offset_s, (int, float)) or not abs(sentence.offset_s) <= _LONGEST_OFFSET_S:
        raise UserFacingError(f"The offset of sentence '{sentence.name}' is not within {_LONGEST_OFFSET_S:g} s.")


def read_plan(path: Path) -> ImportPlan:
    """Read a plan; files that it names without a folder of their own are looked for beside it.

    Raises `UserFacingError`.
    """
    plan = ImportPlan.from_json(read_text(path, "import plan"), f"'{path}'")
    return _with_paths(plan, lambda name: str(Path(path).parent / name))


def write_plan(plan: ImportPlan, path: Path) -> None:
    """Write a plan; what lies below the plan's folder is named from there, so that the two can travel together."""
    folder = Path(path).resolve().parent

    def named(name: str) -> str:
        whole = Path(name).resolve()
        return whole.relative_to(folder).as_posix() if whole.is_relative_to(folder) else str(whole)

    with swapped_in(path) as beside:
        beside.write_text(_with_paths(plan, named).to_json(), encoding="utf-8")


def _with_paths(plan: ImportPlan, change: Callable[[str], str]) -> ImportPlan:
    def changed(of, names: Sequence[str]):
        return replace(of, **{name: change(getattr(of, name)) for name in names if getattr(of, name) is not None})

    sentences = tuple(changed(sentence, ("motion", "audio", "transcript")) for sentence in plan.sentences)
    reading = changed(plan.reading, ("shape_names", "shape_sheet"))
    return changed(replace(plan, sentences=sentences, reading=reading), ("lexicon", "like"))
