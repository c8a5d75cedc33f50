"""All words of the motion units page and its figures. ``{names}`` are filled in."""

from __future__ import annotations

SPEECH_UNIT = "speech {number}"
FIGURE_DRAWN = "Keyframes as drawn on the face “{face}”"
FIGURE_CAPTURED = "Keyframes as captured in “{name}”"
FIGURE_UNITS = "Motion units, two standard deviations to either side"
