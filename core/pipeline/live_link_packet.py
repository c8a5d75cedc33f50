"""One frame as the UDP packet that Live Link Face's application sends to Unreal, Blender add-ons and others.

    uint8 version 6 | int32 length and text: device id of 36 letters | int32 length and text: subject name
    | int32 frame | float32 part of a frame | int32 rate numerator | int32 denominator | uint8 61 | 61 float32

all big-endian. The 61 values stand in the order of Unreal's ``EARFaceBlendShape``, which has left before right all
through, unlike the columns of the application's CSV (`core.motion.live_link_face`).
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

from core.motion.blendshape_track import ARKIT_UNITS, HEAD_AND_EYES

VERSION = 6
PORT = 11111
_SWAPPED = {"jawRight": "jawLeft", "jawLeft": "jawRight", "mouthRight": "mouthLeft", "mouthLeft": "mouthRight"}
UNITS: tuple[str, ...] = tuple(_SWAPPED.get(name, name) for name in ARKIT_UNITS)
N_VALUES = len(UNITS) + len(HEAD_AND_EYES)


def live_link_packet(
    weights: Sequence[float], angles: Sequence[float], frame: int, rate_hz: int, device: str, subject: str
) -> bytes:
    """Return the bytes of a packet.

    weights : of `UNITS`, 0..1; angles : of `core.motion.blendshape_track.HEAD_AND_EYES`, radians
    frame : counted at ``rate_hz`` from midnight, as a timecode counts
    device : an identifier of 36 letters, the same for all packets of a stream; subject : the name that receivers show
    """
    values = (*weights, *angles)
    if len(values) != N_VALUES or len(device) != 36:
        raise ValueError(f"{len(values)} values and a device id of {len(device)} letters; {N_VALUES} and 36 are needed")
    name = subject.encode("utf-8")
    return b"".join((
        struct.pack(">Bi36s", VERSION, len(device), device.encode("ascii")),
        struct.pack(f">i{len(name)}s", len(name), name),
        struct.pack(">ifiiB", frame, 0.0, rate_hz, 1, N_VALUES),
        struct.pack(f">{N_VALUES}f", *values),
    ))  # fmt: skip
