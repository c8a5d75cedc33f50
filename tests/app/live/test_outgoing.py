"""Frames that leave are read back from the socket by parsers that know nothing of how they were made."""

from __future__ import annotations

import socket
import struct

import numpy as np
import pytest

from app.live.outgoing import Outgoing, StreamAddress
from core.errors import UserFacingError
from core.motion.marker_set import MarkerSet
from core.pipeline import live_weights

NAMES = ("jawOpen", "mouthLeft", "mouthRight", "tongueOut", "a studio's own")


@pytest.fixture
def receiver():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as heard:
        heard.bind(("127.0.0.1", 0))
        heard.settimeout(5)
        yield heard


@pytest.fixture
def markers(monkeypatch):
    """Five markers, each moved upwards by one unit alone, 10 mm at full strength."""
    units = np.zeros((5, 5, 3))
    units[range(5), range(5), 1] = 10.0
    monkeypatch.setattr(live_weights, "units_at_markers", lambda face, markers: (NAMES, units))
    return MarkerSet(tuple("abcde"), np.arange(15.0).reshape(5, 3))


def sent(form, receiver, markers, lift_mm):
    outgoing = Outgoing(StreamAddress(form, "127.0.0.1", receiver.getsockname()[1]), None, markers)
    moved = markers.rest.copy()
    moved[:, 1] += lift_mm
    outgoing.send(moved)
    outgoing.close()
    assert (outgoing.n_sent, outgoing.n_refused) == (1, 0)
    return receiver.recv(65_536)


def test_unreal_sees_the_jaw_open_and_the_mouth_on_its_right_side(receiver, markers):
    data = sent("udp", receiver, markers, [5.0, 0.0, 10.0, 0.0, 7.0])
    name_end = 45 + struct.unpack("!i", data[41:45])[0]
    assert data[0] == 6 and data[45:name_end] == b"efase"
    frame, _, rate, denominator, n = struct.unpack("!if2ib", data[name_end : name_end + 17])
    values = struct.unpack("!61f", data[name_end + 17 :])
    assert (rate, denominator, n) == (30, 1, 61) and 0 <= frame < 24 * 3600 * 30
    # places in Unreal's list: JawOpen 17, MouthLeft 21, MouthRight 22
    assert values[17] == pytest.approx(0.5, abs=0.01) and values[22] == pytest.approx(1.0, abs=0.01)
    assert values[21] == 0.0 and sum(value > 0 for value in values) == 2


def test_vmc_hears_each_unit_by_its_name(receiver, markers):
    data = sent("osc", receiver, markers, [5.0, 0.0, 0.0, 10.0, 0.0])
    assert data.startswith(b"#bundle\0") and data.count(b"/VMC/Ext/Blend/Val\0") == 52
    at = data.index(b"jawOpen\0")
    assert struct.unpack(">f", data[at + 8 : at + 12])[0] == pytest.approx(0.5, abs=0.01)
    at = data.index(b"tongueOut\0\0\0")
    assert struct.unpack(">f", data[at + 12 : at + 16])[0] == pytest.approx(1.0, abs=0.01)
    assert data.endswith(b"/VMC/Ext/Blend/Apply\0\0\0\0,\0\0\0")


def test_nobody_needs_to_listen(markers):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as gone:
        gone.bind(("127.0.0.1", 0))
        port = gone.getsockname()[1]
    outgoing = Outgoing(StreamAddress("udp", "127.0.0.1", port), None, markers)
    for _ in range(3):
        outgoing.send(markers.rest)
    assert outgoing.n_sent + outgoing.n_refused == 3
    outgoing.close()


NO_ADDRESSES = [
    "udp://localhost:9?x", "udp://localhost:9#x",
    "", "127.0.0.1:11111", "udp://127.0.0.1", "udp://:11111", "udp://h:99999", "tcp://127.0.0.1:1", "udp://h:x",
    "udp://h:1/face", "udp://me@h:1", "udp://[h:1",
]  # fmt: skip


@pytest.mark.parametrize("address", NO_ADDRESSES)
def test_an_address_that_is_none_is_one_sentence(address):
    with pytest.raises(UserFacingError, match="is no address") as raised:
        StreamAddress.parsed(address)
    assert "udp://HOST:PORT" in raised.value.remedy


def test_addresses_are_said_as_they_are_written(markers):
    for address in ("udp://127.0.0.1:11111", "osc://[::1]:39539"):
        assert str(StreamAddress.parsed(address)) == address
    with pytest.raises(UserFacingError, match=r"host 'no\.such\.host\.invalid'"):
        Outgoing(StreamAddress.parsed("udp://no.such.host.invalid:1"), None, markers)
