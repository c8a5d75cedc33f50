"""All words that the window shows, in one place for translation. ``{names}`` are filled in."""

from __future__ import annotations

APPLICATION = "eFASE Workstation"
UNEXPECTED = "This should not have happened while {what} ({error}); details in the log."

# Jobs, as the status bar names them
OPENING_DEMO = "Opening the demo database"
OPENING_DATABASE = "Opening the motion database"
LOADING_SPEECH = "Aligning speech"
RECOGNISING = "Recognising speech"
SYNTHESISING = "Synthesising"
FITTING_FACE = "Fitting markers to the face"
COMPOSING = "Composing video"
FILM_PROCESS_DIED = "The process that draws the video ended before it was done."
SAVING_FILM = "Saving video"

# Notes in the status bar
SOUND_MISSING = "There is no sound device; it plays without sound."
SOUND_LOST = "The sound device is gone; it goes on without sound."
SOLVED = "search {milliseconds:.0f} ms · solved after “{after}”"
SELECT_TO_PIN = "Select a /{phone}/ in the timeline first; a pin ties a node to one utterance."
SELECT_TO_LOCK = "Select an utterance in the timeline first; a lock keeps what it shows."
FILM_SAVED = "Saved {path}"

# Projects
OPENING_PROJECT = "Opening the project"
UNNAMED_PROJECT = "Unnamed project"
OPENED_AS_COPY = "{why} A copy of it is open instead; File ▸ Save a copy… gives it a place."
SAVED_ALREADY = "Saved already: every edit is on disk, in {path}"
SAVE_A_COPY_REMEDY = "File ▸ Save a copy… puts it elsewhere."
COPY_SAVED = "Saved {path}"
DATABASE_MISSING = "The motion database “{name}” of this project is not at '{path}'."
DATABASE_MISSING_REMEDY = "Locate it with Open database… (Ctrl+D), or open the demo's (in the File menu)."
DATABASE_CHANGED = "The motion database “{name}” is not what it was when this project was last open."
VERSION_KEPT = "Kept as version “{name}”"
WORKING_VERSION = "As it was before comparing"
NO_VERSION_YET = "Keep a version first (File ▸ Versions ▸ Keep version…); then this key goes back and forth."
ONE_VERSION_ONLY = "This is the only version; change something, then this key goes back and forth."
DATABASE_OPEN_ELSEWHERE = (
    "The database is open in another window, which keeps its list of removed nodes; "
    "what is removed here is removed for this project only."
)
CURATION_ONLY_HERE = "The list of removed nodes cannot be written; they are removed for this project only."
NEW_PROJECT = "&New project"
OPEN_PROJECT = "&Open project…"
OPEN_RECENT = "Open &recent"
NO_RECENT = "None yet"
ACTION_SAVE = "&Save"
SAVE_COPY = "Save a &copy…"
MENU_VERSIONS = "&Versions"
KEEP_VERSION = "&Keep version…"
KEEP_VERSION_ASK = "Name of the version"
TOGGLE_VERSIONS = "Compare &A/B"
SWITCH_VERSION = "Switch to “{name}”"
FORGET_VERSION = "&Forget"
OPEN_DEMO_DATABASE = "Open demo database"
FILTER_PROJECT = "eFASE projects (*.efase);;All files (*)"

# Edits, as the Edit menu names them
EDIT_CHOOSE_SPEECH = "Choose speech"
EDIT_SET_TRANSCRIPT = "Set transcript"
EDIT_SET_EMOTION = "Set emotion to {emotion}"
ANIMATED = "{engine} · made after “{after}”"
EDIT_FRAME_RATE = "Set {name} frames a second"
EDIT_START_FRAME = "Number the first frame {number}"
EDIT_HEAD_MOVES = "Let the head move"
EDIT_HEAD_STILL = "Keep the head still"
EDIT_WEIGHT = "Weigh {name}"
EDIT_WEIGHTS_RESET = "Weights of the database"

