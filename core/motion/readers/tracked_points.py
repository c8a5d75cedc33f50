"""A folder of points tracked in video, laid out like the GRID set: ``tracks.npz``, sound and TextGrids.

The steps are those of the set's own README: a similarity fit on the points of forehead and temples, the outer eye
corners 90 mm apart, y and z flipped so that y is up and z towards the camera.
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.audio import load_audio
from core.motion.corpus import Corpus
from core.motion.marker_table import parse_marker_table
from core.motion.readers.npy import read_npz
from core.motion.recording import Recording, is_sentence_name
from core.progress import SILENT, Progress
from core.speech.transcript_files import read_transcript

OUTER_EYE_MM = 90.0
_DIMS = {"xyz64": 3, "start": 1, "clips": 1, "landmark_index": 1, "fps": 0}
_KINDS = {"xyz64": "iuf", "start": "iu", "clips": "U", "landmark_index": "iu", "fps": "iuf"}


def is_tracked_points_folder(folder: Path) -> bool:
    """Tell whether ``folder`` is laid out like the GRID set."""
    return (folder / "tracks.npz").is_file()


def read_tracked_points(folder: Path, progress: Progress = SILENT) -> Corpus:
    """Read the folder as a corpus of neutral speech; raises `UserFacingError` for what is missing or broken."""
    path = folder / "tracks.npz"
    arrays = _load(path)
    xyz = arrays["xyz64"]
    if any(array.dtype.kind not in _KINDS[name] or array.ndim != _DIMS[name] for name, array in arrays.items()):
        raise UserFacingError(f"The arrays of '{path}' are not of the kind that tracks are kept in.")
    start, clips = arrays["start"].astype(int), [str(clip) for clip in arrays["clips"]]
    sane = xyz.shape[1:] == (len(arrays["landmark_index"]), 3) and len(start) == len(clips) + 1
    if not sane or start[0] != 0 or start[-1] != len(xyz) or (np.diff(start) <= 0).any():
        raise UserFacingError(f"The arrays of '{path}' do not fit each other.")
    if xyz.dtype.kind == "f" and np.isinf(xyz).any():
        raise UserFacingError(f"'xyz64' in '{path}' holds infinite coordinates.")
    unsafe = [clip for clip in clips if not is_sentence_name(clip)]
    if unsafe:
        raise UserFacingError(f"'{path}': '{unsafe[0][:40]}' cannot be the name of a sentence.")
    rate_hz = float(arrays["fps"])
    if not 5.0 <= rate_hz <= 1000.0:
        raise UserFacingError(f"'{path}' states {rate_hz} frames a second.")
    names = tuple(f"MP{int(number):03d}" for number in arrays["landmark_index"])
    table_file = files("resources") / "markers" / "mediapipe-148.csv"
    table = parse_marker_table(table_file.read_text(encoding="utf-8"), "mediapipe-148.csv")
    strangers = set(table.kept) - set(names)
    if strangers:
        raise UserFacingError(f"'{path}' lacks the tracked point {min(strangers)}.")

    recordings = []
    for s, clip in enumerate(clips):
        progress.step(s / len(clips), f"reading {clip}")
        audio_path = folder / "audio" / f"{clip}.flac"
        transcript = read_transcript(folder / "textgrid" / f"{clip}.TextGrid", load_audio(audio_path).duration_s)
        pixels = xyz[start[s] : start[s + 1]].astype(np.float32) / 64.0
        pixels[..., 1:] *= -1.0
        text = " ".join(word.word for word in transcript.words if word.word)
        recordings.append(Recording(clip, "neutral", pixels, names, rate_hz, transcript, text, audio_path))
    return Corpus(folder.resolve().name, recordings, table.kept, table.groups, table.landmarks, with_scale=True,
                  outer_eye_mm=OUTER_EYE_MM)  # fmt: skip


def _load(path: Path) -> dict[str, np.ndarray]:
    arrays = read_npz(path, _DIMS)
    missing = [name for name in _DIMS if name not in arrays]
    if missing:
        raise UserFacingError(f"'{path}' has no array '{missing[0]}'.")
    return arrays
