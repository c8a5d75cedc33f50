"""The motion database: one portable HDF5 file, and what it looks like when it is open."""

from __future__ import annotations

import contextlib
import json
import logging
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.manifold.isomap import PhonemeMap
from core.motion.captured_sentence import CapturedSentence
from core.motion.captures import KeptCapture, write_capture
from core.motion.database_checks import (
    Unsound,
    check_held_out,
    check_map,
    check_motion,
    check_nodes,
    check_sentences,
    plain_json,
    stored,
    stored_text,
)
from core.motion.held_out import read_held_out, write_held_out
from core.motion.marker_set import MarkerSet
from core.motion.node import NodeTable
from core.motion.pca import MotionPca
from core.motion.recording import Recording
from core.search.weights import SearchWeights

FORMAT = "efase-motion-database"
VERSION = (1, 2)  # 1.1: held-out recordings, and whether each frame was scaled; 1.2: kept captures, placed frames
REMAKE = "Remake it with `efase build`, or open another one."
# Whatever h5py, numpy and json raise for files that were cut, overwritten or made up.
_DAMAGE = (OSError, KeyError, ValueError, IndexError, TypeError, AttributeError, ArithmeticError, RuntimeError,
           MemoryError)  # fmt: skip
_MAP = {"frames": np.int64, "embedding": np.float32, "pca": np.float32, "triangles": np.int32}
log = logging.getLogger("database")


@dataclass(frozen=True)
class MotionDatabase:
    """An open motion database; nothing in it changes.

    name, synthetic : as in the corpus it was built from
    rate_hz : frames a second
    markers : the marker set with its rest pose
    pca : the space of the frames
    frames : float32, shape (n_frames, n_dims), PCA coefficients of all sentences, one after the other
    head_rotation : float32, shape (n_frames, 3), rotation vectors, radians; head_translation: the same, mm
    nodes : the motion nodes
    sentences : in the order of their frames
    maps : phoneme name to its Isomap
    weights : search weights of this database
    tuning : how they were tuned (see `core.evaluation.tuning`); empty while they are the untuned ones
    with_scale : each frame of its captures was scaled to the size of the rest pose (tracked video)
    held_out : sentence names by split (``tune``, ``test``), which made no node; see `held_out_recordings`
    report : what was done to the data, sentence by sentence of prose
    content_hash : hex digest of the captured content; weights, maps and curation are not part of it
    path : the file, or None when it was never stored
    """

    name: str
    synthetic: bool
    rate_hz: float
    markers: MarkerSet
    pca: MotionPca
    frames: np.ndarray
    head_rotation: np.ndarray
    head_translation: np.ndarray
    nodes: NodeTable
    sentences: tuple[CapturedSentence, ...]
    maps: Mapping[str, PhonemeMap]
    weights: SearchWeights
    content_hash: str
    with_scale: bool = False
    held_out: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    report: Mapping[str, object] = field(default_factory=dict)
    tuning: Mapping[str, object] = field(default_factory=dict)
    path: Path | None = None

    @cached_property
    def untuned_weights(self) -> SearchWeights:
        """The weights of Deng and Neumann's formulas, from medians of this database, whatever is in use."""
        return _weights(self.tuning["untuned_weights"]) if self.tuning else self.weights

    @cached_property
    def paper_weights(self) -> SearchWeights:
        """Weights for the search as the paper prints it: tuned for just that, if they were, else untuned."""
        tuned = self.tuning.get("as_printed")
        return _weights(tuned["weights"]) if tuned else self.untuned_weights.as_printed

    @cached_property
    def rest_coefficients(self) -> np.ndarray:
        """The rest pose in PCA space, float64, shape (n_dims,)."""
        return self.pca.coefficients(self.markers.rest)

    def node_frames(self, row: int) -> np.ndarray:
        """Return the coefficients of a node's frames, float32, shape (n_frames of the node, n_dims)."""
        return self.frames[self.nodes.start[row] : self.nodes.stop[row]]

    def sentence(self, name: str) -> CapturedSentence:
        """Return a sentence by name; raises `UserFacingError` when there is none."""
        for sentence in self.sentences:
            if sentence.name == name:
                return sentence
        raise UserFacingError(f"The database '{self.name}' has no sentence '{name}'.")

    def held_out_recordings(self, split: str) -> list[Recording]:
        """Read the recordings that were held out as ``split`` (``tune``, ``test``), raw as they were captured.

        Raises `UserFacingError` when the database holds out none, or its file is damaged.
        """
        names = self.held_out.get(split, ())
        if self.path is None or not names:
            raise UserFacingError(
                f"The database '{self.name}' holds out no sentences for '{split}'.",
                "Build it with `efase build --hold-out`, or name a corpus folder with --corpus.",
            )
        with self.open_file() as file, damage_told(self.path):
            return read_held_out(file, names, self.markers)

    def audio_bytes(self, sentence: str) -> bytes | None:
        """Return the FLAC file of a sentence's sound, or None if it was built without."""
        import h5py

        if self.path is None:
            return None
        with h5py.File(self.path, "r") as file:
            if f"audio/{sentence}" not in file:
                return None
            return stored(file, f"audio/{sentence}", np.uint8).tobytes()

    def open_file(self):
        """Open the stored HDF5 file, to read what does not come with `open_database`, within `damage_told`."""
        import h5py

        with damage_told(self.path):
            return h5py.File(self.path, "r")

    def summary(self) -> dict[str, object]:
        """Return what `efase info` prints: counts, coverage, rate, content hash."""
        phonemes, counts = np.unique(self.nodes.phoneme, return_counts=True)
        from core.speech.emotion import EMOTIONS
        from core.speech.phoneme import PHONEMES

        emotions = [s.emotion for s in self.sentences]
        return {
            "name": self.name,
            "synthetic": self.synthetic,
            "path": None if self.path is None else str(self.path),
            "nodes": len(self.nodes),
            "frames": len(self.frames),
            "seconds": round(len(self.frames) / self.rate_hz, 3),
            "phonemes": {PHONEMES[p]: int(c) for p, c in zip(phonemes, counts)},
            "emotions": {e: emotions.count(e) for e in EMOTIONS if e in emotions},
            "sentences": len(self.sentences),
            "pca_dims": self.pca.n_dims,
            "pca_coverage": self.pca.coverage,
            "markers": len(self.markers),
            "rate_hz": self.rate_hz,
            "maps": {phone: m.summary() for phone, m in self.maps.items()},
            "weights": self.weights.as_dict(),
            "tuning": dict(self.tuning),
            "held_out": {split: len(names) for split, names in self.held_out.items()},
            "content_hash": self.content_hash,
            "report": dict(self.report),
        }


