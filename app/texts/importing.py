"""All words of the import assistant. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Import captures"
ACTION = "&Import captures…"
UNNAMED = "captures"
LOAD_PLAN = "Load plan…"
LOAD_PLAN_TIP = "Go on with an import that was saved (Ctrl+O)"
SAVE_PLAN = "Save plan…"
SAVE_PLAN_TIP = "Keep all decisions in a file, for another day or for efase import (Ctrl+S)"
START_OVER = "Start over"
START_OVER_TIP = "Forget the files and all decisions"
BACK = "Back"
BACK_TIP = "The step before (Alt+Left)"
NEXT = "Next"
NEXT_TIP = "The next step (Alt+Right)"
STEPS_TIP = "Steps can be taken in any order (Alt+1 to Alt+7)"
FILTER_PLAN = "Import plans (*.json);;All files (*)"
PLAN_SAVED = "Saved {path}"
PLAN_LOADED = "Loaded {path}"
SURVEYING = "Looking through the files"
READING = "Reading captures"
READING_ONE = "Reading {name}"
NO_MOTION = "The chosen files hold no motion."
NO_MOTION_REMEDY = "Motion is read from C3D, TRC, CSV and TSV, from blendshape tracks and from tracked landmarks."
FILES_FIRST = "Choose captures in the step “Files” first."

# Edits, as Undo names them
EDIT_FILES = "Add files"
EDIT_LEAVE_OUT = "Leave sentences out"
EDIT_EMOTION = "Set emotion"
EDIT_WORDS = "Set words"
EDIT_MATCH = "Match markers"
EDIT_UNMATCH = "Unmatch a marker"
EDIT_HEAD = "Choose head markers"
EDIT_LIMITS = "Set limits of mending"
EDIT_OFFSET = "Shift the motion"
EDIT_ALIGNMENT = "Accept an alignment"
EDIT_BUILD = "Set how the database is built"

# Files
FILES = "Files"
FILES_HINT = "Drop motion files, sound and transcripts, or whole folders. Files that share a name become one sentence."
FILES_EMPTY = (
    "Drop files or folders here, or choose them below.\n\n"
    "Motion: C3D, TRC, CSV, TSV, blendshape tracks, tracked landmarks, 25 to 240 Hz.\n"
    "Sound: WAV, FLAC. Words: TextGrid, label files or plain text."
)
ADD_FILES = "Add files…"
ADD_FILES_TIP = "Choose motion, sound and transcript files"
ADD_FOLDER = "Add folder…"
ADD_FOLDER_TIP = "Choose a folder; the folders in it are searched too"
LEAVE_OUT = "Leave out"
LEAVE_OUT_TIP = "Do not import the selected sentences (Delete); Ctrl+Z brings them back"
EMOTION_OF_SELECTED = "Emotion of the selected:"
EMOTION_TIP = "Select rows, then choose, or press 1 to 4"
COLUMNS = ("Sentence", "Motion", "Sound", "Words", "Emotion", "Rate", "Frames", "Problems")
COLUMN_TIPS = (
    "Motion nodes will be called sentence:order",
    "The file that the markers are read from",
    "The sound that was recorded with it",
    "A transcript with times, or the text; double-click or F2 to type what is said",
    "Double-click or F2 to choose",
    "Frames a second of the capture; the database has its own rate",
    "Frames of the capture",
    "What is missing or wrong",
)
NO_SOUND = "–"
WORDS_FROM_FILE = "{file}"
WORDS_RECOGNISED = "to be recognised"
WORDS_NONE = "–"
RATE = "{rate:g} Hz"
PROBLEM_NO_SOUND = "no sound: it is imported as silence"
PROBLEM_NO_WORDS = "no words: they will be recognised"
PROBLEM_MISSING = "{n} samples missing ({share:.1%})"
PROBLEM_SHORTER = "the sound lasts {sound:.1f} s, the motion {motion:.1f} s"
FILES_FOUND = "{n} sentences · {minutes}"
FILES_APART = "{n} sound files without motion"
FILES_UNUSED = "{n} files not used"
STATE_FILES = "{n} sentences"
STATE_PROBLEMS = "{n} sentences, {bad} unreadable"

# Markers
MARKERS = "Markers"
MARKERS_HINT = (
    "Which captured marker is which. Names decide first, then places. Click a dot at the left and its place at the "
    "right to match them by hand; a level line is a good sign."
)
WANTED = "Markers of the database:"
WANTED_TIP = "Keep the capture's own markers, or give them the names and parts of another set"
WANTED_OWN = "the capture's own markers"
WANTED_OURS = "the workstation's 102 markers"
WANTED_OPEN = "those of the open database “{name}”"
WANTED_FILE = "those of another database…"
MATCHING = "Matching markers"
MATCH_AGAIN = "Match again"
MATCH_AGAIN_TIP = "Forget pairs made by hand and propose anew"
CAPTURED = "captured"
ON_THE_FACE = "database"
ON_THE_FACE_OWN = "landmarks of the face"
NOT_USED = "– not used –"
KEPT_AS_IS = "– kept, no landmark –"
MATCH_COLUMNS = ("Captured", "Is", "Told by", "Off")
MATCH_COLUMNS_OWN = ("Captured", "Landmark", "Told by", "Off")
MATCH_COLUMN_TIPS = (
    "Name in the motion file",
    "Double-click or F2 to choose; Delete takes the pair apart",
    "What the pair was told by; a weak one is worth a look",
    "Distance of the two after the capture is laid on the face",
)
HOW = {"name": "name", "alike": "name, nearly", "place": "place", "hand": "hand"}
MATCHED_TIP = "{found}\nis {wanted}"
UNMATCHED_TIP = "{found}\nis matched to nothing"
WANTED_ALONE_TIP = "{wanted}\nis not in the capture"
ALONE = "Not in the capture: {names}"
MATCH_LEGEND = "● matched   □ alone   ┄ doubtful"
STATE_OWN = "{n} markers, {landmarks} landmarks"
STATE_MATCHED = "{n} of {wanted} matched"

# Head
HEAD = "Head"
HEAD_HINT = (
    "Markers that keep their places on the head tell its motion, which is taken out. Click dots to change which; what "
    "they still move after that should stay below about 1 mm."
)
ORIGIN = "Origin marker:"
ORIGIN_TIP = "The marker that is put at zero, best on the bridge of the nose; none: the middle of the rigid ones"
ORIGIN_NONE = "middle of the rigid markers"
PROPOSE = "Propose"
PROPOSE_TIP = "Choose the markers that move least against each other"
HEAD_LEGEND = "rigid ●   origin ◎   other ○"
HEAD_COLUMNS = ("Near-rigid marker", "Moves")
RESIDUAL = "Off its place (mm)"
RESIDUAL_TIME = "Time in “{name}” (s)"
RESIDUAL_NOTE = "{n} rigid markers of “{name}”: {rms:.2f} mm RMS, {most:.2f} mm at most"
RESIDUAL_FEW = "Choose three rigid markers at least, or all markers are taken to be rigid."
FINDING_STEADY = "Looking for steady markers"
MEASURING_HEAD = "Measuring the head"
STATE_HEAD = "{n} rigid, {rms:.2f} mm"
STATE_HEAD_SHORT = "{n} rigid markers"
MM = "{mm:.2f} mm"
TAKE = "Sentence:"
TAKE_TIP = "The sentence that is plotted (Page Up, Page Down)"

# Mend
MEND = "Mend"
MEND_HINT = (
    "What will be filled, cut and swapped back, worst sentence first. Choose a row to see the marker before and after."
)
LONGEST_GAP = "Fill gaps up to"
LONGEST_GAP_TIP = "Longer gaps stay open, and nothing is built from their frames"
LOOK_FOR_FAULTS = "Look for spikes and swaps"
LOOK_FOR_FAULTS_TIP = "Switch it off for points of a face model that was fitted to video; they cannot swap"
LEAST_SPIKE = "Spikes from"
LEAST_SPIKE_TIP = "A smaller excursion is left alone"
LEAST_DEVIATIONS = "and"
LEAST_DEVIATIONS_TIP = "Robust standard deviations above the marker's usual step at which a jump counts"
DEVIATIONS = " × usual"
MENDING = "Looking for gaps, spikes and swaps"
MEND_COLUMNS = ("Sentence", "Swaps", "Spikes", "Gaps filled", "Too long", "Samples")
MEND_COLUMN_TIPS = (
    "The sentence; the worst stand first",
    "Spans in which two markers had changed places",
    "Excursions that are cut out and filled again",
    "Gaps that are filled",
    "Gaps that are longer than the limit and stay open",
    "Marker samples that are changed or stay missing",
)
EVENT_COLUMNS = ("What", "Marker", "From", "Lasts", "Size")
EVENT_KINDS = {"swap": "swap", "spike": "spike", "gap": "gap, filled", "long gap": "gap, open"}
EVENT_OTHER = "{marker} and {other}"
SECONDS = "{s:.2f} s"
MILLISECONDS = "{ms:.0f} ms"
MEND_MARKER = "Marker:"
MEND_MARKER_TIP = "The marker that is plotted"
MEND_AXIS_TIP = "Axis of the capture"
MEND_PLACE = "Place (mm)"
MEND_LEGEND_BEFORE = "as captured"
MEND_LEGEND_AFTER = "as imported"
MEND_NOTHING = "Nothing is to be mended in “{name}”."
MEND_TOTAL = "{gaps} gaps filled · {long} too long · {spikes} spikes · {swaps} swaps"
STATE_SOUND = "nothing to mend"
STATE_MEND = "{n} mends, {long} open"
