"""A planted delay is measured and shifted away; a boundary dragged in the review is in the plan once it is accepted."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.panels.importing.speech_work import SpeechWork
from core.motion.motion_files import read_motion, write_c3d
from core.speech.transcript_files import read_transcript

CTRL = Qt.KeyboardModifier.ControlModifier
LATE_FRAMES, RATE_HZ = 4, 25.0


@pytest.fixture
def late(assistant, grid_examples, give_folder):
    """An assistant with GRID sentences whose motion is 160 ms late."""
    for path in grid_examples.glob("*.c3d"):
        positions, names, rate_hz = read_motion(path)
        write_c3d(path, np.concatenate([np.repeat(positions[:1], LATE_FRAMES, axis=0), positions]), names, rate_hz)
    give_folder(assistant, grid_examples)
    return assistant


def test_a_planted_delay_is_measured_shown_and_taken_out(late, go):
    page, work = late.sound, late.work
    go(late, page)
    delay_ms = 1000 * LATE_FRAMES / RATE_HZ
    assert 1000 * work.session.offset_s == pytest.approx(delay_ms, abs=25.0)
    assert work.session.confidence > 0.5
    sentence = late.draft.sentences[0]
    assert work.taken_out_s(sentence) == 0.0
    page.offsets.setFocus()
    QTest.keyClick(page.offsets, Qt.Key.Key_Down)
    page.offsets.activated.emit(page.offsets.currentIndex())
    assert late.draft.plan.offsets == "session"
    assert work.taken_out_s(sentence) == pytest.approx(work.session.offset_s)


def test_the_slider_shifts_one_sentence_and_a_button_all(late, go, click):
    page, draft = late.sound, late.draft
    go(late, page)
    name = draft.current
    page.slider.setFocus()
    QTest.keyClick(page.slider, Qt.Key.Key_PageUp)
    shifted = {s.name: s.offset_s for s in draft.sentences}
    assert shifted.pop(name) == pytest.approx(0.01) and set(shifted.values()) == {0.0}
    click(page.all)
    assert {s.offset_s for s in draft.sentences} == {0.01}


@pytest.fixture
def few(assistant, grid_examples, give_folder):
    """An assistant with two GRID sentences."""
    for path in grid_examples.glob("l*"):
        path.unlink()
    give_folder(assistant, grid_examples)
    return assistant


@pytest.fixture
def reviewing(few, go, monkeypatch):
    """Looking at them, without the second listening, which takes longest."""
    monkeypatch.setattr(SpeechWork, "listen", lambda _: None)
    go(few, few.review)
    return few


def test_the_least_sure_sentence_is_first(few, go):
    go(few, few.review)
    sure = [few.work.confidence[row[0]].of_sentence for row in few.review.table.rows]
    assert len(sure) == 2 and sure == sorted(sure)


def _drag(lanes, slot, by_px):
    place = lanes.boundary_place(slot)
    start, end = QPoint(round(place.x()), round(place.y())), QPoint(round(place.x()) + by_px, round(place.y()))
    QTest.mousePress(lanes, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(lanes, end)
    QTest.mouseRelease(lanes, Qt.MouseButton.LeftButton, pos=end)


def test_a_dragged_boundary_moves_its_word_too_and_is_kept_when_accepted(reviewing, click, settled):
    page, lanes, draft = reviewing.review, reviewing.review.lanes, reviewing.draft
    name, before = draft.current, lanes.transcript
    words = [w.start_s for w in before.words]
    slot = next(
        i
        for i, u in enumerate(before.phonemes[:-1])
        if any(abs(u.end_s - w) < 1e-3 for w in words) and before.phonemes[i + 1].end_s - u.end_s > 0.08
    )
    _drag(lanes, slot, 12)
    after = lanes.transcript
    one_px_s = 1 / lanes.scale.px_per_s
    assert after.phonemes[slot].end_s - before.phonemes[slot].end_s == pytest.approx(12 * one_px_s, abs=2 * one_px_s)
    assert sum(a != b for a, b in zip(after.words, before.words)) in (1, 2)
    click(page.accept)
    settled(reviewing)
    assert draft.current != name  # on to the next one
    sentence = next(s for s in draft.sentences if s.name == name)
    kept = read_transcript(Path(sentence.transcript), before.duration_s)
    assert [u.phone for u in kept.phonemes] == [u.phone for u in before.phonemes]
    assert kept.phonemes[slot].end_s == pytest.approx(after.phonemes[slot].end_s, abs=1e-4)
    assert page.table.rows[-1][0] == name and page.table.rows[-1][2] == "accepted"
    draft.undo_stack.undo()
    assert next(s for s in draft.sentences if s.name == name).transcript != sentence.transcript


def test_keys_go_through_boundaries_and_sentences(reviewing):
    lanes = reviewing.review.lanes
    before = lanes.transcript
    lanes.setFocus()
    QTest.keyClick(lanes, Qt.Key.Key_Right)
    QTest.keyClick(lanes, Qt.Key.Key_Right)
    QTest.keyClick(lanes, Qt.Key.Key_Right, CTRL)
    moved = lanes.transcript.phonemes[1].end_s - before.phonemes[1].end_s
    assert moved == pytest.approx(0.01)
    QTest.keyClick(lanes, Qt.Key.Key_Escape)
    assert lanes.transcript == before
    first = reviewing.draft.current
    QTest.keyClick(lanes, Qt.Key.Key_PageDown)
    second = reviewing.draft.current
    assert second != first
    QTest.keyClick(lanes, Qt.Key.Key_PageUp)
    assert reviewing.draft.current == first


def test_a_boundary_stays_between_its_neighbours_wherever_it_is_dragged(reviewing):
    lanes = reviewing.review.lanes
    _drag(lanes, 2, 900)
    phonemes = lanes.transcript.phonemes
    assert all(a.end_s == b.start_s and a.end_s > a.start_s for a, b in pairwise(phonemes))