def open_database(path: Path) -> MotionDatabase:
    """Open a database file.

    Raises `UserFacingError` when it is missing, not an eFASE database, from a newer major version, or damaged.
    """
    import h5py

    path = Path(path)
    if not path.is_file():
        raise UserFacingError(f"There is no motion database at '{path}'.", "Build one with `efase build`.")
    with damage_told(path), h5py.File(path, "r") as file:
        _check_version(file, path)
        return _read(file, path)


@contextlib.contextmanager
def damage_told(path: Path) -> Iterator[None]:
    """Turn whatever a file that is no sound database makes us raise into one sentence."""
    try:
        yield
    except _DAMAGE as error:
        if isinstance(error, OSError) and "signature" in str(error):
            raise UserFacingError(f"'{path}' is not a motion database.", REMAKE) from error
        reason = str(error) if isinstance(error, Unsound) else type(error).__name__
        log.info("%s: %s", path, error)
        raise UserFacingError(f"The motion database '{path}' is damaged ({reason}).", REMAKE) from error


def _check_version(file, path: Path) -> None:
    if file.attrs.get("format") != FORMAT:
        raise UserFacingError(f"'{path}' is an HDF5 file, but not a motion database.", REMAKE)
    major, minor = int(file.attrs["version_major"]), int(file.attrs["version_minor"])
    if major > VERSION[0]:
        raise UserFacingError(
            f"'{path}' was made by a newer eFASE (database version {major}.{minor}; this one reads up to "
            f"{VERSION[0]}.x).",
            "Update the workstation to open it.",
        )


def _read(file, path: Path) -> MotionDatabase:
    rate_hz = float(file.attrs["rate_hz"])
    markers = MarkerSet.from_json(file["markers"].attrs["json"], stored(file, "markers/rest", np.float64))
    parts = (stored(file, f"pca/{name}", np.float64) for name in ("mean", "basis", "variance"))
    pca = MotionPca(*parts, float(file["pca"].attrs["coverage"]))
    frames, rotation, translation = (
        stored(file, f"frames/{name}", np.float32) for name in ("coefficients", "head_rotation", "head_translation")
    )
    check_motion(rate_hz, markers, pca, frames, np.concatenate([rotation, translation], axis=1))
    sentences = tuple(CapturedSentence.from_entry(entry) for entry in plain_json(stored_text(file, "sentences")))
    check_sentences((s.name for s in sentences), ((s.start_frame, s.stop_frame) for s in sentences), len(frames))
    columns = {name: stored(file, f"nodes/{name}", dtype) for name, dtype in NodeTable.COLUMNS.items()}
    nodes = NodeTable(**columns, sentence_names=tuple(s.name for s in sentences))
    check_nodes(nodes, len(frames))
    maps = {phone: _map(file, phone, len(frames)) for phone in file["maps"]}
    held_out = plain_json(file.attrs["held_out"])
    check_held_out(held_out)
    return MotionDatabase(
        name=str(file.attrs["name"]),
        synthetic=bool(file.attrs["synthetic"]),
        rate_hz=rate_hz,
        markers=markers,
        pca=pca,
        frames=frames,
        head_rotation=rotation,
        head_translation=translation,
        nodes=nodes,
        sentences=sentences,
        maps=maps,
        weights=_weights(plain_json(file.attrs["weights"])),
        content_hash=str(file.attrs["content_hash"]),
        with_scale=bool(file.attrs.get("with_scale", False)),
        held_out={split: tuple(names) for split, names in held_out.items()},
        report=dict(plain_json(file.attrs["report"])),
        tuning=_tuning(plain_json(file.attrs.get("tuning", "{}"))),
        path=path,
    )


