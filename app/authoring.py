"""What an animator can ask for. A wish becomes an edit, or a job whose answer becomes one; panels only ask."""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app import texts
from app.film import FilmComposer
from app.jobs import JobRunner
from app.loading import (
    DemoSentence,
    OpenedDatabase,
    SpeechRequest,
    fit_face,
    load_demo_sentence,
    open_motion_database,
    read_speech,
)
from app.pictures import FaceRig
from app.player import Player
from core.document.change import ASKED_OF_THE_SEARCH, Change
from core.document.document import DEFAULT_FACE, AlignedSpeech, Document, Edit, FaceChoice
from core.document.edits import PinMotionNode, SetDatabase, SetEmotion, SetFace, SetSpeech
from core.document.view_state import ViewState
from core.errors import UserFacingError
from core.media.audio import Audio
from core.progress import Progress
from core.search.engine import SearchAnswer, SearchEngine
from core.speech.emotion import EmotionModifier
from core.speech.loudness import levels_db
from core.speech.phoneme import PAU
from core.synthesis.engine import SpeechInput
from core.synthesis.pose_tracks import PoseTracks


class _EditCommand(QUndoCommand):
    """Wraps an edit for Qt's undo stack, which gives the menu its labels."""

    def __init__(self, document: Document, edit: Edit, origin: object) -> None:
        super().__init__(edit.label)
        self._document, self._edit, self._origin = document, edit, origin

    def redo(self) -> None:
        """Do it; whoever asked shows it already the first time, later it is news to all."""
        self._document.apply(self._edit, self._origin)
        self._origin = None

    def undo(self) -> None:
        """Take it back."""
        self._document.revert(self._edit)


