import numpy as np
import pytest

from core.motion.node import NIL
from core.search.replicate import replicated


def test_the_first_round_is_the_database_and_later_ones_vary(random_motion):
    frames, nodes = random_motion(1)
    many_frames, many = replicated(frames, nodes, 3 * len(nodes) + 5, 120.0)
    assert len(many) == 3 * len(nodes) + 5
    assert len(set(map(many.name, range(len(many))))) == len(many)
    for n in range(len(nodes)):
        copy = many_frames[many.start[n] : many.stop[n]]
        assert np.array_equal(copy, frames[nodes.start[n] : nodes.stop[n]])
        assert many.phoneme[n] == nodes.phoneme[n] and many.emotion[n] == nodes.emotion[n]
        assert (many.pre[n] == NIL) == (nodes.pre[n] == NIL)
    again = len(nodes)
    assert many.phoneme[again : 2 * again].tolist() == nodes.phoneme.tolist()
    first, second = (many_frames[many.start[n]] for n in (0, again))
    assert np.abs(first - second).max() > 1e-3


@pytest.mark.parametrize("n_nodes", [1, 7, 20])
def test_fewer_nodes_than_there_are(random_motion, n_nodes):
    frames, nodes = random_motion(2)
    fewer_frames, fewer = replicated(frames, nodes, n_nodes, 120.0)
    assert len(fewer) == n_nodes
    assert fewer.stop.max() == len(fewer_frames)


def test_it_is_the_same_every_time(random_motion):
    frames, nodes = random_motion(3)
    one, _ = replicated(frames, nodes, 100, 120.0)
    two, _ = replicated(frames, nodes, 100, 120.0)
    assert np.array_equal(one, two)
