"""GRID through the window's own keys and buttons gives what the command gives, bit for bit."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

from core.importing.report import KEY, ImportReport
from core.motion.database import open_database

WAIT_MS = 60_000


def test_the_window_and_the_command_make_the_same_database(
    open_window, grid_tracks, tmp_path, efase, qtbot, click, give_folder, go
):
    window = open_window()
    QTest.keyClick(window, Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    assistant = window.tools.importing
    qtbot.waitUntil(assistant.isActiveWindow)
    give_folder(assistant, grid_tracks)
    assert len(assistant.files.table.sentences.problems(assistant.draft.sentences[0])[0]) == 0
    for page in assistant.pages[1:6]:  # looking changes nothing
        go(assistant, page)
    go(assistant, assistant.build)
    assistant.build.path.setText(str(tmp_path / "window.h5"))
    click(assistant.build.build)
    qtbot.waitUntil(lambda: assistant.build.open.isVisible(), timeout=WAIT_MS)
    code, _, said = efase("import", grid_tracks, "-o", tmp_path / "command.h5", "--jobs", "1", "--name", "tracks")
    assert code == 0, said
    ours, theirs = open_database(tmp_path / "window.h5"), open_database(tmp_path / "command.h5")
    assert ours.content_hash == theirs.content_hash
    assert ours.report[KEY] == theirs.report[KEY]
    assert [s.as_entry() for s in ours.sentences] == [s.as_entry() for s in theirs.sentences]
    click(assistant.build.open)
    qtbot.waitUntil(lambda: window.authoring.document.database is not None, timeout=WAIT_MS)
    assert window.authoring.document.database.content_hash == ours.content_hash


def test_a_saved_plan_comes_back_and_a_broken_one_is_refused_in_one_sentence(
    assistant, grid_examples, tmp_path, monkeypatch, give_folder, click, settled
):
    give_folder(assistant, grid_examples)
    before = assistant.draft.plan
    path = tmp_path / "plan.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_, **__: (str(path), ""))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, **__: (str(path), ""))
    click(assistant.save_button)
    click(assistant.over_button)
    assert assistant.draft.plan is None and assistant.files.is_empty
    click(assistant.load_button)
    settled(assistant)
    assert assistant.draft.plan == before
    path.write_text(path.read_text().replace('"neutral"', '"bored"', 1))
    click(assistant.load_button)
    assert "bored" in assistant.message.text and str(path) in assistant.message.text
    assert assistant.draft.plan == before


def test_a_sentence_that_cannot_be_read_is_told_and_the_others_are_built(
    assistant, grid_examples, tmp_path, qtbot, give_folder, go, click
):
    (grid_examples / "bwbn3s.c3d").write_bytes(b"no motion at all")
    give_folder(assistant, grid_examples)
    table = assistant.files.table.sentences
    rows = {table.sentence(r).name: table.problems(table.sentence(r)) for r in range(table.rowCount())}
    assert rows["bwbn3s"][1] and not rows["praj3a"][1]
    go(assistant, assistant.build)
    assistant.build.path.setText(str(tmp_path / "rest.h5"))
    QTest.keyClick(assistant, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: assistant.build.open.isVisible(), timeout=WAIT_MS)
    report = ImportReport.from_dict(open_database(tmp_path / "rest.h5").report[KEY])
    assert [row.sentence for row in report.failures] == ["bwbn3s"]
    assert assistant.build.table.rows[0][0] == "bwbn3s" and "bwbn3s" in assistant.build.table.rows[0][-1]


def test_where_nothing_can_be_written_is_said_in_the_window(assistant, grid_examples, qtbot, give_folder, go, click):
    give_folder(assistant, grid_examples)
    go(assistant, assistant.build)
    assistant.build.path.setText(str(grid_examples / "bwbn3s.flac" / "x.h5"))
    click(assistant.build.build)
    qtbot.waitUntil(lambda: bool(assistant.message.text), timeout=WAIT_MS)
    assert "bwbn3s.flac" in assistant.message.text
    assert not assistant.build.open.isVisible()
