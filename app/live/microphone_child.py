"""Listens to a microphone in a process of its own and writes what it hears to standard output.

PortAudio looks for devices once in a process, and may never come back from a sound server that was killed; here every
start sees the devices of the moment, a device that hangs is ended with its process, and no drawing holds up the sound.

``python -m app.live.microphone_child list`` prints devices as JSON. ``... open NAME HOST`` (both empty: the default)
writes messages, each a letter, a length and that many bytes: ``O`` opened (JSON), ``B`` block (`BLOCK_HEAD`, float32
samples), ``E`` a sentence about what went wrong, ``L`` the device is gone. It ends when standard input does.
"""

from __future__ import annotations

import json
import os
import queue
import struct
import sys
import threading
import time

from app.live.priority import be_served_first

MESSAGE_HEAD = struct.Struct("<cI")
BLOCK_HEAD = struct.Struct("<dd?")  # when it came, age of its last sample in seconds, whether sound was lost before
# Input-only streams at 16 kHz stay silent for seconds on PulseAudio, and every device knows 48 kHz.
RATE_HZ = 48_000
_BLOCK_S = 0.010
_OLDEST_S = 1.0  # some hosts tell an age that cannot be


def devices() -> list[dict[str, object]]:
    """Return the devices that hear: {name, host, is_default}; raises `OSError` where there is no PortAudio."""
    import sounddevice

    hosts = sounddevice.query_hostapis()
    default = sounddevice.default.device[0]
    return [
        {"name": device["name"], "host": hosts[device["hostapi"]]["name"], "is_default": index == default}
        for index, device in enumerate(sounddevice.query_devices())
        if device["max_input_channels"] > 0
    ]


def listen(name: str, host: str) -> None:
    """Write messages until the device is gone or nobody reads."""
    import sounddevice

    said: queue.SimpleQueue[tuple[bytes, bytes]] = queue.SimpleQueue()

    def on_block(samples, _n_frames, times, status) -> None:
        arrived_s = time.perf_counter()
        age_s = times.currentTime - times.inputBufferAdcTime - len(samples) / stream.samplerate
        believed_s = age_s if times.inputBufferAdcTime and 0.0 < age_s < _OLDEST_S else 0.0
        mono = samples[:, 0] if samples.shape[1] == 1 else samples.mean(axis=1)
        said.put((b"B", BLOCK_HEAD.pack(arrived_s, believed_s, bool(status.input_overflow)) + mono.tobytes()))

    try:
        stream = _opened(sounddevice, _index(sounddevice, name, host), on_block, lambda: said.put((b"L", b"")))
        stream.start()
    except (sounddevice.PortAudioError, ValueError) as error:
        _write(b"E", str(error).encode())
        return
    _write(b"O", json.dumps({"rate_hz": round(stream.samplerate), "latency_s": stream.latency}).encode())
    while True:
        kind, data = said.get()
        _write(kind, data)
        if kind == b"L":
            return


def _index(sounddevice, name: str, host: str) -> int | None:
    if not name:
        return None
    hosts = sounddevice.query_hostapis()
    for index, device in enumerate(sounddevice.query_devices()):
        if device["name"] == name and hosts[device["hostapi"]]["name"] == host and device["max_input_channels"] > 0:
            return index
    raise ValueError("it is not there")


def _opened(sounddevice, index: int | None, on_block, on_finished):
    """Open a stream at 48 kHz in mono, else as the device likes it best."""
    device = sounddevice.query_devices(index, "input")
    own_hz, n_channels = round(device["default_samplerate"]), device["max_input_channels"]
    wishes = [(RATE_HZ, 1), (own_hz, 1), (RATE_HZ, min(2, n_channels)), (own_hz, n_channels)]
    for rate_hz, channels in wishes:
        try:
            return sounddevice.InputStream(
                samplerate=rate_hz, blocksize=round(_BLOCK_S * rate_hz), channels=channels, dtype="float32",
                device=index, latency="low", callback=on_block, finished_callback=on_finished,
            )  # fmt: skip
        except sounddevice.PortAudioError as error:
            refused = error
    raise refused


def _write(kind: bytes, data: bytes) -> None:
    sys.stdout.buffer.write(MESSAGE_HEAD.pack(kind, len(data)) + data)
    sys.stdout.buffer.flush()


def _end_with_parent() -> None:
    sys.stdin.buffer.read()
    os._exit(0)


def main(arguments: list[str]) -> None:
    """Answer ``list`` or ``open NAME HOST``."""
    try:
        if arguments[0] == "list":
            print(json.dumps(devices()))
        else:
            threading.Thread(target=_end_with_parent, daemon=True).start()
            be_served_first()  # before PortAudio starts threads, which take it over
            listen(*arguments[1:])
    except OSError as error:  # no PortAudio library, or nobody reads any more
        print(error, file=sys.stderr)
        os._exit(3)
    sys.stdout.flush()
    os._exit(0)  # PortAudio's own end waits for a server that may be gone


if __name__ == "__main__":
    main(sys.argv[1:])
