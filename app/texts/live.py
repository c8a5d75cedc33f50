"""All words of the live session and its window. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Live"
ACTION = "&Live face…"

# Sources
DEFAULT_DEVICE = "the default microphone"
NO_SOUND_SYSTEM = "The sound system of this machine tells of no devices."
NO_SOUND_SYSTEM_REMEDY = "Install PortAudio (Debian: libportaudio2), start the sound server, or play a file."
DEVICE_LOST = "{device} is gone."
DEVICE_LOST_REMEDY = "Plug it in again or choose another, and press Listen."
DEVICE_REFUSED = "{device} cannot be opened: {why}."

# Recording
NOTHING_RECORDED = "Nothing was recorded yet."
NOT_RECOGNISED = "What is said was not recognised: {why}"
SAVING = "Saving the recording"

# Streaming out
BAD_ADDRESS = "'{address}' is no address to stream to."
BAD_ADDRESS_REMEDY = "Write udp://HOST:PORT for Live Link Face packets, or osc://HOST:PORT for VMC."
NO_HOST = "The host '{host}' is not known here."
SUBJECT = "efase"

# Meter
CLIPPED = "clipped"
