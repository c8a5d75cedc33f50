"""The face of a database: trained once, kept, and thrown out with what it was trained on."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.iface import default_model as module
from core.iface.default_model import default_model
from core.iface.model_file import FaceModel
from core.iface.speech_features import N_FEATURES
from core.progress import Cancelled, Progress
from tests.core.evaluation.conftest import mouth_corpus, mouth_database  # noqa: F401


@pytest.fixture
def trained(monkeypatch, tmp_path, quick_faces):
    """What was trained, in a cache of the test's own."""
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path))
    asked = []

    def train(database, variant, seed=0, progress=None):
        asked.append((database.content_hash, variant))
        time.sleep(0.3)
        return FaceModel(
            quick_faces[variant], variant, database.markers.names, database.name, database.content_hash, seed
        )

    monkeypatch.setattr(module, "train_face", train)
    return asked


def _files(tmp_path):
    return sorted(path.name for path in (tmp_path / "iface").glob("*.npz"))


def test_it_is_trained_once_and_anew_when_the_database_holds_something_else(trained, loud_database, tmp_path):
    heard = np.ones((5, N_FEATURES))
    first, again = default_model(loud_database), default_model(loud_database)
    assert len(trained) == 1 and (first.motion(heard, {}) == again.motion(heard, {})).all()
    (kept,) = _files(tmp_path)
    default_model(loud_database, variant="paper")
    assert len(trained) == 2 and kept in _files(tmp_path) and len(_files(tmp_path)) == 2
    default_model(replace(loud_database, content_hash="other"))
    assert len(trained) == 3 and kept not in _files(tmp_path) and len(_files(tmp_path)) == 2
    default_model(replace(loud_database, path=tmp_path / "elsewhere.h5"))
    assert len(trained) == 4 and len(_files(tmp_path)) == 3


def test_who_asks_while_it_is_trained_waits_for_it(trained, loud_database):
    faces = []
    threads = [threading.Thread(target=lambda: faces.append(default_model(loud_database))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(trained) == 1 and len(faces) == 3


def test_who_waits_can_be_cancelled(trained, loud_database):
    class Stop(Progress):
        def step(self, fraction, message=""):
            raise Cancelled

    trainer = threading.Thread(target=lambda: default_model(loud_database))
    trainer.start()
    while not trained:
        time.sleep(0.01)
    with pytest.raises(Cancelled):
        default_model(loud_database, Stop())
    trainer.join()
    assert len(trained) == 1


def test_a_cache_that_is_damaged_or_closed_only_costs_time(trained, loud_database, tmp_path, monkeypatch):
    default_model(loud_database)
    (tmp_path / "iface" / _files(tmp_path)[0]).write_bytes(b"PK junk")
    default_model(loud_database)
    assert len(trained) == 2
    (tmp_path / "a file").touch()
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "a file"))
    assert default_model(loud_database).expressions == ("anger",)
    assert len(trained) == 3


def test_a_variant_that_there_is_not_and_a_database_without_sound_are_told(mouth_database, loud_database):
    with pytest.raises(UserFacingError, match="no variant 'best'"):
        default_model(loud_database, variant="best")
    with pytest.raises(UserFacingError, match="keeps no sound"):
        default_model(mouth_database)
