"""Projects in the window: nothing to save, nothing lost, and a way on from whatever is wrong."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.export import VideoSettings, export
from app.project_export import ExportJob, run
from app.project_jobs import is_unnamed
from app.settings import last_project, window_settings
from core.document.content import ProjectContent
from core.document.project_file import ProjectFile, read_project
from core.errors import UserFacingError
from core.media.video import FRAME_RATES
from core.motion.curation import CurationList
from core.motion.motion_files import read_motion

WAIT_MS = 20_000
CTRL = Qt.KeyboardModifier.ControlModifier


def content_of(window):
    return ProjectContent.of(window.authoring.document, window.authoring.view)


def written(window):
    """Wait until all edits so far are written."""
    window.keeper.ask(lambda file: None)


def idle(window):
    return lambda: window.authoring.jobs.is_idle


@pytest.fixture
def own_database(database_path, tmp_path):
    path = tmp_path / "motion" / "tiny.h5"
    path.parent.mkdir()
    shutil.copyfile(database_path, path)
    return path


@pytest.fixture
def working(qtbot, open_window, choose, own_database, speech_path):
    """Return a function that opens a window on a new project with speech and motion."""

    def make():
        window = open_window()
        window.keeper.new()
        window.authoring.open_database(own_database)
        qtbot.waitUntil(lambda: window.authoring.document.database is not None, timeout=WAIT_MS)
        window.open_file(speech_path)
        qtbot.waitUntil(lambda: window.authoring.document.speech is not None, timeout=WAIT_MS)
        window.authoring.synthesise()
        qtbot.waitUntil(lambda: window.authoring.document.prices is not None, timeout=WAIT_MS)
        return window

    return make


def edited(window):
    authoring = window.authoring
    authoring.select_slot(3)
    nodes = authoring.document.database.nodes
    row = next(r for r in range(len(nodes)) if nodes[r].phone == "b" and r != authoring.document.answer.path.nodes[3])
    authoring.toggle_pin(nodes.name(row))
    authoring.paint_emotion(0.2, 0.6, "anger", 0.5)
    authoring.move_boundary(2, 0.38)
    authoring.set_frame_rate("25")
    return row


def test_everything_is_there_again_after_the_window_was_closed(working, open_window, qtbot):
    window = working()
    row = edited(window)
    qtbot.waitUntil(idle(window), timeout=WAIT_MS)
    before, cost = content_of(window), window.authoring.document.answer.path.cost
    window.close()
    again = open_window()
    assert again.keeper.start(None) is False
    qtbot.waitUntil(lambda: again.authoring.document.answer is not None, timeout=WAIT_MS)
    assert content_of(again) == before
    assert again.authoring.document.answer.path.cost == cost
    assert again.authoring.document.answer.path.nodes[3] == row
    assert again.authoring.view.slot == 3
    assert not again.authoring.undo_stack.canUndo()
    assert "Unnamed project" in again.windowTitle()


def test_every_edit_and_its_undo_is_written(working, qtbot):
    window = working()
    path = window.keeper.file.path

    def on_disk():
        written(window)
        return read_project(path)[0]

    edited(window)
    assert on_disk().pins == window.authoring.document.pins != {}
    assert on_disk().output.frame_rate == "25"
    for _ in range(3):
        window.authoring.undo_stack.undo()
    assert on_disk().modifiers == ()
    assert on_disk().output.frame_rate == "30"
    notes = []
    window.authoring.noted.connect(notes.append)
    QTest.keyClick(window, Qt.Key.Key_S, CTRL)
    qtbot.waitUntil(lambda: any("Saved already" in note for note in notes), timeout=WAIT_MS)


def test_a_copy_names_an_unnamed_project_and_a_second_one_stays_behind(working, choose, tmp_path):
    window = working()
    unnamed = window.keeper.file.path
    assert is_unnamed(unnamed)
    choose(tmp_path / "mine")
    window.project_menu.ask_copy()
    assert window.keeper.file.path == tmp_path / "mine.efase"
    assert not unnamed.exists()
    assert window.windowTitle().startswith("mine · ")
    choose(tmp_path / "other.efase")
    window.project_menu.ask_copy()
    assert window.keeper.file.path == tmp_path / "mine.efase"
    window.authoring.paint_emotion(0.1, 0.3, "sadness")
    written(window)
    assert read_project(tmp_path / "other.efase")[0].modifiers == ()
    assert read_project(tmp_path / "mine.efase")[0].modifiers != ()
    assert last_project(window_settings()) == tmp_path / "mine.efase"


def test_versions_go_back_and_forth_with_one_key_and_undo(working, qtbot):
    window = working()
    authoring = window.authoring
    window.versions.keep("calm")
    authoring.paint_emotion(0.1, 0.8, "anger")
    window.versions.keep("angry")
    angry = authoring.document.modifiers
    depth = authoring.undo_stack.count()
    for wanted in ((), angry, ()):
        QTest.keyClick(window, Qt.Key.Key_QuoteLeft)
        assert authoring.document.modifiers == wanted
    assert authoring.undo_stack.count() == depth + 1
    authoring.undo_stack.undo()
    assert authoring.document.modifiers == angry
    authoring.paint_emotion(0.2, 0.3, "happiness")
    unkept = authoring.document.modifiers
    QTest.keyClick(window, Qt.Key.Key_QuoteLeft)
    assert authoring.document.modifiers == angry
    QTest.keyClick(window, Qt.Key.Key_QuoteLeft)
    assert authoring.document.modifiers == unkept
    qtbot.waitUntil(idle(window), timeout=WAIT_MS)


def test_two_windows_share_removed_nodes_and_not_the_project(working, open_window, qtbot):
    first = working()
    path = first.keeper.file.path
    document = first.authoring.document
    used = document.database.nodes.name(document.answer.path.nodes[2])
    second = open_window()
    second.keeper.open(path)
    qtbot.waitUntil(lambda: second.authoring.document.answer is not None, timeout=WAIT_MS)
    assert "is open in another window" in second.message.text
    assert second.keeper.file.path != path and is_unnamed(second.keeper.file.path)
    first.authoring.remove_nodes([used], "a spike")
    qtbot.waitUntil(idle(first), timeout=WAIT_MS)
    assert document.database.nodes.name(document.answer.path.nodes[2]) != used
    first.authoring.curating.wait()
    second.authoring.curating.refresh()
    theirs = second.authoring.document
    assert theirs.shared_removals[used].why == "a spike"
    qtbot.waitUntil(idle(second), timeout=WAIT_MS)
    assert theirs.database.nodes.name(theirs.answer.path.nodes[2]) != used
    first.authoring.undo_stack.undo()
    first.authoring.curating.wait()
    assert CurationList.of(document.database).read() == {}
    qtbot.waitUntil(idle(first), timeout=WAIT_MS)


def test_a_list_that_cannot_be_written_removes_for_this_project(working, qtbot, monkeypatch):
    window = working()
    monkeypatch.setattr(CurationList, "can_be_written", False)
    name = window.authoring.document.database.nodes.name(4)
    window.authoring.remove_nodes([name], "frozen")
    document = window.authoring.document
    assert name in document.removed and name in document.removed_here and not document.shared_removals
    written(window)
    assert read_project(window.keeper.file.path)[0].removed_here[name].why == "frozen"
    qtbot.waitUntil(idle(window), timeout=WAIT_MS)


def test_a_missing_database_is_said_and_can_be_located(working, open_window, qtbot, own_database, tmp_path):
    window = working()
    edited(window)
    pins = dict(window.authoring.document.pins)
    window.close()
    moved = tmp_path / "elsewhere.h5"
    own_database.rename(moved)
    again = open_window()
    again.keeper.start(None)
    qtbot.waitUntil(lambda: "is not at" in again.message.text, timeout=WAIT_MS)
    assert "Ctrl+D" in again.message.text
    assert again.authoring.document.database is None
    assert again.authoring.document.pins == pins
    again.authoring.open_database(moved)
    qtbot.waitUntil(lambda: again.authoring.document.answer is not None, timeout=WAIT_MS)
    assert again.authoring.document.pins == pins
    written(again)
    assert read_project(again.keeper.file.path)[0].database.path == str(moved)


def test_pins_that_a_changed_database_lacks_are_listed_and_kept(working, open_window, qtbot):
    window = working()
    path = window.keeper.file.path
    window.close()
    project = ProjectFile.open(path)
    from dataclasses import replace

    reference = replace(project.content.database, content_hash="other")
    project.save(replace(project.content, pins={2: "gone:7"}, database=reference), project.audio(project.content))
    project.close()
    again = open_window()
    again.keeper.start(None)
    qtbot.waitUntil(lambda: again.authoring.document.answer is not None, timeout=WAIT_MS)
    assert "gone:7" in again.message.text and "is not what it was" in again.message.text
    assert again.authoring.document.pins == {2: "gone:7"}
    assert again.authoring.document.unresolved == ("gone:7",)


@pytest.mark.parametrize("content", [b"", b"no project", b"SQLite format 3\0" + bytes(100)])
def test_a_broken_last_project_leaves_an_empty_one(open_window, qtbot, tmp_path, content):
    window = open_window()
    began = []
    window.keeper.began_empty.connect(lambda: began.append(True))
    path = tmp_path / "broken.efase"
    path.write_bytes(content)
    assert window.keeper.start(path) is False
    qtbot.waitUntil(lambda: bool(began), timeout=WAIT_MS)
    assert "broken.efase" in window.message.text
    assert window.keeper.file is not None and is_unnamed(window.keeper.file.path)


def test_export_writes_the_motion_that_the_window_shows(working, tmp_path, qtbot):
    window = working()
    edited(window)
    document = window.authoring.document
    used = document.database.nodes.name(document.answer.path.nodes[5])
    window.authoring.remove_nodes([used], "a swap")
    qtbot.waitUntil(idle(window), timeout=WAIT_MS)
    qtbot.waitUntil(lambda: document.answer is not None)
    for suffix in (".csv", ".c3d"):
        here, there = tmp_path / f"window{suffix}", tmp_path / f"command{suffix}"
        settings = VideoSettings(FRAME_RATES[document.output.frame_rate])
        export(document.answer.motion, document.speech.audio, None, here, settings)
        written(window)
        answer = run(ExportJob(window.keeper.file.path, (there,)))
        assert here.read_bytes() == there.read_bytes()
    assert [row["node"] for row in answer["phonemes"]][5] != used
    assert np.isfinite(read_motion(there)[0]).all()


def test_a_drag_is_one_entry_and_undoes_at_once(working, qtbot):
    from app.editing import new_gesture

    window = working()
    authoring = window.authoring
    gesture, depth = new_gesture(), authoring.undo_stack.count()
    before = authoring.document.speech.transcript
    for time_s in (0.24, 0.245, 0.25, 0.26):
        authoring.move_boundary(1, time_s, gesture)
    assert authoring.undo_stack.count() == depth + 1
    assert authoring.document.speech.transcript.phonemes[1].end_s == 0.26
    authoring.undo_stack.undo()
    assert authoring.document.speech.transcript == before
    qtbot.waitUntil(idle(window), timeout=WAIT_MS)


def test_a_disk_that_refuses_is_told_before_the_window_closes(working, monkeypatch):
    window = working()
    edited(window)
    written(window)
    asked, answers = [], [False, True]

    def refuse(*_):
        raise UserFacingError("The disk is full.")

    def gives_up(why):
        asked.append(why)
        return answers.pop(0)

    monkeypatch.setattr(ProjectFile, "save", refuse)
    monkeypatch.setattr(window, "_gives_up", gives_up)
    assert not window.close() and window.isVisible() and window.keeper.file is not None
    assert window.close() and not window.isVisible()
    assert len(asked) == 2 and all("The disk is full." in why for why in asked)


def test_a_disk_that_takes_everything_asks_nothing(working, monkeypatch):
    window = working()
    monkeypatch.setattr(window, "_gives_up", lambda why: pytest.fail(why))
    assert window.close()
