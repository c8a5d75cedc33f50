"""The window's questions: which file, which sentence, which command."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMainWindow

from app import texts
from app.authoring import Authoring
from app.loading import SpeechRequest, face_beside_markers, save_emotions
from app.panels.commands import Choosable, Chooser, commands
from app.panels.message_bar import MessageBar
from app.project_keeper import ProjectKeeper
from app.settings import last_folder, remember_folder, window_settings
from core.document.parts import FaceChoice, ReferenceVideo
from core.document.project_file import SUFFIX
from core.face.face_file import FACE_SUFFIX

_DATABASE_SUFFIXES = (".h5", ".hdf5")
_FACE_SUFFIXES = (".obj", ".ply", ".glb", ".gltf", ".npz")


class AskingWindow(QMainWindow):
    """A window that asks, and hands what it is told to authoring."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self.authoring = authoring
        self.keeper = ProjectKeeper(authoring, self)
        self.settings = window_settings()
        self.message = MessageBar()
        self.chooser = Chooser(self)

    def _ask_file(self, kind: str, title: str, pattern: str) -> Path | None:
        name, _ = QFileDialog.getOpenFileName(self, title, last_folder(self.settings, kind), pattern)
        if not name:
            return None
        remember_folder(self.settings, kind, Path(name))
        return Path(name)

    def ask_speech(self) -> None:
        """Choose a sound file; it is recognised at once, and can be given its words afterwards."""
        path = self._ask_file("speech", texts.OPEN_SPEECH, texts.FILTER_SOUND)
        if path is not None:
            self.open_file(path)

    def choose_command(self) -> None:
        """Show everything that can be done now, to be searched by typing."""
        self.chooser.open(texts.COMMANDS_HINT, commands(self))

    def ask_captured(self) -> None:
        """Choose a sentence that was captured, to compare what is synthesised with it."""

        def choose(names: dict[str, str]) -> None:
            self.chooser.open(texts.CAPTURED_HINT, [
                Choosable(f"{text}   ({name})", lambda name=name: self.authoring.open_captured(name))
                for name, text in names.items()
            ])  # fmt: skip

        self.authoring.list_captured(choose)

    def ask_transcript(self) -> None:
        """Choose a transcript for the sound."""
        speech = self.authoring.document.speech
        if speech is None:
            self.message.say(texts.SYNTHESISE_NEEDS_SPEECH + ".")
            return
        path = self._ask_file("speech", texts.OPEN_TRANSCRIPT, texts.FILTER_TRANSCRIPT)
        if path is not None:
            self.authoring.load_speech(SpeechRequest.with_file(speech.audio, path))

    def ask_emotions(self) -> None:
        """Choose an emotion specification."""
        path = self._ask_file("speech", texts.OPEN_EMOTIONS, texts.FILTER_EMOTIONS)
        if path is not None:
            self.authoring.load_emotions(path)

    def ask_face(self) -> None:
        """Choose a face."""
        path = self._ask_file("face", texts.OPEN_FACE, texts.FILTER_FACE)
        if path is not None:
            self._open_face(path)

    def ask_database(self) -> None:
        """Choose a motion database."""
        path = self._ask_file("database", texts.OPEN_DATABASE, texts.FILTER_DATABASE)
        if path is not None:
            self.authoring.open_database(path)

    def ask_reference(self) -> None:
        """Choose a film of the actor."""
        path = self._ask_file("reference", texts.VIDEO_REFERENCE, texts.FILTER_REFERENCE)
        if path is not None:
            self.authoring.set_reference_video(ReferenceVideo(str(path)))

    def ask_save_emotions(self) -> None:
        """Choose where the emotion spans go, as lines of ``start end emotion intensity``."""
        document = self.authoring.document
        if document.speech is None:
            return
        start = Path(last_folder(self.settings, "speech")) / "emotions.txt"
        name, _ = QFileDialog.getSaveFileName(self, texts.SAVE_EMOTIONS, str(start), texts.FILTER_EMOTIONS)
        if name:
            remember_folder(self.settings, "speech", Path(name))
            request = (document.modifiers, document.speech.transcript.duration_s, Path(name))
            done = texts.FILM_SAVED.format(path=name)
            jobs = self.authoring.jobs
            jobs.start("save", texts.SAVING, request, save_emotions, lambda _: self.authoring.noted.emit(done))

    def ask_save_film(self) -> None:
        """Choose where a copy of the film goes."""
        if self.authoring.film.path is None:
            return
        start = Path(last_folder(self.settings, "film")) / "synthesis.avi"
        name, _ = QFileDialog.getSaveFileName(self, texts.SAVE_FILM, str(start), texts.FILTER_VIDEO)
        if name:
            path = Path(name) if Path(name).suffix.lower() == ".avi" else Path(f"{name}.avi")
            remember_folder(self.settings, "film", path)
            self.authoring.film.save(path)

    def open_file(self, path: Path) -> None:
        """Open whatever ``path`` is: a project, speech, a motion database or a face."""
        suffix = path.suffix.lower()
        if suffix == SUFFIX:
            self.keeper.open(path)
        elif suffix in _DATABASE_SUFFIXES:
            self.authoring.open_database(path)
        elif suffix in _FACE_SUFFIXES:
            self._open_face(path)
        else:
            self.message.hide()
            self.authoring.load_speech(SpeechRequest.beside(path))

    def _open_face(self, path: Path) -> None:
        """A mesh alone does not tell where markers sit; ask for that file when it is not beside the mesh."""
        face = face_beside_markers(path)
        if face.marker_file is None and path.suffix.lower() != FACE_SUFFIX:
            markers = self._ask_file("face", texts.OPEN_MARKERS.format(face=path.name), texts.FILTER_MARKERS)
            face = FaceChoice(face.name, None if markers is None else str(markers))
        self.authoring.set_face(face)
