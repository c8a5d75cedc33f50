"""All words of the live session and its window. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Live face"
ACTION = "&Live face…"

# Sources
DEFAULT_DEVICE = "the default microphone"
NO_SOUND_SYSTEM = "The sound system of this machine tells of no devices."
NO_SOUND_SYSTEM_REMEDY = "Install PortAudio (Debian: libportaudio2), start the sound server, or play a file."
DEVICE_LOST = "{device} is gone."
DEVICE_LOST_REMEDY = "Plug it in again or choose another, and listen again."
DEVICE_REFUSED = "{device} cannot be opened: {why}."

LISTEN_TO = "LISTEN TO"
DEFAULT_ITEM = "Default microphone"
DEVICE_ITEM = "{name}  ({host})"
FILE_ITEM = "Sound file…"
SOURCE_TIP = "A microphone of this machine, or a sound file that plays over and over at real-time pace"
REFRESH = "Refresh"
REFRESH_TIP = "Look again for microphones that were plugged in"
LOOKING = "Looking for microphones"
LISTEN = "Listen"
STOP = "Stop listening"
LISTEN_TIP = "Let the face speak with the microphone, a tenth of a second later (Space)"
OPEN_SOUND = "Sound to speak with"
LEARNING = "Learning to speak from the database"
NO_DATABASE = "Open a motion database; the face learns from it how to speak."
NOT_LISTENING = "Press Listen and speak."
NO_SOUND_YET = "No sound arrives from {source} yet."
SILENT = "{source} gives nothing but silence; it may be muted."
ENDED = "{source} is over."

# Meter
LEVEL = "LEVEL"
METER_TIP = "Level of the sound, decibels of full scale; the line is the highest lately"
CLIPPED = "clipped"
CLIP_TIP = "Samples reached full scale: turn the microphone down. A click puts the mark out."
LEVEL_VALUE = "{db:.0f} dB"

# Expression
EXPRESSION = "EXPRESSION"
EMOTION_BUTTON = "{key}   {emotion}"
EMOTION_TIP = "Let the face go to {emotion}, smoothly (key {key})"
NOT_LEARNED = "The database holds no {emotion}, so the face did not learn it."
INTENSITY = "intensity"
INTENSITY_TIP = "How strongly the emotion is shown, in per cent"
PER_CENT = "{value} %"

# Delay
DELAY = "DELAY"
DELAY_TIP = (
    "Measured, medians of the last two seconds: from the sound in the air, as far as the device tells, to the painted "
    "face"
)
DELAY_TOTAL = "{ms:.0f} ms"
DELAY_PARTS = ("capture", "look-ahead", "compute", "frame")
DELAY_PART_TIPS = (
    "The device's buffer, its blocks of 10 ms and the resampler",
    "What the face hears beyond the frame that it shows",
    "From sound to markers, on one processor",
    "From markers to the picture on the screen",
)
NO_DELAY = "–"
DROPS = "drop-outs: {n}"
DROPS_TIP = "How often sound was lost: told by the device, or missed by the clock"

# Recording
RECORDING = "RECORDING"
RECORD = "Record"
RECORD_STOP = "Stop recording"
RECORD_TIP = "Keep sound and emotions from now on (R)"
KEEP = "Save as project…"
KEEP_TIP = "Save the recording as a project: its motion is made again from sound and emotions, and can be edited"
OPEN = "Open"
OPEN_TIP = "Open the saved recording in the main window"
RECORDED = "{minutes:d}:{seconds:04.1f}"
NOTHING_RECORDED = "Nothing was recorded yet."
NOT_RECOGNISED = "What is said was not recognised: {why}"
SAVING = "Saving the recording"
SAVED = "Saved as '{path}'."
FULL = "An hour was recorded, which is the most; the recording ended."
FILTER_PROJECT = "Projects (*.efase)"
FILE_NAME = "live-%Y%m%d-%H%M%S"
CLOSE_UNSAVED = "What was recorded live is not saved yet."
CLOSE_LOSES = "The recording is not saved. Save it as a project, or close once more to lose it."
OPENING = "Opening the motion database…"
CLOSED_EARLY = "The window was closed before the face had learned to speak."

# Streaming out
STREAM = "STREAM OUT"
STREAM_HINT = "udp://127.0.0.1:11111"
STREAM_TIP = (
    "Send each frame to another program: udp://HOST:PORT as Live Link Face (Unreal and others), osc://HOST:PORT as VMC"
)
SEND = "send"
SEND_TIP = "Send frames to this address while listening"
OPENING_STREAM = "Opening the stream"
SENT = "{n} sent"
BAD_ADDRESS = "'{address}' is no address to stream to."
BAD_ADDRESS_REMEDY = "Write udp://HOST:PORT for Live Link Face packets, or osc://HOST:PORT for VMC."
NO_HOST = "The host '{host}' is not known here."
SUBJECT = "efase"

FACE = ("face", "face", "Show the face of the main window")
DOTS = ("dots", "dots", "Show the markers alone")