def write_database(
    database: MotionDatabase,
    path: Path,
    audio: Iterable[tuple[str, bytes]] = (),
    held_out: Sequence[Recording] = (),
    captures: Iterable[tuple[str, KeptCapture]] = (),
) -> None:
    """Store ``database``, the FLAC sound of its sentences, what is held out, and captures that are kept, at ``path``.

    When this returns, the disk has it. Raises `OSError` if the disk refuses.
    """
    import h5py

    # made in memory, for HDF5 ends the process when a disk fills up under it
    with h5py.File("database", "w", driver="core", backing_store=False, libver=("v110", "v110")) as file:
        file.attrs.update(
            format=FORMAT, version_major=VERSION[0], version_minor=VERSION[1], name=database.name,
            synthetic=database.synthetic, rate_hz=database.rate_hz, content_hash=database.content_hash,
            with_scale=database.with_scale,
            weights=json.dumps(database.weights.as_dict()), held_out=json.dumps(dict(database.held_out)),
            report=json.dumps(dict(database.report)), tuning=json.dumps(dict(database.tuning)),
        )  # fmt: skip
        file.create_dataset("markers/rest", data=database.markers.rest)
        file["markers"].attrs["json"] = database.markers.to_json()
        for name in ("mean", "basis", "variance"):
            file.create_dataset(f"pca/{name}", data=getattr(database.pca, name))
        file["pca"].attrs["coverage"] = database.pca.coverage
        file.create_dataset("frames/coefficients", data=database.frames)
        file.create_dataset("frames/head_rotation", data=database.head_rotation)
        file.create_dataset("frames/head_translation", data=database.head_translation)
        for name in NodeTable.COLUMNS:
            file.create_dataset(f"nodes/{name}", data=getattr(database.nodes, name))
        file.create_dataset("sentences", data=json.dumps([s.as_entry() for s in database.sentences]))
        file.create_group("maps")
        for phone, phoneme_map in database.maps.items():
            phoneme_map.write(file.create_group(f"maps/{phone}"))
        write_held_out(file, held_out, database.markers.names)
        for sentence, flac in audio:
            file.create_dataset(f"audio/{sentence}", data=np.frombuffer(flac, np.uint8))
        for sentence, capture in captures:
            write_capture(file, sentence, capture)
        file.flush()
        image = file.id.get_file_image()
    with path.open("wb") as target:
        target.write(image)
        target.flush()
        os.fsync(target.fileno())  # or a power cut after the swap could leave neither the old nor the new


def _weights(values: object) -> SearchWeights:
    try:
        return SearchWeights.from_dict(values)
    except UserFacingError as error:
        raise Unsound("its search weights are none") from error


def _tuning(record: object) -> dict[str, object]:
    if not isinstance(record, dict):
        raise Unsound("what it says of its tuning is no record")
    for kind, found in record.items():
        _weights(found if kind == "untuned_weights" else found["weights"])
    if record and "untuned_weights" not in record:
        raise Unsound("its untuned weights are gone")
    return record


def _map(file, phone: str, n_frames: int) -> PhonemeMap:
    arrays = [stored(file, f"maps/{phone}/{name}", dtype) for name, dtype in _MAP.items()]
    check_map(phone, *arrays, n_frames)
    attrs = file[f"maps/{phone}"].attrs
    quality = float(attrs["residual"])
    if not math.isfinite(quality):
        raise Unsound(f"the map of /{phone}/ is not finite")
    counts = (int(attrs["n_joined"]), int(attrs["n_landmarks"]), quality, int(attrs.get("n_placed", 0)))
    return PhonemeMap(*arrays, *counts)
