import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.speech.script_marks import without_script_marks


@pytest.mark.parametrize(
    ("text", "said", "left_out"),
    [
        ("JOHN: Hello there.", "Hello there.", ["JOHN:"]),
        ("MARY ANN (V.O.): I can't wait!", "I can't wait!", ["MARY ANN (V.O.):"]),
        ("Speaker 1: Hi.\nSpeaker 2: Ho.", "Hi. Ho.", ["Speaker 1:", "Speaker 2:"]),
        ("Anna: Hi.\nBob: Ho.\n\nAnna: Ha.", "Hi. Ho. Ha.", ["Anna:", "Bob:"]),
        ("Remember: come home.", "Remember: come home.", []),
        ("Anna: Hi.\nand Bob: Ho.", "Anna: Hi. and Bob: Ho.", []),
        ("O'NEILL: Hi.", "Hi.", ["O'NEILL:"]),
        ("I said: STOP: now.", "I said: STOP: now.", []),
        ("at 10:30", "at 10:30", []),
        ("[laughs] Well (sighs) no *gasp* (clearing her throat)", "Well no",
         ["[laughs]", "(sighs)", "*gasp*", "(clearing her throat)"]),
        ("I *really* know (I think) this", "I *really* know (I think) this", []),
        ("INT. KITCHEN - DAY\nDon't move.", "Don't move.", ["INT. KITCHEN - DAY"]),
        ("1\n00:00:01,000 --> 00:00:04,000\nHello\n\n2\n00:00:05,000 --> 00:00:06,000\n<i>Bye</i> now", "Hello Bye now",
         []),
        ("WEBVTT\n\n00:01.000 --> 00:04.000\nHello", "Hello", []),
    ],
)  # fmt: skip
def test_said_and_left_out(text, said, left_out):
    spoken, marks = without_script_marks(text)
    assert " ".join(spoken.split()) == said
    assert sorted(marks) == sorted(left_out)


@given(st.text(alphabet="abcXYZ '.,!?\n", max_size=80))
def test_plain_text_stays(text):
    assert without_script_marks(text) == (text, [])
