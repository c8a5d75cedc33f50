"""A database that grows equals one that was built at once; what is taken out is gone, and names survive."""

from __future__ import annotations

import json
from dataclasses import replace

import h5py
import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.curation import CurationList, Removal
from core.motion.database import open_database
from core.motion.database_lock import DatabaseLock
from core.motion.growth import (
    GrowthSettings,
    add_corpus,
    add_database,
    compact,
    merge,
    remove_sentences,
)
from core.motion.node import NodeTable
from core.motion.stored_weights import SEARCH, store_tuned
from core.progress import Progress
from core.search.weights import SearchWeights
from tests.core.motion.growing import NAMES, REST, corpus_of

SETTINGS = BuildSettings(n_dims=6)
KEEPING = replace(SETTINGS, keep_captures=True)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "db.h5"


def names_of(database):
    return [database.nodes.name(n) for n in range(len(database.nodes))]


def assert_equal_nodes(one, other):
    assert one.nodes.sentence_names == other.nodes.sentence_names
    for name in NodeTable.COLUMNS:
        assert np.array_equal(getattr(one.nodes, name), getattr(other.nodes, name)), name


def test_growth_in_ten_steps_with_a_refit_equals_one_build(path, tmp_path):
    whole = build_database(corpus_of(*range(10)), tmp_path / "whole.h5", KEEPING)
    build_database(corpus_of(0), path, KEEPING)
    for seed in range(1, 9):
        add_corpus(path, corpus_of(seed))
    report = add_corpus(path, corpus_of(9), GrowthSettings(refit=True, remake_maps=True))
    grown = open_database(path)
    assert grown.content_hash == report.database.content_hash == whole.content_hash
    assert np.array_equal(grown.frames, whole.frames)
    assert np.array_equal(grown.head_rotation, whole.head_rotation)
    assert_equal_nodes(grown, whole)
    assert grown.sentences == whole.sentences
    assert grown.weights == whole.weights
    for phone, made in whole.maps.items():
        assert np.array_equal(grown.maps[phone].embedding, made.embedding)
        assert np.array_equal(grown.maps[phone].frames, made.frames)


def test_growth_without_a_refit_has_the_same_nodes_and_frames_within_what_the_components_miss(path, tmp_path):
    whole = build_database(corpus_of(*range(6)), tmp_path / "whole.h5", replace(KEEPING, n_dims=100))
    build_database(corpus_of(0, 1), path, SETTINGS)
    for seed in range(2, 6):
        report = add_corpus(path, corpus_of(seed))
        sentence = whole.sentence(f"s{seed}")
        true = whole.pca.positions(whole.frames[sentence.start_frame : sentence.stop_frame])
        grown = report.database
        shown = grown.pca.positions(grown.frames[-len(true) :])
        missed_mm = np.sqrt(((shown - true) ** 2).sum(axis=2).mean())
        assert missed_mm == pytest.approx(report.residual_mm, rel=1e-3)
        away = true - grown.pca.mean.reshape(-1, 3)
        assert report.coverage == pytest.approx(1 - ((shown - true) ** 2).sum() / (away**2).sum(), abs=1e-4)
    assert_equal_nodes(open_database(path), whole)


def test_nothing_that_was_there_moves(path):
    before = build_database(corpus_of(0, 1, 2), path, SETTINGS)
    report = add_corpus(path, corpus_of(3))
    after = open_database(path)
    n = len(before.frames)
    assert np.array_equal(after.frames[:n], before.frames)
    assert names_of(after)[: len(before.nodes)] == names_of(before)
    for phone, old in before.maps.items():
        new = after.maps[phone]
        assert np.array_equal(new.embedding[: len(old.frames)], old.embedding)
        assert np.array_equal(new.frames[: len(old.frames)], old.frames)
        assert new.n_placed == len(new.frames) - len(old.frames)
    grown = {phone for phone in before.maps if len(after.maps[phone].frames) > len(before.maps[phone].frames)}
    assert set(report.maps_grown) == grown
    assert set(report.maps_grown) | set(report.maps_kept) | set(report.maps_made) == set(after.maps)


def test_what_was_added_and_is_removed_leaves_the_content_as_it_was(path):
    before = build_database(corpus_of(0, 1, 2), path, SETTINGS)
    add_corpus(path, corpus_of(3, 4))
    report = remove_sentences(path, ["s3", "s4"])
    assert report.removed == ("s3", "s4")
    after = open_database(path)
    assert after.content_hash == before.content_hash
    for phone, old in before.maps.items():
        assert np.array_equal(after.maps[phone].embedding, old.embedding)
        assert np.array_equal(after.maps[phone].frames, old.frames)
        assert np.array_equal(after.maps[phone].pca, old.pca)


