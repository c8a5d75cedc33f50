"""The small things that a document is made of."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from core.folders import cache_dir
from core.media.audio import Audio
from core.motion.database import MotionDatabase
from core.speech.transcript import Transcript


class AlignedSpeech(Protocol):
    """Sound, what is said in it, and when."""

    audio: Audio
    transcript: Transcript
    text: str


@dataclass(frozen=True)
class Speech:
    """The plain form of `AlignedSpeech`."""

    audio: Audio
    transcript: Transcript
    text: str


@dataclass(frozen=True)
class FaceChoice:
    """A face by name: ``default``, or the path of a mesh, with the marker file that tells where its markers sit."""

    name: str
    marker_file: str | None = None


DEFAULT_FACE = FaceChoice("default")


@dataclass(frozen=True)
class ReferenceVideo:
    """A film of the actor; its time ``offset_s`` (seconds, may be negative) is the start of the speech."""

    path: str
    offset_s: float = 0.0


@dataclass(frozen=True)
class OutputSettings:
    """What films are made at: a name of `core.media.video.FRAME_RATES`, the number of the first frame, head motion."""

    frame_rate: str = "30"
    start_frame: int = 0
    head_moves: bool = True


DEFAULT_OUTPUT = OutputSettings()


@dataclass(frozen=True)
class DatabaseReference:
    """The motion database of a project: where it was, and what it held.

    path : None for the demo's, which is made again on every machine
    """

    name: str
    content_hash: str
    path: str | None = None

    @classmethod
    def to(cls, database: MotionDatabase) -> DatabaseReference:
        """Refer to an open database; one that lies in the cache is the demo's."""
        is_kept = database.path is not None and Path(database.path).parent.absolute() != cache_dir().absolute()
        path = str(Path(database.path).absolute()) if is_kept else None
        return cls(database.name, database.content_hash, path)


@dataclass(frozen=True)
class SoundReference:
    """The sound of a project, by the SHA-256 of what is kept of it; ``path`` is where it once came from."""

    digest: str
    path: str | None = None


@dataclass(frozen=True)
class View:
    """What was looked at; see `core.document.view_state.ViewState`."""

    slot: int | None = None
    playhead_s: float = 0.0
    map_phone: str | None = None
