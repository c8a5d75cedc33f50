"""Every edit takes itself back, and the document speaks once for each."""

from __future__ import annotations

import random
from dataclasses import dataclass
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.document.change import Change
from core.document.content import ProjectContent
from core.document.curation_edits import RemoveMotionNodes, RestoreMotionNodes
from core.document.document import Document
from core.document.edits import (
    LockSlots,
    PinMotionNode,
    SetDatabase,
    SetEmotion,
    SetEngine,
    SetFace,
    SetHolds,
    SetSpeech,
    UnlockSlots,
)
from core.document.parts import FaceChoice
from core.document.view_state import ViewState
from core.errors import UserFacingError
from core.motion.curation import Removal
from core.speech.emotion import EmotionModifier
from core.speech.transcript import PhonemeUtterance, Transcript
from tests.core.document.random_walk import RandomWalk

ANGER = (EmotionModifier(0.0, 1.0, "anger"),)


@dataclass(frozen=True)
class Speech:
    transcript: Transcript
    text: str = ""
    audio: object = None


@dataclass(frozen=True)
class Database:
    maps: dict
    name: str = "made up"
    content_hash: str = "0"
    path: object = None


def speech(*phones):
    return Speech(Transcript.covering([PhonemeUtterance(p, i, i + 1.0) for i, p in enumerate(phones)], (), len(phones)))


def state(document):
    names = ("database", "speech", "modifiers", "pins", "locks", "removed", "face")
    return {name: getattr(document, name) for name in names}


def edits(document):
    return [
        SetSpeech.on(document, speech("m", "aa")),
        SetDatabase.on(document, Database({})),
        SetEmotion.on(document, ANGER, "Set emotion to anger"),
        PinMotionNode.on(document, 1, "s2:3"),
        PinMotionNode.on(document, 0, None),
        SetFace.on(document, FaceChoice("other.obj")),
    ]


@pytest.fixture
def document():
    made = Document()
    made.apply(SetSpeech.on(made, speech("aa", "m", "iy")))
    made.apply(PinMotionNode.on(made, 0, "s1:0"))
    return made


@pytest.mark.parametrize("which", range(6))
def test_do_then_undo_gives_an_equal_document_and_redo_the_edited_one(document, which):
    edit = edits(document)[which]
    before = state(document)
    document.apply(edit)
    after = state(document)
    assert after != before
    document.revert(edit)
    assert state(document) == before
    document.apply(edit)
    assert state(document) == after


@pytest.mark.parametrize("which", range(6))
def test_an_edit_is_told_once_with_its_origin(document, which):
    told = []
    document.changed.connect(lambda change, origin: told.append((change, origin)))
    edit = edits(document)[which]
    document.apply(edit, origin="here")
    assert [origin for _, origin in told] == ["here"]
    assert told[0][0]


def test_an_edit_that_changes_nothing_is_silent(document):
    told = []
    document.changed.connect(lambda *change: told.append(change))
    document.apply(PinMotionNode.on(document, 0, "s1:0"))
    document.apply(SetEmotion.on(document, (), "Set emotion"))
    document.apply(SetFace.on(document, document.face))
    assert told == []


def test_other_speech_takes_the_pins_with_it_and_undo_brings_both_back(document):
    edit = SetSpeech.on(document, speech("m"))
    document.apply(edit)
    assert document.pins == {}
    document.revert(edit)
    assert document.pins == {0: "s1:0"}


def test_a_pin_says_what_it_does_and_what_it_changes(document):
    pin = PinMotionNode.on(document, 2, "s4:1")
    assert pin.label == "Pin node s4:1"
    assert pin.do(document) == Change.CONSTRAINTS
    assert PinMotionNode.on(document, 2, None).label == "Unpin node s4:1"
    assert document.speech_input().pins == {0: "s1:0", 2: "s4:1"}


def test_selecting_an_utterance_shows_its_map_unless_it_is_silence(document):
    document.database = Database({"aa": None, "m": None})
    view = ViewState(document)
    view.select_slot(0)
    assert (view.map_phone, view.map_slot) == ("aa", 0)
    view.select_slot(2)  # iy has no map in this database
    assert (view.map_phone, view.map_slot) == ("aa", None)
    view.select_slot(1)
    assert (view.map_phone, view.map_slot) == ("m", 1)
    view.show_map("aa")
    assert (view.slot, view.map_slot) == (1, None)


def test_the_playhead_stays_within_the_speech(document):
    view = ViewState(document)
    for asked_s, stands_s in ((-1.0, 0.0), (1.5, 1.5), (99.0, 3.0)):
        view.move_playhead(asked_s)
        assert view.playhead_s == stands_s
        assert document.speech.transcript.phonemes[view.slot_at(stands_s)].end_s >= stands_s