def test_removing_from_the_middle_equals_a_build_without_it(path, tmp_path):
    build_database(corpus_of(0, 1, 2, 3), path, KEEPING)
    without = build_database(corpus_of(0, 2, 3), tmp_path / "without.h5", KEEPING)
    remove_sentences(path, ["s1"], GrowthSettings(refit=True, remake_maps=True))
    after = open_database(path)
    assert after.content_hash == without.content_hash
    assert after.maps.keys() == without.maps.keys()


def test_sound_and_what_is_held_out_come_along_and_go(path, tmp_path):
    build_database(corpus_of(0, 1, folder=tmp_path, held_out=(2,)), path, SETTINGS)
    add_corpus(path, corpus_of(3, folder=tmp_path, held_out=(4,)))
    database = open_database(path)
    assert database.held_out == {"test": ("s2", "s4")}
    assert [r.sentence for r in database.held_out_recordings("test")] == ["s2", "s4"]
    for name in ("s0", "s2", "s3", "s4"):
        assert database.audio_bytes(name) == (tmp_path / f"{name}.flac").read_bytes()
    remove_sentences(path, ["s0", "s2"])
    database = open_database(path)
    assert database.held_out == {"test": ("s4",)}
    raw = corpus_of(4).recordings[0].positions
    assert np.array_equal(database.held_out_recordings("test")[0].positions, raw)
    assert database.audio_bytes("s0") is None and database.audio_bytes("s2") is None


def test_the_curation_list_survives(path):
    database = build_database(corpus_of(0, 1, 2), path, SETTINGS)
    curation = CurationList.of(database)
    removed = {"s1:2": Removal.now("blink"), "s2:0": Removal.now("spike")}
    curation.change(removed)
    add_corpus(path, corpus_of(3))
    remove_sentences(path, ["s0"])
    assert CurationList.of(open_database(path)).read() == removed
    nodes = open_database(path).nodes
    assert nodes.name(nodes.row("s1:2")) == "s1:2"


def test_compacting_drops_removed_nodes_and_sentences_without_any(path):
    database = build_database(corpus_of(0, 1, 2), path, KEEPING)
    of_s2 = [name for name in names_of(database) if name.startswith("s2:")]
    inner = database.nodes.row("s1:3")
    CurationList.of(database).change({name: Removal.now("") for name in ["s1:3", *of_s2]})
    report = compact(path, drop_removed=True, drop_captures=True)
    after = open_database(path)
    assert report.nodes_dropped == ("s1:3", *of_s2) and report.removed == ("s2",)
    assert names_of(after) == [name for name in names_of(database) if name != "s1:3" and name not in of_s2]
    assert after.nodes.suc[after.nodes.row(database.nodes.name(database.nodes.pre[inner]))] == -1
    assert after.nodes.pre[after.nodes.row(database.nodes.name(database.nodes.suc[inner]))] == -1
    assert [s.name for s in after.sentences] == ["s0", "s1"]
    stop = database.sentences[1].stop_frame
    assert np.array_equal(after.frames, database.frames[:stop])
    with h5py.File(path) as file:
        assert "captures" not in file


def test_compacting_alone_changes_nothing(path):
    database = build_database(corpus_of(0, 1), path, KEEPING)
    size = path.stat().st_size
    assert compact(path).database.content_hash == database.content_hash
    assert path.stat().st_size == size
    assert open_database(path).summary() == database.summary()


def test_merging_equals_adding(path, tmp_path):
    build_database(corpus_of(0, 1, folder=tmp_path), path, KEEPING)
    other = tmp_path / "other.h5"
    second = build_database(corpus_of(2, 3, folder=tmp_path, held_out=(4,)), other, KEEPING)
    CurationList.of(second).change({"s3:1": Removal.now("x")})
    merged = merge(path, other, tmp_path / "c.h5")
    add_corpus(path, corpus_of(2, 3, folder=tmp_path, held_out=(4,)))
    grown, opened = open_database(path), open_database(tmp_path / "c.h5")
    assert opened.content_hash == grown.content_hash == merged.database.content_hash
    assert opened.held_out == grown.held_out
    assert opened.audio_bytes("s3") == grown.audio_bytes("s3") is not None
    assert set(CurationList.of(opened).read()) == {"s3:1"}