class Authoring(QObject):
    """Joins document, jobs, undo, playback and film.

    failed(sentence, remedy) : for the message bar; noted(sentence) : for the status bar
    rig_changed() : another face, or none, is to be drawn; see `rig`
    tracks_changed() : head, gaze or tongue move otherwise; see `tracks`
    backend_changed(str) : which compute backend searches
    """

    failed = Signal(str, str)
    noted = Signal(str)
    rig_changed = Signal()
    tracks_changed = Signal()
    backend_changed = Signal(str)

    def __init__(self, face: FaceChoice | None = DEFAULT_FACE, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = Document(face)
        self.view = ViewState(self.document)
        self.jobs = JobRunner(self)
        self.player = Player(self.jobs, self)
        self.undo_stack = QUndoStack(self)
        self.film = FilmComposer(self.document, self.jobs, self)
        self.rig: FaceRig | None = None
        self.head_moves = True
        self._tracks = PoseTracks()
        # by content of the database, so that undo need not open or fit again
        self._engines: dict[str, SearchEngine] = {}
        self._rigs: dict[tuple[FaceChoice, str], FaceRig] = {}
        self._engine_lock = threading.Lock()
        self._animated: AlignedSpeech | None = None
        self.document.changed.connect(self._on_document_changed)
        self.player.moved.connect(self.view.move_playhead)
        self.player.noted.connect(self.noted)
        self.jobs.failed.connect(self.failed)
        self.film.saved.connect(lambda path: self.noted.emit(texts.FILM_SAVED.format(path=path)))

    # Opening

    def open_database(self, path: Path | None = None) -> None:
        """Search another motion database from now on; None is the demo's."""
        title = texts.OPENING_DEMO if path is None else texts.OPENING_DATABASE
        self.jobs.start("database", title, path, open_motion_database, self._on_database_opened)

    def _on_database_opened(self, opened: OpenedDatabase) -> None:
        is_first = self.document.database is None
        self._engines[opened.database.content_hash] = opened.engine
        self.backend_changed.emit(opened.backend)
        self.push(SetDatabase.on(self.document, opened.database))
        self._forget_the_start(is_first)

    def open_demo_sentence(self, name: str) -> None:
        """Choose one of the bundled sentences; its transcript and emotion are known, so it is animated at once."""
        self.jobs.start("speech", texts.LOADING_SPEECH, name, load_demo_sentence, self._on_demo_sentence)

    def _on_demo_sentence(self, demo: DemoSentence) -> None:
        is_first = self.document.speech is None
        self._animated = demo.speech
        emotion = texts.EDIT_SET_EMOTION.format(emotion=demo.emotion)
        self.undo_stack.beginMacro(texts.EDIT_CHOOSE_SPEECH)
        self.push(SetEmotion.on(self.document, whole_emotion(demo.emotion), emotion))
        self.push(SetSpeech.on(self.document, demo.speech, texts.EDIT_CHOOSE_SPEECH))
        self.undo_stack.endMacro()
        self._forget_the_start(is_first)

    def load_speech(self, request: SpeechRequest, then_synthesise: bool = False) -> None:
        """Read and align speech in the background."""

        def applied(speech: AlignedSpeech) -> None:
            before = self.document.speech
            same = before is not None and before.audio.path == speech.audio.path
            label = texts.EDIT_SET_TRANSCRIPT if same else texts.EDIT_CHOOSE_SPEECH
            self.push(SetSpeech.on(self.document, speech, label))
            self._forget_the_start(before is None)
            if speech.transcript.warnings:
                self.noted.emit(speech.transcript.warnings[0])
            if then_synthesise:
                self.synthesise()

        heard = request.text is None and request.phones is None
        title = texts.RECOGNISING if heard else texts.LOADING_SPEECH
        self.jobs.start("speech", title, request, read_speech, applied)

    def load_emotions(self, path: Path) -> None:
        """Read an emotion specification."""
        from core.speech.emotion_files import read_emotions

        try:
            modifiers = tuple(read_emotions(path))
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self.set_emotion(modifiers, texts.EDIT_SET_EMOTION.format(emotion=path.name))

    def _forget_the_start(self, is_first: bool) -> None:
        """What one starts from is nothing to take back."""
        if is_first and self.undo_stack.count() == 1:
            self.undo_stack.clear()

    # Editing

    def push(self, edit: Edit, origin: object = None) -> None:
        """Do an edit that can be undone."""
        self.undo_stack.push(_EditCommand(self.document, edit, origin))

    def set_emotion(self, modifiers: tuple[EmotionModifier, ...], label: str, origin: object = None) -> None:
        """Replace the emotion spans."""
        if modifiers != self.document.modifiers:
            self.push(SetEmotion.on(self.document, modifiers, label), origin)

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

    def set_face(self, face: FaceChoice | None) -> None:
        """Show another face, or markers alone; a face that does not fit the markers changes nothing."""
        database = self.document.database
        if face == self.document.face:
            return
        if face is None or database is None:
            self.push(SetFace.on(self.document, face))
            return

        def fitted(rig: FaceRig) -> None:
            self._rigs[face, database.content_hash] = rig
            self.push(SetFace.on(self.document, face))

        self.jobs.start("face", texts.FITTING_FACE, (face, database.markers), fit_face, fitted)

    # Synthesis

    @property
    def can_synthesise(self) -> bool:
        """Whether there is speech and a database."""
        return self.document.speech is not None and self.document.database is not None

    def synthesise(self) -> None:
        """Find motion for the speech; from then on it follows each edit."""
        self._animated = self.document.speech
        self._solve()

    def _solve(self) -> None:
        speech, database = self.document.speech_input(), self.document.database
        if speech is not None and database is not None:
            request = _SolveRequest(
                self._engines[database.content_hash], self._engine_lock, speech, self.document.speech.audio
            )
            self.jobs.start("search", texts.SYNTHESISING, request, _solve, self._on_solved)

    def _on_solved(self, solved: tuple[SearchAnswer, PoseTracks]) -> None:
        answer, self._tracks = solved
        self.document.show_answer(answer)
        after = self.undo_stack.undoText() or texts.SYNTHESISE
        self.noted.emit(texts.SOLVED.format(milliseconds=1000 * answer.search_s, after=after))
        if self.view.slot is None:
            self._select_a_vowel()

    @property
    def tracks(self) -> PoseTracks:
        """What moves besides the markers, at the rate of the motion on show."""
        return self._tracks if self.head_moves else replace(self._tracks, head=None, gaze=None)

    def set_head_moves(self, moves: bool) -> None:
        """Let head and gaze move by themselves, or keep them still."""
        self.head_moves = moves
        self.tracks_changed.emit()
        self.film.set_head_moves(moves)

    def _select_a_vowel(self) -> None:
        """Select the longest phone in the middle of the sentence, so that the map is not blank."""
        phonemes = self.document.speech.transcript.phonemes
        spoken = [slot for slot, utterance in enumerate(phonemes) if utterance.phone != PAU]
        middle = spoken[len(spoken) // 4 : -(len(spoken) // 4) or None]
        if middle:
            self.select_slot(max(middle, key=lambda p: phonemes[p].end_s - phonemes[p].start_s))

    # Looking and playing

    def select_slot(self, slot: int, time_s: float | None = None) -> None:
        """Select an utterance and bring the playhead to it: to ``time_s``, or to its middle."""
        utterance = self.document.speech.transcript.phonemes[slot]
        self.seek((utterance.start_s + utterance.end_s) / 2 if time_s is None else time_s)
        self.view.select_slot(slot)

    def step_slot(self, by: int) -> None:
        """Select the next or the previous utterance; the one at the playhead when none is selected."""
        speech = self.document.speech
        if speech is not None:
            slot = self.view.slot_at(self.view.playhead_s) if self.view.slot is None else self.view.slot + by
            self.select_slot(min(max(slot, 0), len(speech.transcript.phonemes) - 1))

    def seek(self, time_s: float) -> None:
        """Move the playhead, and the sound if it plays."""
        self.player.seek(time_s)
        self.view.move_playhead(time_s)

    def step_frame(self, by: int) -> None:
        """Move the playhead by frames of the output rate."""
        self.player.pause()
        self.seek((round(self.view.playhead_s * self.film.fps) + by) / self.film.fps)

    def play_or_pause(self) -> None:
        """Play, or stop where it is."""
        if not self.player.is_playing:
            self.player.seek(self.view.playhead_s)
        self.player.toggle()

    # Reactions

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        document = self.document
        if change & Change.CLUSTERS:
            self._show_a_map()
        if change & Change.ALIGNMENT:
            self.player.set_audio(None if document.speech is None else document.speech.audio)
            self.view.select_slot(None)
            self.view.move_playhead(0.0)
        if change & (Change.FACE | Change.NODES):
            self._fit_face()
        if change & Change.PATH:
            self.film.renew()
        if change & ASKED_OF_THE_SEARCH:
            self.jobs.cancel("search")
            if document.speech is not None and document.speech is self._animated:
                self._solve()

    def _show_a_map(self) -> None:
        maps = {} if self.document.database is None else self.document.database.maps
        if self.view.map_phone not in maps:
            self.view.show_map(max(maps, key=lambda phone: len(maps[phone].frames), default=None))

    def _fit_face(self) -> None:
        database, face = self.document.database, self.document.face
        if database is None or face is None:
            self.jobs.cancel("face")
            self._show_rig(None)
            return
        key = face, database.content_hash
        if key in self._rigs:
            self.jobs.cancel("face")
            self._show_rig(self._rigs[key])
            return

        def fitted(rig: FaceRig) -> None:
            self._rigs[key] = rig
            self._show_rig(rig)

        self.jobs.start("face", texts.FITTING_FACE, (face, database.markers), fit_face, fitted, self._on_face_failed)

    def _on_face_failed(self, error: UserFacingError) -> None:
        self.failed.emit(error.message, error.remedy)
        self._show_rig(None)

    def _show_rig(self, rig: FaceRig | None) -> None:
        if rig is not self.rig:
            self.rig = rig
            self.rig_changed.emit()
            self.film.set_rig(rig)

    def shut_down(self) -> None:
        """Stop everything that runs and tidy up."""
        self.player.pause()
        self.film.shut_down()
        self.jobs.shut_down()


def whole_emotion(emotion: str, intensity: float = 1.0) -> tuple[EmotionModifier, ...]:
    """Return the spans that ask for one emotion all through the speech, however long that is; none for neutral."""
    if emotion == "neutral" or intensity == 0.0:
        return ()
    return (EmotionModifier(0.0, float("inf"), emotion, intensity),)


@dataclass(frozen=True)
class _SolveRequest:
    engine: SearchEngine
    lock: threading.Lock
    speech: SpeechInput
    audio: Audio


def _solve(request: _SolveRequest, progress: Progress) -> tuple[SearchAnswer, PoseTracks]:
    with request.lock:  # a retired search may still hold the kernels
        answer = request.engine.synthesise(request.speech, progress)
    motion, audio = answer.motion, request.audio
    loudness_db = levels_db(audio.samples, audio.rate_hz)
    tracks = PoseTracks.of(request.speech.transcript, motion.rate_hz, len(motion.positions), loudness_db)
    return answer, tracks
