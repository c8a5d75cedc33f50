"""Real markers with gaps, a spike and a swap: seen in the window, mended near what they were, and they move a face."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.pictures import FaceRig
from core.face.default_face import FaceUnavailable
from core.motion.database import open_database

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


def test_the_database_that_is_built_holds_the_mended_motion_and_drives_a_face(
    assistant, mocap, tmp_path, qtbot, give_folder, go, click, monkeypatch
):
    folder, whole, names = mocap
    give_folder(assistant, folder)
    go(assistant, assistant.build)
    assistant.build.path.setText(str(tmp_path / "mocap.h5"))
    click(assistant.build.build)
    qtbot.waitUntil(lambda: assistant.build.open.isVisible(), timeout=WAIT_MS)
    database = open_database(tmp_path / "mocap.h5")
    assert database.markers.names == names
    jaw = next(s for s in database.sentences if s.name == "Jaw")
    face = database.pca.positions(database.frames[jaw.start_frame : jaw.stop_frame].astype(float))
    clean = _in_head_space(whole["Jaw"], database)
    at = np.arange(200, 212) * 2  # 60 Hz to 120 Hz
    chin = names.index("Chin")
    off_mm = np.linalg.norm(face[at, chin] - clean[200:212, chin], axis=1)
    swing_mm = np.linalg.norm(np.ptp(clean[:, chin], axis=0))
    assert off_mm.max() < 0.1 * swing_mm
    monkeypatch.delenv("EFASE_DATA_DIR")  # the face that this machine has
    try:
        rig = FaceRig.of("default", database.markers)
    except FaceUnavailable as error:
        pytest.skip(str(error))
    open_frame = int(np.argmin(face[:, chin, 1]))
    moved = rig.pose(face[open_frame] - database.markers.rest) - rig.face.positions
    assert moved[rig.vertices[chin], 1] < -0.2 * swing_mm  # the mesh's chin goes down with the actor's


def _in_head_space(positions, database):
    from core.motion.head_space import in_head_space
    from core.motion.recording import Recording
    from core.speech.transcript import Transcript

    transcript = Transcript.covering([], [], len(positions) / 60.0)
    recording = Recording("Jaw", "neutral", positions, database.markers.names, 60.0, transcript)
    return in_head_space(recording, database.markers, False).face


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
