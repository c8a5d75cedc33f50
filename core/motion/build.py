"""From a corpus to a motion database (Deng and Neumann 2008, sections 3 and 4)."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from threadpoolctl import threadpool_limits

from core.errors import UserFacingError
from core.manifold.isomap import PhonemeMap
from core.media.swap_in import swapped_in
from core.motion.captured_sentence import CapturedSentence
from core.motion.corpus import Corpus
from core.motion.database import MotionDatabase, write_database
from core.motion.head_space import LONGEST_GAP_S, in_head_space
from core.motion.marker_set import MarkerSet
from core.motion.node import NodeTable, NodeTableBuilder
from core.motion.normalise import HeadMotion
from core.motion.pca import MotionPca
from core.motion.recording import Recording
from core.motion.resample import frame_bounds, resample
from core.motion.rest_pose import choose_rest_pose
from core.progress import SILENT, Progress
from core.search.terms import default_weights
from core.speech.emotion import EMOTION_INDEX
from core.speech.phoneme import PHONEME_INDEX


@dataclass(frozen=True)
class BuildSettings:
    """How a corpus is processed.

    rate_hz : frames a second of the database
    n_dims : PCA dimensions
    longest_gap_s : marker gaps up to this long are filled; frames of longer ones are masked out
    """

    rate_hz: float = 120.0
    n_dims: int = 25
    longest_gap_s: float = LONGEST_GAP_S


@dataclass
class _Processed:
    """A sentence in head space at the database's rate."""

    recording: Recording
    face: np.ndarray
    head: HeadMotion
    masked: np.ndarray
    n_filled: int


def build_database(
    corpus: Corpus, path: Path, settings: BuildSettings | None = None, progress: Progress = SILENT
) -> MotionDatabase:
    """Build the motion database of ``corpus`` and store it at ``path``.

    Sentences that the corpus holds out lie in the file as they were captured, and take no part in rest pose, principal
    components, nodes, maps and weights. The file is written beside ``path`` and swapped in at the end, so that a cut
    leaves what was there before. Raises `UserFacingError` when the corpus has no usable sentence or the target cannot
    be written.
    """
    settings = settings or BuildSettings()
    _check_corpus(corpus)
    path = Path(path)
    apart = {name for names in corpus.held_out.values() for name in names}
    held_out = [r for r in corpus.recordings if r.sentence in apart]
    seen = replace(corpus, recordings=[r for r in corpus.recordings if r.sentence not in apart])
    columns = np.array([corpus.recordings[0].marker_names.index(name) for name in corpus.kept_markers])
    markers = _marker_set(seen, columns)

    processed = []
    n = len(seen.recordings)
    for s, recording in enumerate(seen.recordings):
        progress.step(0.25 * s / n, f"normalising {recording.sentence}")
        processed.append(_process(recording, markers, corpus.with_scale, settings))

    progress.step(0.25, "fitting principal components")
    pca = MotionPca.fit((p.face[~p.masked] for p in processed), settings.n_dims)
    database = _assemble(seen, settings, markers, pca, processed)
    if len(database.nodes) == 0:
        raise UserFacingError(f"The corpus '{corpus.name}' has no phoneme with motion, so there is nothing to search.")
    maps = make_maps(database, progress.part(0.3, 0.95))
    database = replace(
        database, maps=maps, weights=default_weights(database.frames, database.nodes, database.rate_hz).in_context
    )
    progress.step(0.95, "writing the database")
    audio = {r.sentence: _flac(r) for r in corpus.recordings if r.audio is not None}
    return _store(database, path, audio, held_out)


def _check_corpus(corpus: Corpus) -> None:
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
    if len({name for held in corpus.held_out.values() for name in held}) == len(names):
        raise UserFacingError(f"All sentences of the corpus '{corpus.name}' are held out, so nothing is left to build.")
    missing = [name for name in corpus.kept_markers if name not in first.marker_names]
    if missing:
        raise UserFacingError(f"The captures of '{corpus.name}' have no marker '{missing[0]}', which the list keeps.")


def _marker_set(corpus: Corpus, columns: np.ndarray) -> MarkerSet:
    """Return the marker set with its rest pose."""
    names = corpus.kept_markers
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


def _process(recording: Recording, markers: MarkerSet, with_scale: bool, settings: BuildSettings) -> _Processed:
    captured = in_head_space(recording, markers, with_scale, settings.longest_gap_s)
    face, head, masked = captured.face, captured.head, captured.masked
    n_frames = max(1, round(recording.transcript.duration_s * settings.rate_hz))
    turn = Rotation.from_matrix(head.rotation).as_rotvec()
    tracks = np.concatenate([face.reshape(len(face), -1), turn, head.translation, head.scale[:, None]], axis=1)
    raised = resample(tracks, recording.rate_hz, settings.rate_hz, n_frames)
    head = HeadMotion(Rotation.from_rotvec(raised[:, -7:-4]).as_matrix(), raised[:, -4:-1], raised[:, -1])
    nearest = np.minimum(np.arange(n_frames) * recording.rate_hz / settings.rate_hz, len(masked) - 1)
    masked_now = masked[np.floor(nearest).astype(int)] | masked[np.ceil(nearest).astype(int)]
    # sound may run on after the capture has ended: those frames would be made up
    masked_now |= np.arange(n_frames) / settings.rate_hz > (len(masked) + 1) / recording.rate_hz
    return _Processed(recording, raised[:, :-7].reshape(n_frames, len(markers), 3), head, masked_now, captured.n_filled)


