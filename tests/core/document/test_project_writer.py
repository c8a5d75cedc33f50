"""Edits are written one after the other, in order, by a thread that keeps nobody waiting."""

from __future__ import annotations

import threading

import pytest

from core.document.content import ProjectContent
from core.document.document import Document
from core.document.edits import SetSpeech
from core.document.project_file import ProjectFile
from core.document.project_writer import MOST_WAITING, ProjectWriter
from core.errors import UserFacingError
from tests.core.document.random_edits import made_speech


@pytest.fixture
def writer(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    made = ProjectWriter(ProjectFile.create(tmp_path / "a.efase"))
    yield made
    made.close().result()


@pytest.fixture
def states():
    """Return a function that makes a state which knows its number."""
    document = Document()
    document.apply(SetSpeech.on(document, made_speech(0)))
    return lambda number: (ProjectContent.of(document, others={"number": number}), document.speech.audio)


def held(writer):
    """Let the disk be slow until the event that is returned is set."""
    slow = threading.Event()
    writer.ask(lambda _: slow.wait(10))
    return slow


def number_of(file):
    return file.content.others.get("number")


def test_what_is_asked_sees_just_the_states_before_it(writer, states):
    disk = held(writer)
    answers = []
    for number in range(3 * MOST_WAITING):
        writer.save(*states(number))
        answers.append(writer.ask(number_of))
    assert not answers[0].done()
    disk.set()
    assert [answer.result(10) for answer in answers] == list(range(3 * MOST_WAITING))


def test_each_state_is_a_transaction_and_confirmed_in_order(writer, states):
    revisions, confirmed = [], []
    for number in range(MOST_WAITING):
        saved = writer.save(*states(number))
        saved.add_done_callback(lambda done, number=number: confirmed.append((number, done.result())))
        revisions.append(writer.ask(lambda file: file._revision))
    numbers = [revision.result(10) for revision in revisions]
    assert numbers == list(range(numbers[0], numbers[0] + MOST_WAITING))
    assert confirmed == [(number, True) for number in range(MOST_WAITING)]


def test_a_slow_disk_falls_behind_by_a_bounded_number_of_states(writer, states):
    disk = held(writer)
    saves = [writer.save(*states(number)) for number in range(5 * MOST_WAITING)]
    disk.set()
    written = [save.result(10) for save in saves]
    # what was passed over came before all that was written; the newest is on disk
    assert written == sorted(written) and sum(written) == MOST_WAITING + 1
    assert writer.ask(number_of).result(10) == 5 * MOST_WAITING - 1


def test_a_refused_state_is_told_and_the_next_one_holds_all(writer, states, monkeypatch):
    def full(*_):
        raise UserFacingError("The disk is full.")

    with monkeypatch.context() as patch:
        patch.setattr(ProjectFile, "save", full)
        with pytest.raises(UserFacingError, match="full"):
            writer.save(*states(1)).result(10)
    assert writer.save(*states(2)).result(10)
    assert writer.ask(number_of).result(10) == 2


def test_closing_comes_after_everything(tmp_path, monkeypatch, states):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    writer = ProjectWriter(ProjectFile.create(tmp_path / "b.efase"))
    disk = held(writer)
    writer.save(*states(7))
    closed = writer.close()
    disk.set()
    closed.result(10)
    again = ProjectFile.open(tmp_path / "b.efase")
    assert number_of(again) == 7
    again.close()
