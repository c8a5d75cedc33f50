import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.node import NIL, NodeTableBuilder
from core.speech.phoneme import PHONEMES


def table(phones, masked=(), lengths=None):
    ids = [PHONEMES.index(p) for p in phones.split()]
    lengths = np.array(lengths or [4] * len(ids))
    stops = lengths.cumsum()
    mask = np.zeros(stops[-1], bool)
    mask[list(masked)] = True
    builder = NodeTableBuilder()
    left_out = builder.add_sentence("hello: again", 2, ids, stops - lengths, stops, mask, first_frame=100)
    return builder.table(), left_out


def test_silence_makes_no_node_and_breaks_the_chain():
    nodes, _ = table("pau hh ax pau l ow pau")
    assert [nodes[n].phone for n in range(4)] == ["hh", "ax", "l", "ow"]
    assert nodes.pre.tolist() == [NIL, 0, NIL, 2]
    assert nodes.suc.tolist() == [1, NIL, 3, NIL]
    assert nodes[1].triphone == ("hh", "ax", "pau")
    assert nodes[2].triphone == ("pau", "l", "ow")
    assert (nodes[0].start_frame, nodes[0].stop_frame) == (104, 108)


def test_names_go_there_and_back():
    nodes, _ = table("pau hh ax pau l ow pau")
    for n in range(len(nodes)):
        assert nodes.row(nodes.name(n)) == n
    assert nodes.name(3) == "hello: again:3"
    for stranger in ("hello: again:4", "hello", "x:0", "hello: again:-1", ""):
        with pytest.raises(UserFacingError):
            nodes.row(stranger)


def test_a_node_with_masked_frames_is_left_out_and_the_others_keep_their_names():
    nodes, left_out = table("hh ax l ow", masked=[5])
    assert left_out == 1
    assert [nodes.name(n) for n in range(3)] == ["hello: again:0", "hello: again:2", "hello: again:3"]
    assert nodes.pre.tolist() == [NIL, NIL, 1]


def test_a_phone_shorter_than_a_frame_is_left_out():
    nodes, left_out = table("hh ax l", lengths=[4, 0, 4])
    assert left_out == 1
    assert nodes.pre.tolist() == [NIL, NIL]
