"""What an animator can ask for. A wish becomes an edit, or a job whose answer becomes one; panels only ask."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app import texts
from app.backends import Backends
from app.curating import Curating
from app.editing import Editing
from app.film import FilmComposer
from app.loading import (
    KnownSentence,
    OpenedDatabase,
    SpeechRequest,
    list_captured_sentences,
    load_captured_sentence,
    load_demo_sentence,
    open_motion_database,
    read_speech,
)
from app.pictures import FaceRig
from app.rigs import Rigs
from app.solving import Solving
from core.document.change import Change
from core.document.edits import SetDatabase, SetEmotion, SetFace, SetSpeech
from core.document.live_engine import LiveEngine
from core.document.parts import DEFAULT_FACE, AlignedSpeech, FaceChoice
from core.errors import UserFacingError
from core.search.engine import SearchAnswer
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import EngineAnswer
from core.synthesis.pose_tracks import PoseTracks
from core.synthesis.registry import engine_kind


class Authoring(Editing):
    """Joins document, jobs, undo, playback, search, faces and film.

    rig_changed() : another face, or none, is to be drawn; see `rig`
    tracks_changed() : head, gaze or tongue move otherwise; see `tracks`
    backend_changed(name, sentence) : which compute backend searches, in a word and in full
    """

    rig_changed = Signal()
    tracks_changed = Signal()
    backend_changed = Signal(str, str)

    def __init__(self, face: FaceChoice | None = DEFAULT_FACE, parent: QObject | None = None) -> None:
        super().__init__(face, parent)
        self.film = FilmComposer(self.document, self.jobs, self)
        self._rigs = Rigs(self.document, self.jobs, self)
        self._solving = Solving(self.document, self.jobs, self)
        self.curating = Curating(self.document, self)
        self._backends = Backends(self.document, self)
        self.document.changed.connect(self._on_document_changed)
        self.curating.failed.connect(self.failed)
        self.curating.noted.connect(self.noted)
        self._solving.solved.connect(self._on_solved)
        self._rigs.changed.connect(self._on_rig_changed)
        self._rigs.failed.connect(self.failed)
        self._backends.changed.connect(self.backend_changed)
        self.film.saved.connect(lambda path: self.noted.emit(texts.FILM_SAVED.format(path=path)))

    # Opening

    def open_database(self, path: Path | None = None) -> None:
        """Search another motion database from now on; None is the demo's."""
        title = texts.OPENING_DEMO if path is None else texts.OPENING_DATABASE
        self.jobs.start("database", title, path, open_motion_database, self._on_database_opened)

    def _on_database_opened(self, opened: OpenedDatabase) -> None:
        is_first = self.document.database is None
        self.take_engine(opened)
        self.push(SetDatabase.on(self.document, opened.database, opened.removals))
        self._forget_the_start(is_first)

    def take_engine(self, opened: OpenedDatabase) -> None:
        """Make a database that was opened one that can be searched."""
        self._solving.add_engine(opened.engine)
        self._backends.add(opened)
        if opened.trouble:
            self.failed.emit(*opened.trouble)

    def open_demo_sentence(self, name: str) -> None:
        """Choose one of the bundled sentences; its transcript and emotion are known, so it is animated at once."""
        self.jobs.start("speech", texts.LOADING_SPEECH, name, load_demo_sentence, self._on_known_sentence)

    def _on_known_sentence(self, demo: KnownSentence) -> None:
        is_first = self.document.speech is None
        emotion = texts.EDIT_SET_EMOTION.format(emotion=demo.emotion)
        self.undo_stack.beginMacro(texts.EDIT_CHOOSE_SPEECH)
        self.push(SetEmotion.on(self.document, whole_emotion(demo.emotion), emotion))
        self.push(SetSpeech.on(self.document, demo.speech, texts.EDIT_CHOOSE_SPEECH))
        self.undo_stack.endMacro()
        self._forget_the_start(is_first)
        self.synthesise()

    def list_captured(self, done: Callable[[dict[str, str]], None]) -> None:
        """Hand ``done`` all captured sentences, name to what is said; those that were held out come first."""
        database = self.document.database
        if database is not None:
            self.jobs.start("captured", texts.LISTING_CAPTURED, database, list_captured_sentences, done)

    def open_captured(self, name: str) -> None:
        """Choose a captured sentence of the database, to compare its synthesis with it."""
        request = (self.document.database, name)
        self.jobs.start("speech", texts.LOADING_SPEECH, request, load_captured_sentence, self._on_known_sentence)

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

    def set_face(self, face: FaceChoice | None) -> None:
        """Show another face, or markers alone; a face that does not fit the markers changes nothing."""
        if face != self.document.face:
            self._rigs.try_on(face, lambda: self.push(SetFace.on(self.document, face)))

    def _forget_the_start(self, is_first: bool) -> None:
        """What one starts from is nothing to take back."""
        if is_first and self.undo_stack.count() == 1:
            self.undo_stack.clear()

    def remove_nodes(self, nodes: Iterable[str], why: str) -> None:
        """Let no search use these nodes any more: in any project, or in this one where the list cannot be written."""
        self.removes_only_here = not self.curating.can_be_written
        if self.removes_only_here:
            self.noted.emit(texts.CURATION_ONLY_HERE)
        super().remove_nodes(nodes, why)

    # Synthesis

    @property
    def can_synthesise(self) -> bool:
        """Whether there is speech and a database."""
        return self.document.speech is not None and self.document.database is not None

    def synthesise(self) -> None:
        """Find motion for the speech; from then on it follows each edit."""
        self._solving.follow()

    def follow_later(self) -> None:
        """Find motion for the speech once there is a database for it, and anew after each edit."""
        self._solving.follow_later()

    def live_engine(self, name: str) -> LiveEngine:
        """Return an engine for the database that is open; whoever else asks it waits for its turn."""
        return self._solving.engine(name)

    @property
    def changed_slots(self) -> tuple[int, ...]:
        """Slots that the last edit gave another motion node."""
        return self._solving.changed_slots

    @property
    def tracks(self) -> PoseTracks:
        """What moves besides the markers, at the rate of the motion on show."""
        return self._solving.tracks

    @property
    def rig(self) -> FaceRig | None:
        """The face on show, fitted to the markers; None for markers alone."""
        return self._rigs.rig

    # Reactions

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        if change & Change.MOTION:
            self.film.renew()
        if change & Change.OUTPUT:
            output = self.document.output
            self.film.set_frame_rate(output.frame_rate)
            self.film.set_head_moves(output.head_moves)
            self.tracks_changed.emit()

    def _on_solved(self, answer: EngineAnswer) -> None:
        after = self.undo_stack.undoText() or texts.SYNTHESISE
        if isinstance(answer, SearchAnswer):
            solved = texts.SOLVED.format(milliseconds=1000 * answer.search_s, after=after)
        else:
            solved = texts.ANIMATED.format(engine=engine_kind(self.document.engine).title, after=after)
        self.noted.emit(" · ".join((solved, *answer.warnings)))
        if self.view.slot is None:
            self.select_a_vowel()

    def _on_rig_changed(self) -> None:
        self.rig_changed.emit()
        self.film.set_rig(self.rig)

    def shut_down(self) -> None:
        """Stop everything that runs and tidy up."""
        self.player.pause()
        self.film.shut_down()
        self.jobs.shut_down()
        self.curating.close()


def whole_emotion(emotion: str, intensity: float = 1.0) -> tuple[EmotionModifier, ...]:
    """Return the spans that ask for one emotion all through the speech, however long that is; none for neutral."""
    if emotion == "neutral" or intensity == 0.0:
        return ()
    return (EmotionModifier(0.0, float("inf"), emotion, intensity),)