# Control panel
SPEECH = "SPEECH"
EMOTION = "EMOTION"
FACE = "FACE"
DATABASE = "DATABASE"
ENGINE = "ENGINE"
CHOOSE_SPEECH = "Choose speech…"
OPEN_SPEECH = "Open sound file…"
DEMO_SENTENCE = "Demo sentence, {emotion}"
SPEECH_FACTS = "{seconds:.2f} s · {rate_khz:g} kHz · {phonemes} phonemes"
TRANSCRIPT_HINT = "What is said. Leave it empty to have the speech recognised."
TRANSCRIPT_TIP = "The words of the speech; Align fits them to the sound"
OPEN_TRANSCRIPT = "Transcript file…"
OPEN_TRANSCRIPT_TIP = "A text file, Praat TextGrid, Festival or HTK label file, or lines of “start end phone”"
ALIGN = "Align"
ALIGN_TIP = "Fit the transcript to the sound; without any words, recognise them"
EMOTION_TIP = "The emotion of the whole sentence"
EMOTION_MIXED = "As painted in the timeline"
OPEN_EMOTIONS = "Emotion file…"
OPEN_EMOTIONS_TIP = "Lines of “start end emotion [intensity]”, times in seconds"
FACE_NONE = "Markers only"
OPEN_FACE = "Open face…"
FACE_TIP = "The face that the markers move: OBJ, PLY or glTF"
NO_DATABASE = "None is open"
DATABASE_FACTS = "{sentences} sentences · {nodes} motion nodes\n{frames} frames · {markers} markers · {rate:g} Hz"
DATABASE_TIP = "PCA keeps {coverage:.1%} of the motion in {dims} numbers a frame.\n{path}"
SYNTHETIC = "synthetic"
SYNTHETIC_TIP = "This motion was made by a program; it was not captured from a person"
OPEN_DATABASE = "Open database…"
OPEN_SHORT = "Open…"
OPEN_DATABASE_TIP = "Open another motion database (Ctrl+D)"
ENGINE_FACTS = "relaxation on the processor,\nelse all paths on {backend}"
ENGINE_TIP = (
    "Bounds from a relaxation leave few motion nodes to look at, and the best path among them is proved best.\n"
    "Where too many are left, all paths are searched on:\n{sentence}"
)
NO_PATH = "takes no path through the database:\nno costs, prices, pins or weights"
NO_PATH_TIP = "This engine makes motion of its own; what is pinned or locked waits until a search is chosen."
HOLD = "hold long sounds"
HOLD_TIP = "A sound that is dragged or sung longer than any that was learnt from keeps its shape"
NO_COST = "No cost: no path"
NO_STRIP = "none: this engine takes no path through the database"
NO_NODE_IN_USE = "this engine uses no motion node"
PIN_NEEDS_SEARCH = "The engine that is chosen takes no motion nodes, so none can be pinned."
CHOOSE_A_SEARCH = "Choose a search in the control panel."
BACKEND_WAITING = "no compute backend yet"
WEIGHTS = "WEIGHTS"
WEIGHTS_TIP = "What the search minds most; it answers while you drag"
WEIGHTS_RESET = "Reset"
WEIGHTS_RESET_TIP = "Take the weights of the database again"
WEIGHTS_TUNED = "tuned on {sentences} sentences"
WEIGHTS_UNTUNED = "untuned · see efase tune"
WEIGHTS_OWN = "of this project"
WEIGHT_NAMES = {
    "pnt": ("penalty", "PNT: the unit of the penalties below, against how joins look"),
    "alpha1": ("no predecessor", "α1: a motion node that nothing was captured before, in PNT"),
    "alpha2": ("smooth blend", "α2: how a blend of the two motion nodes bends"),
    "alpha3": ("position", "α3: how far positions are apart where nodes join, against velocities"),
    "alpha4": ("like phoneme", "α4: the share of the penalty for a phoneme that looks alike"),
    "alpha5": ("phoneme", "α5: another phoneme, in PNT"),
    "alpha6": ("emotion", "α6: another emotion, in PNT"),
    "context_before": ("phoneme before", "Another phoneme before, in PNT; not in the paper"),
    "context_after": ("phoneme after", "Another phoneme after, in PNT; not in the paper"),
    "context_decay": ("context reach", "What each further phoneme counts, against the nearer one; not in the paper"),
    "duration": ("length", "A node of another length than its phoneme, in PNT; not in the paper"),
}
SYNTHESISE = "Synthesise"
SYNTHESISE_NEEDS_SPEECH = "Choose speech first"
SYNTHESISE_NEEDS_DATABASE = "Open a motion database first"
COST = "Cost {cost:.1f}"
COST_PROVED = "Cost {cost:.1f} · proved best"
COST_TIP = (
    "COST of the best path (equation 4), in penalty units: 1 is PNT, the typical jump between two random\n"
    "motion nodes. The path is proved best: no other choice of nodes costs less."
)
COST_SLOT = "/{phone}/ by {node}: {cost:.2f}\nphone {observation:.2f} · join {transition:.2f} · emotion {emotion:.2f}"
COST_SLOT_TIP = (
    "What the selected utterance adds to the cost, in penalty units: a phone that does not match,\n"
    "the join to the node before, an emotion that does not match."
)

