"""An artist's own curves: named controls over time, each file beside the transcript of what is said."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from core.animeme.controls import ControlTrack
from core.animeme.examples import Example
from core.animeme.material import LEARNING_RATE_HZ
from core.errors import UserFacingError
from core.motion.readers.blendshape_files import read_blendshapes
from core.pipeline.curves import read_curves_json
from core.speech.transcript_files import read_transcript

_CURVES = (".csv", ".tsv", ".json")
_TRANSCRIPTS = (".TextGrid", ".textgrid", ".lab")


def read_artist_examples(paths: Sequence[Path]) -> list[Example]:
    """Read curves and the transcripts beside them.

    paths : files (.csv, .tsv or .json; ``take.csv`` goes with ``take.TextGrid`` or ``take.lab``), or folders for all of
        the kind that lie in them
    Raises `UserFacingError` that names the file that is missing, damaged, or has other controls than the first.
    """
    files: list[Path] = []
    for path in paths:
        if path.is_dir():
            files += sorted(found for found in path.iterdir() if found.suffix.lower() in _CURVES)
        else:
            files.append(path)
    if not files:
        raise UserFacingError(f"There are no curves in '{paths[0]}'.", f"They end in {', '.join(_CURVES)}.")
    examples: list[Example] = []
    for file in files:
        track = _track(file)
        if examples:
            _check_same(examples[0].track, track, files[0], file)
            track = track.arranged(examples[0].track.names)
        spoken = next((p for s in _TRANSCRIPTS if (p := file.with_suffix(s)).is_file()), None)
        if spoken is None:
            raise UserFacingError(
                f"There is no transcript beside '{file}'.",
                f"Put one there: '{file.stem}.TextGrid' or '{file.stem}.lab'.",
            )
        examples.append(Example(read_transcript(spoken, track.duration_s), track.at_rate(LEARNING_RATE_HZ)))
    return examples


def _track(file: Path) -> ControlTrack:
    if file.suffix.lower() == ".json":
        return read_curves_json(file)
    read = read_blendshapes(file)
    try:
        return ControlTrack(read.names, read.weights, read.rate_hz)
    except UserFacingError as error:
        raise UserFacingError(f"'{file}': {error.message}", error.remedy) from error


def _check_same(first: ControlTrack, track: ControlTrack, first_file: Path, file: Path) -> None:
    strangers = set(first.names) ^ set(track.names)
    if strangers:
        raise UserFacingError(
            f"'{file}' and '{first_file}' do not have the same controls: '{min(strangers)}' is in one of them only."
        )
