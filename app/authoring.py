"""What an animator can ask for. A wish becomes an edit, or a job whose answer becomes one; panels only ask."""

from __future__ import annotations

import logging
import shutil
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app import texts
from app.export import FRAME_RATES, VideoSettings
from app.jobs import JobRunner
from app.pictures import FaceRig
from app.player import Player
from core.document.change import ASKED_OF_THE_SEARCH, Change
from core.document.document import AlignedSpeech, Document, Edit
from core.document.edits import PinMotionNode, SetDatabase, SetEmotion, SetFace, SetSpeech
from core.document.view_state import ViewState
from core.errors import UserFacingError
from core.media.audio import Audio
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.progress import Progress
from core.search.engine import SearchAnswer, SearchEngine, SpeechInput
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion

log = logging.getLogger("authoring")

_COMPOSE_AFTER_MS = 400


@dataclass(frozen=True)
class SpeechRequest:
    """Speech to load: a sound file, and its text or a transcript file, or neither."""

    audio: Path
    text: str | None = None
    phones: Path | None = None


@dataclass(frozen=True)
class _BundledSpeech:
    """A sentence that comes with the workstation."""

    audio: Audio
    transcript: Transcript
    text: str


@dataclass(frozen=True)
class _OpenDatabase:
    database: MotionDatabase
    engine: SearchEngine
    backend: str


@dataclass(frozen=True)
class _FilmRequest:
    motion: MarkerMotion
    audio: Audio
    rig: FaceRig | None
    settings: VideoSettings
    path: Path


class _EditCommand(QUndoCommand):
    """Wraps an edit for Qt's undo stack, which gives the menu its labels."""

    def __init__(self, document: Document, edit: Edit, origin: object) -> None:
        super().__init__(edit.label)
        self._document, self._edit, self._origin = document, edit, origin

    def redo(self) -> None:
        self._document.apply(self._edit, self._origin)
        self._origin = None  # whoever asked shows it the first time; later it is news to all

    def undo(self) -> None:
        self._document.revert(self._edit)


