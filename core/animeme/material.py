"""Examples from a motion database: its own principal components, key lip shapes, or the units of a face."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from core.animeme.cross_mapping import RIDGE_MM2, solve_controls, solve_shares, units_at_markers
from core.animeme.examples import Example
from core.animeme.key_shapes import captured_keys
from core.errors import UserFacingError
from core.evaluation.measures import lip_gap_mm, lip_width_mm
from core.face.face import Face
from core.motion.database import MotionDatabase
from core.motion.head_space import in_head_space
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack

# Curves are learnt at the rate of video: at 120 Hz the frames say nearly the same, four times.
LEARNING_RATE_HZ = 30.0

# Maps marker positions in head space, (F, K, 3) mm, to values of controls, (F, U).
Mapping = Callable[[np.ndarray], np.ndarray]


def database_examples(
    database: MotionDatabase, names: Sequence[str], mapping: Mapping, n_sentences: int | None = None,
    progress: Progress = SILENT,
) -> list[Example]:  # fmt: skip
    """Return the sentences of ``database`` with the controls that ``mapping`` makes of their markers.

    n_sentences : only the first so many; all when None
    """
    step = max(1, round(database.rate_hz / LEARNING_RATE_HZ))
    chosen = database.sentences[:n_sentences]
    examples = []
    for s, sentence in enumerate(chosen):
        progress.step(s / len(chosen), f"controls of {sentence.name}")
        frames = database.frames[sentence.start_frame : sentence.stop_frame : step].astype(float)
        if len(frames):
            track = ControlTrack(tuple(names), mapping(database.pca.positions(frames)), database.rate_hz / step)
            examples.append(Example(sentence.transcript, track, sentence.emotion))
    return examples


def recorded_examples(
    database: MotionDatabase, recordings: Sequence[Recording], names: Sequence[str], mapping: Mapping
) -> list[Example]:
    """Return ``recordings`` that ``database`` does not hold, at their own rate; what long gaps hide is bridged."""
    examples = []
    for recording in recordings:
        face = in_head_space(recording, database.markers, database.with_scale).face
        n_frames = min(len(face), int(recording.transcript.duration_s * recording.rate_hz) + 1)
        track = ControlTrack(tuple(names), mapping(face[:n_frames]), recording.rate_hz)
        examples.append(Example(recording.transcript, track, recording.emotion))
    return examples


def component_controls(database: MotionDatabase) -> tuple[tuple[str, ...], Mapping]:
    """Take the principal components of the markers for controls: they tell all that the markers do."""
    names = tuple(f"component{d + 1:02d}" for d in range(database.pca.n_dims))
    return names, database.pca.coefficients


def key_shape_controls(
    database: MotionDatabase, n_shapes: int = 7, seed: int = 2008
) -> tuple[tuple[str, ...], Mapping]:
    """Take shares of key lip shapes for controls (Kuo et al. 2012, section 4: a rig that has bases of its own).

    Raises `UserFacingError` when the markers are not told which are the lips.
    """
    lips, shapes = captured_keys(database, n_shapes, seed)
    rest = database.markers.rest[lips]
    return (
        tuple(f"lips{k + 1}" for k in range(len(shapes))),
        lambda positions: solve_shares(positions[:, lips] - rest, shapes),
    )


def face_controls(
    database: MotionDatabase, face: Face, ridge_mm2: float = RIDGE_MM2
) -> tuple[tuple[str, ...], Mapping]:
    """Take the units of ``face`` for controls, in [0, 1]; raises `UserFacingError` for a face without units."""
    if not face.units:
        raise UserFacingError(f"The face {face.name} has no shapes to control.")
    names, units = units_at_markers(face, database.markers)
    rest = database.markers.rest
    return names, lambda positions: solve_controls(positions - rest, units, ridge_mm2)


def mouth_measures(database: MotionDatabase) -> tuple[tuple[str, ...], Mapping]:
    """Take lip gap and mouth width for controls, mm from rest: few, and everybody knows what they mean.

    Raises `UserFacingError` when the markers do not show them.
    """
    landmarks = ("upper_lip", "lower_lip", "mouth_corner_left", "mouth_corner_right")
    marks = [database.markers.landmark(name) for name in landmarks]
    if None in marks:
        raise UserFacingError(f"The markers of '{database.name}' do not show how the mouth opens.")
    upper, lower, left, right = marks

    def measured(positions: np.ndarray) -> np.ndarray:
        return np.stack([lip_gap_mm(positions, upper, lower), lip_width_mm(positions, left, right)], axis=1)

    rest = measured(database.markers.rest[None])
    return ("lip gap", "mouth width"), lambda positions: measured(positions) - rest
