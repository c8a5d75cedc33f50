"""Curves of an artist beside their transcripts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import soundfile

from core.animeme import form as forms
from core.animeme.artist_curves import CurveReading, read_artist_examples
from core.animeme.training import train_animemes
from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS
from core.pipeline.curves import write_curves_csv, write_curves_json
from core.rig.control_track import ControlTrack
from core.speech.transcript import PhonemeUtterance, Transcript

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


def test_our_own_names_of_curves_go_with_the_transcript_of_the_take(takes):
    (takes / "take0.csv").rename(takes / "take0.livelink.csv")
    (takes / "take1.json").rename(takes / "take1.curves.json")
    examples, notes = read_artist_examples([takes])
    assert len(examples) == 4 and not notes


def test_a_folder_is_read_in_order_of_the_names(takes, known_model, babble):
    examples, notes = read_artist_examples([takes])
    assert not notes
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


SHAPES = ("jaw_down", "mouth_oo")


@pytest.fixture
def weights(takes):
    """The takes' curves as a studio keeps them: arrays without names, a list, and a table to ARKit's units."""
    folder = takes / "weights"
    folder.mkdir()
    (takes / "names.txt").write_text("\n".join(SHAPES))
    (takes / "sheet.csv").write_text("ARKit,Ours\njawOpen,jaw_down\nmouthPucker,mouth_oo\n")
    for i, example in enumerate(read_artist_examples(sorted(takes.glob("take*.[cj]s*")))[0]):
        np.save(folder / f"bs_value_take{i}.npy", example.track.values)
    return folder


def reading_of(takes, **more):
    return CurveReading(takes / "names.txt", takes / "sheet.csv", speech_folder=takes, **more)


def test_weights_without_names_are_curves_by_a_list_and_a_table(takes, weights):
    examples, notes = read_artist_examples([weights], reading_of(takes))
    assert {e.track.names for e in examples} == {("jawOpen", "mouthPucker")}
    for path, example in zip(sorted(weights.iterdir()), examples):
        written = np.load(path)
        np.testing.assert_allclose(example.track.values, written[: len(example.track)], atol=1e-6)
    assert all("30 frames a second" in note for note in notes) and len(notes) == len(examples)


def test_a_model_among_the_curves_is_no_take(takes, known_model):
    known_model(PRINTED).save(takes / "model.npz")
    assert len(read_artist_examples([takes])[0]) == 4


def test_sound_is_asked_where_no_times_are_and_how_is_said(takes, monkeypatch):
    (takes / "take2.lab").unlink()
    soundfile.write(takes / "take2.wav", np.zeros(16_000), 16_000)
    asked = []

    def place(audio, text):
        asked.append(text)
        return Transcript.covering([PhonemeUtterance("aa", 0.2, 0.8)], (), audio.duration_s)

    monkeypatch.setattr("core.speech.aligner.align", lambda audio, text, *_: place(audio, text))
    monkeypatch.setattr("core.speech.aligner.recognise", lambda audio, *_: ("ah", place(audio, None)))
    (takes / "take2.txt").write_text("ah", encoding="utf-8")
    for text, said in (("ah", "text was placed"), (None, "recognised from the sound")):
        examples, notes = read_artist_examples([takes])
        assert asked[-1] == text and examples[2].transcript.phones == ("pau", "aa", "pau")
        assert "take2.csv" in notes[0] and said in notes[0]
        assert len(examples[2].track) == 30 and "lasts 1.00 s" in notes[1]  # no further than the sound
        (takes / "take2.txt").unlink(missing_ok=True)


def test_silence_and_a_folder_of_sounds_that_is_not_there_are_told(takes):
    (takes / "take2.lab").unlink()
    soundfile.write(takes / "take2.wav", np.zeros(16_000), 16_000)
    with pytest.raises(UserFacingError, match=r"No speech is heard in '.*take2\.wav'"):
        read_artist_examples([takes])
    with pytest.raises(UserFacingError, match="no folder of sounds"):
        read_artist_examples([takes], CurveReading(speech_folder=takes / "gone"))


def test_facegoods_weights_are_read_with_transcripts_beside_the_sounds(tmp_path, shared_data):
    folder = shared_data("facegood")
    (tmp_path / "1114_3_15.lab").write_text("0 20 pau\n20 30 aa\n30 49.07 pau\n", encoding="utf-8")
    reading = CurveReading(folder / "shirley_1015_bs_name.npy", folder / "Voice2Face_blendshape2ARkit.xlsx",
                           speech_folder=tmp_path)  # fmt: skip
    ((example,), notes) = read_artist_examples([folder / "bs_value" / "bs_value_1114_3_15.npy"], reading)
    assert set(example.track.names) < set(ARKIT_UNITS) and len(example.track) == 1472
    assert any("not mapped" in note for note in notes)
