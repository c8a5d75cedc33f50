"""The face of a database: trained when it is first asked for, and kept in the cache."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import time
from collections.abc import Iterator
from pathlib import Path

from core.errors import UserFacingError
from core.file_lock import lock_file
from core.folders import cache_dir
from core.iface.model_file import MODERN, FaceModel, load_model, save_model
from core.iface.modern_training import ModernSettings
from core.iface.paper_training import PaperSettings
from core.iface.training import N_NOISES, check_variant, train_face
from core.iface.unit_face import UnitFace
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

_TRAINING = 2  # raise it when training changes beyond its settings, so that cached faces are not taken for new ones
_LOOK_EVERY_S = 0.2
log = logging.getLogger("iface")


def default_model(database: MotionDatabase, progress: Progress = SILENT, variant: str = MODERN) -> UnitFace:
    """Return the face of ``database``, from the cache, or trained now (half a minute for ten minutes of speech).

    Two processes that ask at once train once: the other one waits. Faces of what the same database file held before
    are thrown away. A cache that cannot be read or written only costs time. Raises as
    `core.iface.training.train_face`.
    """
    check_variant(variant)
    path = _cache_path(database, variant)
    if (kept := _kept(path, database)) is not None:
        return kept
    with _alone(path, progress):
        if (kept := _kept(path, database)) is not None:
            return kept
        model = train_face(database, variant, progress=progress)
        try:
            keep_default_model(model, database)
        except UserFacingError as error:
            log.warning("%s", error)
    return model.face


def keep_default_model(model: FaceModel, database: MotionDatabase) -> Path:
    """Make ``model`` the face of ``database``; returns where it lies. Raises `UserFacingError` when it cannot."""
    path = _cache_path(database, model.variant)
    with contextlib.suppress(OSError):  # said when the file itself cannot be written
        path.parent.mkdir(parents=True, exist_ok=True)
    save_model(model, path)
    of_database = path.name.rsplit("-", 1)[0]
    for older in path.parent.glob(f"{of_database}-*"):
        if older.stem != path.stem:
            with contextlib.suppress(OSError):  # on Windows another workstation may have it open
                older.unlink()
    return path


def _kept(path: Path, database: MotionDatabase) -> UnitFace | None:
    if not path.is_file():
        return None
    try:
        model: FaceModel = load_model(path)
    except UserFacingError as error:
        log.warning("%s It is trained again.", error.message)
        return None
    is_its = model.content_hash == database.content_hash and model.markers == database.markers.names
    return model.face if is_its else None


@contextlib.contextmanager
def _alone(path: Path, progress: Progress) -> Iterator[None]:
    """Wait until no other process trains this face; without a folder to write in there is nobody to wait for."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.with_suffix(".lock").open("a+b")
    except OSError:
        yield
        return
    with file:
        while True:
            try:
                lock_file(file)
                break
            except OSError:
                progress.step(0.0, "another process trains this face")
                time.sleep(_LOOK_EVERY_S)
        yield


def _cache_path(database: MotionDatabase, variant: str) -> Path:
    where = database.name if database.path is None else str(database.path.resolve())
    settings = ModernSettings() if variant == MODERN else PaperSettings()
    what = f"{_TRAINING} {database.content_hash} {settings} {N_NOISES}"
    place, content = (hashlib.sha256(said.encode()).hexdigest()[:16] for said in (where, what))
    return cache_dir() / "iface" / f"{variant}-{place}-{content}.npz"
