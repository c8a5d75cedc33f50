"""An artist's own curves: named controls over time, and what is said in each take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from core.animeme.examples import Example
from core.animeme.material import LEARNING_RATE_HZ
from core.errors import UserFacingError
from core.importing.survey import kinds_of
from core.media.audio import load_audio
from core.motion.readers.blendshape_files import is_blendshape_file, take_name
from core.motion.shape_mapping import read_units
from core.pipeline.blendshapes import controls_of
from core.pipeline.curves import read_curves_json
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.speech.placing import ALIGNED, RECOGNISED, SILENCE, placed_speech
from core.speech.text_file import read_text
from core.speech.transcript import Transcript
from core.speech.transcript_files import END_TOLERANCE_S

_CURVES = (".csv", ".tsv", ".json", ".npy", ".npz")
_HOW = {
    ALIGNED: "its text was placed in its sound.",
    RECOGNISED: "what is said was recognised from the sound, taken for English.",
}


@dataclass(frozen=True)
class CurveReading:
    """What curves do not tell of themselves; the first three as `core.motion.shape_mapping.read_units` takes them.

    speech_folder : where sounds and transcripts lie that are not beside their curves
    lexicon : pronunciations, for texts that are placed in their sound
    """

    shape_names: Path | None = None
    shape_sheet: Path | None = None
    rate_hz: float | None = None
    speech_folder: Path | None = None
    lexicon: Path | None = None


def read_artist_examples(
    paths: Sequence[Path], reading: CurveReading | None = None, progress: Progress = SILENT
) -> tuple[list[Example], list[str]]:
    """Read curves, and what is said in them; return sentences on what was taken for granted too.

    paths : files of curves or weights, or folders for all that lie in them. ``take.csv`` goes with what is named
        ``take``, and facegood's ``bs_value_take.npy`` too: a transcript with times (TextGrid, .lab or .txt); else a
        sound, in which the text of a .txt is placed, and which is recognised where there is none

    Raises `UserFacingError` that names the file that is missing, damaged, or has other controls than the first.
    """
    reading = reading or CurveReading()
    files = curve_files(paths, reading)
    examples: list[Example] = []
    notes: list[str] = []
    for n, file in enumerate(files):
        track, said = _track(file, reading)
        if examples:
            _check_same(examples[0].track, track, files[0], file)
            track = track.arranged(examples[0].track.names)
        stage = progress.part(n / len(files), (n + 1) / len(files))
        transcript, heard = _spoken(file, track, reading, stage)
        stage.step(1.0, f"{file.name} read")
        notes += [f"{file.name}: {sentence}" for sentence in (*said, *heard)]
        n_frames = max(1, round(min(track.duration_s, transcript.duration_s) * LEARNING_RATE_HZ))
        examples.append(Example(transcript, track.at_rate(LEARNING_RATE_HZ, n_frames)))
    return examples, notes


def curve_files(paths: Sequence[Path], reading: CurveReading) -> list[Path]:
    """Return the files of curves that ``paths`` name, and all that lie in those that are folders.

    Raises `UserFacingError` when there is none, or the folder of sounds is missing.
    """
    if reading.speech_folder is not None and not reading.speech_folder.is_dir():
        raise UserFacingError(f"There is no folder of sounds at '{reading.speech_folder}'.")
    listed = {path.resolve() for path in (reading.shape_names, reading.shape_sheet) if path is not None}
    files: list[Path] = []
    for path in paths:
        files += sorted(found for found in path.iterdir() if _holds_curves(found)) if path.is_dir() else [path]
    files = [file for file in files if file.resolve() not in listed]
    if not files:
        raise UserFacingError(f"There are no curves in '{paths[0]}'.", f"They end in {', '.join(_CURVES)}.")
    return files


def _holds_curves(path: Path) -> bool:
    """A model that was trained before may lie among the curves."""
    suffix = path.suffix.lower()
    return suffix in _CURVES and (suffix != ".npz" or is_blendshape_file(path))


def _track(file: Path, reading: CurveReading) -> tuple[ControlTrack, tuple[str, ...]]:
    if file.suffix.lower() == ".json":
        return read_curves_json(file), ()
    read = read_units(file, reading.shape_names, reading.shape_sheet, reading.rate_hz)
    try:
        return controls_of(read), read.notes
    except UserFacingError as error:
        raise UserFacingError(f"'{file}': {error.message}", error.remedy) from error


def _spoken(
    file: Path, track: ControlTrack, reading: CurveReading, progress: Progress
) -> tuple[Transcript, tuple[str, ...]]:
    stems = (file.stem, take_name(file))
    folders = [file.parent, *([] if reading.speech_folder is None else [reading.speech_folder])]
    beside = [path for folder in folders for path in sorted(folder.iterdir()) if path.stem in stems]
    kinds = kinds_of([path for path in beside if path.is_file()])
    transcript, sound = kinds.get("transcript"), kinds.get("audio")
    if transcript is None and sound is None:
        raise UserFacingError(
            f"There is no transcript beside '{file}', and no sound.",
            f"Put one there: '{stems[-1]}.TextGrid', '{stems[-1]}.lab' or '{stems[-1]}.wav'.",
        )
    if transcript is not None:
        placed, _, _ = placed_speech(None, track.duration_s, transcript)
        return placed, placed.warnings
    audio = load_audio(sound)
    text = read_text(kinds["text"], "text") if "text" in kinds else ""
    placed, _, how = placed_speech(audio, audio.duration_s, None, text, reading.lexicon, progress)
    if how == SILENCE:
        raise UserFacingError(f"No speech is heard in '{sound}'.")
    notes = [_HOW[how]]
    if abs(audio.duration_s - track.duration_s) > END_TOLERANCE_S:
        notes.append(
            f"the sound lasts {audio.duration_s:.2f} s and the curves {track.duration_s:.2f} s; both are taken to "
            "begin at once."
        )
    return placed, (*notes, *(placed.warnings if how == ALIGNED else ()))


def _check_same(first: ControlTrack, track: ControlTrack, first_file: Path, file: Path) -> None:
    strangers = set(first.names) ^ set(track.names)
    if strangers:
        raise UserFacingError(
            f"'{file}' and '{first_file}' do not have the same controls: '{min(strangers)}' is in one of them only."
        )
