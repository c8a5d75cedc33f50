"""Film strips: a face at a few moments of a sentence, a row for each expression or engine (as figures 6 and 7)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.pictures import FaceRig, frames
from app.texts import strips as texts
from core.errors import UserFacingError
from core.media.picture_grid import PictureRow, picture_grid
from core.progress import SILENT, Progress
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

MOST_MOMENTS = 40
_TRACK_HZ = 30.0
_GROUND = (26, 28, 31)


@dataclass(frozen=True)
class StripRow:
    """One motion of the sentence; ``label`` stands at its left."""

    label: str
    motion: MarkerMotion


@dataclass(frozen=True)
class StripSettings:
    """How a strip is laid out.

    times_s : moments of the speech; empty: ``count`` even ones from the first sound to the last
    cell_px : width and height of one face; style : one of `app.pictures.STYLES`
    background : red, green, blue, 0..1, behind the faces and between them; None: the studio's, dark
    title : over the strip; may be empty
    """

    times_s: tuple[float, ...] = ()
    count: int = 8
    cell_px: tuple[int, int] = (192, 240)
    style: str = "face"
    background: tuple[float, float, float] | None = None
    title: str = ""


def even_times_s(transcript: Transcript, count: int) -> tuple[float, ...]:
    """Return ``count`` moments, the middles of as many equal parts of what is said, silence at its ends left out."""
    said = [u for u in transcript.phonemes if u.phone != PAU] or list(transcript.phonemes)
    start_s, length_s = said[0].start_s, said[-1].end_s - said[0].start_s
    return tuple(start_s + (n + 0.5) / count * length_s for n in range(count))


def moments(transcript: Transcript, settings: StripSettings) -> tuple[float, ...]:
    """Return the moments that ``settings`` ask for; raises `UserFacingError` for too many, or outside the speech."""
    count = len(settings.times_s) or settings.count
    if not 1 <= count <= MOST_MOMENTS:
        raise UserFacingError(f"A strip has 1 to {MOST_MOMENTS} moments, not {count}.")
    for time_s in settings.times_s:
        if not 0.0 <= time_s <= transcript.duration_s:
            raise UserFacingError(f"{time_s:g} s lies outside the speech, which lasts {transcript.duration_s:.2f} s.")
    return tuple(sorted(settings.times_s)) or even_times_s(transcript, settings.count)


def film_strip(
    rows: Sequence[StripRow], rig: FaceRig | None, transcript: Transcript, settings: StripSettings,
    progress: Progress = SILENT,
) -> np.ndarray:  # fmt: skip
    """Return one picture of all rows, uint8, shape (height, width, 3), with phones, words and times under it.

    rows : of one marker set; rig : None draws markers
    Head and eyes rest, so that nothing but the face differs from picture to picture; the tongue moves.
    """
    times_s = moments(transcript, settings)
    sampled = np.concatenate([row.motion.at_times(times_s) for row in rows])
    motion = MarkerMotion(sampled, 1.0, rows[0].motion.markers)
    tongue = PoseTracks.of(transcript, _TRACK_HZ, int(transcript.duration_s * _TRACK_HZ) + 1, head=False, gaze=False)
    chosen = [min(round(time_s * _TRACK_HZ), len(tongue.tongue) - 1) for time_s in times_s]
    tracks = replace(tongue, tongue=np.tile(tongue.tongue[chosen], (len(rows), 1)))
    style = settings.style if rig is not None else "markers"
    cells = list(
        frames(motion, rig, style, *settings.cell_px, progress, tracks, background=settings.background)
    )  # fmt: skip
    n = len(times_s)
    captions, notes = zip(*(_told(transcript, time_s) for time_s in times_s))
    laid = [PictureRow(cells[r * n : (r + 1) * n], row.label) for r, row in enumerate(rows)]
    laid[-1] = replace(laid[-1], captions=captions, notes=notes)
    return picture_grid(laid, settings.title, _ground(settings.background))


def _told(transcript: Transcript, time_s: float) -> tuple[str, str]:
    """The phone of a moment, and under it the time and the word."""
    phone = next((u.phone for u in transcript.phonemes if u.start_s <= time_s < u.end_s), PAU)
    word = next((w.word for w in transcript.words if w.start_s <= time_s < w.end_s), "")
    return texts.SILENCE if phone == PAU else phone, " ".join([texts.TIME.format(time_s=time_s), word]).strip()


def _ground(background: tuple[float, float, float] | None) -> tuple[int, int, int]:
    return _GROUND if background is None else tuple(round(255 * part) for part in background)
