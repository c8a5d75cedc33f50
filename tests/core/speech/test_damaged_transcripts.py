"""Damaged transcripts, lexicons and emotion files are read, or refused in one sentence."""

from __future__ import annotations

import pytest

from core.speech.emotion_files import read_emotions
from core.speech.lexicon import read_lexicon
from core.speech.spoken_words import spoken_words
from core.speech.textgrid import write_textgrid
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.speech.transcript_files import read_transcript

SPOKEN = Transcript.covering(
    [PhonemeUtterance("n", 0.2, 0.5), PhonemeUtterance("ow", 0.5, 0.8)], [WordUtterance("no", 0.2, 0.8)], 1.0
)
CONTENT = {
    "xwaves.lab": "separator ;\nnfields 1\n#\n 0.2 100 pau\n 0.5 100 n\n 0.8 100 ow\n 1.0 100 pau\n",
    "htk.lab": "0 2000000 sil\n2000000 5000000 n -12.5\n5000000 8000000 ow -3\n8000000 10000000 sil\n",
    "plain.txt": "# by hand\n0 0.2 pau\n0.2 0.5 n\n0.5 0.8 ow\n0.8 1 pau\n",
    "emotions.txt": "0.0 1.2 neutral\n1.2 2.5 anger 0.7\n",
    "lexicon.txt": "efase IY F EY S\nefase(2) IY F AH S\n",
}


def covering(path):
    phonemes = read_transcript(path, 1.0).phonemes
    assert phonemes[0].start_s == 0 and phonemes[-1].end_s == 1.0


READ = {"emotions.txt": read_emotions, "lexicon.txt": read_lexicon}


@pytest.mark.parametrize("name", ["grid.TextGrid", *CONTENT])
@pytest.mark.parametrize("n", [150, pytest.param(5000, marks=pytest.mark.prove)])
def test_damaged_copies_are_read_or_refused(tmp_path, survives_damage, name, n):
    path = tmp_path / name
    if name in CONTENT:
        path.write_text(CONTENT[name])
    else:
        write_textgrid(SPOKEN, path)
    assert survives_damage(path, READ.get(name, covering), n) > n / 3


def test_numbers_of_any_length_can_be_said():
    assert spoken_words("9" * 5000) == ["nine"] * 5000
    assert spoken_words("$" + "9" * 5000)[:2] == ["nine", "nine"]
