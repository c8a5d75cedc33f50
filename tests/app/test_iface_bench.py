"""`efase bench iface` on a small corpus, with a ridge regression in the place of the trained faces."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import soundfile
from typer.testing import CliRunner

from app.cli import app
from app.iface_bench import bench_curves, bench_database
from app.iface_tables import as_table
from core.actress.corpus import CORPUS_NAME
from core.animeme.artist_curves import CurveReading
from core.errors import UserFacingError
from core.iface.heard_takes import database_takes
from core.iface.speech_features import SAMPLE_RATE_HZ
from core.speech.transcript import Transcript
from tests.core.iface.conftest import loud_corpus, loud_database  # noqa: F401
from tests.core.iface.test_comparison import train


@pytest.fixture(scope="module")
def answer(loud_database):
    return bench_database(loud_database, {"ridge": train, "again": train})


def test_every_split_scope_and_emotion_is_there_and_as_compared(answer, loud_database):
    json.dumps(answer, allow_nan=False)
    assert (answer["corpus"], answer["synthetic"]) == ("loud mouths", False)
    assert list(answer["splits"]) == ["by sentence", "by frame"]
    takes = database_takes(loud_database)
    by_sentence = answer["splits"]["by sentence"]
    said_s = by_sentence["speech_s"]["train"]
    assert sum(said_s.values()) == pytest.approx(sum(map(len, takes)) / 30, abs=0.2)
    assert by_sentence["faces"]["ridge"]["test"] == by_sentence["faces"]["again"]["test"]
    assert "ceiling" not in by_sentence["faces"]["ridge"]
    assert 0.3 < by_sentence["faces"]["ridge"]["lips"]["lip_gap_r"] < 1.0
    by_frame = answer["splits"]["by frame"]["speech_s"]
    assert sum(by_frame["train"].values()) == pytest.approx(4 * sum(by_frame["test"].values()), rel=0.03)


def test_the_table_has_a_column_for_each_half_and_emotion(answer):
    lines = as_table(answer).splitlines()
    heads = [line for line in lines if line.startswith(("| all markers", "| lips and jaw", "| tracked"))]
    assert len(heads) == 6
    assert all(head.endswith("| train, neutral | train, anger | test, neutral | test, anger |") for head in heads)
    r = answer["splits"]["by sentence"]["faces"]["ridge"]["test"]["all markers"]["anger"]["r"]
    captured, row = lines[lines.index(heads[0]) + 2 :][:2]
    assert captured.startswith("| captured | ν | 0.")
    assert row.startswith("| ridge | R |") and row.endswith(f"| {r:.3f} |")
    assert any("; lip gap r 0." in line for line in lines)
    told = answer["splits"]["by sentence"]["told"]["test"]["all markers"]["neutral"]["r"]
    assert any(line.startswith("| told the phones | R | – | – |") and f"{told:.3f}" in line for line in lines)


def test_sentences_of_the_actress_are_said_twice_for_the_ceiling(loud_database, monkeypatch):
    """Her voice and face are many; here somebody else speaks in her name, who trembles anew each time."""
    from app import iface_bench
    from core.actress import corpus as actress

    names = [recording.sentence for recording in loud_database.held_out_recordings("test")]
    spoken = [actress.SpokenSentence(name, "neutral", "", None, None) for name in names]
    by_name = {recording.sentence: recording for recording in loud_database.held_out_recordings("test")}

    def said_again(line, seed):
        recording = by_name[line.sentence]
        tremble = np.random.default_rng(len(seed)).normal(size=recording.positions.shape).astype(np.float32)
        return replace(recording, positions=recording.positions + 0.02 * tremble)

    monkeypatch.setattr(actress, "comparison_sentences", lambda: spoken)
    monkeypatch.setattr(iface_bench, "said_again", said_again)
    answer = bench_database(replace(loud_database, name=CORPUS_NAME), {"ridge": train})
    found = answer["splits"]["by sentence"]["faces"]["ridge"]["ceiling"]
    rows = [row for by in (found["all markers"], found["lips and jaw"]) for row in by.values()]
    assert len(rows) == 4
    for row in rows:
        assert 0.1 < row["ceiling"] < 1.0 and row["share"] == pytest.approx(row["r"] / row["ceiling"])
    assert "| all markers | √R of two takes |" in as_table(answer)


def test_curves_are_measured_by_what_they_move(tmp_path, monkeypatch):
    from core.iface import curve_takes

    rng = np.random.default_rng(1)
    for n in range(2):
        loud = np.repeat(rng.uniform(0, 1, 60), 5)
        jaw = np.convolve(loud, np.ones(3) / 3, mode="same")
        np.savez(
            tmp_path / f"take{n}.npz",
            weights=np.stack([jaw, 0.3 * jaw], axis=1),
            names=["jawOpen", "mouthPucker"],
            rate_hz=30.0,
        )
        sound = np.repeat(loud, SAMPLE_RATE_HZ // 30) * rng.normal(size=300 * (SAMPLE_RATE_HZ // 30)) * 0.1
        soundfile.write(tmp_path / f"take{n}.wav", sound, SAMPLE_RATE_HZ)

    def recognised(audio, duration_s, **_):
        return Transcript.covering([], [], duration_s, []), "", "recognised"

    monkeypatch.setattr(curve_takes, "placed_speech", recognised)
    answer = bench_curves([tmp_path], CurveReading(), {"ridge": train})
    split = answer["splits"]["by time"]
    assert split["speech_s"]["test"]["neutral"] == pytest.approx(2 * 2.0, abs=0.1)
    assert split["speech_s"]["train"]["neutral"] == pytest.approx(2 * 6.0, abs=0.1)
    assert split["faces"]["ridge"]["test"]["lips and jaw"]["neutral"]["r"] > 0.5
    assert "| lips and jaw |  | train, neutral | test, neutral |" in as_table(answer)


def test_the_verb_tells_what_it_cannot_measure(tmp_path):
    runner = CliRunner()
    for words, said in (
        (["--variant", "old"], "no variant 'old'"),
        (["--controls", str(tmp_path)], "no curves in"),
        (["--controls", str(tmp_path), "--audio-dir", str(tmp_path / "gone")], "no folder of sounds"),
    ):
        answer = runner.invoke(app, ["bench", "iface", *words])
        assert isinstance(answer.exception, UserFacingError) and said in str(answer.exception)
