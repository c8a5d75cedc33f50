"""The paper's whole story in one session, by mouse and keys: what an animator does between opening and closing."""

from __future__ import annotations

import shutil
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from core.document.content import ProjectContent
from core.motion.build import BuildSettings, build_database
from core.motion.curation import CurationList

LEFT = Qt.MouseButton.LeftButton
CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
WAIT_MS = 120_000
SPOKEN = "lbay1a"  # "lay blue at y one again", a real recording of the GRID corpus
FAULTY_SENTENCE, FAULTY_FRAME = 3, 30


@pytest.fixture
def recording(shared_data, tmp_path):
    """A real recording with its transcript beside it."""
    folder = shared_data("grid-s1") / "examples"
    for suffix in (".flac", ".TextGrid"):
        shutil.copy(folder / f"{SPOKEN}{suffix}", tmp_path)
    return tmp_path / f"{SPOKEN}.flac"


@pytest.fixture
def tiny_contaminated(tiny_corpus, tmp_path):
    """The small database with one spike in it, and the names of the nodes that have a part in it."""
    corpus = tiny_corpus()
    recordings = list(corpus.recordings)
    spoilt = recordings[FAULTY_SENTENCE].positions.copy()
    spoilt[FAULTY_FRAME, :4] += 25.0
    recordings[FAULTY_SENTENCE] = replace(recordings[FAULTY_SENTENCE], positions=spoilt)
    path = tmp_path / "motion" / "tiny.h5"
    path.parent.mkdir()
    database = build_database(replace(corpus, recordings=recordings), path, BuildSettings(rate_hz=60.0))
    nodes = database.nodes
    first = database.sentences[FAULTY_SENTENCE].start_frame
    near = np.flatnonzero((nodes.start <= first + FAULTY_FRAME + 1) & (nodes.stop > first + FAULTY_FRAME - 1))
    return path, {nodes.name(int(row)) for row in near}


@pytest.fixture
def demo_contaminated(tmp_path):
    """A copy of the demo database, and the names of the nodes in which a fault was planted."""
    from app.demo import demo_database, demo_database_path
    from app.suspicion_bench import planted_kinds

    database = demo_database()
    path = tmp_path / "motion" / "demo.h5"
    path.parent.mkdir()
    shutil.copyfile(demo_database_path(), path)
    return path, {database.nodes.name(int(row)) for row in np.flatnonzero(planted_kinds(database) != "")}


class Animator:
    """Looks at the window, and has a mouse and a keyboard."""

    def __init__(self, window, qtbot) -> None:
        self.window, self.qtbot = window, qtbot
        self.document, self.view = window.authoring.document, window.authoring.view

    def waits_for(self, what) -> None:
        self.qtbot.waitUntil(what, timeout=WAIT_MS)

    def waits_until_all_is_done(self) -> None:
        self.waits_for(lambda: self.window.authoring.jobs.is_idle)

    def clicks(self, widget, at: QPoint | None = None) -> None:
        QTest.mouseClick(widget, LEFT, pos=widget.rect().center() if at is None else at)

    def drags(self, widget, start: QPoint, end: QPoint) -> None:
        QTest.mousePress(widget, LEFT, pos=start)
        for share in (0.3, 0.7, 1.0):
            QTest.mouseMove(widget, start + (end - start) * share)
            QTest.qWait(15)
        QTest.mouseRelease(widget, LEFT, pos=end)

    def presses(self, key, modifiers=Qt.KeyboardModifier.NoModifier, widget=None) -> None:
        QTest.keyClick(widget or self.window, key, modifiers)

    def sees(self, face_view) -> np.ndarray:
        """Pixels of a face as they are drawn."""
        image = face_view.grabFramebuffer()
        return np.frombuffer(image.constBits(), np.uint8).copy()

    def in_timeline(self, lane: str, time_s: float, height: float = 0.5) -> QPoint:
        area = self.window.timeline.lanes()[lane]
        return QPoint(round(self.window.timeline.scale.x(time_s)), round(area.bottom() - height * area.height()))

    def middle(self, utterance) -> float:
        return (utterance.start_s + utterance.end_s) / 2

    def on_map(self, place) -> QPoint:
        view = self.window.isomap.view
        return view.canvas.mapFromScene(view.box.mapViewToScene(QPointF(*map(float, place))))

    def content(self) -> ProjectContent:
        return ProjectContent.of(self.document, self.view)

    def solution(self) -> tuple[list[int], float]:
        path = self.document.answer.path
        return path.nodes.tolist(), path.cost


