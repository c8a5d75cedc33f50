"""Concatenation, join smoothing, silence."""

import numpy as np
import pytest

from core.motion.node import NIL
from core.speech.phoneme import PHONEMES
from core.synthesis.concatenate import SlotFrames, concatenate
from core.synthesis.silence import regenerate_silence
from core.synthesis.smoothing import join_windows, smooth_joins

PAU, AA, P = (PHONEMES.index(phone) for phone in ("pau", "aa", "p"))


def slots_of(lengths):
    stop = np.cumsum(lengths)
    return SlotFrames(stop - np.asarray(lengths), stop)


def test_a_captured_sentence_at_its_own_pace_comes_back_unchanged(random_motion):
    frames, nodes = random_motion(1, phones="aa b k iy")
    rows = np.flatnonzero(nodes.sentence == 0)
    slots = slots_of(nodes.n_frames[rows])
    laid = concatenate(rows, slots, frames, nodes)
    assert laid == pytest.approx(frames[nodes.start[rows[0]] : nodes.stop[rows[-1]]])
    assert smooth_joins(laid, rows, nodes.phoneme[rows], slots, nodes) == pytest.approx(laid)


def test_warping_keeps_the_ends_of_each_node(random_motion):
    frames, nodes = random_motion(2)
    path = np.array([3, 10, 5])
    slots = slots_of([20, 7, 31])
    laid = concatenate(path, slots, frames, nodes)
    for p, row in enumerate(path):
        assert laid[slots.start[p]] == pytest.approx(frames[nodes.start[row]])
        assert laid[slots.stop[p] - 1] == pytest.approx(frames[nodes.stop[row] - 1])


def test_slots_share_boundaries_and_cover_the_sound():
    slots = SlotFrames.of([0, 0.0511, 0.052, 1.0], [0.0511, 0.052, 1.0, 2.978], 120)
    assert (slots.start[1:] == slots.stop[:-1]).all()
    assert slots.n_frames == 357
    assert SlotFrames.of([0], [0.001], 120).n_frames == 1


def jump(phones=(AA, AA), size=10.0):
    """Two nodes of different sentences that stand still at 0 and at ``size``."""
    motion = np.zeros((40, 2))
    motion[20:] = size
    return motion, np.array([0, 1]), np.array(phones), slots_of([20, 20])


class Strangers:
    pre = np.array([NIL, NIL])


def test_a_jump_is_smoothed_only_in_its_window():
    motion, path, phones, slots = jump()
    smoothed = smooth_joins(motion, path, phones, slots, Strangers)
    changed = np.flatnonzero(np.abs(smoothed - motion).max(axis=1) > 1e-9)
    assert changed.min() >= 17 and changed.max() < 23
    assert np.abs(np.diff(smoothed[:, 0])).max() < 0.7 * 10
    bent = np.abs(np.diff(smoothed, 2, axis=0)).sum(), np.abs(np.diff(motion, 2, axis=0)).sum()
    assert bent[0] < bent[1] / 2


def test_the_smoothed_window_minimises_equation_16():
    """Against a dense minimiser of the same objective on a fine grid, ends tied."""
    motion, path, phones, slots = jump(phones=(P, AA))
    smoothed = smooth_joins(motion, path, phones, slots, Strangers)[:, 0]
    fine = 40
    grid = np.arange(15, 24 + 1e-9, 1 / fine)
    bend = np.diff(np.eye(len(grid)), 2, axis=0) * fine**2 / np.sqrt(fine)
    at = np.zeros((10, len(grid)))
    at[np.arange(10), np.arange(10) * fine] = 1
    weights = np.array([1e5, 1e5, 2, 2, 2, 1, 1, 1, 1e5, 1e5])
    system = bend.T @ bend + at.T @ (weights[:, None] * at)
    best = np.linalg.solve(system, at.T @ (weights * motion[15:25, 0]))
    assert smoothed[15:25] == pytest.approx(at @ best, abs=0.03)


def test_visible_phones_hold_harder():
    loose = smooth_joins(*jump(phones=(AA, AA)), Strangers)
    held = smooth_joins(*jump(phones=(P, AA)), Strangers)
    assert np.abs(held[17:20, 0]).sum() < np.abs(loose[17:20, 0]).sum()


def test_overlapping_windows_become_one():
    nodes = type("N", (), {"pre": np.full(4, NIL)})
    path, phones = np.arange(4), np.full(4, AA)
    windows = join_windows(path, phones, slots_of([20, 3, 2, 20]), nodes, 3, 45)
    assert windows == [(17, 28)]


def test_joins_to_silence_and_captured_ones_are_left():
    nodes = type("N", (), {"pre": np.array([NIL, 0, NIL])})
    assert join_windows(np.array([0, 1, 2]), np.array([AA, AA, PAU]), slots_of([9, 9, 9]), nodes, 3, 27) == []


@pytest.mark.parametrize("interpolation", ["linear", "cubic", "cosine"])
def test_silence_inside_runs_between_its_neighbours(interpolation):
    motion = np.zeros((30, 2))
    motion[:10], motion[20:] = 1.0, 3.0
    filled = regenerate_silence(motion, [AA, PAU, AA], slots_of([10, 10, 10]), np.zeros(2), 120, interpolation)
    assert filled[9] == pytest.approx([1, 1])
    assert filled[20] == pytest.approx([3, 3])
    assert (np.diff(filled[9:21, 0]) > 0).all()
    assert filled[14:16, 0].mean() == pytest.approx(2.0, abs=1e-9)


def test_silence_at_the_ends_eases_to_rest():
    motion = np.full((200, 1), 5.0)
    filled = regenerate_silence(motion, [PAU, AA, PAU], slots_of([80, 40, 80]), np.array([1.0]), 120)
    assert filled[:50] == pytest.approx(1.0)
    assert filled[-50:] == pytest.approx(1.0)
    assert filled[80:120] == pytest.approx(5.0)
    assert np.abs(np.diff(filled[:, 0])).max() < 0.3


def test_all_silence_is_rest():
    filled = regenerate_silence(np.ones((50, 2)), [PAU], slots_of([50]), np.array([4.0, 2.0]), 120)
    assert filled == pytest.approx(np.tile([4.0, 2.0], (50, 1)))