# Panes
MOTION = "SYNTHESISED MOTION"
VIDEO = "VIDEO PLAYBACK"
ISOMAP = "PHONEME ISOMAP"
PREVIEW = "FACE PREVIEW"
MARKERS = "markers"
WIREFRAME = "wireframe"
SHADED = "shaded"
TEXTURED = "face"
MARKERS_TIP = "Show the markers"
WIREFRAME_TIP = "Show the face as a wireframe"
SHADED_TIP = "Show the face in one plain colour, to judge its shape"
TEXTURED_TIP = "Show the face"
PLOT = "plot"
PLOT_TIP = "Plot one marker over time: where it is and how fast"
PLOT_MARKER_TIP = "Whose path to plot; the lower lip is the paper's marker 79"
PLOT_AXIS_TIP = "x to the actor's left, y up, z forward"
PLOT_LEGEND_TIP = "Displacement from rest above, velocity below"
PLOT_PLACE = "mm"
PLOT_SPEED = "mm/s"
PLOT_SYNTHESISED = "synthesised"
PLOT_CAPTURED = "captured"
TRAILS = "trails"
TRAILS_TIP = "Show with the markers where those around the mouth come from, a third of a second back"
CAPTURED_TIP = "Show with the markers how the actor herself said this sentence"
CAPTURED_NONE_TIP = "This sentence was not captured"
ORBIT_TIP = "Drag or Shift+arrows to turn, wheel to zoom, right-drag to move, F to frame"
MOTION_EMPTY = "Choose speech, then press Synthesise (Ctrl+Return)."
MOTION_NO_DATABASE = "Open a motion database to animate speech (Ctrl+D)."
MOTION_EMPTY_READY = "Press Synthesise (Ctrl+Return)."
WAITING_DATABASE = "Opening the motion database…"
WAITING_SPEECH = "Aligning the speech…"
MOTION_WAITING = "Finding the motion…"
VIDEO_EMPTY = "The video is composed after a synthesis."
VIDEO_WAITING = "Composing the video…"
VIDEO_CANCELLED = "Press Compose to make the video."
VIDEO_FAILED = "The video cannot be shown: {why}"
VIDEO_COMPOSED = "composed"
VIDEO_COMPOSED_TIP = "The video as it would be exported"
VIDEO_REFERENCE = "reference"
VIDEO_REFERENCE_TIP = "A film of the actor beside the synthesis, at the same playhead"
REFERENCE_EMPTY = "Open a film of the actor to compare with."
OPEN_CAPTURED = "Open a captured sentence…"
CAPTURED_HINT = "Type some words of a captured sentence…"
LISTING_CAPTURED = "Listing captured sentences"
OPEN_REFERENCE = "Open…"
OPEN_REFERENCE_TIP = "Choose a film of the actor; it stays where it is"
OFFSET = "offset "
OFFSET_TIP = "The time of the film at which the speech starts"
FILTER_REFERENCE = "Films (*.avi *.mp4 *.mov *.mkv *.webm *.mpg *.mpeg);;All files (*)"
COMPOSE = "Compose"
COMPOSE_TIP = "Compose the video of the motion on show"
SAVE_AS = "Save as…"
SAVE_AS_TIP = "Keep a copy of the composed video; Export (Ctrl+E) has more forms"
ISOMAP_EMPTY = "Open a motion database to see its maps."
PHONE_TIP = "Whose map to show; selecting an utterance in the timeline shows its own"
PHONE_ITEM = "/{phone}/   {frames} frames"
TRIPHONE = "{before} · {phone} · {after}"
MAP_TIP = (
    "Point to preview, click to select, double click or Enter to pin, U to unpin, Space to play, Shift+Space slowly, "
    "Delete to remove, Shift+drag for a box, Ctrl+drag for a lasso"
)
LEGEND_USED = "in use"
LEGEND_PICKED = "picked"
LEGEND_TIME = "same time"
LEGEND_CONTEXT = "same triphone"
LEGEND_TIP = (
    "<qt>◆ the node and frame in use; its way is drawn, brighter as time goes by<br>"
    "○ time-correct: where each node is at the playhead's relative time<br>"
    "◎ context-correct: captured between the same two phones<br>⊕ what you picked</qt>"
)
PINNED = "pinned to {node}"
PREVIEW_REST = "at rest · point at the map to see a frame"
PREVIEW_NODE = "{node} · {emotion} · {before}·{phone}·{after} · {milliseconds:.0f} ms"
PREVIEW_USED = "in use · "
PREVIEW_OUTSIDE = "nearest frame (outside the map) · "
PREVIEW_PRICE = " · price +{price:.2f}"
PREVIEW_NO_PRICE = " · cannot stand here"
PIN = "Pin"
UNPIN = "Unpin"
PIN_TIP = "Tie this node to the selected utterance (Enter on the map, or double click)"
UNPIN_TIP = "Let the search choose again"

