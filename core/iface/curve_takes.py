"""A studio's own blendshape curves as takes: what they do to the markers of the default face is what is learned."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.animeme.artist_curves import CurveReading
from core.errors import UserFacingError
from core.face.blendshape_drive import markers_of_blendshapes
from core.face.marker_units import MarkerUnits
from core.iface.heard_takes import HeardTake
from core.iface.motion_unit import NEUTRAL
from core.iface.noisy_hearing import heard_in_noises
from core.iface.speech_features import RATE_HZ, speech_features
from core.importing.survey import kinds_of
from core.media.audio import load_audio
from core.motion.readers.blendshape_files import take_name
from core.motion.shape_mapping import read_units
from core.progress import SILENT, Progress
from core.speech.placing import placed_speech


def curve_takes(
    files: Sequence[Path], reading: CurveReading, units: MarkerUnits, progress: Progress = SILENT, n_noises: int = 0
) -> list[HeardTake]:
    """Read curves of 30 frames a second and the sounds named like them; what is said is recognised, taken for English.

    Motion is that of the markers ``units`` keeps, mm, so that equations 6–8 are asked about points as on captures, and
    not about the names that a studio gives its shapes. Frames in which no face was tracked are not used. Each sound is
    heard in ``n_noises`` noises besides.

    files : of weights, see `core.motion.shape_mapping.read_units`; every sound lies beside its curves or in
        ``reading.speech_folder``, ``take.wav`` to ``bs_value_take.npy``

    Raises `UserFacingError` for a file that cannot be read, has another rate, or lacks a sound.
    """
    takes = []
    for f, file in enumerate(files):
        stage = progress.part(f / len(files), (f + 1) / len(files))
        track = read_units(file, reading.shape_names, reading.shape_sheet, reading.rate_hz)
        if abs(track.rate_hz - RATE_HZ) > 1e-3:
            raise UserFacingError(f"'{file}' has {track.rate_hz:g} frames a second, not {RATE_HZ}.")
        moved = markers_of_blendshapes(track, units).positions - units.markers.rest[units.kept]
        audio = load_audio(_sound(file, reading.speech_folder))
        transcript, _, _ = placed_speech(audio, audio.duration_s, lexicon=reading.lexicon, progress=stage)
        n_frames = min(len(moved), round(audio.duration_s * RATE_HZ))
        is_seen = np.isfinite(moved[:n_frames]).all(axis=(1, 2))
        displacements = np.nan_to_num(moved[:n_frames]).astype(np.float32)
        features = speech_features(audio, n_frames)
        noises = heard_in_noises(audio, n_frames, n_noises, f)
        takes.append(HeardTake(take_name(file), NEUTRAL, transcript, features, displacements, is_seen, noises))
        stage.step(1.0, f"{file.name} heard")
    return takes


def _sound(file: Path, folder: Path | None) -> Path:
    folders = [file.parent, *([] if folder is None else [folder])]
    beside = [p for f in folders for p in sorted(f.iterdir()) if p.stem in (file.stem, take_name(file)) and p.is_file()]
    sound = kinds_of(beside).get("audio")
    if sound is None:
        raise UserFacingError(f"There is no sound of '{file}'.", f"Put '{take_name(file)}.wav' beside it.")
    return sound
