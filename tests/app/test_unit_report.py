from __future__ import annotations

import json

import av
import numpy as np
import pytest

from app.demo import demo_database
from app.unit_report import in_words
from core.iface.units_of_database import spoken_deformations
from core.motion.database import open_database


def test_the_figures_are_those_of_the_captures(efase, database_path):
    code, out, err = efase("units", "--db", database_path, "--count", "3", "--json")
    answer = json.loads(out)
    assert (code, err) == (0, "") and answer["synthetic"] is True
    database = open_database(database_path)
    moved = spoken_deformations(database)["neutral"].reshape(-1, 3 * len(database.markers))
    variance = np.linalg.svd(moved - moved.mean(axis=0), compute_uv=False) ** 2
    shares = [0, *np.cumsum(variance / variance.sum())[:3]]
    np.testing.assert_allclose(answer["utterance"]["covered_by_count"][:4], shares)
    assert answer["utterance"]["count"] == 3
    assert answer["utterance"]["covered"] == pytest.approx(shares[3])
    assert answer["frames"]["neutral"] == len(moved) and set(answer["expressions"]) == {"happiness", "anger", "sadness"}
    for off in answer["keyframes"]["off_mm"].values():
        assert off["unbounded"] <= off["bounded"]
    assert "3 units cover" in in_words(answer)
    # its markers fit no face, so what it does not show cannot be drawn
    assert answer["keyframes"]["names"] == ["smile", "sad", "a", "i", "m"]


def test_a_figure_is_drawn_of_a_database_that_is_named(efase, tmp_path):
    path = tmp_path / "figure4.png"
    code, out, _ = efase("units", "--db", demo_database().path, "--picture", path)
    if code:
        pytest.skip("no face or no GL on this machine")
    assert out.splitlines()[-1] == str(path)
    with av.open(str(path)) as container:
        picture = next(container.decode(video=0)).to_ndarray(format="rgb24")
    assert picture.shape[1] > 4 * 256 and picture.shape[0] > 2 * 320
    assert picture.max() > 150  # lit skin
    assert sorted(p.name for p in tmp_path.iterdir()) == ["figure4.png"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--covered", "1.5"), "does not lie between 0 and 1"),
        (("--count", "3", "--covered", "0.9"), "choose one of them"),
        (("--keyframes", "guessed"), "captured or drawn"),
        (("--picture", "figure.jpg"), "is no .png"),
        (("--face", "nobody"), "no character 'nobody'"),
        (("--picture", "figure.png", "--units-picture", "./figure.png"), "named for both pictures"),
    ],
)
def test_what_cannot_be_is_one_sentence(efase, words, sentence):
    code, out, err = efase("units", *words)
    assert (code, out) == (2, "") and sentence in err and len(err.strip().splitlines()) == 1