# Transport
PLAY_TIP = "Play or pause (Space)"
BACK_TIP = "One frame back (Left)"
FORWARD_TIP = "One frame on (Right)"
TO_START_TIP = "To the start (Home)"
TO_END_TIP = "To the end (End)"
TIME_TIP = "Minutes, seconds and milliseconds; frame of frames at {fps} frames a second"

# Timeline
TIMELINE_EMPTY = "Choose speech to see it here."
TIMELINE_TIP = "Click selects, drag scrubs, wheel zooms · drag edges of phonemes · paint in the emotion lane"
LANE_WAVE = "wave"
LANE_WORDS = "words"
LANE_PHONEMES = "phonemes"
LANE_EMOTION = "emotion"
LANE_CURVE = "{region} ×"
POLISH = "POLISH"
POLISH_TIP = "More or less of what the search found; it stays when the search answers anew"
POLISH_RESET_TIP = "Take the whole layer away"
POLISH_GAINS = {
    "articulation": ("articulation", "How far mouth and jaw go with each sound; 1 is as found"),
    "expression": ("expression", "How strong the slow part of the motion is, everywhere; 1 is as found"),
}
POLISH_CURVE = "curve of"
POLISH_CURVE_TIP = "Whose curve the timeline shows: click there to set a key, drag it, double click takes it away"
EDIT_POLISH = "Set {name}"
EDIT_POLISH_RESET = "Reset the polish"
EDIT_CURVE = "Shape the curve of the {region}"
LANE_COST = "cost"
LANE_PRICE = "price"
TIMELINE = "TIMELINE"
BRUSH = "brush"
BRUSH_TIP = "Drag in the emotion lane to paint; the height of the pointer is the intensity"
BRUSH_KEYS = "Paint with this emotion (key {key}); the height of the pointer is the intensity"
ERASE = "erase"
SNAP = "snap"
SNAP_TIP = "Whether a stroke covers whole phonemes, whole words, or just what it touches"
SNAP_FREE = "off"
SPECTROGRAM = "spectrogram"
SPECTROGRAM_TIP = "Show the spectrogram behind the wave, up to 8 kHz"
MAKING_SPECTROGRAM = "Making the spectrogram"
UNITS = {"seconds": "s", "frames": "frames", "timecode": "timecode"}
UNITS_TIP = "Write times in seconds, in frames, or as timecode (HH:MM:SS:FF)"
ZOOM_IN_TIP = "Zoom in (+)"
ZOOM_OUT_TIP = "Zoom out (-)"
ZOOM_ALL = "all"
ZOOM_ALL_TIP = "Show all of the speech (0)"
BOUNDARY_MOVED = "{milliseconds:+.0f} ms"
PAINTING = "{emotion} {intensity:.2f}"
ERASING = "erase"
EDIT_PAINT = "Paint {emotion}"
EDIT_ERASE_EMOTION = "Erase emotion"
RENAME_TIP = "Type the phone, Return to take it, Escape to leave it.\n{phones}"
RENAME_PHONEME = "Rename /{phone}/…"
SPLIT_PHONEME = "Split /{phone}/ here"
MERGE_PHONEME = "Merge with the next"
ACTION_LOCK = "&Lock the span to its nodes"
ACTION_UNLOCK = "Un&lock the span"
LOCKED = "locked to the node in use"
TERMS = {
    "observation": "phone", "position": "position", "velocity": "velocity", "smoothing": "smoothing",
    "viseme": "viseme", "no_predecessor": "start of a capture", "emotion": "emotion",
}  # fmt: skip
COST_TERM = "{term}  {cost:.2f}"
COST_OF_SLOT = "cost of this slot  {cost:.2f} PNT"
NEXT_BEST = "the next best node would add {price:.2f} PNT"
SILENCE = "silence"
UTTERANCE = "{phone}  {milliseconds:.0f} ms"

