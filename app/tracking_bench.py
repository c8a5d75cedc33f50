"""How well faces are tracked in rendered videos whose every point is known, beside tracking points alone."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np

from app.tracking_scene import RATE_HZ, Scene, Trouble
from core.actress.corpus import SpokenSentence, comparison_sentences, tuning_sentences
from core.errors import UserFacingError
from core.face.default_face import character_face
from core.iface.affine_fit import AffineFit, PosedUnits, refined
from core.media.video import write_video
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.tracking.face_model import CLICKED, FaceModel
from core.tracking.optical_flow import followed, look_of
from core.tracking.track import TrackingRequest, starting_points, track_video
from core.tracking.video_pictures import pictures

# name: character, head motion as a multiple of the actress's own, trouble
CONDITIONS: dict[str, tuple[str, float, Trouble]] = {
    "clean": ("default", 1.0, Trouble()),
    "noise": ("default", 1.0, Trouble(noise=10.0)),
    "blur": ("default", 1.0, Trouble(noise=5.0, blur_px=1.5)),
    "light": ("default", 1.0, Trouble(noise=5.0, light=0.35)),
    "head": ("default", 3.0, Trouble(noise=5.0)),
    "all": ("default", 2.0, Trouble(noise=10.0, blur_px=1.0, light=0.25)),
    "another face, noise": ("ben", 1.0, Trouble(noise=10.0)),
    "old face, noise": ("rosa", 1.0, Trouble(noise=10.0)),
}
METHODS = ("alone", "alone, first picture", "paper", "constrained")
_PARTS = {"test": comparison_sentences, "tune": tuning_sentences}
_SURE, _NEAR_PX = 0.5, 6.0


def bench_tracking(
    database: MotionDatabase, part: str = "test", per_emotion: int = 3, conditions: Sequence[str] = tuple(CONDITIONS),
    progress: Progress = SILENT,
) -> dict[str, object]:  # fmt: skip
    """Track rendered sentences that no unit was learned from; returns {rows}, one a condition.

    part : ``test`` (the comparison sentences) or ``tune``; per_emotion : sentences of each emotion
    Errors are pixels at 640 by 480, of all points and all frames but the first, where they are 0.
    """
    if part not in _PARTS:
        raise UserFacingError(f"There is no part '{part}' to measure on.", f"Known are {', '.join(_PARTS)}.")
    strangers = [name for name in conditions if name not in CONDITIONS]
    if strangers:
        raise UserFacingError(f"There is no condition '{strangers[0]}'.", f"Known are {', '.join(CONDITIONS)}.")
    sentences = _chosen(_PARTS[part](), per_emotion)
    model = FaceModel.of_database(database)
    rows = []
    with tempfile.TemporaryDirectory(prefix="efase-tracking-") as folder:
        for c, name in enumerate(conditions):
            stage = progress.part(c / len(conditions), (c + 1) / len(conditions))
            rows.append(_row(name, sentences, model, Path(folder) / "scene.mp4", stage))
    return {"part": part, "sentences": len(sentences), "points": len(model.names), "units": len(model.units),
            "rows": rows}  # fmt: skip


def _chosen(sentences: list[SpokenSentence], per_emotion: int) -> list[SpokenSentence]:
    chosen: dict[str, list[SpokenSentence]] = {}
    for spoken in sentences:
        chosen.setdefault(spoken.emotion, []).append(spoken)
    return [spoken for each in chosen.values() for spoken in each[:per_emotion]]


def _row(
    name: str, sentences: list[SpokenSentence], model: FaceModel, path: Path, progress: Progress
) -> dict[str, object]:
    character, head_gain, trouble = CONDITIONS[name]
    face = character_face(character)
    errors: dict[str, list[np.ndarray]] = {method: [] for method in METHODS}
    n_frames, seconds, cpu_s, n_lost = 0, 0.0, 0.0, 0
    for s, spoken in enumerate(sentences):
        progress.step(s / len(sentences), f"{name}: {spoken.sentence}")
        scene = Scene.of(face, spoken, head_gain)
        seen = trouble.of(scene.pictures(), seed=s)
        write_video(path, seen, len(scene.vertices), Fraction(int(RATE_HZ)))
        request = request_for(scene, path, model)
        began, cpu_began_s = time.perf_counter(), time.process_time()
        track = track_video(request)
        seconds += time.perf_counter() - began
        cpu_s += time.process_time() - cpu_began_s
        n_frames, n_lost = n_frames + len(track.points), n_lost + int(track.lost.sum())
        truth = scene.tracks(track.points[0])
        looks = [look_of(picture.grey) for picture in pictures(path)]
        tracks = {"constrained": track.points, **{key: follow(request, looks) for key, follow in _OTHERS.items()}}
        for method, points in tracks.items():
            errors[method].append(np.linalg.norm(points - truth, axis=2)[1:].ravel())
    pooled = {method: np.concatenate(each) for method, each in errors.items()}
    best_free = min(pooled[method].mean() for method in METHODS[:2])
    return {
        "condition": name, "frames": n_frames, "lost": n_lost, "frames_per_s": round(n_frames / seconds, 1),
        "cpu_ms_per_frame": round(1000 * cpu_s / n_frames, 1),
        "mean_px": {method: round(float(error.mean()), 3) for method, error in pooled.items()},
        "p95_px": {method: round(float(np.quantile(error, 0.95)), 2) for method, error in pooled.items()},
        "less_than_alone": round(1.0 - float(pooled["constrained"].mean() / best_free), 3),
    }  # fmt: skip


def request_for(scene: Scene, path: Path, model: FaceModel) -> TrackingRequest:
    """Click mouth and eye corners where they are in the scene's first picture."""
    at = scene.pixels(scene.vertices[0].astype(float))
    clicks = {name: tuple(at[scene.face.landmarks[name]].tolist()) for name in CLICKED}
    return TrackingRequest(path, model, clicks)