def everything(document):
    return ProjectContent.of(document), dict(document.shared_removals)


def walk(seed, n_steps):
    """Do, undo and redo at random, as an undo stack does; each state is met again on the way back."""
    document = Document()
    walk, states = RandomWalk(document, random.Random(seed)), [everything(document)]
    done = walk.done
    for _ in range(n_steps):
        if not walk.undo_or_redo():
            edit = walk.edit()
            if edit is None:
                continue
            merged = done[-2].followed_by(edit) if len(done) > 1 else None
            if merged is not None:
                done[-2:] = [merged]
            del states[len(done) :]
            states.append(everything(document))
        assert everything(document) == states[len(done)]
    end = everything(document)
    for edit in reversed(done):
        document.revert(edit)
    assert everything(document) == states[0]
    for edit in done:
        document.apply(edit)
    assert everything(document) == end


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_undo_and_redo_go_through_equal_documents(seed):
    walk(seed, 60)


@pytest.mark.prove
@pytest.mark.parametrize("seed", range(10))
def test_sequences_of_2000_edits_return_to_equal_documents(seed):
    walk(seed, 2000)


def test_an_undo_leaves_what_another_window_removed_meanwhile(document):
    mine, theirs = Removal("me", "t", "spike"), Removal("they", "t", "drift")
    edit = RemoveMotionNodes.on(document, ["s1:1", "s1:2"], mine)
    document.apply(edit)
    document.read_curation({**document.shared_removals, "s7:7": theirs})
    document.revert(edit)
    assert dict(document.shared_removals) == {"s7:7": theirs}
    assert document.removed == {"s7:7"}


def test_a_project_may_keep_a_node_that_the_list_removes_or_remove_one_by_itself(document):
    why = Removal("me", "t", "spike")
    document.read_curation({"s1:1": why, "s1:2": why})
    document.apply(RestoreMotionNodes.on(document, ["s1:1"], only_here=True))
    assert set(document.shared_removals) == {"s1:1", "s1:2"}
    assert document.removed == {"s1:2"}
    document.apply(RemoveMotionNodes.on(document, ["s4:4"], why, only_here=True))
    assert document.removed == {"s1:2", "s4:4"}
    document.apply(RestoreMotionNodes.on(document, ["s4:4", "s1:2"]))
    assert document.removed == frozenset() and set(document.shared_removals) == {"s1:1"}


def test_a_lock_keeps_what_is_in_use_and_no_pin_may_differ(document):
    with pytest.raises(UserFacingError, match="no motion to lock"):
        LockSlots.on(document, [1])
    nodes = SimpleNamespace(name=lambda row: f"s9:{row}")
    document.database = SimpleNamespace(nodes=nodes, maps={})
    document.answer = SimpleNamespace(path=SimpleNamespace(nodes=[4, 5, 6]))
    edit = LockSlots.on(document, [2, 1])
    document.apply(edit)
    assert edit.label == "Lock /m/ /iy/"
    assert document.locks == {1: "s9:5", 2: "s9:6"}
    with pytest.raises(UserFacingError, match="locked to the node s9:5"):
        PinMotionNode.on(document, 1, "s1:1")
    document.apply(UnlockSlots.on(document, [1]))
    assert document.locks == {2: "s9:6"}


def test_another_database_keeps_the_pins(document):
    document.apply(SetDatabase.on(document, Database({})))
    assert document.pins == {0: "s1:0"}


def test_another_engine_is_an_edit_and_one_that_there_is_not_is_told(document):
    edit = SetEngine.on(document, "search-single")
    assert edit.do(document) == Change.ENGINE and document.engine == "search-single"
    assert "best path alone" in edit.label
    assert not document.has_no_path
    document.apply(SetEngine.on(document, "static"))
    assert document.has_no_path
    edit.undo(document)
    assert document.engine == "search"
    with pytest.raises(UserFacingError, match="no engine 'magic'"):
        SetEngine.on(document, "magic")


def test_holding_long_sounds_is_an_edit_that_reaches_the_question_to_the_engine(document):
    edit = SetHolds.on(document, True)
    assert edit.do(document) == Change.ENGINE and document.speech_input().holds
    held = ProjectContent(holds=True)
    assert ProjectContent.from_json(held.to_json()).state(None, None).holds and not ProjectContent.from_json("{}").holds
    edit.undo(document)
    assert not document.speech_input().holds


def test_a_motion_without_a_path_cannot_be_locked(document):
    document.database, document.answer = SimpleNamespace(maps={}), SimpleNamespace(motion=None)
    with pytest.raises(UserFacingError, match="no path of motion nodes"):
        LockSlots.on(document, [1])
