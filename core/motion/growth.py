"""A database that grows and shrinks: sentences added, removed, merged in, and only what changed is computed.

Public names of motion nodes survive, and with them pins and the curation list, which lies beside the database and is
not touched. Every change is written beside the database and swapped in: a cut leaves the old one whole.
"""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.manifold.isomap import PhonemeMap
from core.media.swap_in import swapped_in
from core.motion.build import BuildSettings, check_corpus, prepare_all, sounds
from core.motion.corpus import Corpus
from core.motion.curation import CurationList
from core.motion.database import MotionDatabase, open_database, write_database
from core.motion.database_lock import DatabaseLock
from core.motion.grown_faces import GrownFaces
from core.motion.growth_record import ADDED, NODES_DROPPED, REFITTED, REMOVED, with_step
from core.motion.head_space import LONGEST_GAP_S
from core.motion.maps import grown_maps
from core.motion.motion_part import MotionPart, packed
from core.motion.newcomers import (
    NOBODY,
    Newcomers,
    counts_of,
    held_out_recordings,
    newcomers_of_database,
    seen_by,
    stored_sounds,
)
from core.motion.pca import MotionPca
from core.progress import SILENT, Progress
from core.search.terms import default_weights


@dataclass(frozen=True)
class GrowthSettings:
    """What is computed anew beyond what must be.

    refit : fit the principal components anew to all sentences. Sentences whose captures were kept
        (`BuildSettings.keep_captures`) are fitted as they were captured, others as the database still shows them
    remake_maps : map every cluster anew that got or lost frames, now or since its map was made, instead of placing new
        frames on the old map
    """

    refit: bool = False
    remake_maps: bool = False


