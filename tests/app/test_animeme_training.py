"""`efase train animeme`: what it writes, what it says, and what it refuses."""

from __future__ import annotations

import json

import numpy as np
import pytest

from core.animeme.animeme import load_animemes
from core.pipeline.curves import write_curves_csv
from core.rig.control_track import ControlTrack


@pytest.fixture
def takes(tmp_path):
    """Two takes of an artist: the jaw opens in each vowel."""
    folder = tmp_path / "takes"
    folder.mkdir()
    times_s = np.arange(60) / 30.0
    for take in ("a", "b"):
        jaw = 0.5 - 0.5 * np.cos(2 * np.pi * times_s / 0.4)
        write_curves_csv(folder / f"{take}.csv", ControlTrack(("jawOpen", "smile"), np.c_[jaw, 0 * jaw], 30.0))
        rows = [f"{0.2 * i:.1f} {0.2 * i + 0.2:.1f} {'m' if i % 2 else 'aa'}" for i in range(10)]
        (folder / f"{take}.lab").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder


def test_animemes_of_a_databases_components_are_written_and_told(efase, database_path, settings_folder, tmp_path):
    target = tmp_path / "talk.npz"
    words = ("train", "animeme", "--db", database_path, "--rig", "components", "--sentences", "5", "-o", target)
    code, out, _ = efase(*words, "--json")
    answer = json.loads(out)
    assert code == 0
    assert (answer["sentences"], answer["form"]) == (5, "best")
    model = load_animemes(target)
    assert list(model.names) == answer["names"]
    assert answer["controls"] == len(model.names)
    assert 0 < answer["residual"] < 1
    assert not list((tmp_path / "cache" / "animemes").glob("*.journal.npz"))
    code, out, _ = efase(*words, "--form", "printed")
    assert code == 0 and "5 sentences" in out
    assert not load_animemes(target).form.is_normalised


def test_animemes_of_an_artists_curves_keep_the_names_of_the_controls(efase, takes, settings_folder, tmp_path):
    target = tmp_path / "talk.npz"
    code, _, err = efase("train", "animeme", "--controls", takes, "-o", target)
    assert code == 0, err
    assert load_animemes(target).names == ("jawOpen", "smile")


def test_weights_of_a_studio_become_its_controls_and_what_was_taken_for_granted_is_said(
    efase, takes, settings_folder, tmp_path
):
    for take in ("a", "b"):
        table = np.loadtxt(takes / f"{take}.csv", delimiter=",", skiprows=1)
        np.save(takes / f"{take}.npy", table[:, -2:])
        (takes / f"{take}.csv").unlink()
    (tmp_path / "names.txt").write_text("jaw_down\nsmile_both\n", encoding="utf-8")
    (tmp_path / "sheet.csv").write_text("ARKit,Ours\njawOpen,jaw_down\n", encoding="utf-8")
    names = ("--shape-names", tmp_path / "names.txt")
    words = ("train", "animeme", "--controls", takes, "-o", tmp_path / "talk.npz")
    code, _, err = efase(*words)
    assert code == 2 and "list of names" in err
    code, out, err = efase(*words, *names, "--shape-sheet", tmp_path / "sheet.csv", "--json")
    assert code == 0 and "a.npy: Taken to have 30 frames a second." in err
    assert json.loads(out)["names"] == ["jawOpen"] and len(json.loads(out)["warnings"]) == 2
    code, _, err = efase(*words, *names, "--rate", "30")
    assert code == 0 and not err
    assert load_animemes(tmp_path / "talk.npz").names == ("jaw_down", "smile_both")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--rig", "puppet"), "no rig 'puppet'"),
        (("--form", "square"), "no form 'square'"),
        (("--controls", "nowhere.csv"), "nowhere.csv"),
        (("--controls", "a.csv", "--corpus", "b"), "at once"),
        (("--db", "nowhere.h5"), "nowhere.h5"),
    ],
)
def test_what_cannot_be_learnt_is_told_in_one_sentence(efase, settings_folder, tmp_path, words, said):
    code, out, err = efase("train", "animeme", *words, "-o", tmp_path / "talk.npz")
    assert (code, out) == (2, "") and said in err and "Traceback" not in err
    assert not (tmp_path / "talk.npz").exists()