# Status bar
CANCEL_TIP = "Cancel"
CLOSE_TIP = "Close this message"

# Menus
MENU_FILE = "&File"
MENU_EDIT = "&Edit"
MENU_MOTION = "&Motion"
MENU_MAP = "Ma&p"
MENU_TIMELINE = "&Timeline"
MENU_VIEW = "&View"
MENU_HELP = "&Help"
ACTION_START_FRAME = "&First frame…"
START_FRAME_ASK = "Number of the first frame, for timecode and numbered pictures:"
MENU_FRAME_RATE = "Frame &rate"
MENU_THEME = "&Theme"
ACTION_QUIT = "&Quit"
ACTION_UNDO = "&Undo"
ACTION_REDO = "&Redo"
ACTION_PLAY = "&Play or pause"
ACTION_SHUTTLE_BACK = "Shuttle bac&kwards"
ACTION_SHUTTLE_STOP = "Stop the sh&uttle"
ACTION_SHUTTLE_ON = "Shuttle &forwards"
ACTION_LOOP = "&Loop the selection"
ACTION_RENAME = "&Rename the phoneme…"
ACTION_SPLIT = "&Split at the playhead"
ACTION_MERGE = "&Merge with the next"
ACTION_COMMANDS = "Search &commands…"
COMMANDS_HINT = "Search commands…"
ACTION_BACK = "One frame &back"
ACTION_FORWARD = "One frame &on"
ACTION_TO_START = "To the &start"
ACTION_TO_END = "To the &end"
ACTION_PREVIOUS = "&Previous phoneme"
ACTION_NEXT = "&Next phoneme"
ACTION_FRAME_VIEW = "&Frame the view"
ACTION_FRONT = "Fr&ont"
ACTION_SIDE = "Si&de"
ACTION_PIN = "&Pin the picked node"
ACTION_UNPIN = "&Unpin the utterance"
ACTION_ZOOM_IN = "Zoom &in"
ACTION_ZOOM_OUT = "Zoom o&ut"
ACTION_ZOOM_ALL = "Zoom to &all"
ACTION_BRUSH = "Brush: {emotion}"
ACTION_HEAD = "&Head and gaze move"
ACTION_RESET_LAYOUT = "&Reset the layout"
ACTION_ABOUT = "&About"
THEMES = {"dark": "&Dark", "light": "&Light"}

# File dialogs
FILTER_SOUND = "Sound (*.wav *.flac *.ogg *.oga *.aiff *.aif *.mp3);;All files (*)"
FILTER_TRANSCRIPT = "Transcripts (*.txt *.TextGrid *.textgrid *.lab *.phn *.phones);;All files (*)"
FILTER_EMOTIONS = "Emotion specifications (*.txt *.emo *.csv);;All files (*)"
FILTER_FACE = "Faces (*.obj *.ply *.glb *.gltf *.npz);;All files (*)"
FILTER_DATABASE = "Motion databases (*.h5 *.hdf5 *.efdb);;All files (*)"
FILTER_VIDEO = "AVI video (*.avi)"

