"""Names are taught once, in the window, and known to the next alignment."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.loading import lexicon_path
from core.speech.lexicon import read_lexicon

WAIT_MS = 20_000


@pytest.fixture
def dialog(open_window):
    window = open_window()
    window.actions.by_name["lexicon"].trigger()
    return window.lexicon


def test_a_word_is_guessed_and_put_right_and_kept(dialog, qtbot):
    QTest.keyClicks(dialog.word, "efase")
    QTest.keyClick(dialog.word, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: dialog.lines.toPlainText().strip().startswith("efase "), timeout=WAIT_MS)
    dialog.lines.selectAll()
    QTest.keyClicks(dialog.lines, "efase iy f ey s")
    qtbot.waitUntil(lambda: lexicon_path().is_file(), timeout=WAIT_MS)
    qtbot.waitUntil(lambda: read_lexicon(lexicon_path()) == {"efase": [("iy", "f", "ey", "s")]}, timeout=WAIT_MS)


def test_a_line_that_is_wrong_is_named_and_what_was_kept_stays(dialog, qtbot):
    QTest.keyClicks(dialog.lines, "one w ah n")
    dialog.keep()
    QTest.keyClick(dialog.lines, Qt.Key.Key_Return)
    QTest.keyClicks(dialog.lines, "two")
    dialog.keep()
    assert "line 2" in dialog.message.text()
    assert read_lexicon(lexicon_path()) == {"one": [("w", "ah", "n")]}


def test_the_next_alignment_knows_the_words(dialog, monkeypatch, speech_path):
    from app import speech
    from app.loading import SpeechRequest, read_speech
    from core.progress import SILENT

    QTest.keyClicks(dialog.lines, "zzyzx z ay z ih k s")
    dialog.keep()
    asked = []
    monkeypatch.setattr(speech, "_aligned", lambda audio, said, words, progress: asked.append(words))
    read_speech(SpeechRequest(speech_path, "zzyzx"), SILENT)
    assert asked == [{"zzyzx": [("z", "ay", "z", "ih", "k", "s")]}]
