"""What is read in the background: databases, speech, faces. Functions for `app.jobs`; the slow imports are in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from app import texts
from app.pictures import FaceRig
from core.document.parts import AlignedSpeech, FaceChoice, Speech
from core.errors import UserFacingError
from core.folders import data_dir
from core.media.audio import Audio
from core.motion.curation import CurationList, Removal
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.progress import Progress
from core.search.engine import SearchEngine
from core.search.parts_cache import remembered_parts
from core.speech.emotion import EmotionModifier
from core.speech.lexicon import parse_lexicon

_TEXT_SUFFIX = ".txt"
_BESIDE_SPEECH = (".TextGrid", ".textgrid", ".lab", ".txt")
_BESIDE_FACE = (".markers.csv", ".csv")


@dataclass(frozen=True)
class SpeechRequest:
    """Speech to load: sound or its file, and its text (or a text file) or a transcript file, or neither."""

    audio: Path | Audio
    text: str | None = None
    phones: Path | None = None

    @classmethod
    def with_file(cls, audio: Path | Audio, transcript: Path) -> SpeechRequest:
        """Take a transcript file: a text file holds words, unless its first line is one of ``start end phone``."""
        if transcript.suffix.lower() == _TEXT_SUFFIX and not _holds_times(transcript):
            return cls(audio, text=str(transcript))
        return cls(audio, phones=transcript)

    @classmethod
    def beside(cls, audio: Path) -> SpeechRequest:
        """Take the transcript that lies beside a sound file under its name, if there is one."""
        found = next((p for suffix in _BESIDE_SPEECH if (p := audio.with_suffix(suffix)).is_file()), None)
        return cls(audio) if found is None else cls.with_file(audio, found)


def face_beside_markers(mesh: Path) -> FaceChoice:
    """Choose a mesh with the marker file that lies beside it under its name, if there is one."""
    found = next((p for suffix in _BESIDE_FACE if (p := mesh.with_suffix(suffix)).is_file()), None)
    return FaceChoice(str(mesh), None if found is None else str(found))


@dataclass(frozen=True)
class OpenedDatabase:
    """A database with its engine, what computes, and which of its motion nodes are removed.

    trouble : (sentence, remedy) about a curation list that cannot be read, or nothing
    """

    database: MotionDatabase
    engine: SearchEngine
    backend: str
    removals: Mapping[str, Removal]
    trouble: tuple[str, str] | tuple[()] = ()


@dataclass(frozen=True)
class KnownSentence:
    """Bundled speech and the emotion that it is spoken in."""

    speech: Speech
    emotion: str


def open_motion_database(path: Path | None, progress: Progress) -> OpenedDatabase:
    """Open a database (None: the demo's, which is built the first time).

    Its transitions are priced by the first search, so that its maps can be looked at before.
    """
    from app.demo import open_named
    from gpu.device import open_kernels

    progress.step(0.0, texts.OPENING_DATABASE)
    database = open_named(path, progress)
    kernels, backend = open_kernels()
    removals, trouble = {}, ()
    try:
        removals = CurationList.of(database).read()
    except UserFacingError as error:
        trouble = error.message, error.remedy
    return OpenedDatabase(database, SearchEngine(database, kernels, price=remembered_parts), backend, removals, trouble)


def load_demo_sentence(name: str, _progress: Progress) -> KnownSentence:
    """Load a bundled sentence by name."""
    from core.actress.corpus import demo_sentences, transcript_of
    from core.media.audio import load_audio

    spoken = next(s for s in demo_sentences() if s.sentence == name)
    speech = Speech(load_audio(spoken.audio), transcript_of(spoken), spoken.text)
    speech.audio.digest  # noqa: B018  computed here, off the main thread
    return KnownSentence(speech, spoken.emotion)


def list_captured_sentences(database: MotionDatabase, _progress: Progress) -> dict[str, str]:
    """Return all sentences that a database has a capture of, name to what is said."""
    from core.motion.capture import captured_names

    return captured_names(database)


def load_captured_sentence(request: tuple[MotionDatabase, str], _progress: Progress) -> KnownSentence:
    """Load the speech of a captured sentence."""
    from core.motion.capture import captured_speech

    sound, transcript, text, emotion = captured_speech(*request)
    sound.digest  # noqa: B018  computed here, off the main thread
    return KnownSentence(Speech(sound, transcript, text), emotion)


def lexicon_path() -> Path:
    """Return where this user's own lexicon lies; it need not exist."""
    return data_dir() / "lexicon.txt"


def read_speech(request: SpeechRequest, progress: Progress) -> AlignedSpeech:
    """Read speech and align it, with the user's own lexicon."""
    from app.speech import load_speech

    path = lexicon_path()
    lexicon = path if path.is_file() and parse_lexicon(path.read_text(encoding="utf-8"), path.name) else None
    speech = load_speech(request.audio, request.text, request.phones, lexicon, progress=progress)
    speech.audio.digest  # noqa: B018  computed here, off the main thread
    return speech


def save_emotions(request: tuple[tuple[EmotionModifier, ...], float, Path], _progress: Progress) -> None:
    """Write emotion spans; one without an end ends with the speech."""
    from core.speech.emotion_files import write_emotions

    modifiers, duration_s, path = request
    write_emotions([replace(m, end_s=min(m.end_s, duration_s)) for m in modifiers], path)


def fit_face(request: tuple[FaceChoice, MarkerSet], progress: Progress) -> FaceRig:
    """Bind a face to a marker set, and work out what its views would have to on the main thread."""
    from app.face_light import face_light
    from gpu.gl.complexion import grain

    face, markers = request
    marker_file = None if face.marker_file is None else Path(face.marker_file)
    rig = FaceRig.of(face.name, markers, marker_file, progress)
    grain()
    face_light().prepare(rig.face, rig.arrays)
    return rig


def _holds_times(path: Path) -> bool:
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            columns = next((line.split() for line in file if line.strip() and not line.startswith("#")), [])
        return len(columns) >= 3 and float(columns[0]) <= float(columns[1])
    except (OSError, ValueError):
        return False
