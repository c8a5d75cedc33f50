"""`efase import`: from files to a database, a plan, or the mended motion itself."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
import soundfile

from core.motion.motion_files import read_motion, write_markers_csv

NAMES = ("nose_bridge", "nose_tip", "inner_eye_left", "inner_eye_right", "chin", "upper_lip", "lower_lip",
         "mouth_corner_left", "mouth_corner_right", "brow_left", "brow_right", "cheek_left", "cheek_right")  # fmt: skip
RATE_HZ = 60.0


@pytest.fixture
def captures(tmp_path, settings_folder):
    """Three takes of a made-up face, the second with a gap and a spike; two have sound and phones."""
    folder = tmp_path / "captures"
    folder.mkdir()
    rest = np.array([[0, 0, 0], [0, -25, 20], [15, 5, -8], [-15, 5, -8], [0, -90, 0], [0, -50, 12], [0, -58, 12],
                     [25, -54, 2], [-25, -54, 2], [30, 25, -5], [-30, 25, -5], [45, -25, -15],
                     [-45, -25, -15]], float)  # fmt: skip
    times_s = np.arange(120) / RATE_HZ
    for s in range(3):
        take = np.repeat(rest[None], 120, axis=0) + 0.01 * np.random.default_rng(s).normal(size=(120, 13, 3))
        open_mm = 6 * (1 + np.sin(2 * np.pi * (2 + 0.3 * s) * times_s))
        take[:, [4, 6], 1] -= open_mm[:, None]
        take[:, [7, 8], 1] -= 0.5 * open_mm[:, None]
        if s == 1:
            take[40:45, 12] = np.nan
            take[80, 9] += 9.0
        write_markers_csv(folder / f"anger_{s}.csv", take, NAMES, RATE_HZ)
        if s < 2:
            soundfile.write(folder / f"anger_{s}.wav", 0.1 * np.random.default_rng(s).normal(size=32_000), 16_000)
            (folder / f"anger_{s}.lab").write_text("0 0.2 pau\n0.2 0.6 b\n0.6 1.2 aa\n1.2 1.8 m\n1.8 2.0 pau\n")
    return folder


def test_files_become_a_database_that_tells_what_was_done(efase, captures, tmp_path):
    db = tmp_path / "db.h5"
    code, out, err = efase("import", captures, "-o", db, "--jobs", 1, "--json")
    assert code == 0, err
    answer = json.loads(out)
    assert answer["sentences"] == 3
    mended = next(row for row in answer["report"]["rows"] if row["sentence"] == "anger_1")
    assert (mended["gap_samples"], mended["spikes_cut"]) == (5, 1)
    code, out, err = efase("info", db)
    assert code == 0, err
    assert "imported 3 of 3 sentences" in out
    assert "anger" in out


def test_a_plan_is_written_changed_and_carried_out(efase, captures, tmp_path):
    plan = tmp_path / "plan.json"
    code, _, err = efase("import", captures, "--save-plan", plan)
    assert code == 0, err
    proposed = json.loads(plan.read_text())
    assert proposed["landmarks"]["chin"] == "chin"
    assert proposed["origin"] == "nose_bridge"
    proposed["sentences"] = proposed["sentences"][:2]
    proposed["sentences"][0]["motion"] = "gone.csv"
    plan.write_text(json.dumps(proposed))
    failures = tmp_path / "failures.csv"
    code, out, _ = efase("import", "--plan", plan, "-o", tmp_path / "db.h5", "--failures", failures, "--jobs", 1)
    assert code == 0
    assert "imported 1 of 2 sentences" in out
    rows = list(csv.reader(failures.read_text().splitlines()))
    assert [row[0] for row in rows] == ["name", "anger_0"]
    assert "gone.csv" in rows[1][1]


def test_the_mended_motion_itself_is_written(efase, captures, tmp_path):
    target = tmp_path / "take.c3d"
    code, _, err = efase("import", captures / "anger_1.csv", "-o", target, "--jobs", 1)
    assert code == 0, err
    positions, names, _ = read_motion(target)
    assert names == NAMES
    assert np.isfinite(positions).all()
    assert positions[:, 9].std(axis=0).max() < 0.3


def test_markers_take_the_names_of_another_database(efase, captures, tmp_path):
    first, second = tmp_path / "first.h5", tmp_path / "second.h5"
    assert efase("import", captures, "-o", first, "--jobs", 1)[0] == 0
    for path in captures.glob("*.csv"):
        path.write_text(path.read_text().replace("mouth_corner_left", "MouthL_Corner").replace("chin", "jaw"))
    code, out, err = efase("import", captures, "-o", second, "--markers-like", first, "--jobs", 1, "--json")
    assert code == 0, err
    assert json.loads(out)["content_hash"]
    from core.motion.database import open_database

    assert open_database(second).markers.names == open_database(first).markers.names


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("{captures}", "-o", "x.txt"), "x.txt"),
        (("-o", "{tmp}/db.h5"), "files"),
        (("{captures}", "--plan", "p.json", "-o", "{tmp}/db.h5"), "both"),
        (("{captures}",), "written"),
        (("{captures}", "-o", "{tmp}/db.h5", "--emotion", "bored"), "bored"),
        (("{captures}", "-o", "{tmp}/db.h5", "--picture", "big"), "big"),
        (("{captures}/anger_2.csv", "-o", "{tmp}/db.h5"), "speech"),
    ],
)
def test_what_cannot_be_done_is_said_and_nothing_is_written(efase, captures, tmp_path, words, said):
    filled = [word.format(captures=captures, tmp=tmp_path) for word in words]
    code, _, err = efase("import", *filled)
    assert code == 2
    assert said in err
    assert not (tmp_path / "db.h5").exists()
