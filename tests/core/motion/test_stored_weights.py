"""Weights change with the database's file; what was captured does not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.database import open_database
from core.motion.recording import Recording
from core.motion.stored_weights import AS_PRINTED, SEARCH, forget_weights, store_tuned
from core.search.weights import SearchWeights
from core.speech.transcript import PhonemeUtterance, Transcript

TUNED = SearchWeights(pnt=3.5, alpha1=0.25, alpha4=0.9, context_before=0.5)


def record(weights: SearchWeights = TUNED, tuned: str = SEARCH) -> dict[str, object]:
    return {"tuned": tuned, "weights": weights.as_dict(), "split": "tune"}


@pytest.fixture
def stored(tmp_path):
    rng = np.random.default_rng(3)
    said = Transcript(
        tuple(PhonemeUtterance(p, 0.5 * i, 0.5 * i + 0.5) for i, p in enumerate(("n", "ow", "n"))), (), 1.5
    )
    positions = rng.normal(size=(90, 6, 3)).cumsum(axis=0) * 0.2 + 30 * rng.normal(size=(6, 3))
    recording = Recording("one", "neutral", positions.astype(np.float32), tuple("abcdef"), 60.0, said)
    return build_database(
        Corpus("small", [recording], tuple("abcdef")), tmp_path / "db.h5", BuildSettings(rate_hz=60.0)
    )


def test_weights_are_stored_and_the_untuned_ones_stay_at_hand(stored):
    changed = store_tuned(stored, record())
    reopened = open_database(stored.path)
    assert reopened.weights == changed.weights == TUNED
    assert reopened.untuned_weights == stored.weights
    assert reopened.tuning[SEARCH]["split"] == "tune"
    again = store_tuned(reopened, record(replace(TUNED, pnt=9.0)))
    assert again.untuned_weights == stored.weights


def test_weights_for_the_search_as_printed_stay_beside_those_in_use(stored):
    printed = replace(TUNED, context_before=0.0)
    assert stored.paper_weights == stored.weights.as_printed
    both = store_tuned(store_tuned(stored, record()), record(printed, AS_PRINTED))
    assert (both.weights, both.paper_weights, both.untuned_weights) == (TUNED, printed, stored.weights)
    assert store_tuned(stored, record()).paper_weights == stored.weights.as_printed


def test_tuning_is_no_part_of_the_content(stored):
    changed = store_tuned(stored, record())
    assert changed.content_hash == stored.content_hash
    assert np.array_equal(changed.frames, stored.frames)
    assert changed.maps.keys() == stored.maps.keys()


def test_forgetting_gives_back_the_database_as_it_was_built(stored):
    forgotten = forget_weights(store_tuned(stored, record()))
    assert forgotten.weights == stored.weights
    assert not forgotten.tuning


def test_a_folder_that_refuses_leaves_the_database_as_it_is(stored, monkeypatch):
    before = stored.path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(UserFacingError, match="No space left"):
        store_tuned(stored, record())
    monkeypatch.undo()
    assert stored.path.read_bytes() == before
    assert [p.name for p in stored.path.parent.iterdir()] == ["db.h5"]


def test_weights_that_are_none_are_damage(stored):
    import h5py

    store_tuned(stored, record())
    with h5py.File(stored.path, "r+") as file:
        file.attrs["tuning"] = '{"untuned_weights": {"pnt": -1}}'
    with pytest.raises(UserFacingError, match="damaged"):
        open_database(stored.path)