def alone(request: TrackingRequest, looks: Sequence[np.ndarray]) -> np.ndarray:
    """Follow each point by itself from picture to picture, shape (F, K, 2)."""
    points = [_start(request, looks)]
    for before, now in pairwise(looks):
        points.append(followed(before, now, points[-1], points[-1]).points)
    return np.array(points)


def alone_with_first(request: TrackingRequest, looks: Sequence[np.ndarray]) -> np.ndarray:
    """The same, and each point then goes where it looks as in the first picture, if that is near and comes back."""
    first = _start(request, looks)
    points = [first]
    for before, now in pairwise(looks):
        step = followed(before, now, points[-1], points[-1]).points
        back = followed(looks[0], now, first, step)
        is_sure = (back.trust > _SURE) & (np.linalg.norm(back.points - step, axis=1) < _NEAR_PX)
        points.append(np.where(is_sure[:, None], back.points, step))
    return np.array(points)


def as_in_the_paper(request: TrackingRequest, looks: Sequence[np.ndarray]) -> np.ndarray:
    """Equation 5 alone: points from the last picture, a 2D affine, least squares, all points alike."""
    first = _start(request, looks)
    placement, _ = starting_points(request, (looks[0].shape[1], looks[0].shape[0]))
    model = request.model
    face = PosedUnits(placement.millimetres(first), model.units[..., :2])
    fit = AffineFit(np.zeros(len(face.units)), np.column_stack([placement.scale * placement.turn, placement.shift]))
    points = [first]
    for before, now in pairwise(looks):
        fit = refined(face, followed(before, now, points[-1], points[-1]).points, fit, prior=1e-3 / model.variance)
        points.append(fit.points(face))
    return np.array(points)


_OTHERS: dict[str, Callable[[TrackingRequest, Sequence[np.ndarray]], np.ndarray]] = {
    "alone": alone, "alone, first picture": alone_with_first, "paper": as_in_the_paper,
}  # fmt: skip


def _start(request: TrackingRequest, looks: Sequence[np.ndarray]) -> np.ndarray:
    return starting_points(request, (looks[0].shape[1], looks[0].shape[0]))[1]


def as_table(answer: dict[str, object]) -> str:
    """Lay the rows out as a Markdown table."""
    lines = [f"| condition | frames | {' | '.join(METHODS)} | less than alone | 95 % | frames/s | CPU ms |",
             "|---|" + "---|" * (len(METHODS) + 5)]  # fmt: skip
    for row in answer["rows"]:
        cells = [row["condition"], str(row["frames"]), *(f"{row['mean_px'][method]:.2f}" for method in METHODS)]
        cells += [f"{row['less_than_alone']:.0%}", f"{row['p95_px']['constrained']:.1f}"]
        cells += [f"{row['frames_per_s']:.0f}", f"{row['cpu_ms_per_frame']:.0f}"]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
