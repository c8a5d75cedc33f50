"""All words of the window in which two engines are compared. ``{names}`` are filled in."""

from __future__ import annotations

TITLE = "Compare engines"
ACTION = "&Compare engines…"
ONE, OTHER = "A", "B"
ONE_TIP = "The first of the two; choosing what B is swaps them"
OTHER_TIP = "The second of the two; choosing what A is swaps them"
SWAP_TIP = "Swap A and B (X)"
CAPTURED = "As captured"
CAPTURED_TIP = "How the actor herself said this sentence"
CAPTURED_NONE_TIP = "This sentence was not captured"
BOTH = "A with B over it"
BESIDE = ("beside", "side by side", "Two faces beside each other (O)")
OVERLAID = ("overlaid", "overlaid", "One face, and the other over it as lines, or markers in two colours (O)")

WAITING = "Choose speech and a motion database in the main window."
COMPARING = "Comparing engines"
COMPARING_WITH = "Making the motion of A and of B…"
STOPPED = "Press compare again (Ctrl+Return), or choose other engines."
FINDING_CAPTURE = "Looking for the capture"
FAILED = "{engine}: {why}"
AGAIN = "compare again"
AGAIN_TIP = "Make both motions again (Ctrl+Return)"
LEARNT = "This sentence is one of the database's: engines have learnt from it and may repeat its capture."
HELD_OUT = "This sentence was held out: no engine has learnt from it."
NOT_CAPTURED = "This sentence was not captured, so there is no error to measure, only what lies between A and B."
LAYERS = "engines alone, without the edited curves and the polish"

# Curves
CURVES = "CURVES"
GAP = "lip gap"
WIDTH = "lip width"
DIFFERENCE = "A to B"
ERROR = "error"
LIP_ERROR = "lip error"
MM = "mm"
SECOND_TIP = "What the second lane shows: how wide the mouth is, or a control of the face"
ERROR_OF_FACE = ("face", "face", "Error of all markers against the capture")
ERROR_OF_LIPS = ("lips", "lips", "Error of the lips' markers against the capture")
GRAPH_HINT = "Point to read values, click or drag to move the playhead, wheel to zoom, 0 for all"
GRAPH_NAMES = {"one": "A", "other": "B", "captured": "captured", "face": "face", "lips": "lips"}
FINDING_CONTROLS = "Finding control curves"

# Figures
FIGURES = "FIGURES"
AGAINST = "{of} – {standard}"
CAPTURED_SHORT = "captured"
FIGURE_ROWS = {
    "rms_mm": ("face, RMS", "mm", "Root of the mean squared distance over all markers and frames (equation 12)"),
    "mean_mm": ("face, mean", "mm", "Mean distance over all markers and frames"),
    "lip_rms_mm": ("lips, RMS", "mm", "Root of the mean squared distance over the markers of the lips"),
    "lip_mean_mm": ("lips, mean", "mm", "Mean distance over the markers of the lips"),
    "gap_r": ("lip gap r", "", "Pearson's correlation of the lip gaps"),
    "width_r": ("lip width r", "", "Pearson's correlation of the lip widths"),
    "gap_variance_ratio": ("gap variance", "×", "Variance of the lip gap over that of the second named, smoothed "
                           "lightly at 25 Hz: 1 is as alive, less is duller"),
    "velocity_variance_ratio": ("velocity variance", "×", "The same of the lip gap's velocity: more than 1 jitters"),
}  # fmt: skip
UNKNOWN = "–"

# Exports
SAVE_CURVES = "Curves…"
SAVE_CURVES_TIP = "Write all curves as a table, a row a frame (Ctrl+S)"
SAVE_FILM = "Film…"
SAVE_FILM_TIP = "Write a film of both, side by side, with the sound (Ctrl+E)"
FILTER_CURVES = "Tables (*.csv)"
FILTER_FILM = "Films (*.avi *.mp4)"
CURVES_NAME = "{one}-{other}.csv"
FILM_NAME = "{one}-{other}.avi"
WRITING_CURVES = "Writing the curves"
WRITING_FILM = "Drawing the film"
SAVED = "Saved {path}"
FILM_PROCESS_DIED = "The process that draws the film ended before it was done."
