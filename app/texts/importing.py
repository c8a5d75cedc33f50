"""All words of the import assistant. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Import captures"
ACTION = "&Import captures…"
LOAD_PLAN = "Load plan…"
LOAD_PLAN_TIP = "Go on with an import that was saved (Ctrl+O)"
SAVE_PLAN = "Save plan…"
SAVE_PLAN_TIP = "Keep all decisions in a file, for another day or for efase import (Ctrl+S)"
START_OVER = "Start over"
START_OVER_TIP = "Forget the files and all decisions"
BACK = "Back"
BACK_TIP = "The step before (Alt+Left)"
NEXT_STEP = "Next: {title}"
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
EDIT_PROPOSALS = "Take proposals"
EDIT_READING = "Read files otherwise"
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
FILES_APART = "without motion: {n}"
FILES_UNUSED = "not used: {n}"
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
KEPT_AS_IS = "– kept –"
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
STATE_OWN = "{n} kept, {landmarks} landmarks"
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
MILLIMETRES = "mm"
PIXELS = "pixels"
MM_ABOUT = "{mm:.1f} mm"
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
MEND_PLACE = "Place ({unit})"
MEND_LEGEND_BEFORE = "as captured"
MEND_LEGEND_AFTER = "as imported"
MEND_NOTHING = "Nothing is to be mended in “{name}”."
MEND_TOTAL = "{gaps} gaps filled · {long} too long · {spikes} spikes · {swaps} swaps"
STATE_SOUND = "nothing to mend"
STATE_MEND = "{n} mends, {long} open"

# Sound and words
SOUND = "Sound and words"
SOUND_HINT = (
    "Sound and motion should start together. The mouth's opening is laid over the loudness of the speech; what was "
    "measured can be taken out, and each sentence shifted by hand."
)
WORKING_SPEECH = "Placing words, comparing sound and motion"
OFFSETS = "Take out:"
OFFSETS_TIP = "What is done with the measured lateness; an unsure measurement (below 50 %) is never taken out"
OFFSET_MODES = {
    "keep": "nothing that was measured", "session": "one offset, measured over all", "each": "what each measured",
}  # fmt: skip
SOUND_COLUMNS = ("Sentence", "Measured", "Sure", "By hand", "Words")
SOUND_COLUMN_TIPS = (
    "The least sure stand first",
    "How late the motion is against its sound, as measured",
    "How clearly mouth and speech agree there, and nowhere else",
    "The shift set by hand",
    "What is said, and how it was placed",
)
MS = "{ms:+.0f} ms"
SURE = "{share:.0%}"
SHIFT = "Shift by hand:"
SHIFT_TIP = "Milliseconds by which the motion is late; they are taken out (drag, or arrow keys)"
SHIFT_ALL = "Same for all"
SHIFT_ALL_TIP = "Shift all sentences by as much"
PLAY = "Play"
PLAY_TIP = "Hear the sound; the line shows where the mouth is (Space)"
OPENING_AXIS = "Mouth opening ({unit})"
TIME_AXIS = "Time in the sound (s)"
AGREEMENT_AXIS = "Agreement"
AGREEMENT_X = "Motion late by (ms)"
SOUND_LEGEND_LOUD = "loudness"
SOUND_LEGEND_MOUTH = "mouth opening, shifted by {ms:+.0f} ms"
SESSION_OFFSET = "all together: {ms:+.0f} ms, sure {share:.0%}"
NOTHING_HEARD = "There is no sound in “{name}”; it is imported as silence."
FAILED_SENTENCE = "“{name}” cannot be imported: {why}"
STATE_OFFSET = "{ms:+.0f} ms, sure {share:.0%}"
ALIGNMENTS = {"given": "given", "aligned": "aligned", "recognised": "recognised", "silence": "silence"}

# Review
REVIEW = "Review"
REVIEW_HINT = (
    "Where each word and phone was placed, the least sure sentence first. Drag a boundary where it is wrong, "
    "then accept (Return) and go on."
)
REVIEW_EMPTY = "There is no speech to review yet; choose captures with sound in the step “Files”."
LISTENING_AGAIN = "Listening again"
REVIEW_COLUMNS = ("Sentence", "Sure", "Words")
REVIEW_COLUMN_TIPS = (
    "The least sure stand first; accepted ones last",
    "How little the boundaries move when the same words are placed again through noise; agreement, not probability",
    "How they were placed",
)
ACCEPT = "Accept"
ACCEPT_TIP = "Keep these boundaries and go to the next sentence (Return)"
ACCEPTED = "accepted"
PREVIOUS = "Previous sentence"
PREVIOUS_TIP = "The sentence before (Page Up)"
NEXT_SENTENCE = "Next sentence"
NEXT_SENTENCE_TIP = "The next sentence (Page Down)"
REVERT = "Revert"
REVERT_TIP = "Take back what was dragged in this sentence (Escape)"
LANES_TIP = "arrows choose a boundary, Ctrl+arrows move it by 10 ms · wheel zooms, Shift+wheel moves"
PHONE_TIP = "/{phone}/ {ms:.0f} ms\nits boundaries move by {shift:.0f} ms through noise"
PHONE_TIP_UNKNOWN = "/{phone}/ {ms:.0f} ms"
LANE_SOUND = "sound"
LANE_WORDS = "words"
LANE_PHONES = "phones"
LANE_DOUBT = "unsure"
SILENCE = "silence"
STATE_REVIEW = "{n} of {all} accepted"
CANNOT_KEEP = "The accepted alignment cannot be kept in '{folder}'."

# Build
BUILD = "Build"
BUILD_HINT = (
    "Where the database goes, and how it is made. A build that was cut goes on where it was. Takes without speech can "
    "be written as films or markers instead."
)
TARGET = "Write to"
TARGET_TIP = (
    "A motion database (.h5); or films (.avi, .mp4) or markers (.c3d, .csv) of the mended takes, one each, for takes "
    "without speech too"
)
NAME = "Name"
RATE_OF = "Frame rate"
DIMS = "Dimensions"
DIMS_TIP = "Principal components; the paper kept 25 of 270"
HOLD_OUT = "Hold out"
HOLD_OUT_TIP = "Keep a sixth of the sentences out of the database, to tune weights and to measure with"
HOLD_OUTS = {"": "nothing", "sentences": "a sixth of the sentences", "letters": "by letters (GRID)",
             "digits": "by digits (GRID)"}  # fmt: skip
BROWSE = "Browse…"
BUILD_NOW = "Build"
BUILD_NOW_TIP = "Carry the plan out (Ctrl+Return)"
CANCEL_BUILD = "Cancel"
BUILDING = "Building “{name}”"
OPEN_BUILT = "Open in the workstation"
OPEN_BUILT_TIP = "Search this database from now on, in the main window"
BUILT = "Built {path}: {nodes} motion nodes of {sentences} sentences"
WRITTEN = "Wrote {takes} takes as {path}"
BUILD_EMPTY = "Choose captures in the step “Files” first."
FILTER_TARGET = "Motion databases (*.h5);;Films of the takes (*.avi *.mp4);;Markers of the takes (*.c3d *.csv)"
REPORT_COLUMNS = ("Sentence", "Gaps", "Open", "Spikes", "Swaps", "Head", "Late", "Taken out", "Words", "Notes")
STATE_BUILT = "built"
STATE_BUILDING = "building…"

# What the files do not say
READING_RATE = "Rate:"
READING_RATE_TIP = "Frames a second, where files do not tell or tell wrongly"
AS_FILED = "as the files say"
READING_UNIT = "Unit:"
READING_UNIT_TIP = "Unit of length, where files do not tell or tell wrongly"
READING_AXES = "Left · up · forward:"
READING_AXES_TIP = (
    "Which axis of the capture points to the actor's left, up and forward; proposed from the face's shape"
)
READING_NAMES = "Names of weights…"
READING_NAMES_TIP = "The file that names the weights of blendshape arrays, one a column"
READING_SHEET = "Sheet of names…"
READING_SHEET_TIP = "The table that maps the studio's names to ARKit's (.xlsx or .csv)"
FILTER_NAMES = "Names (*.npy *.txt *.csv *.json);;All files (*)"
FILTER_SHEET = "Tables (*.xlsx *.csv *.tsv);;All files (*)"
