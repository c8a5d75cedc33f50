"""All words of the window in which a face is tracked in a video. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Track a video[*]"
ACTION = "&Track a video…"
CLOSE_UNSAVED = "What was tracked in the video is not saved as a capture.\n\nClose, and lose it?"

VIDEO = "VIDEO"
OPEN = "Open video…"
OPEN_TIP = "Open a film of a face that looks into the camera, neutral in its first picture (Ctrl+O)"
FILTER_VIDEO = "Films (*.mp4 *.mov *.avi *.mkv *.webm *.m4v *.mpg);;All files (*)"
EMPTY = "Open a film of a face that looks into the camera,\nwith a neutral face and closed mouth in the first picture."
FACTS = "{width} × {height}, {rate:g} pictures a second, {seconds:.1f} s"

START = "WHERE THE FACE IS"
CLICK = {
    "mouth_corner_right": "Click the corner of the mouth at the left of the picture.",
    "mouth_corner_left": "Click the corner of the mouth at the right of the picture.",
    "outer_eye_right": "Click the outer corner of the eye at the left of the picture.",
    "outer_eye_left": "Click the outer corner of the eye at the right of the picture.",
}
CLICK_OF = "{n} of 4. {what}"
TO_FIRST = "Go to the first picture (Home) to click where the face is."
LAID = "Drag a ring if the points lie badly, or a point by itself; then track."
TRACKED = "Drag a point where it drifted; tracking goes on from there."
ANEW = "Click anew"
ANEW_TIP = "Forget the clicks and all corrections"
LOAD = "Load clicks…"
LOAD_TIP = "Go on with clicks and corrections that were saved"
SAVE_START = "Save clicks…"
SAVE_START_TIP = "Write clicks and corrections, as efase track --start reads them"
FILTER_START = "Clicks and corrections (*.json);;All files (*)"

UNITS = "MOTION UNITS"
UNITS_OF = "of '{name}'"
UNITS_DEMO = "of the demo database"
UNITS_TIP = "What the face can do is learned from the database that is open in the main window, or the demo's"
EXPRESSION_TIP = "Which expressions the person makes; with any, all that the database knows may come and go"
ANY = "any expression"

TRACK = "Track"
TRACK_TIP = "Follow the points through the whole film (Ctrl+Return)"
TRACK_FROM = "Track on from picture {frame}"
SAVE = "Save capture…"
SAVE_TIP = "Write what was tracked as markers in millimetres, and the film's sound beside it (Ctrl+S)"
FILTER_CAPTURE = "C3D (*.c3d);;TRC (*.trc);;CSV (*.csv)"
IMPORT = "Import…"
IMPORT_TIP = "Take the saved capture into a database, in the import window"

TRUST = "TRUST"
STRIP_TIP = (
    "How sure the points of each picture are; red where the face was lost, marks where you corrected. Click to go there"
)
UNSURE = "next unsure"
UNSURE_TIP = "Go to the next picture that is unsure or in which the face was lost (F8)"
NO_UNSURE = "No picture is unsure."
STATE = "{n} pictures, {lost} lost, {unsure} unsure; {corrected} corrected by hand"
HERE = "picture {frame}: trust {trust:.2f}, drift {drift}"
HERE_LOST = "picture {frame}: the face was lost"
DRIFT = "{px:.1f} px"
NO_DRIFT = "unknown"
POINT_TIP = "{name}: trust {trust:.2f}, drift {drift}"
CANVAS_TIP = "Wheel zooms, a drag on the picture moves it; [ and ] choose a point, Alt with arrows moves it"
UNDO = "undo"
UNDO_TIP = "Take the last click or correction back (Ctrl+Z)"
REDO = "redo"
REDO_TIP = "Do it again (Ctrl+Shift+Z)"
PLAY_TIP = "Play the film with its points (Space)"

OPENING = "Opening the film"
LEARNING = "Learning motion units"
TRACKING = "Tracking"
SAVING = "Writing the capture"
SAVED = "Saved {files}"
SAVED_START = "Saved {path}; efase track --start takes it"
DONE = "Tracked {n} pictures at {rate:.0f} a second"
CLICKS_FIRST = "Click mouth and eye corners in the first picture first."
TRACK_FIRST = "Nothing was tracked yet."

# Edits, as Undo names them
EDIT_CLICK = "Click"
EDIT_MOVE_CLICK = "Move a click"
EDIT_CORRECT = "Move {name} in picture {frame}"
EDIT_ANEW = "Click anew"
EDIT_LOAD = "Load clicks"
EDIT_EXPRESSION = "Choose an expression"
