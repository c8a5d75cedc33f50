"""A corpus of any length made of a database: its first round is the database, later ones are varied."""

import numpy as np
import pytest

from core.motion.build import BuildSettings, build_database
from core.motion.repeated_corpus import repeated_corpus
from tests.core.motion.growing import corpus_of


@pytest.fixture
def database(tmp_path):
    return build_database(corpus_of(0, 1, 2), tmp_path / "db.h5", BuildSettings(n_dims=10))


def test_it_has_as_many_frames_as_are_asked_for_and_every_phoneme_its_own(database):
    corpus = repeated_corpus(database, 3 * len(database.frames))
    lengths = [len(np.asarray(r.positions)) for r in corpus.recordings]
    assert 3 * len(database.frames) <= sum(lengths) < 3 * len(database.frames) + max(lengths)
    assert lengths == [round(r.transcript.duration_s * r.rate_hz) for r in corpus.recordings]
    assert lengths == [len(r.positions) for r in corpus.recordings]
    assert corpus.synthetic and len({r.sentence for r in corpus.recordings}) == len(lengths)
    for recording, sentence in zip(corpus.recordings, database.sentences * 4):
        assert recording.transcript.phones == sentence.transcript.phones


def test_a_build_of_the_first_round_gives_the_database_back(database, tmp_path):
    again = build_database(repeated_corpus(database, len(database.frames)), tmp_path / "again.h5",
                           BuildSettings(n_dims=10))  # fmt: skip
    assert np.array_equal(again.nodes.phoneme, database.nodes.phoneme)
    assert np.array_equal(again.nodes.start, database.nodes.start)
    shown, true = (d.pca.positions(d.frames) for d in (again, database))
    assert np.sqrt(((shown - true) ** 2).sum(axis=2).mean()) < 0.3
    assert again.head_rotation == pytest.approx(database.head_rotation, abs=0.01)


def test_later_rounds_are_varied_and_the_same_each_time(database):
    corpus = repeated_corpus(database, 2 * len(database.frames))
    first, later = corpus.recordings[0], corpus.recordings[3]
    assert later.sentence == "s0-1"
    assert np.array_equal(np.asarray(later.positions), np.asarray(later.positions))
    n = min(len(first.positions), len(later.positions))
    assert not np.allclose(np.asarray(first.positions)[:n], np.asarray(later.positions)[:n], atol=0.5)
