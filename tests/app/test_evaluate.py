"""`efase evaluate` from databases and folders to a page, an object, or one sentence of refusal."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import soundfile

from app.evaluate import ANSWER, PAGE, EvaluationJob, run
from core.evaluation.split import split_names
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.motion_files import write_c3d
from core.motion.recording import Recording
from core.progress import Cancelled, Progress
from core.speech.emotion import EMOTIONS
from core.speech.transcript import PhonemeUtterance, Transcript

RATE_HZ, N = 50.0, 24
NAMES = ("up", "low", *(f"m{k}" for k in range(6)))
PHONES = ("pau", "m", "aa", "b", "iy", "pau")
FIGURES = (
    "error_mm2", "lip_error_mm", "lip_gap_r", "closure_rate", "gap_variance_ratio", "velocity_variance_ratio",
    "acceleration_variance_ratio", "seconds_per_sentence",
)  # fmt: skip


def recording(s):
    rng = np.random.default_rng(s)
    rest = np.random.default_rng(99).normal(size=(1, len(NAMES), 3)) * 40
    rest[0, 1] = rest[0, 0] - [0, 4, 0]
    positions = np.repeat(rest, 60, axis=0) + 0.05 * rng.normal(size=(60, len(NAMES), 3))
    opening = np.array([0, 0, 8, 0, 3, 0])[np.minimum(np.arange(60) // 10, 5)] * (1 + s % 4)
    positions[:, 1, 1] -= np.convolve(opening, np.ones(5) / 5, "same")
    spoken = tuple(PhonemeUtterance(p, 0.2 * i, 0.2 * i + 0.2) for i, p in enumerate(PHONES))
    emotion = EMOTIONS[s % 2]
    return Recording(
        f"s{s:02d}", emotion, positions.astype(np.float32), NAMES, RATE_HZ, Transcript(spoken, (), 1.2), "maybe <i>"
    )


@pytest.fixture(scope="module")
def corpus():
    groups, landmarks = {"lips": ("up", "low")}, {"upper_lip": "up", "lower_lip": "low"}
    recordings = [recording(s) for s in range(N)]
    parts = split_names([r.sentence for r in recordings])
    return Corpus(
        "<small> & co", recordings, NAMES, groups, landmarks, held_out={s: parts[s] for s in ("tune", "test")}
    )


@pytest.fixture(scope="module")
def database(corpus, tmp_path_factory):
    path = tmp_path_factory.mktemp("database") / "small.h5"
    build_database(corpus, path, BuildSettings(n_dims=6))
    return path


@pytest.fixture
def folder(corpus, tmp_path):
    """The same corpus as files."""
    home = tmp_path / "corpus"
    home.mkdir()
    lines = ["sentence,emotion"]
    for r in corpus.recordings:
        lines.append(f"{r.sentence},{r.emotion}")
        write_c3d(home / f"{r.sentence}.c3d", r.positions, r.marker_names, r.rate_hz)
        soundfile.write(home / f"{r.sentence}.wav", 0.1 * np.sin(np.arange(19_200) / 9), 16_000)
        spoken = [f"{u.start_s:.3f} {u.end_s:.3f} {u.phone}" for u in r.transcript.phonemes]
        (home / f"{r.sentence}.txt").write_text("\n".join(spoken) + "\n")
    (home / "corpus.csv").write_text("\n".join(lines) + "\n")
    table = [
        "marker,kept,groups,landmark",
        "up,1,lips,upper_lip",
        "low,1,lips,lower_lip",
        *(f"m{k},1,," for k in range(6)),
    ]
    (home / "markers.csv").write_text("\n".join(table) + "\n")
    return home


def test_the_object_of_the_held_out_sentences(efase, database):
    code, out, err = efase("evaluate", "--db", database, "--json")
    answer = json.loads(out)
    assert (code, err) == (0, "")
    assert (answer["corpus"], answer["split"], answer["sentences"]) == ("<small> & co", "test", 2)
    assert {"static", "phone-means", "random", "search"} <= set(answer["engines"])
    for figures in answer["engines"].values():
        assert all(isinstance(figures[name], float) for name in FIGURES)
        assert set(figures["seconds_by_phonemes"]) == {"14", "24", "53", "63"}
    recognised = answer["emotion_recognised"]
    assert recognised["capture"]["low"] <= recognised["capture"]["share"] <= recognised["capture"]["high"]
    both = run(EvaluationJob(database, split="all", engines=("static",)))
    assert both["sentences"] == 4 and list(both["engines"]) == ["static"]


def test_a_report_is_one_page_with_its_figures_and_the_object(efase, database, tmp_path):
    target = tmp_path / "made" / "report"
    code, out, _ = efase(
        "evaluate", "--db", database, "--engine", "phone-means", "--engine", "search", "--report", target
    )
    assert code == 0 and "phone-means" in out and str(target / PAGE) in out
    page = (target / PAGE).read_text(encoding="utf-8")
    assert "&lt;small&gt; &amp; co" in page and "<small>" not in page and "maybe <i>" not in page
    assert "http" not in page.replace('xmlns="http://www.w3.org/2000/svg"', "")
    figures = sorted(path.stem for path in target.glob("*.svg"))
    assert figures == ["error-and-liveliness", "error-per-frame", "lip-trajectory", "lip-velocity"]
    for name in figures:
        text = (target / f"{name}.svg").read_text(encoding="utf-8")
        ET.fromstring(text)
        assert text in page
    answer = json.loads((target / ANSWER).read_text(encoding="utf-8"))
    assert f"{answer['engines']['search']['lip_error_mm']:.2f}" in page
    assert sorted(path.name for path in target.iterdir()) == sorted([PAGE, ANSWER, *(f"{n}.svg" for n in figures)])


def test_the_table_is_markdown_with_a_row_an_engine(efase, database):
    code, out, _ = efase("evaluate", "--db", database, "--engine", "static", "--engine", "phone-means")
    rows = [line.strip("|").split("|") for line in out.splitlines() if line.startswith("|")]
    assert code == 0 and {len(row) for row in rows} == {9}
    assert [row[0].strip() for row in rows] == [
        "",
        "-" * len(rows[0][0]),
        "static",
        "phone-means",
        "noise of the capture",
    ]
    assert rows[2][3].strip() == "0.00" and rows[-1][-1].strip() == "–"
    assert len({len(line) for line in out.splitlines() if line.startswith("|")}) == 1


def test_a_corpus_folder_is_split_by_the_rule_and_measured_alike(database, folder):
    kept = run(EvaluationJob(database, engines=("static", "phone-means")))
    given = run(EvaluationJob(database, folder, engines=("static", "phone-means")))
    assert given["corpus"] == "corpus" and given["sentences"] == kept["sentences"]
    for name, figures in kept["engines"].items():
        assert given["engines"][name]["error_mm2"] == pytest.approx(figures["error_mm2"], rel=1e-3)
    rest = run(EvaluationJob(database, folder, split="all", engines=("static",)))
    assert rest["sentences"] == 4  # what the database is built of is left out


def test_refusals_are_one_sentence_and_leave_nothing(efase, corpus, database, folder, tmp_path):
    whole = tmp_path / "whole.h5"
    build_database(replace(corpus, held_out={}), whole, BuildSettings(n_dims=6))
    occupied = tmp_path / "file"
    occupied.write_text("")
    target = tmp_path / "report"
    for words, says in (
        (["--db", whole], "holds out no sentences"),
        (["--db", whole, "--split", "all"], "holds out no sentences"),
        (["--db", whole, "--corpus", folder], "is built of sentence"),
        (["--db", whole, "--corpus", folder, "--split", "all"], "built of all sentences"),
        (["--db", database, "--split", "verify"], "no split 'verify'"),
        (["--db", database, "--engine", "magic"], "no engine 'magic'"),
        (["--db", database, "--corpus", tmp_path / "none"], "no corpus folder"),
        (["--db", tmp_path / "none.h5"], "no motion database"),
    ):
        code, out, err = efase("evaluate", *words, "--report", target, "--json")
        assert (code, out) == (2, "") and says in err and err.count("\n") == 1, (words, err)
    code, out, err = efase("evaluate", "--db", database, "--report", occupied / "report")
    assert (code, out) == (2, "") and err.count("\n") == 1
    assert not target.exists()


@pytest.mark.parametrize("fraction", [0.1, 0.5, 0.92, 0.98])
def test_a_cancelled_evaluation_leaves_nothing(database, tmp_path, fraction):
    class Impatient(Progress):
        def step(self, at, message=""):
            if at >= fraction:
                raise Cancelled

    with pytest.raises(Cancelled):
        run(EvaluationJob(database, engines=("static",), report=tmp_path / "report"), Impatient())
    assert not list(tmp_path.iterdir())


def test_build_holds_out_on_request(efase, folder, tmp_path):
    code, out, _ = efase("build", folder, "--hold-out", "-o", tmp_path / "a.h5", "--dims", "4", "--json")
    assert code == 0 and json.loads(out)["held_out"] == {"tune": 2, "test": 2}
    code, out, err = efase("build", folder, "--split", "digits", "-o", tmp_path / "b.h5")
    assert (code, out) == (2, "") and "too few" in err and not (tmp_path / "b.h5").exists()
