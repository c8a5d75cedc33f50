"""Each live frame to another program, by UDP: Live Link Face packets for Unreal and others, or VMC messages by OSC."""

from __future__ import annotations

import socket
import time
import uuid
from dataclasses import dataclass
from urllib.parse import urlsplit

import numpy as np

from app.texts import live as texts
from core.errors import UserFacingError
from core.face.face import Face
from core.iface.speech_features import RATE_HZ
from core.motion.blendshape_track import HEAD_AND_EYES
from core.motion.marker_set import MarkerSet
from core.pipeline.live_link_packet import UNITS, live_link_packet
from core.pipeline.live_weights import LiveWeights
from core.pipeline.osc_packet import osc_packet

_LIVE_LINK, _OSC = "udp", "osc"


@dataclass(frozen=True)
class StreamAddress:
    """Where frames go, and in which words: ``udp`` for Live Link Face packets, ``osc`` for VMC messages."""

    form: str
    host: str
    port: int

    @classmethod
    def parsed(cls, address: str) -> StreamAddress:
        """Return what ``udp://HOST:PORT`` or ``osc://HOST:PORT`` means; raises `UserFacingError` for anything else."""
        try:
            parts = urlsplit(address.strip())
            form, host, port = parts.scheme.lower(), parts.hostname, parts.port
        except ValueError:
            form, host, port = "", None, None
        if form not in (_LIVE_LINK, _OSC) or not host or not port or any(parts[2:]) or parts.username:
            raise UserFacingError(texts.BAD_ADDRESS.format(address=address), texts.BAD_ADDRESS_REMEDY)
        return cls(form, host, port)

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.form}://{host}:{self.port}"


class Outgoing:
    """Sends frames; whether anybody hears them is not known.

    n_sent, n_refused : packets that left, and that the system would not send
    """

    def __init__(self, address: StreamAddress, face: Face, markers: MarkerSet) -> None:
        """Raises `UserFacingError` when the host is not known, or the markers cannot be laid on ``face``."""
        self.address = address
        self._rest = markers.rest
        self._weights = LiveWeights(face, markers)
        self._rows = [self._weights.names.index(unit) if unit in self._weights.names else -1 for unit in UNITS]
        self._device = str(uuid.uuid4()).upper()
        self._angles = (0.0,) * len(HEAD_AND_EYES)
        self.n_sent = self.n_refused = 0
        try:
            family, _, _, _, self._target = socket.getaddrinfo(
                address.host, address.port, type=socket.SOCK_DGRAM
            )[0]  # fmt: skip
        except (OSError, UnicodeError) as error:
            raise UserFacingError(texts.NO_HOST.format(host=address.host), texts.BAD_ADDRESS_REMEDY) from error
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    def send(self, positions: np.ndarray) -> None:
        """Send the face whose markers are at ``positions``, shape (n_markers, 3), mm."""
        solved = np.append(self._weights.solve(positions - self._rest), 0.0)  # the last is for units it does not have
        weights = solved[self._rows].tolist()
        if self.address.form == _LIVE_LINK:
            data = live_link_packet(weights, self._angles, _frame_of_day(), RATE_HZ, self._device, texts.SUBJECT)
        else:
            data = osc_packet(UNITS, weights)
        try:
            self._socket.sendto(data, self._target)
            self.n_sent += 1
        except OSError:  # no route, or the system's buffer is full: the next frame comes soon
            self.n_refused += 1

    def close(self) -> None:
        """Send no more."""
        self._socket.close()


def _frame_of_day() -> int:
    """The frame that it is now, counted from midnight."""
    now_s = time.time()
    now = time.localtime(now_s)
    second = (now.tm_hour * 60 + now.tm_min) * 60 + now.tm_sec
    return second * RATE_HZ + int(now_s % 1.0 * RATE_HZ)