ABOUT_TITLE = "About the eFASE Workstation"
ABOUT = """<h3>eFASE Workstation</h3>
<p>Expressive speech animation from captured facial motion, after Deng and Neumann,
“Expressive Speech Animation Synthesis with Phoneme-Level Controls” (2008).</p>
<p>{face}</p>
<p>The demo database is motion of a <i>synthetic</i> actress, made by a program; her voice is Festival's
cmu_us_slt_arctic (see resources/demo/LICENSES.md).</p>
<p>The workstation is under the MIT licence. It stands on Qt (PySide6, LGPL), NumPy, SciPy, scikit-learn, pyqtgraph,
ModernGL, PyOpenCL, PyAV (FFmpeg), pocketsphinx and others, each under its own licence.</p>"""
ABOUT_DEFAULT_FACE = "The default face is cut from MakeHuman data (CC0)."
FRAME_RATE_ITEM = "{name} frames a second"
EXPORT_TITLE = "Export"
EXPORT = "Export"
EXPORT_ACTION = "&Export…"
EXPORTING = "Exporting {name}"
EXPORT_NEEDS_MOTION = "There is no motion to export yet. Press Synthesise first."
EXPORT_AS = "as"
EXPORT_SIZE = "size"
EXPORT_SHOWS = "showing"
EXPORT_BACKGROUND = "background"
EXPORT_RATE = "frame rate"
EXPORT_SPAN = "part"
EXPORT_TO = "to"
EXPORT_KINDS = {
    ".avi": "AVI video (Motion JPEG, PCM sound)", ".mp4": "MP4 video (H.264, AAC sound)",
    ".png": "Numbered pictures (PNG)", ".c3d": "Markers, C3D", ".csv": "Markers, CSV",
    ".TextGrid": "Transcript, Praat TextGrid",
}  # fmt: skip
EXPORT_STYLES = {"face": "the face", "shaded": "the face, shaded", "wireframe": "a wireframe", "markers": "markers"}
BACKGROUND_STUDIO = "studio"
BACKGROUND_TIP = "One colour behind the face, for keying; cancel the choice for the studio"
SPAN_ALL = "all"
SPAN_SELECTED = "selected"
SPAN_FROM_TO = "from – to"
SPAN_TIP = "Which part of the speech is written"
BROWSE = "Browse…"
FILTER_ANY = "All files (*)"
LEXICON_ACTION = "Le&xicon…"
LEXICON_TITLE = "Lexicon"
LEXICON_HINT = "Names and coined words: a line is a word and its phones, as in “efase iy f ey s”. The next alignment \
knows them."
LEXICON_WORD = "A word…"
LEXICON_ADD = "Add"
LEXICON_ADD_TIP = "Write a line for this word as it would be guessed, to be put right"
LEXICON_GUESSING = "Guessing how a word is said"
LEXICON_UNREADABLE = "The lexicon '{path}' cannot be read."
SAVE_EMOTIONS = "Save emotions…"
EXPORT_IS_RUNNING = "An export is still being written. Give it up and quit?"
SAVING = "Saving"
CLOSE_UNSAVED = "The last edits are not on disk: {why}\n\nClose, and lose them?"
CLOSE_ANYWAY = "Close and lose them"
KEEP_OPEN = "Keep open"
SAVE_FILM = "Save video as…"
SHOWING = "drawing the window"
OPEN_MARKERS = "Where the markers sit on {face} (a CSV of marker,vertex)"
FILTER_MARKERS = "Marker files (*.csv);;All files (*)"

