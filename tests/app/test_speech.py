"""Speech is aligned the same way here and apart, and apart the process stays free for others."""

from __future__ import annotations

import time

import pytest

from app.speech import load_speech
from core.actress.corpus import demo_sentences
from core.errors import UserFacingError
from core.progress import Cancelled, Progress


@pytest.fixture(scope="module")
def spoken():
    return demo_sentences()[0]


class Clocked(Progress):
    """Knows the longest time between two steps."""

    def __init__(self, stop_at: str = "nowhere") -> None:
        self.longest_s, self._last_s, self._stop_at = 0.0, time.monotonic(), stop_at

    def step(self, fraction, message=""):
        now_s = time.monotonic()
        self.longest_s, self._last_s = max(self.longest_s, now_s - self._last_s), now_s
        if message == self._stop_at:
            raise Cancelled


def test_apart_and_here_give_the_same_transcript(spoken, monkeypatch):
    here = load_speech(spoken.audio, spoken.text)
    monkeypatch.setattr("app.speech._LONGEST_ALIGNED_HERE_S", 0.0)
    apart = load_speech(spoken.audio, spoken.text)
    assert apart.transcript == here.transcript
    with pytest.raises(UserFacingError, match=r"200 words cannot be said in"):
        load_speech(spoken.audio, "one " * 200)


def test_recognition_can_be_cancelled_while_it_listens(spoken):
    began = Clocked("listening")
    with pytest.raises(Cancelled):
        load_speech(spoken.audio, progress=began)
    full, began_s = Clocked(), time.monotonic()
    speech = load_speech(spoken.audio, progress=full)
    assert speech.recognised and speech.text
    # in this process one stretch would hold the lock for most of the time
    assert full.longest_s < 0.25 * (time.monotonic() - began_s)


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("script.docx", b"PK\x03\x04\x14\x00\x06\x00\x08\xff", "is a document, not plain text"),
        ("script.rtf", b"{\\rtf1\\ansi Hello}", "is a document, not plain text"),
        ("script.txt", b'File type = "ooTextFile"\nObject class = "TextGrid"\n', "is a TextGrid, not a text"),
        ("missing.srt", None, "There is no text file"),
    ],
)
def test_a_file_that_holds_no_text_is_named(spoken, tmp_path, name, content, says):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(UserFacingError, match=says):
        load_speech(spoken.audio, str(tmp_path / name))