def slot_with_map(animator: Animator, slots: range) -> int:
    """A slot among ``slots`` whose phone has a map, the longest."""
    phonemes, maps = animator.document.speech.transcript.phonemes, animator.document.database.maps
    return max(
        (slot for slot in slots if phonemes[slot].phone in maps),
        key=lambda slot: phonemes[slot].end_s - phonemes[slot].start_s,
    )


def tell_the_story(animator: Animator, again, database_path, contaminated, recording, choose, film_path) -> None:
    """Do it all; ``again`` opens a new window as the program does when it starts."""
    window, document, view, qtbot = animator.window, animator.document, animator.view, animator.qtbot
    timeline, isomap, preview = window.timeline, window.isomap, window.preview

    # load a real recording, synthesise
    animator.presses(Qt.Key.Key_N, CTRL)
    choose(database_path, recording)
    animator.presses(Qt.Key.Key_D, CTRL)
    animator.waits_for(lambda: document.database is not None)
    animator.presses(Qt.Key.Key_O, CTRL)
    animator.waits_for(lambda: document.speech is not None)
    transcript = document.speech.transcript
    assert [word.word for word in transcript.words if word.word] == ["lay", "blue", "at", "y", "one", "again"]
    assert document.answer is None
    animator.clicks(window.control.synthesise_button)
    animator.waits_for(lambda: document.prices is not None)
    animator.waits_until_all_is_done()
    assert not window.authoring.undo_stack.canUndo()
    at_first, first_solution = animator.content(), animator.solution()

    # scrub: the face moves under the hand
    spoken = [slot for slot, utterance in enumerate(transcript.phonemes) if utterance.phone != "pau"]
    slot = slot_with_map(animator, range(spoken[0], spoken[-1]))
    utterance = transcript.phonemes[slot]
    seen = animator.sees(window.motion.face_view)
    animator.drags(timeline, animator.in_timeline("wave", 0.05), animator.in_timeline("wave", utterance.start_s))
    assert view.playhead_s == pytest.approx(utterance.start_s, abs=2 / timeline.scale.px_per_s)
    assert (animator.sees(window.motion.face_view) != seen).any()

    # select a phoneme: its map comes
    animator.clicks(timeline, animator.in_timeline("phonemes", animator.middle(utterance)))
    assert view.slot == slot
    assert isomap.view.shown.phone == utterance.phone

    # hover: the preview follows
    shown, used = isomap.view.shown, isomap.used
    away = np.linalg.norm(shown.points - used.at, axis=1)
    away[shown.node == used.node] = -1
    target = animator.on_map(shown.points[away.argmax()])
    seen = animator.sees(preview.face_view)
    QTest.mouseMove(isomap.canvas.viewport(), target)
    animator.waits_for(lambda: preview.pick is not None and not preview.pick.in_use)
    assert (animator.sees(preview.face_view) != seen).any()

    # pin: the motion is another one, and the face shows it
    seen, posed = animator.sees(window.motion.face_view), document.motion
    QTest.mouseClick(isomap.canvas.viewport(), LEFT, pos=target)
    wanted = preview.pick.node
    QTest.mouseDClick(isomap.canvas.viewport(), LEFT, pos=target)
    animator.waits_for(lambda: document.answer.path.nodes[slot] == wanted)
    animator.waits_until_all_is_done()
    assert document.pins == {slot: document.database.nodes.name(wanted)}
    frame = round(view.playhead_s * document.motion.rate_hz)
    assert np.abs(document.motion.positions[frame] - posed.positions[frame]).max() > 0.1
    assert (animator.sees(window.motion.face_view) != seen).any()

    # paint anger over two words
    words = [word for word in transcript.words if word.word]
    animator.clicks(window.timeline_pane.bar.snap.button("words"))
    animator.presses(Qt.Key.Key_3)
    start = animator.in_timeline("emotion", animator.middle(words[1]), 0.97)
    animator.drags(timeline, start, animator.in_timeline("emotion", animator.middle(words[2]), 0.97))
    (painted,) = document.modifiers
    assert painted.emotion == "anger"
    assert (painted.start_s, painted.end_s) == (words[1].start_s, words[2].end_s)
    animator.waits_until_all_is_done()

    # prune a contaminated node that the list finds
    animator.clicks(isomap.suspects_button)
    animator.waits_for(lambda: bool(isomap.suspects.nodes))
    animator.presses(Qt.Key.Key_N, widget=isomap.suspects.view)
    name = document.database.nodes.name(isomap.suspects.current)
    assert name in contaminated
    animator.waits_for(lambda: not isomap.clip.is_playing)  # it is watched
    animator.presses(Qt.Key.Key_Delete, widget=isomap.suspects.view)
    QTest.keyClicks(isomap.strip.reason, "it tears")
    animator.presses(Qt.Key.Key_Return, widget=isomap.strip.reason)
    assert document.removed == {name}
    animator.waits_until_all_is_done()
    window.authoring.curating.wait()
    assert set(CurationList.of(document.database).read()) == {name}
    at_last, last_solution = animator.content(), animator.solution()
    assert last_solution != first_solution

    # undo all, redo all
    undone = 0
    while window.authoring.undo_stack.canUndo():
        animator.presses(Qt.Key.Key_Z, CTRL)
        undone += 1
    assert undone == 3
    animator.waits_until_all_is_done()
    assert replace(animator.content(), view=at_first.view) == at_first
    assert document.removed == frozenset()
    assert animator.solution() == first_solution
    while window.authoring.undo_stack.canRedo():
        animator.presses(Qt.Key.Key_Z, CTRL | SHIFT)
    animator.waits_until_all_is_done()
    assert replace(animator.content(), view=at_last.view) == at_last
    assert document.removed == {name}
    assert animator.solution() == last_solution

    # export a film
    animator.presses(Qt.Key.Key_E, CTRL)
    dialog = window.export_dialog
    assert dialog.isVisible()
    assert dialog.kind.currentData() == ".avi"
    dialog.size.lineEdit().selectAll()
    QTest.keyClicks(dialog.size.lineEdit(), "320x240")
    dialog.path.selectAll()
    QTest.keyClicks(dialog.path, str(film_path))
    animator.clicks(dialog.export_button)
    animator.waits_for(film_path.is_file)
    animator.waits_until_all_is_done()
    from core.media.video import probe

    facts = probe(film_path)
    assert (facts.width, facts.height, facts.fps) == (320, 240, 30)
    assert abs(facts.video_duration_s - document.speech.audio.duration_s) < 1 / 30
    assert facts.audio_duration_s == pytest.approx(document.speech.audio.duration_s, abs=1 / 30)

    # quit, reopen, find everything as it was
    at_last, seen = animator.content(), animator.sees(preview.face_view)
    playhead_s, phone = view.playhead_s, view.map_phone
    animator.presses(Qt.Key.Key_Q, CTRL)
    animator.waits_for(lambda: not window.isVisible())
    other = Animator(again(), qtbot)
    other.waits_for(lambda: other.document.answer is not None)
    other.waits_until_all_is_done()
    assert other.content() == at_last
    assert other.document.removed == {name}
    assert other.solution() == last_solution
    assert (other.view.slot, other.view.playhead_s, other.view.map_phone) == (slot, playhead_s, phone)
    assert not other.window.motion.is_empty
    assert not other.window.authoring.undo_stack.canUndo()


def test_the_whole_story_on_a_small_database(qtbot, open_window, choose, tiny_contaminated, recording, tmp_path):
    animator = Animator(open_window(), qtbot)
    tell_the_story(animator, _starting(open_window), *tiny_contaminated, recording, choose, tmp_path / "story.avi")


@pytest.mark.prove
def test_the_whole_story_on_the_demo_database_with_its_face(
    qtbot, demo_contaminated, open_window, choose, recording, tmp_path
):
    from core.document.parts import DEFAULT_FACE

    window = open_window(DEFAULT_FACE)
    qtbot.waitUntil(lambda: window.authoring.rig is not None or window.authoring.jobs.is_idle, timeout=WAIT_MS)
    animator = Animator(window, qtbot)
    again = _starting(lambda: open_window(DEFAULT_FACE))
    tell_the_story(animator, again, *demo_contaminated, recording, choose, tmp_path / "story.avi")
    assert window.authoring.rig is not None


def _starting(open_window):
    """Return a function that opens a window on what was open last."""
    from app.main import _start

    def make():
        window = open_window()
        _start(window, None)
        return window

    return make
