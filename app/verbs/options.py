"""Options that several verbs share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

OUTPUTS = (
    ".avi, .mp4, .png (numbered), .c3d, .csv, .TextGrid, or for rigs .livelink.csv, .curves.csv, .json, .glb, .usd; "
    "repeat for more."
)
KeyPoses = Annotated[
    Path | None, typer.Option("--poses", help="Key lip shapes as an artist posed them on the rig (JSON).")
]
Background = Annotated[str | None, typer.Option(help="Colour behind the face, #rrggbb.")]
Span = Annotated[str | None, typer.Option("--range", metavar="START-END", help="Only this part, in seconds.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Database = Annotated[Path | None, typer.Option("--db", help="Motion database; the demo's when absent.")]
Lexicon = Annotated[Path | None, typer.Option(help="Pronunciations of names and coined words, `word phone phone …`.")]
Strict = Annotated[bool, typer.Option(help="Refuse phones that are not in the set, instead of taking the nearest.")]
Language = Annotated[str | None, typer.Option(help="The text's language, as espeak-ng names it: de, fr-fr, ...")]
AudioDir = Annotated[Path | None, typer.Option(help="Folder of sounds and texts named like the takes.")]
Rate = Annotated[float | None, typer.Option(help="Frames a second of files that do not tell.")]
ShapeNames = Annotated[Path | None, typer.Option(help="Names of the weights of blendshape arrays.")]
ShapeSheet = Annotated[Path | None, typer.Option(help="Table from such names to ARKit's (.xlsx, .csv).")]
Hold = Annotated[bool, typer.Option("--hold", help="Animemes: dragged and sung sounds keep their shape.")]
PhoneTable = Annotated[
    str | None, typer.Option("--phone-table", help="What names in the phone file stand for: pinyin, or a file.")
]
