"""Every pairwise term against a pair-by-pair computation from the equations."""

import numpy as np
import pytest

from core.motion.node import NIL
from core.search.terms import (
    TransitionTerms,
    default_weights,
    emotion_mismatch_penalties,
    observation_costs,
    warp_matrix,
)
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights
from core.speech.phoneme import PHONEMES, viseme_of

RATE = 120.0


def by_hand(frames, nodes, n, m):
    """PGap, VGap and DSC of one pair, straight from equations 6 to 9."""

    def velocity(at, node):
        mine = nodes.sentence == nodes.sentence[node]
        low, high = nodes.start[mine].min(), nodes.stop[mine].max() - 1
        before, after = max(at - 1, low), min(at + 1, high)
        return (frames[after] - frames[before]) * RATE / max(after - before, 1)

    def warped(node, length):
        own = frames[nodes.start[node] : nodes.stop[node]].astype(float)
        at = np.linspace(0, len(own) - 1, length)
        return np.stack([np.interp(at, np.arange(len(own)), column) for column in own.T], axis=1)

    frames = frames.astype(float)
    first, last = nodes.start[m], nodes.stop[n] - 1
    position = ((frames[first] - frames[last]) ** 2).sum()
    speed = ((velocity(first, m) - velocity(last, n)) ** 2).sum()
    pre = nodes.pre[m]
    length = max(nodes.stop[pre] - nodes.start[pre], 3)
    fade = np.linspace(1, 0, length)[:, None]
    blend = fade * warped(n, length) + (1 - fade) * warped(pre, length)
    curvature = np.diff(blend, n=2, axis=0) * RATE**2
    return position, speed, (curvature**2).sum() / RATE


def test_terms_equal_pairwise_computation(random_motion):
    frames, nodes = random_motion(1)
    terms = TransitionTerms(frames, nodes, RATE)
    seen = set()
    for block in terms.blocks(most_bytes=3 * 8 * len(nodes)):
        for row, m in enumerate(block.targets):
            seen.add(int(m))
            for n in range(len(nodes)):
                position, speed, smoothing = by_hand(frames, nodes, n, m)
                assert block.position_gap[row, n] == pytest.approx(position, rel=1e-9, abs=1e-9)
                assert block.velocity_gap[row, n] == pytest.approx(speed, rel=1e-9, abs=1e-6)
                assert block.smoothing[row, n] == pytest.approx(smoothing, rel=1e-9, abs=1e-3)
                differs = nodes[n].viseme != nodes[nodes.pre[m]].viseme
                assert block.viseme_differs[row, n] == differs
    assert seen == set(np.flatnonzero(nodes.pre != NIL).tolist())


def test_transition_rules_in_their_order(random_motion):
    frames, nodes = random_motion(2)
    weights = SearchWeights(pnt=10.0, alpha1=2.0, alpha2=1e-6, alpha3=3.0)
    matrix = TransitionCosts(TransitionTerms(frames, nodes, RATE), weights).matrix
    for m in range(len(nodes)):
        for n in range(len(nodes)):
            if nodes.pre[m] == n:
                expected = 0.0
            elif nodes.pre[m] == NIL:
                expected = 20.0
            else:
                position, speed, smoothing = by_hand(frames, nodes, n, m)
                expected = 1e-6 * smoothing + 3.0 * position + speed
                expected += 10.0 * (nodes[n].viseme != nodes[nodes.pre[m]].viseme)
            assert matrix[m, n] == pytest.approx(expected, rel=2e-7, abs=1e-6)


def test_a_node_whose_last_frame_is_the_next_ones_first_has_no_position_gap(random_motion):
    frames, nodes = random_motion(3)
    m = int(np.flatnonzero(nodes.pre != NIL)[0])
    n = int(np.flatnonzero(nodes.sentence != nodes.sentence[m])[0])
    frames[nodes.stop[n] - 1] = frames[nodes.start[m]]
    (block,) = TransitionTerms(frames, nodes, RATE).blocks(np.array([m]))
    assert block.position_gap[0, n] == pytest.approx(0.0, abs=1e-9)


def test_observation_costs_are_table_2(random_motion):
    _, nodes = random_motion(4, phones="aa ah b p iy")
    weights = SearchWeights(pnt=10.0, alpha4=0.3, alpha5=5.0)
    wanted = ["aa", "pau", "p", "zh"]
    costs = observation_costs(np.array([PHONEMES.index(p) for p in wanted]), nodes, weights)
    for slot, phone in enumerate(wanted):
        for n in range(len(nodes)):
            if phone in ("pau", nodes[n].phone):
                expected = 0.0
            else:
                expected = 15.0 if viseme_of(phone) == nodes[n].viseme else 50.0
            assert costs[slot, n] == pytest.approx(expected)


def test_emotion_penalty_is_equation_5_when_pure_and_linear_between(random_motion):
    _, nodes = random_motion(5)
    weights = SearchWeights(pnt=10.0, alpha6=2.0)
    penalties = emotion_mismatch_penalties(np.array([[0, 0, 1, 0], [0.6, 0, 0.4, 0]]), nodes, weights)
    assert np.array_equal(penalties[0], np.where(nodes.emotion == 2, 0.0, 20.0))
    assert penalties[1] == pytest.approx(20.0 * (1 - np.choose(nodes.emotion, [0.6, 0, 0.4, 0])))


@pytest.mark.parametrize(("n_frames", "length"), [(1, 4), (2, 3), (7, 3), (5, 5), (4, 1)])
def test_warp_keeps_ends_and_lines(n_frames, length):
    matrix = warp_matrix(n_frames, length)
    assert matrix.sum(axis=1) == pytest.approx(np.ones(length))
    line = matrix @ np.arange(n_frames)
    if length > 1:
        assert line == pytest.approx(np.linspace(0, n_frames - 1, length))


def test_default_weights_balance_the_terms(random_motion):
    frames, nodes = random_motion(6, n_sentences=20)
    weights = default_weights(frames, nodes, RATE)
    blocks = list(TransitionTerms(frames, nodes, RATE).blocks())
    position = np.concatenate([b.position_gap.ravel() for b in blocks])
    velocity = np.concatenate([b.velocity_gap.ravel() for b in blocks])
    smoothing = np.concatenate([b.smoothing.ravel() for b in blocks])
    assert weights.alpha3 * np.median(position) == pytest.approx(np.median(velocity))
    assert weights.pnt == pytest.approx(np.median(weights.alpha3 * position + velocity))
    assert weights.alpha2 * np.median(smoothing) == pytest.approx(weights.pnt / 4)