# The map's tools
MAP_MOVE, MAP_BOX, MAP_LASSO = "move", "box", "lasso"
MAP_MOVE_TIP = "A drag moves the map; Shift+drag draws a box, Ctrl+drag a lasso"
MAP_BOX_TIP = "A drag selects the nodes in a box (Shift+drag at any time)"
MAP_LASSO_TIP = "A drag selects the nodes within an outline (Ctrl+drag at any time)"
COLOUR_BY = {
    "emotion": "emotion", "time": "relative time", "sentence": "sentence", "suspicion": "suspicion", "price": "price",
}  # fmt: skip
COLOUR_TIP = "What the colours of the dots tell"
COLOUR_TIPS = {
    "emotion": "The emotion in which a frame was captured",
    "time": "Where a frame is between the start and the end of its motion node",
    "sentence": "Which sentence a frame comes from",
    "suspicion": "How much speaks for a fault of the capture",
    "price": "What it would add to the cost to force the node into the selected utterance, in penalty units (PNT)",
}
SCALE_START, SCALE_END = "start", "end"
SCALE_SOUND, SCALE_SUSPECT = "sound", "suspect"
SCALE_PRICE, SCALE_FREE = "+{price:.2f} and more", "free"
PRICE_WAITS = "Prices come with a synthesis; select a /{phone}/ in the timeline."
PRICE_NEEDS_SEARCH = "No prices: the engine that is chosen takes no path through the database."
SIGMA, RHO = "σ", "ρ"
SIGMA_TIP = "σ of the splats (equation 3): how far each frame shines, {sigma:.0f} pixels"
FILTER_TIP = "Show frames captured in {emotion}"
PCA_MAP = "PCA"
PCA_TIP = "Show the linear map (PCA) beside the Isomap, and how well each keeps neighbours"
ISOMAP_MAP = "Isomap"
PRESERVATION = "{map} · keeps {figures.shared:.0%} of neighbours"
PRESERVATION_TIP = (
    ".\nOf the 12 nearest captured frames, among the 12 nearest on the map: Isomap {isomap.shared:.1%}, "
    "PCA {pca.shared:.1%}.\nTrustworthiness: {isomap.trustworthiness:.3f}, {pca.trustworthiness:.3f}. "
    "Continuity: {isomap.continuity:.3f}, {pca.continuity:.3f}."
)
COMPARING_MAPS = "Comparing the maps"
EMOTION_COLOURS = {"paper": "The paper's colours", "okabe-ito": "Okabe–Ito, safe for colour-blind eyes"}
EMOTION_COLOURS_TIP = "Colours of the emotions"

# Selecting and playing nodes
SELECTED_NODES = "{count} nodes selected"
CLIP_SOUND = "Opening the node's sound"

# Removing
REMOVE = "Remove"
REMOVE_ASK = "Remove {what} because"
REMOVE_ONE = "node {node}"
REMOVE_MANY = "{count} nodes"
REMOVE_REASONS = ("contaminated", "wrong label", "bad acting", "duplicate")
REMOVE_REASON_HINT = "reason"
REMOVE_TIP = "Let no search use them (Enter); the Removed list brings them back"
REMOVE_NOTHING = "Select what to remove first: click a dot, or draw a box (Shift+drag) or a lasso (Ctrl+drag)."
REMOVED = "Removed"
REMOVED_TIP = "Motion nodes that no search uses; double click or Enter restores one"
REMOVED_EMPTY = "No node is removed. Delete removes what is selected on the map."
REMOVED_ROW = "{node}   /{phone}/   {why}"
REMOVED_ROW_TIP = "removed by {who}, {at}"
NODES_REMOVED, NODES_RESTORED = "Removed {what}", "Restored {what}"
COST_MOVED = "{what}: cost {before:.2f} → {after:.2f}"
COST_STAYED = "{what}: cost stays {after:.2f}"

# Suspicion
SUSPECTS = "Suspects"
SUSPECTS_TIP = "Motion nodes that look contaminated, worst first; N steps to the next and plays it (F8 anywhere)"
LOOKING_FOR_FAULTS = "Looking for capture faults"
SUSPECTS_WAIT = "Looking for capture faults…"
SUSPECTS_EMPTY = "Nothing looks contaminated."
SUSPECTS_COUNT = "{count} worth watching · N next · Space plays · Delete removes"
SUSPECT_ROW = "{node}   /{phone}/   {fault}"
SUSPECT_TIPS = {
    "spike": "{marker} leaves by {size_mm:.1f} mm and is back within a moment",
    "swap": "{marker} stands {size_mm:.1f} mm off, then is back; two markers may have changed names",
    "drift": "{marker} creeps away and snaps back by {size_mm:.1f} mm",
    "freeze": "{marker} stands still, then jumps by {size_mm:.1f} mm",
    "far": "far from all other nodes of its phoneme",
    "never wins": "no place of the corpus would choose it",
}
SUSPECT_SCORE = "{score:.0f} robust deviations above what is usual in this corpus"
ACTION_REMOVE = "&Remove the selected nodes…"
ACTION_RESTORE = "R&estore the selected nodes"
ACTION_NEXT_SUSPECT = "&Next suspect"
ACTION_PLAY_NODE = "Play the &node"
ACTION_SUSPECTS = "&Suspects"
ACTION_REMOVED = "Rem&oved nodes"
ACTION_PCA = "P&CA beside the Isomap"
