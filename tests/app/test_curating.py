"""The first window on a database writes its list of removed nodes; the second reads, says so, and takes over later."""

import pytest

from app import texts
from app.curating import Curating
from core.document.curation_edits import RemoveMotionNodes, RestoreMotionNodes
from core.document.document import Document
from core.document.edits import SetDatabase
from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.curation import CurationList, Removal
from core.motion.growth import add_corpus
from tests.core.motion.growing import corpus_of


@pytest.fixture
def database(tmp_path):
    return build_database(corpus_of(0), tmp_path / "db.h5", BuildSettings(n_dims=6))


@pytest.fixture
def opened(qapp, database):
    """Return a function that opens the database as a window does: (document, curating, what was noted)."""
    windows = []

    def open_it():
        document = Document(None)
        curating, noted = Curating(document), []
        curating.noted.connect(noted.append)
        document.apply(SetDatabase.on(document, database, CurationList.of(database).read()))
        windows.append(curating)
        return document, curating, noted

    yield open_it
    for curating in windows:
        curating.close()


def test_the_second_window_reads_and_says_so(opened, database):
    first, one, noted = opened()
    _, two, told = opened()
    assert (noted, told) == ([], [texts.DATABASE_OPEN_ELSEWHERE])
    assert one.can_be_written and not two.can_be_written
    first.apply(RemoveMotionNodes.on(first, ["s0:1"], Removal.now("x"), False))
    one.wait()
    two.refresh()
    assert set(CurationList.of(database).read()) == {"s0:1"} == set(two._document.shared_removals)


def test_the_second_takes_over_when_the_first_is_closed(opened):
    _, one, _ = opened()
    _, two, _ = opened()
    one.close()
    two.refresh()
    assert two.can_be_written


def test_a_database_that_a_window_has_open_does_not_grow(opened, database):
    _, curating, _ = opened()
    with pytest.raises(UserFacingError, match="open for writing elsewhere"):
        add_corpus(database.path, corpus_of(1))
    curating.close()
    assert add_corpus(database.path, corpus_of(1)).added == ("s1",)


def test_another_database_lets_go_of_the_first(opened, database, tmp_path):
    document, _, _ = opened()
    other = build_database(corpus_of(1), tmp_path / "other.h5", BuildSettings(n_dims=6))
    document.apply(SetDatabase.on(document, other))
    _, second, told = opened()
    assert second.can_be_written and told == []


def test_edits_are_written_in_their_order_and_none_is_taken_back(opened, database, qapp):
    document, curating, _ = opened()
    names = ["s0:1", "s0:2", "s0:3"]
    for name in names:
        document.apply(RemoveMotionNodes.on(document, [name], Removal.now("x"), False))
        qapp.processEvents()
        assert name in document.shared_removals
    document.apply(RestoreMotionNodes.on(document, ["s0:2"]))
    curating.wait()
    qapp.processEvents()
    assert set(document.shared_removals) == {"s0:1", "s0:3"} == set(CurationList.of(database).read())


def test_a_list_that_cannot_be_written_is_said_and_the_next_edit_writes_all(opened, database, qapp, monkeypatch):
    document, curating, _ = opened()
    told = []
    curating.failed.connect(lambda sentence, _remedy: told.append(sentence))

    def full(*_):
        raise UserFacingError("The disk is full.")

    with monkeypatch.context() as patch:
        patch.setattr(CurationList, "_write", full)
        document.apply(RemoveMotionNodes.on(document, ["s0:1"], Removal.now("x"), False))
        curating.wait()
    qapp.processEvents()
    assert told == ["The disk is full."] and CurationList.of(database).read() == {}
    document.apply(RemoveMotionNodes.on(document, ["s0:2"], Removal.now("x"), False))
    curating.wait()
    assert set(CurationList.of(database).read()) == {"s0:1", "s0:2"}
