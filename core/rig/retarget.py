"""From marker motion, of whatever engine, to the controls of a rig (Kuo et al. 2012, section 4)."""

from __future__ import annotations

from core.animeme.cross_mapping import solve_controls, units_at_markers
from core.face.face import Face
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig
from core.synthesis.marker_motion import MarkerMotion


def controls_of_motion(motion: MarkerMotion, face: Face) -> ControlTrack:
    """Find the controls of ``face``, each in [0, 1], that move its skin under the markers as they moved.

    Bounded least squares, frame by frame; what the markers do not see (the tongue) stays at rest. Raises
    `UserFacingError` for a face that has no shapes, or on which the markers cannot be laid.
    """
    Rig.of(face)  # refuses a face without shapes
    names, units = units_at_markers(face, motion.markers)
    return ControlTrack(names, solve_controls(motion.displacements, units), motion.rate_hz)
