"""From a corpus to a motion database (Deng and Neumann 2008, sections 3 and 4)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.captures import KeptCapture
from core.motion.corpus import Corpus
from core.motion.database import MotionDatabase, write_database
from core.motion.head_space import LONGEST_GAP_S
from core.motion.maps import make_maps
from core.motion.marker_set import MarkerSet
from core.motion.motion_part import MotionPart
from core.motion.pca import MotionPca
from core.motion.prepared import PreparedSentence, prepare
from core.motion.recording import Recording
from core.motion.rest_pose import choose_rest_pose
from core.progress import SILENT, Progress
from core.search.terms import default_weights


@dataclass(frozen=True)
class BuildSettings:
    """How a corpus is processed.

    rate_hz : frames a second of the database
    n_dims : PCA dimensions
    longest_gap_s : marker gaps up to this long are filled; frames of longer ones are masked out
    keep_captures : store the faces beside their coefficients, so that the components can be fitted anew to them when
        the database has grown; 12 bytes a marker and frame
    """

    rate_hz: float = 120.0
    n_dims: int = 25
    longest_gap_s: float = LONGEST_GAP_S
    keep_captures: bool = False


def build_database(
    corpus: Corpus,
    path: Path,
    settings: BuildSettings | None = None,
    progress: Progress = SILENT,
) -> MotionDatabase:
    """Build the motion database of ``corpus`` and store it at ``path``.

    Sentences that the corpus holds out lie in the file as they were captured, and take no part in rest pose, principal
    components, nodes, maps and weights. The file is written beside ``path`` and swapped in at the end, so that a cut
    leaves what was there before. What the corpus reports goes into the database's report. Raises `UserFacingError` when
    the corpus has no usable sentence or the target cannot be written.
    """
    settings = settings or BuildSettings()
    check_corpus(corpus)
    path = Path(path)
    apart = {name for names in corpus.held_out.values() for name in names}
    held_out = [r for r in corpus.recordings if r.sentence in apart]
    seen = replace(corpus, recordings=[r for r in corpus.recordings if r.sentence not in apart])
    markers = marker_set_of(seen)
    prepared = prepare_all(seen.recordings, markers, corpus.with_scale, settings, progress.part(0.0, 0.25))
    progress.step(0.25, "fitting principal components")
    pca = MotionPca.fit((p.face[~p.masked] for p in prepared), settings.n_dims)
    part, left_out = MotionPart.of_prepared(prepared, pca, settings.rate_hz)
    if len(part.nodes) == 0:
        raise UserFacingError(f"The corpus '{corpus.name}' has no phoneme with motion, so there is nothing to search.")
    report = {
        **corpus.report,
        "captured_rate_hz": seen.recordings[0].rate_hz,
        "longest_gap_s": settings.longest_gap_s,
        "pca_dims": settings.n_dims,
        "marker_samples_filled": sum(p.n_filled for p in prepared),
        "frames_masked": int(sum(p.masked.sum() for p in prepared)),
        "phones_left_out": left_out,
    }
    captures = {p.recording.sentence: KeptCapture(p.face, p.masked) for p in prepared if settings.keep_captures}
    prepared.clear()  # the faces are the largest thing here, and the maps want room
    database = MotionDatabase(
        name=corpus.name, synthetic=corpus.synthetic, rate_hz=settings.rate_hz, markers=markers, pca=pca,
        frames=part.frames, head_rotation=part.head_rotation, head_translation=part.head_translation,
        nodes=part.nodes, sentences=part.sentences,
        maps=make_maps(part.frames, part.nodes, progress.part(0.3, 0.95)),
        weights=default_weights(part.frames, part.nodes, settings.rate_hz).in_context,
        content_hash=part.content_hash(markers, pca), with_scale=corpus.with_scale, held_out=corpus.held_out,
        report=report,
    )  # fmt: skip
    progress.step(0.95, "writing the database")
    return _store(database, path, sounds(corpus.recordings), held_out, captures.items())


def prepare_all(
    recordings: Sequence[Recording], markers: MarkerSet, with_scale: bool, settings: BuildSettings, progress: Progress
) -> list[PreparedSentence]:
    """Bring all recordings into head space, at the rate of the database."""
    prepared = []
    for s, recording in enumerate(recordings):
        progress.step(s / len(recordings), f"normalising {recording.sentence}")
        prepared.append(prepare(recording, markers, with_scale, settings.rate_hz, settings.longest_gap_s))
    return prepared


def sounds(recordings: Iterable[Recording]) -> Iterable[tuple[str, bytes]]:
    """Yield name and FLAC file of each sentence that has sound."""
    from core.media.audio import encode_flac, load_audio

    for recording in recordings:
        if recording.audio is not None:
            yield recording.sentence, encode_flac(load_audio(recording.audio))


def check_corpus(corpus: Corpus, some_seen: bool = True) -> None:
    """Check names, markers and what is held out; raises `UserFacingError`.

    some_seen : not all sentences may be held out
    """
    if not corpus.recordings:
        raise UserFacingError(f"The corpus '{corpus.name}' has no sentence.")
    names = [r.sentence for r in corpus.recordings]
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise UserFacingError(f"The corpus '{corpus.name}' has two sentences named '{twice}'.")
    first = corpus.recordings[0]
    for recording in corpus.recordings:
        if recording.marker_names != first.marker_names:
            raise UserFacingError(
                f"Sentence '{recording.sentence}' of the corpus '{corpus.name}' has other markers than "
                f"'{first.sentence}'.",
                "All sentences of one database need the same markers in the same order.",
            )
    strangers = [name for held in corpus.held_out.values() for name in held if name not in names]
    if strangers:
        raise UserFacingError(f"The corpus '{corpus.name}' has no sentence '{strangers[0]}' to hold out.")
    if some_seen and len({name for held in corpus.held_out.values() for name in held}) == len(names):
        raise UserFacingError(f"All sentences of the corpus '{corpus.name}' are held out, so nothing is left to build.")
    missing = [name for name in corpus.kept_markers if name not in first.marker_names]
    if missing:
        raise UserFacingError(f"The captures of '{corpus.name}' have no marker '{missing[0]}', which the list keeps.")


def marker_set_of(corpus: Corpus) -> MarkerSet:
    """Return the marker set with its rest pose; raises `UserFacingError` when no frame shows all markers."""
    names = corpus.kept_markers
    columns = np.array([corpus.recordings[0].marker_names.index(name) for name in names])
    groups = {g: tuple(m for m in members if m in names) for g, members in corpus.groups.items()}
    landmarks = {anatomy: marker for anatomy, marker in corpus.landmarks.items() if marker in names}
    row = {name: k for k, name in enumerate(names)}
    rigid = np.array([row[m] for m in groups.get("rigid", ())], int)
    if len(rigid) < 3:
        rigid = np.arange(len(names))
    origins = groups.get("origin", ())
    origin = row[origins[0]] if origins else None
    if corpus.rest is not None:
        rest = np.asarray(corpus.rest, float)
        rest = rest - (rest[origin] if origin is not None else rest[rigid].mean(axis=0))
    else:
        try:
            rest = choose_rest_pose(corpus, columns, rigid, origin)
        except ValueError as error:
            raise UserFacingError(f"No frame of the corpus '{corpus.name}' shows all of its markers.") from error
    if corpus.outer_eye_mm is not None:
        corners = [row[landmarks[name]] for name in ("outer_eye_left", "outer_eye_right")]
        rest = rest * (corpus.outer_eye_mm / np.linalg.norm(rest[corners[0]] - rest[corners[1]]))
    return MarkerSet(names, rest, groups, landmarks)


def _store(
    database: MotionDatabase,
    path: Path,
    audio: Iterable[tuple[str, bytes]],
    held_out: Sequence[Recording],
    captures: Iterable[tuple[str, KeptCapture]],
) -> MotionDatabase:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(f"The folder '{path.parent}' cannot be made: {error.strerror}.") from error
    with swapped_in(path) as beside:
        write_database(database, beside, audio, held_out, captures)
    return replace(database, path=path)
