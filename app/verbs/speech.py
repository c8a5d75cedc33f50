"""The verb on speech alone: align."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar, warn
from app.verbs.options import Json, Lexicon
from core.errors import UserFacingError


def align(
    audio: Annotated[Path, typer.Argument(help="WAV, FLAC or OGG.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Praat TextGrid to write.")],
    text: Annotated[str | None, typer.Option(help="What is said, or a text file; recognised when absent.")] = None,
    lexicon: Lexicon = None,
    json: Json = False,
) -> None:
    """Find when each word and phone is said."""
    from app.speech import load_speech
    from core.media.swap_in import check_target
    from core.speech.textgrid import write_textgrid

    if output.suffix.lower() != ".textgrid":
        raise UserFacingError(f"'{output}' is not a name for a TextGrid.", "Let it end in .TextGrid.")
    check_target(output)
    with progress_bar("align") as progress:
        speech = load_speech(audio, text, lexicon=lexicon, progress=progress)
    write_textgrid(speech.transcript, output)
    warn(speech.transcript.warnings)
    if json:
        print_json(
            {
                "text": speech.text, "recognised": speech.recognised, "duration_s": speech.transcript.duration_s,
                "words": [[w.word, w.start_s, w.end_s] for w in speech.transcript.words],
                "phonemes": _phonemes(speech.transcript), "warnings": list(speech.transcript.warnings),
                "outputs": [str(output)],
            }
        )  # fmt: skip
    else:
        print(output)


def _phonemes(transcript) -> list[dict]:
    return [{"phone": u.phone, "start_s": u.start_s, "end_s": u.end_s} for u in transcript.phonemes]
