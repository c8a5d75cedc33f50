"""Curves of an artist beside their transcripts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.animeme import form as forms
from core.animeme.artist_curves import read_artist_examples
from core.animeme.controls import ControlTrack
from core.animeme.training import train_animemes
from core.errors import UserFacingError
from core.pipeline.curves import write_curves_csv, write_curves_json

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral

SPOKEN = ("b", "aa", "iy", "k", "s")  # neighbouring silences would become one


def drawn(model, transcript):
    """Curves of weights, which lie between 0 and 1."""
    track = model.curves(transcript, 30.0)
    return replace(track, values=1.0 / (1.0 + np.exp(-track.values)))


def write_lab(path, transcript):
    rows = [f"{u.end_s:.6f} 100 {u.phone}" for u in transcript.phonemes]
    path.write_text("\n".join(["#", *rows]) + "\n", encoding="utf-8")


@pytest.fixture
def takes(tmp_path, known_model, babble):
    """Four takes, CSV and JSON in turn, at 30 frames a second."""
    for i, transcript in enumerate(babble(4, phones=SPOKEN)):
        track = drawn(known_model(PRINTED), transcript)
        if i % 2:
            write_curves_json(tmp_path / f"take{i}.json", track)
        else:
            write_curves_csv(tmp_path / f"take{i}.csv", track)
        write_lab(tmp_path / f"take{i}.lab", transcript)
    return tmp_path


def test_a_folder_is_read_in_order_of_the_names(takes, known_model, babble):
    examples = read_artist_examples([takes])
    assert [e.transcript.phones[:12] for e in examples] == [t.phones for t in babble(4, phones=SPOKEN)]
    for example, transcript in zip(examples, babble(4, phones=SPOKEN)):
        wanted = drawn(known_model(PRINTED), transcript)
        assert example.track.names == wanted.names
        n = min(len(example.track), len(wanted))
        np.testing.assert_allclose(example.track.values[:n], wanted.values[:n], atol=1e-5)
    assert train_animemes(examples, PRINTED).model.names == ("jawOpen", "mouthPucker")


def test_a_take_without_a_transcript_and_one_with_other_controls_are_told(takes):
    (takes / "take2.lab").rename(takes / "take2.gone")
    with pytest.raises(UserFacingError, match=r"no transcript beside '.*take2\.csv'"):
        read_artist_examples([takes])
    (takes / "take2.gone").rename(takes / "take2.lab")
    write_curves_csv(takes / "take2.csv", ControlTrack(("jawOpen", "smile"), np.zeros((40, 2)), 30.0))
    with pytest.raises(UserFacingError, match="same controls"):
        read_artist_examples([takes])


def test_an_empty_folder_is_told(tmp_path):
    with pytest.raises(UserFacingError, match="no curves"):
        read_artist_examples([tmp_path])
