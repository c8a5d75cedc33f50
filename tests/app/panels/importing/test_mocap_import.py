"""Real markers with gaps, a spike and a swap: seen in the window, mended near what they were, and they move a face."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.pictures import FaceRig
from core.face.default_face import FaceUnavailable
from core.motion.marker_set import MarkerSet
from core.motion.motion_files import read_motion
from core.motion.normalise import normalise

WAIT_MS = 60_000


def _cell(table, row, column):
    return table.rows[row][column]


def test_what_was_planted_is_listed_worst_first_and_a_limit_closes_the_long_gap(
    assistant, mocap, give_folder, go, settled, qtbot
):
    give_folder(assistant, mocap[0])
    go(assistant, assistant.mend)
    page = assistant.mend
    assert _cell(page.sentences, 0, 0) == "Jaw"
    told = [(what, marker) for what, marker, *_ in page.events.rows]
    assert ("gap, filled", "Chin") in told and ("gap, open", "Rcheek_Up") in told and ("spike", "Mouth_Up") in told
    assert any(what == "swap" and "Mouth_UpL1" in marker and "Mouth_Lend" in marker for what, marker in told)
    page.events.choose(told.index(("spike", "Mouth_Up")))
    assert page.marker.currentText() == "Mouth_Up"
    before = page._picture.before[450, page._picture.names.index("Mouth_Up"), 1]
    after = page._picture.after[450, page._picture.names.index("Mouth_Up"), 1]
    assert before - after == pytest.approx(15.0, abs=1.0)
    page.longest.setFocus()
    page.longest.selectAll()
    QTest.keyClicks(page.longest, "1.2")
    qtbot.waitUntil(lambda: assistant.draft.plan.mending.longest_gap_s == 1.2, timeout=WAIT_MS)
    settled(assistant)
    assert ("gap, filled", "Rcheek_Up") in [(what, marker) for what, marker, *_ in page.events.rows]
    assistant.draft.undo_stack.undo()
    assert page.longest.value() == 0.5


def test_takes_without_speech_are_no_database_and_the_window_says_what_else_they_can_be(
    assistant, mocap, tmp_path, qtbot, give_folder, go, click
):
    give_folder(assistant, mocap[0])
    go(assistant, assistant.build)
    assistant.build.path.setText(str(tmp_path / "mocap.h5"))
    click(assistant.build.build)
    qtbot.waitUntil(lambda: bool(assistant.message.text), timeout=WAIT_MS)
    assert "speech" in assistant.message.text and "film" in assistant.message.text
    assert not (tmp_path / "mocap.h5").exists()


def test_the_mended_motion_is_near_what_was_captured_and_drives_a_face(
    assistant, mocap, tmp_path, qtbot, give_folder, go, click, monkeypatch
):
    folder, whole, names = mocap
    give_folder(assistant, folder)
    go(assistant, assistant.build)
    assistant.build.path.setText(str(tmp_path / "mended.c3d"))
    click(assistant.build.build)
    qtbot.waitUntil(lambda: (tmp_path / "mended-Jaw.c3d").is_file() and assistant.jobs.is_idle, timeout=WAIT_MS)
    face, written, rate_hz = read_motion(tmp_path / "mended-Jaw.c3d")
    plan, chin = assistant.draft.plan, names.index("Chin")
    assert written == names and rate_hz == 30.0
    rows = [names.index(name) for name in plan.rigid]
    clean, _ = normalise(whole["Jaw"][::2], face[0].astype(float), rows, names.index(plan.origin))
    swing_mm = np.linalg.norm(np.ptp(clean[:, chin], axis=0))
    off_mm = np.linalg.norm(face[100:106, chin] - clean[100:106, chin], axis=1)
    assert off_mm.max() < 0.1 * swing_mm
    monkeypatch.delenv("EFASE_DATA_DIR")  # the face that this machine has
    markers = MarkerSet(names, face[0], plan.groups, plan.landmarks)
    try:
        rig = FaceRig.of("default", markers)
    except FaceUnavailable as error:
        pytest.skip(str(error))
    open_frame = int(np.argmin(face[:, chin, 1]))
    moved = rig.pose(face[open_frame] - face[0]) - rig.face.positions
    assert moved[rig.vertices[chin], 1] < -0.2 * swing_mm  # the mesh's chin goes down with the actor's


def test_a_click_on_a_dot_changes_the_head_and_undo_brings_it_back(assistant, mocap, give_folder, go, click):
    give_folder(assistant, mocap[0])
    go(assistant, assistant.head)
    before = assistant.draft.plan.rigid
    assert len(before) >= 4
    name = before[0]
    click(assistant.head.view, assistant.head.view.place_of(name))
    assert name not in assistant.draft.plan.rigid
    QTest.keyClick(assistant, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert assistant.draft.plan.rigid == before
