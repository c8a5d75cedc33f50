"""Every edit takes itself back, and the document speaks once for each."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from core.document.change import Change
from core.document.document import Document, FaceChoice
from core.document.edits import PinMotionNode, SetDatabase, SetEmotion, SetFace, SetSpeech
from core.document.view_state import ViewState
from core.speech.emotion import EmotionModifier
from core.speech.transcript import PhonemeUtterance, Transcript

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
    names = ("database", "speech", "modifiers", "pins", "removed", "face")
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
