"""One frame as Open Sound Control messages in the words of the VMC protocol, which Blender and VTuber tools hear.

OSC 1.0: strings end with zeros up to a multiple of 4 bytes, numbers are big-endian; a bundle is ``#bundle``, a time
tag (1: at once) and messages with their lengths. VMC: ``/VMC/Ext/Blend/Val name value`` for each blendshape, then
``/VMC/Ext/Blend/Apply``.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

PORT = 39539
_AT_ONCE = 1
_VALUE, _APPLY = "/VMC/Ext/Blend/Val", "/VMC/Ext/Blend/Apply"


def osc_packet(names: Sequence[str], weights: Sequence[float]) -> bytes:
    """Return a bundle that sets blendshapes ``names`` to ``weights``, 0..1, and applies them."""
    messages = [_message(_VALUE, name, weight) for name, weight in zip(names, weights)]
    parts = [struct.pack(">i", len(message)) + message for message in (*messages, _message(_APPLY))]
    return _text("#bundle") + struct.pack(">Q", _AT_ONCE) + b"".join(parts)


def _message(address: str, *arguments: str | float) -> bytes:
    tags = "," + "".join("s" if isinstance(argument, str) else "f" for argument in arguments)
    data = [_text(a) if isinstance(a, str) else struct.pack(">f", a) for a in arguments]
    return _text(address) + _text(tags) + b"".join(data)


def _text(text: str) -> bytes:
    data = text.encode("utf-8")
    return data + b"\0" * (4 - len(data) % 4)