@dataclass(frozen=True)
class GrowthReport:
    """What a change did; ``database`` is the database as it is now.

    added, removed : sentences; nodes_dropped : motion nodes that were taken out for good
    coverage : share of the new frames' variance about the database's mean that its components carry; None without any
    residual_mm : what they miss, root mean square over markers and frames
    maps_kept, maps_grown, maps_made : clusters whose map stayed (but for frames that went), got frames, is new
    """

    database: MotionDatabase
    content_before: str
    added: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    nodes_dropped: tuple[str, ...] = ()
    refitted: bool = False
    coverage: float | None = None
    residual_mm: float | None = None
    maps_kept: tuple[str, ...] = ()
    maps_grown: tuple[str, ...] = ()
    maps_made: tuple[str, ...] = ()
    seconds: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return it for ``--json``."""
        database = self.database
        lists = ("added", "removed", "nodes_dropped", "maps_kept", "maps_grown", "maps_made")
        return {
            "path": str(database.path), "content_before": self.content_before, "content_hash": database.content_hash,
            "sentences": len(database.sentences), "nodes": len(database.nodes), "frames": len(database.frames),
            **{name: list(getattr(self, name)) for name in lists}, "refitted": self.refitted,
            "coverage": self.coverage, "residual_mm": self.residual_mm, "pca_coverage": database.pca.coverage,
            "seconds": round(self.seconds, 2),
        }  # fmt: skip


def add_corpus(
    path: Path, corpus: Corpus, settings: GrowthSettings | None = None, progress: Progress = SILENT
) -> GrowthReport:
    """Add the sentences of ``corpus`` to the database at ``path``, in the head space of its rest pose.

    Raises `UserFacingError` when a name is taken, the markers or scales are others, no phoneme is added, the database
    is open for writing elsewhere, or it cannot be written.
    """
    with DatabaseLock(Path(path)):
        database = open_database(path)
        check_corpus(corpus, some_seen=False)
        if corpus.with_scale != database.with_scale:
            raise UserFacingError(
                f"The corpus '{corpus.name}' and the database '{database.name}' are not both of true scale."
            )
        with database.open_file() as file:
            newcomers = _newcomers_of_corpus(corpus, database, progress.part(0.0, 0.3))
            return _changed(database, file, path, newcomers, settings, about=corpus.report,
                            progress=progress.part(0.3, 1.0))  # fmt: skip


def add_database(
    path: Path, other: Path, settings: GrowthSettings | None = None, prefix: str = "", progress: Progress = SILENT
) -> GrowthReport:
    """Add all sentences of another database of the same actor to the one at ``path``; see `merge`."""
    with DatabaseLock(Path(path)):
        return _merged(open_database(path), open_database(other), Path(path), settings, prefix, progress)


def merge(
    path: Path, other: Path, target: Path, settings: GrowthSettings | None = None, prefix: str = "",
    progress: Progress = SILENT,
) -> GrowthReport:  # fmt: skip
    """Write a database with the sentences of two at ``target``; its maps are those of the first, grown.

    The two need the same markers and rate. Where their rest poses differ, the second's sentences are brought into the
    head space of the first's. Curation lists are joined beside ``target``. Raises `UserFacingError` when the two are
    not of one actor, a sentence name is in both, or ``target`` cannot be written.

    prefix : put before each sentence name of ``other``
    """
    path, other, target = Path(path), Path(other), Path(target)
    if target.resolve() in (path.resolve(), other.resolve()):
        raise UserFacingError(
            f"'{target}' is one of the two databases to be merged.", "Write to another file, or add one to the other."
        )
    with DatabaseLock(target):
        first, second = open_database(path), open_database(other)
        lists = [(CurationList.of(first).read(), ""), (CurationList.of(second).read(), prefix)]
        report = _merged(first, second, target, settings, prefix, progress)
        removals = {before + node: removal for removed, before in lists for node, removal in removed.items()}
        if removals:
            CurationList.of(report.database).change(removals)
        return report


def remove_sentences(
    path: Path, names: Sequence[str], settings: GrowthSettings | None = None, progress: Progress = SILENT
) -> GrowthReport:
    """Take sentences out of the database at ``path``, those among them too that it holds out.

    Raises `UserFacingError` for an unknown one, when none would be left, and as `add_corpus` does.
    """
    with DatabaseLock(Path(path)):
        database = open_database(path)
        known = {s.name for s in database.sentences}.union(*database.held_out.values())
        strangers = [name for name in names if name not in known]
        if strangers:
            raise UserFacingError(f"The database '{database.name}' has no sentence '{strangers[0]}'.")
        with database.open_file() as file:
            return _changed(database, file, path, settings=settings, removed=tuple(dict.fromkeys(names)),
                            progress=progress)  # fmt: skip


def compact(
    path: Path, drop_removed: bool = False, drop_captures: bool = False, progress: Progress = SILENT
) -> GrowthReport:
    """Write the database at ``path`` anew without what is not used.

    drop_removed : take the motion nodes that its curation list removes out for good, and sentences that have none left;
        the frames of other sentences stay, for silences are made from them
    drop_captures : forget the captures that `BuildSettings.keep_captures` kept
    """
    with DatabaseLock(Path(path)):
        database = open_database(path)
        dropped: tuple[str, ...] = ()
        if drop_removed:
            removed = CurationList.of(database).read()
            dropped = tuple(name for n in range(len(database.nodes)) if (name := database.nodes.name(n)) in removed)
        rows = np.array([database.nodes.row(name) for name in dropped], int)
        left = np.bincount(np.delete(database.nodes.sentence, rows), minlength=len(database.sentences))
        had = np.bincount(database.nodes.sentence, minlength=len(database.sentences))
        emptied = tuple(s.name for s, a, b in zip(database.sentences, left, had) if a == 0 and b)
        with database.open_file() as file:
            return _changed(database, file, path, removed=emptied, dropped=dropped,
                            with_captures=not drop_captures, progress=progress)  # fmt: skip


def _newcomers_of_corpus(corpus: Corpus, database: MotionDatabase, progress: Progress) -> Newcomers:
    apart = {name for names in corpus.held_out.values() for name in names}
    seen = [r for r in corpus.recordings if r.sentence not in apart]
    gap_s = database.report.get("longest_gap_s")
    gap_s = gap_s if isinstance(gap_s, float) and 0.0 <= gap_s < 10.0 else LONGEST_GAP_S
    settings = BuildSettings(rate_hz=database.rate_hz, longest_gap_s=gap_s)
    prepared = prepare_all(seen, database.markers, database.with_scale, settings, progress)
    return replace(
        Newcomers.of_prepared(prepared, database),
        audio=sounds(corpus.recordings),
        held_out=corpus.held_out,
        apart=[seen_by(database.markers, r) for r in corpus.recordings if r.sentence in apart],
        synthetic=corpus.synthetic,
    )


def _merged(
    database: MotionDatabase, other: MotionDatabase, target: Path, settings: GrowthSettings | None, prefix: str,
    progress: Progress,
) -> GrowthReport:  # fmt: skip
    with database.open_file() as file, other.open_file() as theirs:
        newcomers = newcomers_of_database(database, other, theirs, prefix)
        return _changed(database, file, target, newcomers, settings, progress=progress)


def _changed(
    database: MotionDatabase,
    file,
    target: Path,
    newcomers: Newcomers = NOBODY,
    settings: GrowthSettings | None = None,
    removed: tuple[str, ...] = (),
    dropped: tuple[str, ...] = (),
    with_captures: bool = True,
    about: Mapping[str, object] | None = None,
    progress: Progress = SILENT,
) -> GrowthReport:
    """Change ``database``, whose open HDF5 file is ``file``, and store it at ``target``."""
    began = time.perf_counter()
    settings, target = settings or GrowthSettings(), Path(target)
    as_it_was = Path(database.path).stat()
    _check_names(database, newcomers)
    part = MotionPart.of_database(database).without(removed, np.array([database.nodes.row(n) for n in dropped], int))
    if newcomers.part is not None:
        part = part.followed_by(newcomers.part)
    if len(part.nodes) == 0:
        raise UserFacingError(f"The database '{database.name}' would have no motion node left.")
    faces = GrownFaces(database, file, newcomers)
    names = [s.name for s in part.sentences]
    pca = database.pca
    if settings.refit:
        progress.step(0.0, "fitting principal components")
        pca = faces.fit(names)
        part = replace(part, frames=np.concatenate([packed(pca, faces.of(name).face) for name in names]))
    maps = grown_maps(
        database.maps, part.came_from, part.frames, part.nodes, settings.remake_maps, progress.part(0.1, 0.9)
    )
    progress.step(0.9, "writing the database")
    done = {ADDED: newcomers.names, REMOVED: removed, NODES_DROPPED: dropped}
    done = {what: names for what, names in done.items() if names} | ({REFITTED: ()} if settings.refit else {})
    apart = [r for r in held_out_recordings(database) if r.sentence not in removed]
    grown = replace(_grown(database, newcomers, part, pca, done, about), maps=maps, path=target)
    audio = stored_sounds(database, file, [*names, *(r.sentence for r in apart)])
    with swapped_in(target) as beside:
        write_database(grown, beside, itertools.chain(audio, newcomers.audio), [*apart, *newcomers.apart],
                       faces.kept(names) if with_captures else ())  # fmt: skip
        file.close()  # Windows replaces nothing that is open
        # tuning stores weights without the lock, and they shall not be lost
        if not os.path.samestat(as_it_was, Path(database.path).stat()):
            raise UserFacingError(f"The database '{database.path}' was changed by another process.", "Try once more.")
    return GrowthReport(grown, database.content_hash, newcomers.names, removed, dropped, settings.refit,
                        *newcomers.fit(database), *_told_apart(database.maps, maps),
                        time.perf_counter() - began)  # fmt: skip


def _grown(
    database: MotionDatabase,
    newcomers: Newcomers,
    part: MotionPart,
    pca: MotionPca,
    done: Mapping[str, Sequence[str]],
    about: Mapping[str, object] | None,
) -> MotionDatabase:
    """Return the database with other sentences, but for its maps."""
    removed = done.get(REMOVED, ())
    held_out = {split: tuple(n for n in names if n not in removed) for split, names in database.held_out.items()}
    for split, names in newcomers.held_out.items():
        held_out[split] = held_out.get(split, ()) + tuple(names)
    weights = default_weights(part.frames, part.nodes, database.rate_hz).in_context
    content_hash = part.content_hash(database.markers, pca)
    counts = {name: n + newcomers.counts.get(name, 0) for name, n in counts_of(database).items()}
    report = {**database.report, **counts}
    return replace(
        database, synthetic=database.synthetic or newcomers.synthetic, pca=pca, frames=part.frames,
        head_rotation=part.head_rotation, head_translation=part.head_translation, nodes=part.nodes,
        sentences=part.sentences, content_hash=content_hash, held_out=held_out,
        weights=database.weights if database.tuning else weights,  # those that were tuned stay in use
        tuning=database.tuning and {**database.tuning, "untuned_weights": weights.as_dict()},
        report=with_step(report, database.content_hash, content_hash, done, about) if done else report,
    )  # fmt: skip


def _check_names(database: MotionDatabase, newcomers: Newcomers) -> None:
    known = {s.name for s in database.sentences}.union(*database.held_out.values())
    for name in (*newcomers.names, *(r.sentence for r in newcomers.apart)):
        if name in known:
            raise UserFacingError(
                f"The database '{database.name}' has a sentence '{name}' already.",
                "Remove it first, or give the new ones other names (--prefix for those of a database).",
            )


def _told_apart(old: Mapping[str, PhonemeMap], new: Mapping[str, PhonemeMap]) -> Iterator[tuple[str, ...]]:
    def of_kind(is_kind: Callable[[str], bool]) -> tuple[str, ...]:
        return tuple(phone for phone in new if is_kind(phone))

    grown = of_kind(lambda p: p in old and new[p].n_placed > old[p].n_placed)
    made = of_kind(lambda p: p not in old or new[p].n_placed < old[p].n_placed)
    return iter((of_kind(lambda p: p not in grown and p not in made), grown, made))
