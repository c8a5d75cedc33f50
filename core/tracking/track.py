"""A video tracked from its first picture to its last, and again from any picture that was corrected."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.progress import SILENT, Progress
from core.tracking.face_model import FaceModel
from core.tracking.start import Placement, placed
from core.tracking.tracker import FaceTracker, TrackedFrame, TrackerState
from core.tracking.video_pictures import LARGEST_PX, Picture, VideoFormat, format_of, pictures

# Faces larger than this are tracked in smaller pictures: sharper than need be, and slower.
_LARGEST_SCALE = 3.0

Clicks = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class TrackingRequest:
    """What is tracked.

    video : the file; model : points and units
    clicks : landmark to x, y in pixels of the first picture, two or more
    corrections : frame to marker to x, y where a hand put it; those of frame 0 change where the points begin
    """

    video: Path
    model: FaceModel
    clicks: Clicks
    corrections: Mapping[int, Clicks] = field(default_factory=dict)


@dataclass(frozen=True)
class Track:
    """What was found.

    format : of the video; shrink : share of its size at which it was tracked
    times_s : float64, shape (F,), when each picture is shown, as the file says
    points : float64, shape (F, K, 2), pixels of the video
    trust : shape (F, K), 0..1; drift_px : shape (F, K), NaN where unknown; lost : bool, shape (F,)
    states : one a frame, from which tracking can go on
    placement : of the face in the first picture, pixels of the video
    """

    request: TrackingRequest
    format: VideoFormat
    shrink: float
    placement: Placement
    times_s: np.ndarray
    points: np.ndarray
    trust: np.ndarray
    drift_px: np.ndarray
    lost: np.ndarray
    states: tuple[TrackerState, ...]

    @property
    def frame_trust(self) -> np.ndarray:
        """The mean trust of each frame's points, shape (F,), 0..1."""
        return self.trust.mean(axis=1)

    @property
    def frame_drift_px(self) -> np.ndarray:
        """The median drift of each frame's points, shape (F,); NaN where no point's is known."""
        known = np.isfinite(self.drift_px).any(axis=1)
        drift = np.full(len(self.drift_px), np.nan)
        drift[known] = np.nanmedian(self.drift_px[known], axis=1)
        return drift


def starting_points(request: TrackingRequest, size_px: tuple[int, int]) -> tuple[Placement, np.ndarray]:
    """Lay the face on the clicks of the first picture; returns its placement and its points, shape (K, 2), pixels.

    Points that a hand moved in the first picture are where it put them. Raises `UserFacingError`, see `placed`.
    """
    placement = placed(request.model, request.clicks, size_px)
    points = placement.pixels(request.model.seen)
    for row, place in _rows(request, 0).items():
        points[row] = place
    return placement, points


def track_video(request: TrackingRequest, progress: Progress = SILENT, earlier: Track | None = None) -> Track:
    """Track all of a video, or what has changed since ``earlier``.

    With ``earlier``, a track of the same video with other corrections, all frames before the first difference are taken
    from it; the answer is the same as without. Raises `UserFacingError` for a video or clicks that cannot be used.
    """
    first_new = 0 if earlier is None else _first_difference(earlier.request, request)
    if earlier is not None and first_new >= len(earlier.points):
        return replace(earlier, request=request)
    form = format_of(request.video) if earlier is None else earlier.format
    size = form.width, form.height
    placement, start = starting_points(request, size)
    shrink = min(1.0, LARGEST_PX / max(size), _LARGEST_SCALE / placement.scale)
    if first_new == 0:
        source = pictures(request.video, shrink)
        picture = _first(source, request)
        tracker = _tracker(request.model, placement, picture.grey, start, shrink)
        count = len(start)
        frames = [TrackedFrame(start * shrink, np.ones(count), np.zeros(count), False, tracker.state)]
        times_s = [picture.time_s]
    else:
        frames, times_s = _kept(earlier, first_new), earlier.times_s[:first_new].tolist()
        first = _first(pictures(request.video, shrink), request)
        tracker = _tracker(request.model, placement, first.grey, start, shrink)
        source = _taken_up(tracker, earlier, first_new)
    total = max(form.n_frames, len(frames))
    for picture in source:
        f = len(frames)
        progress.step(min(f / total, 1.0), f"tracking picture {f + 1}")
        hand = {row: place * shrink for row, place in _rows(request, f).items()}
        frames.append(tracker.accept(picture.grey, hand))
        times_s.append(picture.time_s)
    return Track(
        request, form, shrink, placement, np.array(times_s),
        np.array([frame.points for frame in frames]) / shrink, np.array([frame.trust for frame in frames]),
        np.array([frame.drift_px for frame in frames]) / shrink, np.array([frame.is_lost for frame in frames]),
        tuple(frame.state for frame in frames),
    )  # fmt: skip


def _first(source: Iterator[Picture], request: TrackingRequest) -> Picture:
    picture = next(source, None)
    if picture is None:
        raise UserFacingError(f"'{request.video}' holds no picture that can be read.")
    return picture


def _tracker(model: FaceModel, placement: Placement, grey: np.ndarray, start: np.ndarray, shrink: float) -> FaceTracker:
    """A tracker in the smaller pictures."""
    return FaceTracker(model, placement.shrunk(shrink), grey, start * shrink)


def _kept(earlier: Track, stop: int) -> list[TrackedFrame]:
    return [
        TrackedFrame(earlier.points[f] * earlier.shrink, earlier.trust[f], earlier.drift_px[f] * earlier.shrink,
                     bool(earlier.lost[f]), earlier.states[f])
        for f in range(stop)
    ]  # fmt: skip


def _taken_up(tracker: FaceTracker, earlier: Track, first_new: int) -> Iterator[Picture]:
    """Put ``tracker`` where it was before frame ``first_new``, and yield the pictures from that frame on."""
    video = earlier.request.video
    seen = int(np.flatnonzero(~earlier.lost[:first_new])[-1])  # the first one always is
    source = pictures(video, earlier.shrink, float(earlier.times_s[seen]))
    picture = next(source, None)
    if picture is None or abs(picture.time_s - earlier.times_s[seen]) > 1e-6:
        # a file that cannot be sought in is read from its beginning
        source = pictures(video, earlier.shrink)
        for _ in range(seen + 1):
            picture = next(source)
    tracker.go_on_from(earlier.states[first_new - 1], picture.grey)
    for _ in range(first_new - 1 - seen):
        next(source)
    yield from source


def _rows(request: TrackingRequest, frame: int) -> dict[int, np.ndarray]:
    """Corrections of one frame by row; raises `UserFacingError` for a point that the face has not."""
    rows = {}
    for name, place in request.corrections.get(frame, {}).items():
        if name not in request.model.names:
            raise UserFacingError(f"A correction names the point '{name}', which the face does not have.")
        rows[request.model.names.index(name)] = np.array(place, float)
    return rows


def _first_difference(one: TrackingRequest, other: TrackingRequest) -> int:
    """The first frame that is to be tracked anew."""
    if one.video != other.video or one.model is not other.model or dict(one.clicks) != dict(other.clicks):
        return 0
    frames = set(one.corrections) | set(other.corrections)
    changed = [f for f in frames if dict(one.corrections.get(f, {})) != dict(other.corrections.get(f, {}))]
    return min(changed, default=np.iinfo(int).max)
