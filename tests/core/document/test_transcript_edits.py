"""Phonemes are moved, renamed, split and merged; time stays whole, and pins go where their phonemes go."""

from __future__ import annotations

import pytest

from core.document.change import Change
from core.document.document import Document
from core.document.edits import FieldEdit, PinMotionNode, SetSpeech
from core.document.parts import Speech
from core.document.transcript_edits import MergePhonemes, MovePhonemeBoundary, RenamePhoneme, SplitPhoneme
from core.errors import UserFacingError
from core.media.audio import Audio
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance


@pytest.fixture
def document():
    """Five phones of 0.1 s, the middle three a word; slots 1 to 3 are pinned, 2 is locked too."""
    utterances = [PhonemeUtterance(p, 0.1 * i, 0.1 * (i + 1)) for i, p in enumerate(("pau", "m", "aa", "b", "pau"))]
    transcript = Transcript.covering(utterances, [WordUtterance("mob", 0.1, 0.4)], 0.5)
    made = Document()
    made.apply(SetSpeech.on(made, Speech(Audio(None, 8000), transcript, "mob")))
    for slot in (1, 2, 3):
        made.apply(PinMotionNode.on(made, slot, f"s{slot}:0"))
    made.apply(FieldEdit.setting(made, "Lock", Change.CONSTRAINTS, locks={2: "s2:0"}))
    return made


def phones(document):
    return document.speech.transcript.phones


def covers(document):
    phonemes, end_s = document.speech.transcript.phonemes, 0.0
    for utterance in phonemes:
        assert utterance.start_s == pytest.approx(end_s) and utterance.end_s > utterance.start_s
        end_s = utterance.end_s
    return end_s == pytest.approx(document.speech.transcript.duration_s)


def test_a_boundary_moves_with_the_edge_of_its_word_and_keeps_the_pins(document):
    edit = MovePhonemeBoundary.on(document, 3, 0.43)
    document.apply(edit)
    assert document.speech.transcript.phonemes[3].end_s == document.speech.transcript.phonemes[4].start_s == 0.43
    assert document.speech.transcript.words == (WordUtterance("mob", 0.1, 0.43),)
    assert document.pins == {1: "s1:0", 2: "s2:0", 3: "s3:0"} and document.locks == {2: "s2:0"}
    assert edit.note == "" and edit.label == "Move boundary of /b/ and /pau/"
    assert covers(document)


@pytest.mark.parametrize(("asked_s", "stands_s"), [(-9.0, 0.11), (9.0, 0.29)])
def test_a_boundary_leaves_both_phonemes_some_time(document, asked_s, stands_s):
    document.apply(MovePhonemeBoundary.on(document, 1, asked_s))
    assert document.speech.transcript.phonemes[1].end_s == pytest.approx(stands_s)
    assert covers(document)


def test_a_renamed_phoneme_loses_its_pin_says_so_and_undo_restores_it(document):
    edit = RenamePhoneme.on(document, 2, "iy")
    document.apply(edit)
    assert phones(document) == ("pau", "m", "iy", "b", "pau")
    assert document.pins == {1: "s1:0", 3: "s3:0"} and document.locks == {}
    assert "1 pin and 1 lock" in edit.note and "undo" in edit.note
    document.revert(edit)
    assert document.pins[2] == document.locks[2] == "s2:0"
    with pytest.raises(UserFacingError, match="'xx' is not a phone"):
        RenamePhoneme.on(document, 2, "xx")
    assert RenamePhoneme.on(document, 2, "aa").do(document) == Change(0)


def test_split_and_merge_are_each_others_opposite_and_pins_behind_them_move(document):
    split = SplitPhoneme.on(document, 1, 0.13)
    document.apply(split)
    assert phones(document) == ("pau", "m", "m", "aa", "b", "pau")
    assert document.speech.transcript.phonemes[2].start_s == 0.13
    assert document.pins == {3: "s2:0", 4: "s3:0"} and document.locks == {3: "s2:0"}
    assert covers(document)
    merge = MergePhonemes.on(document, 1)
    document.apply(merge)
    assert phones(document) == ("pau", "m", "aa", "b", "pau")
    assert document.pins == {2: "s2:0", 3: "s3:0"} and merge.note == ""
    assert covers(document)
    document.revert(merge)
    document.revert(split)
    assert document.pins == {1: "s1:0", 2: "s2:0", 3: "s3:0"}


def test_a_merge_drops_both_pins(document):
    merge = MergePhonemes.on(document, 1)
    document.apply(merge)
    assert phones(document) == ("pau", "m", "b", "pau")
    assert document.pins == {2: "s3:0"} and document.locks == {}
    assert "2 pins and 1 lock" in merge.note


def test_what_cannot_be_is_one_sentence(document):
    for make in (
        lambda: MergePhonemes.on(document, 4),
        lambda: MovePhonemeBoundary.on(document, 4, 0.2),
        lambda: SplitPhoneme.on(document, -1),
        lambda: RenamePhoneme.on(Document(), 0, "aa"),
    ):
        with pytest.raises(UserFacingError, match="There is no"):
            make()
    for _ in range(3):
        document.apply(SplitPhoneme.on(document, 0))
    with pytest.raises(UserFacingError, match="too short to split"):
        SplitPhoneme.on(document, 0)


def test_a_drag_is_one_edit(document):
    first = MovePhonemeBoundary.on(document, 1, 0.21, gesture=7)
    document.apply(first)
    second = MovePhonemeBoundary.on(document, 1, 0.25, gesture=7)
    document.apply(second)
    whole = first.followed_by(second)
    before = whole.before["speech"].transcript
    document.revert(whole)
    assert document.speech.transcript == before and before.phonemes[1].end_s == pytest.approx(0.2)
    document.apply(whole)
    assert document.speech.transcript.phonemes[1].end_s == 0.25
    assert first.followed_by(MovePhonemeBoundary.on(document, 1, 0.21, gesture=8)) is None
    assert MovePhonemeBoundary.on(document, 1, 0.2).followed_by(second) is None