def test_another_head_space_is_brought_into_ours(path, tmp_path):
    build_database(corpus_of(0, 1), path, replace(KEEPING, n_dims=100))
    moved = replace(corpus_of(2), rest=REST + np.array([0, 0, 1.0]) * (np.arange(len(NAMES)) > 0)[:, None])
    build_database(moved, tmp_path / "other.h5", replace(KEEPING, n_dims=100))
    here = add_database(path, tmp_path / "other.h5", prefix="b-").database
    direct = add_corpus(path, corpus_of(2)).database
    n = len(corpus_of(2).recordings[0].transcript.phones)
    assert n and names_of(here)[-1].startswith("b-s2:")
    span = here.sentences[-1].stop_frame - here.sentences[-1].start_frame
    ours, theirs = direct.frames[-span:], direct.frames[-2 * span : -span]
    assert direct.pca.positions(theirs) == pytest.approx(direct.pca.positions(ours), abs=0.01)
    assert direct.head_rotation[-2 * span : -span] == pytest.approx(direct.head_rotation[-span:], abs=1e-3)
    assert direct.head_translation[-2 * span : -span] == pytest.approx(direct.head_translation[-span:], abs=0.01)


def test_tuned_weights_stay_and_untuned_ones_follow(path):
    database = build_database(corpus_of(0, 1), path, SETTINGS)
    tuned = SearchWeights(pnt=3.5)
    store_tuned(database, {"tuned": SEARCH, "weights": tuned.as_dict()})
    add_corpus(path, corpus_of(2))
    grown = open_database(path)
    assert grown.weights == tuned
    assert grown.untuned_weights != database.weights


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda path, _: add_corpus(path, corpus_of(0)), "has a sentence 's0' already"),
        (lambda path, _: remove_sentences(path, ["s9"]), "has no sentence 's9'"),
        (lambda path, _: remove_sentences(path, ["s0", "s1"]), "no motion node left"),
        (lambda path, _: add_corpus(path, replace(corpus_of(2), with_scale=True)), "true scale"),
        (lambda path, other: add_database(path, other), "has a sentence 's0' already"),
        (lambda path, other: merge(path, other, path), "one of the two"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_changes_nothing(path, tmp_path, change, words):
    build_database(corpus_of(0, 1), path, SETTINGS)
    other = tmp_path / "other.h5"
    build_database(corpus_of(0), other, SETTINGS)
    before = path.read_bytes()
    with pytest.raises(UserFacingError, match=words):
        change(path, other)
    assert path.read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["db.h5", "other.h5"]


def test_other_markers_and_another_face_are_refused(path, tmp_path):
    build_database(corpus_of(0), path, SETTINGS)
    corpus = corpus_of(1)
    fewer = replace(corpus, kept_markers=NAMES[:-1], rest=None)
    build_database(fewer, tmp_path / "fewer.h5", SETTINGS)
    with pytest.raises(UserFacingError, match="only one has 'cheek'"):
        add_database(path, tmp_path / "fewer.h5")
    build_database(replace(corpus, rest=REST * 1.4), tmp_path / "giant.h5", SETTINGS)
    with pytest.raises(UserFacingError, match="not of one actor"):
        add_database(path, tmp_path / "giant.h5")


def test_weights_that_are_stored_meanwhile_are_not_lost(path):
    database = build_database(corpus_of(0), path, SETTINGS)

    class Tunes(Progress):
        def step(self, fraction, message=""):
            if message == "writing the database":
                store_tuned(database, {"tuned": SEARCH, "weights": SearchWeights(pnt=3.5).as_dict()})

    with pytest.raises(UserFacingError, match="changed by another process"):
        add_corpus(path, corpus_of(1), progress=Tunes())
    assert open_database(path).weights == SearchWeights(pnt=3.5)


def test_sentences_that_overlap_are_damage(path, tmp_path):
    build_database(corpus_of(0, 1), path, SETTINGS)
    build_database(corpus_of(2, 3), tmp_path / "other.h5", SETTINGS)
    with h5py.File(tmp_path / "other.h5", "r+") as file:
        entries = json.loads(file["sentences"][()])
        entries[1]["frames"][0] -= 5
        del file["sentences"]
        file["sentences"] = json.dumps(entries)
    for change in (
        lambda: add_database(path, tmp_path / "other.h5"),
        lambda: remove_sentences(tmp_path / "other.h5", ["s2"]),
    ):
        with pytest.raises(UserFacingError, match="damaged"):
            change()


def test_a_database_open_for_writing_elsewhere_is_not_changed(path):
    build_database(corpus_of(0), path, SETTINGS)
    with DatabaseLock(path), pytest.raises(UserFacingError, match="open for writing elsewhere"):
        add_corpus(path, corpus_of(1))
    assert add_corpus(path, corpus_of(1)).added == ("s1",)
