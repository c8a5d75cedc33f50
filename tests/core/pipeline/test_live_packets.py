"""Packets are read back by parsers that know nothing of how they were made."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from core.motion.blendshape_track import ARKIT_UNITS, HEAD_AND_EYES
from core.pipeline.live_link_packet import UNITS, live_link_packet
from core.pipeline.osc_packet import osc_packet

# Unreal's EARFaceBlendShape, typed from its header; the application's CSV has right before left at jaw and mouth
UNREAL = (
    "EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft "
    "EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight "
    "EyeWideRight JawForward JawLeft JawRight JawOpen MouthClose MouthFunnel MouthPucker MouthLeft "
    "MouthRight MouthSmileLeft MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft "
    "MouthDimpleRight MouthStretchLeft MouthStretchRight MouthRollLower MouthRollUpper MouthShrugLower "
    "MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft MouthLowerDownRight "
    "MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft "
    "BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut "
    "HeadYaw HeadPitch HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch "
    "RightEyeRoll "
)
DEVICE = "6C1A8F5E-0D5B-4A5C-9D3C-0123456789AB"


def read_live_link(data: bytes) -> dict:
    """Read a packet as receivers in public do: a little-endian version, '$' and 36 letters, then big-endian fields."""
    (version,) = struct.unpack("<i", data[:4])
    device = data[4:41].decode()
    (length,) = struct.unpack("!i", data[41:45])
    end = 45 + length
    frame, part, rate, denominator, n = struct.unpack("!if2ib", data[end : end + 17])
    values = dict(zip(UNREAL.split(), struct.unpack(f"!{n}f", data[end + 17 :])))
    return {"version": version, "device": device, "subject": data[45:end].decode(), "frame": frame, "part": part,
        "rate": rate / denominator, "values": values}  # fmt: skip


def test_a_live_link_packet_is_what_unreal_reads():
    weights = np.linspace(0.0, 1.0, len(UNITS)).tolist()
    angles = [0.1 * a for a in range(9)]
    got = read_live_link(live_link_packet(weights, angles, 123456, 30, DEVICE, "Käthe"))
    assert (got["version"], got["device"], got["subject"]) == (6, "$" + DEVICE, "Käthe")
    assert (got["frame"], got["part"], got["rate"]) == (123456, 0.0, 30.0)
    sent = dict(zip([name.lower() for name in (*UNITS, *HEAD_AND_EYES)], [*weights, *angles]))
    assert len(got["values"]) == 61 and set(UNITS) == set(ARKIT_UNITS)
    for name, value in got["values"].items():
        assert value == pytest.approx(sent[name.lower()], abs=1e-6), name


def test_a_packet_of_too_few_values_is_our_own_mistake():
    with pytest.raises(ValueError, match="60 values"):
        live_link_packet([0.0] * 51, [0.0] * 9, 0, 30, DEVICE, "a")


def read_osc(data: bytes) -> list[tuple]:
    """Read a bundle of OSC 1.0 messages of strings and floats, written from its specification."""

    def text(data, at):
        end = data.index(b"\0", at)
        return data[at:end].decode(), (end // 4 + 1) * 4

    assert data[:16] == b"#bundle\0" + struct.pack(">Q", 1) and len(data) % 4 == 0
    messages, at = [], 16
    while at < len(data):
        (length,) = struct.unpack(">i", data[at : at + 4])
        message, place = data[at + 4 : at + 4 + length], 0
        address, place = text(message, place)
        tags, place = text(message, place)
        values = []
        for tag in tags[1:]:
            if tag == "s":
                value, place = text(message, place)
            else:
                (value,), place = struct.unpack(">f", message[place : place + 4]), place + 4
            values.append(value)
        assert place == length
        messages.append((address, *values))
        at += 4 + length
    return messages


def test_an_osc_bundle_sets_each_blendshape_and_applies_them():
    names, weights = ("jawOpen", "a", "abc", "abcd"), (0.25, 0.5, 0.75, 1.0)
    *values, last = read_osc(osc_packet(names, weights))
    assert values == [("/VMC/Ext/Blend/Val", name, weight) for name, weight in zip(names, weights)]
    assert last == ("/VMC/Ext/Blend/Apply",)