class Authoring(QObject):
    """Joins document, jobs, undo and playback.

    failed(sentence, remedy) : for the message bar; noted(sentence) : for the status bar
    rig_changed() : another face, or none, is to be drawn; see `rig`
    backend_changed(str) : which compute backend searches
    film_changed() : see `film`, the composed video of the motion on show, or None while there is none
    film_failed(str) : why there is none
    """

    failed = Signal(str, str)
    noted = Signal(str)
    rig_changed = Signal()
    backend_changed = Signal(str)
    film_changed = Signal()
    film_failed = Signal(str)

    def __init__(self, face: str | None = "default", parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = Document(face)
        self.view = ViewState(self.document)
        self.jobs = JobRunner(self)
        self.player = Player(self.jobs, self)
        self.undo_stack = QUndoStack(self)
        self.rig: FaceRig | None = None
        self.film: Path | None = None
        self.fps_name = "30"
        self._engine: SearchEngine | None = None
        self._engines: dict[str, SearchEngine] = {}
        self._engine_lock = threading.Lock()
        self._animated: AlignedSpeech | None = None
        self._film_folder = tempfile.TemporaryDirectory(prefix="efase-films-", ignore_cleanup_errors=True)
        self._n_films = 0
        self._compose_soon = QTimer(self, singleShot=True, interval=_COMPOSE_AFTER_MS)
        self._compose_soon.timeout.connect(self._compose)
        self.document.changed.connect(self._on_document_changed)
        self.player.moved.connect(self.view.move_playhead)
        self.player.noted.connect(self.noted)
        self.jobs.failed.connect(self.failed)

    # Opening

    def open_demo(self) -> None:
        """Open the demo database and a demo sentence, so that nothing is blank."""
        self._open_database(None)

    def open_database(self, path: Path) -> None:
        """Search another motion database from now on."""
        self._open_database(path)

    def _open_database(self, path: Path | None) -> None:
        title = texts.OPENING_DEMO if path is None else texts.OPENING_DATABASE
        self.jobs.start("database", title, path, _open_database, self._on_database_opened)

    def _on_database_opened(self, opened: _OpenDatabase) -> None:
        self._engines[opened.database.content_hash] = opened.engine
        self.backend_changed.emit(opened.backend)
        self.push(SetDatabase.on(self.document, opened.database))
        if self.document.speech is None:
            self.undo_stack.clear()  # where one starts from is nothing to take back

    def open_demo_sentence(self, name: str) -> None:
        """Choose one of the bundled sentences; its transcript and emotion are known, so it is animated at once."""
        self.jobs.start("speech", texts.LOADING_SPEECH, name, _load_demo_sentence, self._on_demo_sentence)

    def _on_demo_sentence(self, answer: tuple[AlignedSpeech, str]) -> None:
        speech, emotion = answer
        first = self.document.speech is None
        self.undo_stack.beginMacro(texts.EDIT_CHOOSE_SPEECH)
        self.push(SetSpeech.on(self.document, speech, texts.EDIT_CHOOSE_SPEECH))
        self.push(SetEmotion.on(self.document, whole_emotion(emotion), texts.EDIT_SET_EMOTION.format(emotion=emotion)))
        self.undo_stack.endMacro()
        if first:
            self.undo_stack.clear()
        self.synthesise()

    def load_speech(self, request: SpeechRequest, then_synthesise: bool = False) -> None:
        """Read and align speech in the background."""

        def applied(speech: AlignedSpeech) -> None:
            same = self.document.speech is not None and self.document.speech.audio.path == speech.audio.path
            label = texts.EDIT_SET_TRANSCRIPT if same else texts.EDIT_CHOOSE_SPEECH
            self.push(SetSpeech.on(self.document, speech, label))
            if speech.transcript.warnings:
                self.noted.emit(speech.transcript.warnings[0])
            if then_synthesise:
                self.synthesise()

        heard = request.text is None and request.phones is None
        title = texts.RECOGNISING if heard else texts.LOADING_SPEECH
        self.jobs.start("speech", title, request, _load_speech, applied)

    # Editing

    def push(self, edit: Edit, origin: object = None) -> None:
        """Do an edit that can be undone."""
        self.undo_stack.push(_EditCommand(self.document, edit, origin))

    def set_emotion(self, modifiers: tuple[EmotionModifier, ...], label: str, origin: object = None) -> None:
        """Replace the emotion spans."""
        if modifiers != self.document.modifiers:
            self.push(SetEmotion.on(self.document, modifiers, label), origin)

    def load_emotions(self, path: Path) -> None:
        """Read an emotion specification."""
        from core.speech.emotion_files import read_emotions

        try:
            modifiers = tuple(read_emotions(path))
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self.set_emotion(modifiers, texts.EDIT_SET_EMOTION.format(emotion=path.name))

    def toggle_pin(self, node: str) -> None:
        """Tie ``node`` to the selected slot, or free the slot if it is tied to just that node."""
        slot = self.view.map_slot
        if slot is None:
            self.noted.emit(texts.SELECT_TO_PIN.format(phone=self.view.map_phone))
            return
        pinned = self.document.pins.get(slot)
        self.push(PinMotionNode.on(self.document, slot, None if pinned == node else node))

    def unpin(self) -> None:
        """Free the selected slot."""
        slot = self.view.slot
        if slot is not None and slot in self.document.pins:
            self.push(PinMotionNode.on(self.document, slot, None))

    def set_face(self, face: str | None) -> None:
        """Show another face, or markers alone."""
        if face != self.document.face:
            self.push(SetFace.on(self.document, face))

    # Synthesis

    def synthesise(self) -> None:
        """Find motion for the speech; from then on it follows each edit."""
        self._animated = self.document.speech
        self._solve()

    @property
    def can_synthesise(self) -> bool:
        """Whether there is speech and a database."""
        return self.document.speech is not None and self.document.database is not None

    def _solve(self) -> None:
        speech = self.document.speech_input()
        if speech is None or self._engine is None:
            return
        request = (self._engine, speech, self._engine_lock)
        self.jobs.start("search", texts.SYNTHESISING, request, _solve, self._on_solved)

    def _on_solved(self, answer: SearchAnswer) -> None:
        self.document.show_answer(answer)
        undone = self.undo_stack.undoText()
        self.noted.emit(texts.SOLVED.format(milliseconds=1000 * answer.search_s, after=undone or texts.SYNTHESISE))
        if self.view.slot is None:
            self._select_something()

    def _select_something(self) -> None:
        phonemes = self.document.speech.transcript.phonemes
        spoken = [slot for slot, utterance in enumerate(phonemes) if utterance.phone != PAU]
        if spoken:
            self.select_slot(max(spoken[len(spoken) // 4 :], key=lambda p: phonemes[p].end_s - phonemes[p].start_s))

    # Looking

    def select_slot(self, slot: int, time_s: float | None = None) -> None:
        """Select an utterance and bring the playhead to it: to ``time_s``, or to its middle."""
        utterance = self.document.speech.transcript.phonemes[slot]
        self.seek((utterance.start_s + utterance.end_s) / 2 if time_s is None else time_s)
        self.view.select_slot(slot)

    def step_slot(self, by: int) -> None:
        """Select the next or the previous utterance."""
        speech = self.document.speech
        if speech is not None:
            now = self.view.slot if self.view.slot is not None else self.view.slot_at(self.view.playhead_s) - by
            self.select_slot(min(max(now + by, 0), len(speech.transcript.phonemes) - 1))

    def seek(self, time_s: float) -> None:
        """Move the playhead, and the sound if it plays."""
        self.player.seek(time_s)
        self.view.move_playhead(time_s)

    def step_frame(self, by: int) -> None:
        """Move the playhead by frames of the output rate."""
        self.player.pause()
        fps = float(FRAME_RATES[self.fps_name])
        self.seek((round(self.view.playhead_s * fps) + by) / fps)

    def play_or_pause(self) -> None:
        """Play, or stop where it is."""
        self.player.seek(self.view.playhead_s)
        self.player.toggle()

    # The film

    def set_frame_rate(self, name: str) -> None:
        """Choose the output rate, one of `app.export.FRAME_RATES`; the film is composed anew."""
        if name != self.fps_name:
            self.fps_name = name
            self._renew_film()

    def save_film(self, path: Path) -> None:
        """Copy the composed film to ``path``."""
        if self.film is not None:
            request = (self.film, path)
            said = texts.FILM_SAVED.format(path=path)
            self.jobs.start("save", texts.SAVING_FILM, request, _copy, lambda _: self.noted.emit(said))

    def _renew_film(self) -> None:
        self.jobs.cancel("film")
        if self.film is not None:
            self.film = None
            self.film_changed.emit()
        if self.document.answer is not None:
            self._compose_soon.start()

    def compose(self) -> None:
        """Compose the film of the motion on show, if there is none yet."""
        if self.film is None and not self.jobs.is_running("film"):
            self._compose()

    def _compose(self) -> None:
        answer, speech = self.document.answer, self.document.speech
        if answer is None or speech is None:
            return
        if self.jobs.is_running("face") or self.jobs.is_running("search"):
            self._compose_soon.start()
            return
        self._n_films += 1
        path = Path(self._film_folder.name) / f"synthesis-{self._n_films}.avi"
        style = "face" if self.rig is not None else "markers"
        settings = VideoSettings(fps=FRAME_RATES[self.fps_name], width=800, height=600, style=style)
        request = _FilmRequest(answer.motion, speech.audio, self.rig, settings, path)
        self.jobs.start("film", texts.COMPOSING, request, _compose_film, self._on_film, self._on_film_failed)

    def _on_film(self, path: Path) -> None:
        self.film = path
        self.film_changed.emit()

    def _on_film_failed(self, error: UserFacingError) -> None:
        self.film_failed.emit(str(error))

    # Reactions

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        document = self.document
        if change & Change.NODES:
            self._on_nodes_changed()
        if change & Change.ALIGNMENT:
            self.player.set_audio(None if document.speech is None else document.speech.audio)
            self.view.select_slot(None)
            self.view.move_playhead(0.0)
        if change & (Change.FACE | Change.NODES):
            self._fit_face()
        if change & Change.PATH:
            self._renew_film()
        if change & ASKED_OF_THE_SEARCH:
            self.jobs.cancel("search")
            if document.speech is not None and document.speech is self._animated:
                self._solve()

    def _on_nodes_changed(self) -> None:
        database = self.document.database
        self._engine = None if database is None else self._engines[database.content_hash]
        if database is None or not database.maps:
            self.view.show_map(None)
        elif self.view.map_phone not in database.maps:
            self.view.show_map(max(database.maps, key=lambda phone: len(database.maps[phone].frames)))

    def _fit_face(self) -> None:
        database, face = self.document.database, self.document.face
        if database is None or face is None:
            self.jobs.cancel("face")
            self._show_rig(None)
            return
        request = (face, database.markers)
        self.jobs.start("face", texts.FITTING_FACE, request, _fit_face, self._show_rig, self._on_face_failed)

    def _on_face_failed(self, error: UserFacingError) -> None:
        self.failed.emit(error.message, error.remedy)
        self._show_rig(None)

    def _show_rig(self, rig: FaceRig | None) -> None:
        if rig is not self.rig:
            self.rig = rig
            self.rig_changed.emit()
            self._renew_film()

    def shut_down(self) -> None:
        """Stop everything that runs and tidy up."""
        self.player.pause()
        self._compose_soon.stop()
        self.jobs.shut_down()
        self._film_folder.cleanup()


def whole_emotion(emotion: str, intensity: float = 1.0) -> tuple[EmotionModifier, ...]:
    """Return the spans that ask for one emotion all through the speech, however long that is; none for neutral."""
    if emotion == "neutral" or intensity == 0.0:
        return ()
    return (EmotionModifier(0.0, float("inf"), emotion, intensity),)


def _open_database(path: Path | None, progress: Progress) -> _OpenDatabase:
    from core.motion.database import open_database
    from gpu.device import open_kernels

    if path is None:
        from app.demo import demo_database

        database = demo_database(progress.part(0.0, 0.9))
    else:
        progress.step(0.0, texts.OPENING_DATABASE)
        database = open_database(path)
    kernels, backend = open_kernels()
    engine = SearchEngine(database, kernels)
    engine.prepare(progress.part(0.9, 1.0))
    return _OpenDatabase(database, engine, backend)


def _load_demo_sentence(name: str, _progress: Progress) -> tuple[AlignedSpeech, str]:
    from core.actress.corpus import demo_sentences, transcript_of
    from core.media.audio import load_audio

    spoken = next(s for s in demo_sentences() if s.sentence == name)
    return _BundledSpeech(load_audio(spoken.audio), transcript_of(spoken), spoken.text), spoken.emotion


def _load_speech(request: SpeechRequest, progress: Progress) -> AlignedSpeech:
    from app.speech import load_speech

    return load_speech(request.audio, request.text, request.phones, progress=progress)


def _solve(request: tuple[SearchEngine, SpeechInput, threading.Lock], progress: Progress) -> SearchAnswer:
    engine, speech, lock = request
    with lock:  # a retired search may still hold the kernels
        return engine.synthesise(speech, progress)


def _fit_face(request: tuple[str, MarkerSet], progress: Progress) -> FaceRig:
    face, markers = request
    return FaceRig.of(face, markers, progress=progress)


def _compose_film(request: _FilmRequest, progress: Progress) -> Path:
    from app.export import export

    export(request.motion, request.audio, request.rig, request.path, request.settings, progress)
    return request.path


def _copy(request: tuple[Path, Path], _progress: Progress) -> None:
    from core.media.swap_in import swapped_in

    source, target = request
    with swapped_in(target) as beside:
        shutil.copyfile(source, beside)
