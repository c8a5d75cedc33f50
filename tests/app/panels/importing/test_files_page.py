"""Files become sentences; what is chosen or typed in the table goes into the plan, and comes back by undo."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QFileDialog

CTRL = Qt.KeyboardModifier.ControlModifier


def _name(table, row):
    return table.sorted.index(row, 0).data()


def _click_row(table, row, modifier=Qt.KeyboardModifier.NoModifier):
    place = table.visualRect(table.sorted.index(row, 0)).center()
    QTest.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, modifier, QPoint(place))


def test_an_empty_page_says_what_to_do(assistant):
    assert assistant.files.is_empty
    assert not assistant.save_button.isEnabled()
    for page in assistant.pages[1:]:
        assistant.steps.setCurrentRow(assistant.pages.index(page))
        assert page.is_empty


def test_dropped_files_are_listed_with_rate_frames_and_problems(assistant, grid_examples, settled):
    (grid_examples / "praj3a.TextGrid").unlink()
    (grid_examples / "lbay1a.flac").unlink()
    urls = QMimeData()
    urls.setUrls([QUrl.fromLocalFile(str(path)) for path in sorted(grid_examples.iterdir())])
    drop = QDropEvent(QPointF(5, 5), Qt.DropAction.CopyAction, urls, Qt.MouseButton.LeftButton,
                      Qt.KeyboardModifier.NoModifier)  # fmt: skip
    assistant.files.dropEvent(drop)
    settled(assistant)
    table = assistant.files.table.sentences
    shown = {table.index(r, 0).data(): [table.index(r, c).data() for c in range(1, 8)] for r in range(4)}
    assert shown["bwbn3s"][0:2] == ["bwbn3s.c3d", "bwbn3s.flac"]
    assert shown["bwbn3s"][4:] == ["25 Hz", 75, ""]  # 3 s at 25 frames a second, as the set's own notes say
    assert "recognised" in shown["praj3a"][6] and "silence" in shown["lbay1a"][6]


def test_keys_set_the_emotion_of_all_selected_rows_in_one_step(assistant, grid_examples, give_folder):
    give_folder(assistant, grid_examples)
    table = assistant.files.table
    _click_row(table, 0)
    _click_row(table, 2, CTRL)
    chosen = {_name(table, 0), _name(table, 2)}
    QTest.keyClick(table, Qt.Key.Key_3)
    felt = {s.name: s.emotion for s in assistant.draft.sentences}
    assert {name for name, emotion in felt.items() if emotion == "anger"} == chosen
    assert set(table.chosen) == chosen  # still selected, to go on
    QTest.keyClick(table, Qt.Key.Key_Z, CTRL)
    assert {s.emotion for s in assistant.draft.sentences} == {"neutral"}


def test_sentences_are_left_out_and_brought_back(assistant, grid_examples, give_folder):
    give_folder(assistant, grid_examples)
    table = assistant.files.table
    _click_row(table, 1)
    gone = _name(table, 1)
    QTest.keyClick(table, Qt.Key.Key_Delete)
    assert gone not in [s.name for s in assistant.draft.sentences] and len(assistant.draft.sentences) == 3
    assistant.draft.undo_stack.undo()
    assert gone in [s.name for s in assistant.draft.sentences]


def test_typed_words_take_the_place_of_a_transcript_file(assistant, grid_examples, give_folder, qtbot):
    give_folder(assistant, grid_examples)
    table = assistant.files.table
    table.setCurrentIndex(table.sorted.index(0, 3))
    table.setFocus()
    QTest.keyClick(table, Qt.Key.Key_F2)
    editor = table.viewport().findChild(type(assistant.build.name))
    QTest.keyClicks(editor, "bin white  by n")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    name = _name(table, 0)
    qtbot.waitUntil(lambda: any(s.name == name and bool(s.text) for s in assistant.draft.sentences))
    changed = next(s for s in assistant.draft.sentences if s.name == name)
    assert (changed.text, changed.transcript) == ("bin white by n", None)


def test_files_without_motion_are_refused_in_one_sentence(assistant, tmp_path, give_folder):
    soundfile.write(tmp_path / "alone.wav", [0.0] * 16_000, 16_000)
    give_folder(assistant, tmp_path)
    assert "no motion" in assistant.message.text
    assert assistant.draft.plan is None
    give_folder(assistant, tmp_path / "nowhere")
    assert "nowhere" in assistant.message.text


def test_a_rate_that_the_user_states_wins_and_all_is_read_anew(assistant, grid_examples, give_folder, settled):
    give_folder(assistant, grid_examples)
    row = assistant.files.reading
    row.rate.setFocus()
    row.rate.selectAll()
    QTest.keyClicks(row.rate, "50")
    QTest.keyClick(row.rate, Qt.Key.Key_Return)
    settled(assistant)
    assert assistant.draft.plan.reading.rate_hz == 50.0
    assert {facts.rate_hz for facts in assistant.draft.facts.values()} == {50.0}


@pytest.mark.filterwarnings("ignore:Reading `.npy`")  # written by Python 2
def test_arrays_of_weights_say_what_they_need_and_are_markers_once_they_have_it(
    assistant, shared_data, tmp_path, give_folder, monkeypatch, click, settled
):
    source, folder = shared_data("facegood"), tmp_path / "weights"
    folder.mkdir()
    weights = np.load(source / "bs_value" / "bs_value_1114_2_01.npy", allow_pickle=False)
    np.save(folder / "take.npy", np.asarray(weights)[:200])
    give_folder(assistant, folder)
    assert "names" in assistant.message.text
    for button, name in (
        (assistant.files.reading.names, "shirley_1015_bs_name.npy"),
        (assistant.files.reading.sheet, "Voice2Face_blendshape2ARkit.xlsx"),
    ):
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, name=name: (str(source / name), ""))
        click(button)
        settled(assistant)
    facts = assistant.draft.facts["take"]
    assert facts.problem == "" and facts.n_frames == 200 and facts.rate_hz == 30.0
    assert not assistant.message.text
    assert assistant.draft.plan.landmarks["chin"] in facts.names and len(assistant.draft.plan.rigid) >= 3


def test_an_emotion_is_chosen_in_its_cell(assistant, grid_examples, give_folder, qtbot):
    give_folder(assistant, grid_examples)
    table = assistant.files.table
    table.setCurrentIndex(table.sorted.index(1, 4))
    table.setFocus()
    QTest.keyClick(table, Qt.Key.Key_F2)
    editor = table.viewport().findChild(QComboBox)
    QTest.keyClick(editor.view(), Qt.Key.Key_Down)
    QTest.keyClick(editor.view(), Qt.Key.Key_Return)
    name = _name(table, 1)
    qtbot.waitUntil(lambda: next(s.emotion for s in assistant.draft.sentences if s.name == name) == "happiness")
