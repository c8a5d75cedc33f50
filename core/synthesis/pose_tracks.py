"""Head, gaze and tongue along one synthesis, each on or off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.face.tongue import tongue_track
from core.speech.transcript import Transcript
from core.synthesis.head_motion import gaze_track, head_track


@dataclass(frozen=True)
class PoseTracks:
    """What moves besides the markers, frame by frame; None for a track that is off.

    head : rotation vectors (radians) and translations (mm), both shape (n_frames, 3)
    gaze : yaw and pitch, degrees, shape (n_frames, 2); tongue : tip, back, advance, shape (n_frames, 3)
    """

    head: tuple[np.ndarray, np.ndarray] | None = None
    gaze: np.ndarray | None = None
    tongue: np.ndarray | None = None

    @classmethod
    def of(
        cls,
        transcript: Transcript,
        rate_hz: float,
        n_frames: int,
        loudness_db: np.ndarray | None = None,
        *,
        head: bool = True,
        gaze: bool = True,
    ) -> PoseTracks:
        """Make the tracks for speech; the tongue always moves. Deterministic."""
        return cls(
            head_track(transcript, rate_hz, n_frames, loudness_db) if head else None,
            gaze_track(transcript, rate_hz, n_frames) if gaze else None,
            tongue_track(transcript, rate_hz, n_frames),
        )

    def later(self, first: int) -> PoseTracks:
        """Return the tracks from frame ``first`` on; a track that is shorter holds its last frame."""

        def rest(track: np.ndarray) -> np.ndarray:
            return track[min(first, len(track) - 1) :]

        return PoseTracks(
            None if self.head is None else (rest(self.head[0]), rest(self.head[1])),
            None if self.gaze is None else rest(self.gaze),
            None if self.tongue is None else rest(self.tongue),
        )

    def at(self, frame: int) -> dict[str, object]:
        """Return the keyword arguments of `FaceRig.pose` for one frame; the last frame is held."""

        def row(track: np.ndarray) -> np.ndarray:
            return track[min(frame, len(track) - 1)]

        return {
            "head": None if self.head is None else (row(self.head[0]), row(self.head[1])),
            "gaze": None if self.gaze is None else row(self.gaze),
            "tongue": None if self.tongue is None else row(self.tongue),
        }
