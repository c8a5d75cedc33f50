"""The demo database holds out what the actress keeps to tune and to compare on."""

from __future__ import annotations

import numpy as np
import pytest

from app.demo import demo_database
from core.actress.corpus import comparison_sentences, record, tuning_sentences
from core.media.audio import audio_from_bytes, load_audio
from core.motion.database import open_database


@pytest.fixture(scope="module")
def demo():
    return open_database(demo_database().path)


def test_24_sentences_to_tune_and_12_to_compare_on_are_held_out(demo):
    expected = {"tune": tuning_sentences(), "test": comparison_sentences()}
    assert {s: list(names) for s, names in demo.held_out.items()} == {
        split: [spoken.sentence for spoken in sentences] for split, sentences in expected.items()
    }
    assert demo.summary()["held_out"] == {"tune": 24, "test": 12}
    apart = {name for names in demo.held_out.values() for name in names}
    assert apart.isdisjoint(sentence.name for sentence in demo.sentences) and len(demo.sentences) == 180


def test_their_recordings_are_the_actress_and_their_sound_is_hers(demo):
    spoken = comparison_sentences()[4]
    given, kept = record(spoken), demo.held_out_recordings("test")[4]
    columns = [given.marker_names.index(name) for name in demo.markers.names]
    assert np.array_equal(kept.positions, given.positions[:, columns], equal_nan=True)
    assert (kept.sentence, kept.emotion, kept.text, kept.rate_hz) == (
        spoken.sentence, spoken.emotion, spoken.text, given.rate_hz,
    )  # fmt: skip
    assert kept.transcript == given.transcript
    sound = audio_from_bytes(demo.audio_bytes(spoken.sentence))
    assert sound.duration_s == load_audio(spoken.audio).duration_s
