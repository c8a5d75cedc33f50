"""`efase synth --batch`: many lines of dialogue, those that fail in a table, those that are done not done again."""

from __future__ import annotations

import csv
import json
from dataclasses import fields, replace
from pathlib import Path

import pytest

from app.synthesis import SynthesisJob
from core.motion.database import open_database
from core.motion.motion_files import read_motion
from core.search.weight_files import write_weights


@pytest.fixture
def table(tmp_path, speech_path, settings_folder):
    """A table of four lines on the hum; the third one's sound is missing."""
    path = tmp_path / "jobs.csv"
    phones = speech_path.with_suffix(".lab")
    rows = [("audio", "phones", "emotion", "output")]
    rows += [
        (speech_path, phones, emotion, f"line{i}.csv") for i, emotion in enumerate(("neutral", "anger", "", "sad"))
    ]
    rows[3] = ("absent.wav", "", "", "line2.csv")
    with path.open("w", newline="") as file:
        csv.writer(file).writerows(rows)
    return path


def _run(efase, table, database_path, *words):
    code, out, err = efase("synth", "--batch", table, "--db", database_path, "--backend", "numpy", "--jobs", 1,
                           "--json", *words)  # fmt: skip
    assert code == 0, err
    return json.loads(out)


def test_every_line_is_made_as_by_itself(efase, table, database_path, speech_path, tmp_path):
    answer = _run(efase, table, database_path, "--failures", tmp_path / "failed.csv")
    assert (answer["lines"], answer["made"], answer["resumed"]) == (4, 3, 0)
    assert list(answer["failed"]) == ["4"]
    rows = list(csv.reader((tmp_path / "failed.csv").read_text().splitlines()))
    assert rows[1][0] == "line 4"
    assert "absent.wav" in rows[1][1]
    alone = tmp_path / "alone.csv"
    code, _, err = efase("synth", speech_path, "--phones", speech_path.with_suffix(".lab"), "--emotion", "sad", "-o",
                         alone, "--db", database_path, "--backend", "numpy")  # fmt: skip
    assert code == 0, err
    assert (tmp_path / "line3.csv").read_bytes() == alone.read_bytes()
    assert (tmp_path / "line0.csv").read_bytes() != alone.read_bytes()


def test_what_is_done_is_not_done_again(efase, table, database_path, tmp_path):
    _run(efase, table, database_path)
    (tmp_path / "line1.csv").unlink()
    before = (tmp_path / "line0.csv").stat().st_mtime_ns
    again = _run(efase, table, database_path)
    assert (again["made"], again["resumed"]) == (1, 2)
    assert (tmp_path / "line0.csv").stat().st_mtime_ns == before
    assert len(read_motion(tmp_path / "line1.csv")[0])


def test_another_request_is_made_anew(efase, table, database_path):
    _run(efase, table, database_path)
    assert _run(efase, table, database_path, "--fps", "60")["made"] == 3


@pytest.mark.parametrize("option", ["--weights", "--markers"])
def test_a_changed_file_is_made_anew(efase, table, database_path, tmp_path, option):
    """Any file of the request, not only the sound."""
    given = tmp_path / "given"
    if option == "--weights":
        write_weights(given, open_database(database_path).weights, {})
    else:
        given.write_text("marker,vertex\n")
    assert _run(efase, table, database_path, option, given)["made"] == 3
    assert _run(efase, table, database_path, option, given)["made"] == 0
    given.write_text(given.read_text() + " \n")
    assert _run(efase, table, database_path, option, given)["made"] == 3


def test_every_file_of_a_request_is_known():
    """A field that comes to name a file has to be told of, or a batch would not see it change."""
    words = {"outputs", "emotion", "engine", "holds", "csv_is_live_link", "backend", "pins", "strict", "language"}
    files = {f.name for f in fields(SynthesisJob)} - words - {"video"}
    job = replace(SynthesisJob(Path("a"), ()), **{name: Path(f"file of {name}") for name in files})
    assert set(job.files_read) == {f"file of {name}" for name in files}


def test_a_journal_cut_by_a_kill_is_gone_on_with(efase, table, database_path):
    _run(efase, table, database_path)
    journal = table.with_name("jobs.csv.journal")
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:2]) + lines[2][:40])
    again = _run(efase, table, database_path)
    assert (again["made"], again["resumed"]) == (2, 1)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("audio,text\na.wav,hello\n", "output"),
        ("audio,output,colour\na.wav,a.csv,red\n", "colour"),
        ("audio,output\n", "no line"),
        ("audio,output\na.wav,a.csv\nb.wav,a.csv\n", "Line 3"),
        ("audio,output\na.wav,a.xyz\n", "Line 2"),
        ("audio,output\n,a.csv\n", "audio is empty"),
        ("audio,text,phones,output\na.wav,hello,a.lab,a.csv\n", "Line 2"),
    ],
)
def test_a_table_that_cannot_be_used_is_refused_whole(efase, settings_folder, tmp_path, text, said):
    table = tmp_path / "jobs.csv"
    table.write_text(text)
    code, _, err = efase("synth", "--batch", table)
    assert code == 2
    assert said in err
    assert not table.with_name("jobs.csv.journal").exists()


def test_a_sound_or_a_table_and_not_both(efase, settings_folder, speech_path, table):
    assert efase("synth", speech_path, "--batch", table)[0] == 2
    assert efase("synth", speech_path)[0] == 2