def _assemble(
    corpus: Corpus, settings: BuildSettings, markers: MarkerSet, pca: MotionPca, processed: list[_Processed]
) -> MotionDatabase:
    builder = NodeTableBuilder()
    sentences, first, left_out = [], 0, 0
    for p in processed:
        transcript = p.recording.transcript
        start, stop = frame_bounds([u.start_s for u in transcript.phonemes], [u.end_s for u in transcript.phonemes],
                                   settings.rate_hz)  # fmt: skip
        left_out += builder.add_sentence(
            p.recording.sentence, EMOTION_INDEX[p.recording.emotion], [PHONEME_INDEX[x] for x in transcript.phones],
            start, stop, p.masked, first,
        )  # fmt: skip
        sentences.append(CapturedSentence(p.recording.sentence, p.recording.emotion, p.recording.text, first,
                                          first + len(p.face), transcript))  # fmt: skip
        first += len(p.face)
    with threadpool_limits(1):  # as in `MotionPca.fit`: equal captures give equal bytes
        frames = np.concatenate([pca.coefficients(p.face) for p in processed]).astype(np.float32)
    turns = np.concatenate([Rotation.from_matrix(p.head.rotation).as_rotvec() for p in processed]).astype(np.float32)
    moves = np.concatenate([p.head.translation for p in processed]).astype(np.float32)
    nodes = builder.table()
    report = {
        "captured_rate_hz": processed[0].recording.rate_hz,
        "marker_samples_filled": sum(p.n_filled for p in processed),
        "frames_masked": int(sum(p.masked.sum() for p in processed)),
        "phones_left_out": left_out,
        "longest_gap_s": settings.longest_gap_s,
    }
    return MotionDatabase(
        name=corpus.name, synthetic=corpus.synthetic, rate_hz=settings.rate_hz, markers=markers, pca=pca,
        frames=frames, head_rotation=turns, head_translation=moves, nodes=nodes, sentences=tuple(sentences), maps={},
        weights=None, content_hash=_content_hash(markers, pca, frames, nodes), with_scale=corpus.with_scale,
        held_out=corpus.held_out, report=report,
    )  # fmt: skip


def _content_hash(markers: MarkerSet, pca: MotionPca, frames: np.ndarray, nodes: NodeTable) -> str:
    digest = hashlib.sha256(markers.to_json().encode())
    columns = [getattr(nodes, name) for name in NodeTable.COLUMNS]
    for array in (markers.rest, pca.mean, pca.basis, frames, *columns):
        digest.update(np.ascontiguousarray(array).tobytes())
    digest.update("\n".join(nodes.sentence_names).encode())
    return digest.hexdigest()


def cluster_frames(nodes: NodeTable, phoneme: int) -> np.ndarray:
    """Return the rows of all frames of a phoneme cluster, int64, node after node."""
    rows = np.flatnonzero(nodes.phoneme == phoneme)
    return np.concatenate([np.arange(nodes.start[n], nodes.stop[n]) for n in rows]).astype(np.int64)


def make_maps(database: MotionDatabase, progress: Progress = SILENT) -> dict[str, PhonemeMap]:
    """Make the map of every phoneme cluster, largest first, on all cores when there is much to do."""
    from joblib import Parallel, delayed

    from core.speech.phoneme import PHONEMES

    clusters = {PHONEMES[p]: cluster_frames(database.nodes, p) for p in np.unique(database.nodes.phoneme)}
    order = sorted(clusters, key=lambda phone: -len(clusters[phone]))
    jobs = (delayed(_map_of)(phone, clusters[phone], database.frames[clusters[phone]]) for phone in order)
    workers = -1 if len(database.frames) > 60_000 else 1  # starting processes costs more than a small corpus
    maps = {}
    for phone, made in Parallel(n_jobs=workers, return_as="generator_unordered")(jobs):
        maps[phone] = made
        progress.step(len(maps) / len(order), f"map of /{phone}/ made")
    return {phone: maps[phone] for phone in sorted(maps)}


def _map_of(phone: str, rows: np.ndarray, frames: np.ndarray) -> tuple[str, PhonemeMap]:
    with threadpool_limits(1):
        return phone, PhonemeMap.make(rows, frames.astype(float))


def _flac(recording: Recording) -> bytes:
    from core.media.audio import encode_flac, load_audio

    return encode_flac(load_audio(recording.audio))


def _store(database: MotionDatabase, path: Path, audio: dict[str, bytes], held_out: list[Recording]) -> MotionDatabase:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(f"The folder '{path.parent}' cannot be made: {error.strerror}.") from error
    with swapped_in(path) as beside:
        write_database(database, beside, audio, held_out)
    return replace(database, path=path)
