"""The films of a perception study: each audio in each expression, synthetic and captured, with and without sound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from app.export import VideoSettings, export
from app.pictures import FaceRig
from app.stimuli.real_films import write_real_film
from app.stimuli.tracks import Track, words_of
from core.evaluation.stimuli import AUDIO, BIMODAL, CAPTURED, SILENT, Stimulus
from core.media.audio import write_wav
from core.media.silent_film import without_sound
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.speech.emotion import EmotionModifier
from core.synthesis.dubbing import dubbed
from core.synthesis.engine import MotionEngine, SpeechInput
from core.synthesis.marker_motion import MarkerMotion


def write_stimuli(
    folder: Path, stimuli: Sequence[Stimulus], files: Mapping[str, str], tracks: Sequence[Track],
    database: MotionDatabase, engine: MotionEngine, rig: FaceRig | None, video: VideoSettings, progress: Progress,
) -> list[str]:  # fmt: skip
    """Write every film with and without its sound, and every sound alone; return sentences to warn with.

    files : path within ``folder`` by code of a stimulus
    rig : None draws markers

    Head, gaze and tongue come from the sound, so that they are alike in all films of an audio.
    """
    code_of = {(s.kind, s.track, s.expression, s.face): s.code for s in stimuli}
    films = [s for s in stimuli if s.kind == BIMODAL]
    by_name = {track.name: track for track in tracks}
    warnings: list[str] = []
    for n, stimulus in enumerate(films):
        stage = progress.part(n / len(films), (n + 1) / len(films))
        track = by_name[stimulus.track]
        path = folder / files[stimulus.code]
        if stimulus.face == CAPTURED and track.films:
            write_real_film(path, track.films[stimulus.expression], track, video, stage)
        elif stimulus.face == CAPTURED:
            motion = _captured_motion(database, track, stimulus.expression)
            export(motion, track.audio, rig, path, video, stage, track.transcript)
        else:
            motion, said = _synthetic_motion(database, engine, track, stimulus.expression, stage.part(0.0, 0.2))
            warnings += said
            export(motion, track.audio, rig, path, video, stage.part(0.2, 1.0), track.transcript)
        silent = code_of[SILENT, stimulus.track, stimulus.expression, stimulus.face]
        without_sound(path, folder / files[silent])
    for track in tracks:
        write_wav(track.audio, folder / files[code_of[AUDIO, track.name, None, None]])
    return warnings


def _captured_motion(database: MotionDatabase, track: Track, expression: str) -> MarkerMotion:
    take = track.takes[expression]
    frames = database.frames[take.start_frame : take.stop_frame].astype(float)
    motion = MarkerMotion(database.pca.positions(frames).astype(np.float32), database.rate_hz, database.markers)
    return dubbed(motion, take.transcript, track.transcript)


def _synthetic_motion(
    database: MotionDatabase, engine: MotionEngine, track: Track, expression: str, progress: Progress
) -> tuple[MarkerMotion, tuple[str, ...]]:
    # a search that may use the captures of these very words would show them again
    words = words_of(track.text)
    rows = {row for row, sentence in enumerate(database.sentences) if words_of(sentence.text) == words}
    nodes = database.nodes
    removed = frozenset(nodes.name(n) for n in np.flatnonzero(np.isin(nodes.sentence, list(rows))))
    modifiers = (EmotionModifier(0.0, track.transcript.duration_s, expression),)
    answer = engine.synthesise(SpeechInput(track.transcript, modifiers, removed=removed, audio=track.audio), progress)
    return answer.motion, answer.warnings
