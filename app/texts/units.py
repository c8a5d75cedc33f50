"""All words of the motion units page and its figures. ``{names}`` are filled in."""

from __future__ import annotations

SPEECH_UNIT = "speech {number}"
FIGURE_DRAWN = "Keyframes as drawn on the face “{face}”"
FIGURE_CAPTURED = "Keyframes as captured in “{name}”"
NOTE_DRAWN = "not captured, drawn"
FIGURE_UNITS = "Motion units, two standard deviations to either side"

TITLE = "Motion units"
ACTION = "Motion &units…"
SETTINGS = "MOTION UNITS"
NO_DATABASE = "Open a motion database in the main window to learn motion units from it."
LEARNING = "Learning motion units"
FACE_PANE = "FACE"
FACE = ("face", "face", "Show the face of the main window as the markers move it")
DOTS = ("dots", "dots", "Show the markers")

SPEECH_UNITS = "Units of speech"
EXPRESSION_UNITS = "Units of an expression"
BY_SHARE = ("share", "by share", "As many units as cover this share of the variance")
BY_COUNT = ("count", "by hand", "So many units")
SHARE_TIP = "Share of the variance that the units shall cover; the paper's is 97.56 % for speech"
COUNT_TIP = "How many units; the paper has 7 for speech and 2 for each expression"
COVERED_SPEECH = "{count} cover {share:.2f} % of neutral speech"
COVERED_EXPRESSION = "{name}: {count} cover {share:.2f} % of what speech leaves"
NO_EXPRESSIONS = "The database holds neutral speech alone."
EXPRESSION = "Expression"
EXPRESSION_TIP = "Which expression's units are added to those of speech"
INTENSITY = "Intensity"
INTENSITY_TIP = "α of the expression in equation 2; the paper knows 0 and 1"
SAVE_KEYFRAMES = "Save keyframes…"
SAVE_KEYFRAMES_TIP = "Draw all keyframes on the face, as figure 4, into one picture"
SAVE_UNITS = "Save units…"
SAVE_UNITS_TIP = "Draw each unit, two standard deviations to either side of the mean, into one picture"
FILTER_PICTURE = "Pictures (*.png)"
FILE_KEYFRAMES = "keyframes.png"
FILE_UNITS = "motion-units.png"
DRAWING = "Drawing the figure"
SAVED = "Saved {path}"
DIED = "The process that draws the figure ended before it was done."
NEEDS_FACE = "There is no face to draw on."
CHOOSE_FACE = "Choose one in the main window."

UNITS = "UNITS"
UNIT_TIP = "Standard deviations of the captured speech; double click puts it back to 0"
UNIT_VALUE = "{value:.2f} σ"
RESET = "mean"
RESET_TIP = "All units to 0: the mean face of the speech (Ctrl+0)"
REST = "neutral"
REST_TIP = "The units that come nearest to the neutral face"
KEYFRAMES = "KEYFRAMES"
KEYFRAME_TIP = "Weight of this keyframe; the units follow, and back (equation 4)"
CAPTURED = ("captured", "captured", "Keyframes as they occur in the database")
DRAWN = ("drawn", "drawn", "Keyframes as the shapes of the face draw them")
PRINTED = ("printed", "as printed", "Weights of whole faces, as equation 4 prints them; none of the eight is neutral")
DISPLACEMENT = ("displacement", "displacements", "Weights of displacements from the neutral face, as rigs have them")
BOUNDED = "0 to 1"
BOUNDED_TIP = "Keep all weights within 0 and 1, as rigs want them"
KEYFRAMES_OFF = "keyframes come within {off:.2f} mm of these units"
UNITS_OFF = "units come within {off:.2f} mm of these keyframes"
NOT_CAPTURED = "drawn: {names}"
CURVE_TIP = (
    "Share of the variance by number of units, in the colours of the emotions: neutral speech by its own units, an "
    "expression's by what speech leaves of it"
)
INTENSITY_VALUE = "Intensity {intensity:.0%}"
