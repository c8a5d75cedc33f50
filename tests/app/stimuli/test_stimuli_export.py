"""A perception study from the command line: its films and papers fit each other, and nothing is left of half of one."""

from __future__ import annotations

import csv
import itertools
import json
import shutil
from fractions import Fraction

import av
import numpy as np
import pytest
import soundfile

from app.export import VideoSettings
from app.stimuli.export import run
from app.stimuli.job import StimuliJob
from core.media.video import probe, write_video
from core.motion.database import open_database
from core.progress import Cancelled, Progress
from core.search.engine import SearchEngine

EXPRESSIONS = ("neutral", "happiness")


@pytest.fixture
def sounds(tmp_path, speech_path):
    """A table of two sounds, whose words were captured neutrally alone."""
    folder = tmp_path / "sounds"
    folder.mkdir()
    for name in ("one", "two"):
        shutil.copy(speech_path, folder / f"{name}.wav")
        shutil.copy(speech_path.with_suffix(".lab"), folder / f"{name}.lab")
    table = folder / "table.csv"
    table.write_text("audio,text,phones\none.wav,sentence 0,one.lab\ntwo.wav,Sentence 4!,two.lab\n")
    return table


def asked(out, database_path, sounds, *more):
    return ("stimuli", "--out", out, "--db", database_path, "--table", sounds, "--style", "markers", "--size", "96x64",
            "--participants", "4", *more)  # fmt: skip


def rows_of(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_films_and_papers_fit_each_other(efase, tmp_path, database_path, sounds, settings_folder):
    out = tmp_path / "study"
    code, said, err = efase(*asked(out, database_path, sounds, "--expressions", "neutral,happiness", "--json"))
    answer = json.loads(said)
    assert code == 0 and answer["faces"] == ["synthetic"] and "not captured in happiness" in err
    key = {row["stimulus"]: row for row in rows_of(out / "key.csv")}
    assert len(key) == answer["stimuli"] == 2 * 2 + 2 + 2 * 2
    assert {p.name for p in (out / "stimuli").iterdir()} == {
        row["file"].removeprefix("stimuli/") for row in key.values()
    }
    sound = soundfile.info(sounds.with_name("one.wav"))
    for row in key.values():
        path = out / row["file"]
        if row["kind"] == "audio":
            assert soundfile.info(path).duration == pytest.approx(sound.duration, abs=1e-3)
            continue
        facts = probe(path)
        assert (facts.width, facts.height, facts.fps) == (96, 64, 30)
        assert facts.video_duration_s == pytest.approx(sound.duration, abs=1 / 30 + 1e-6)
        assert (facts.audio_duration_s is None) == (row["kind"] == "silent")
    sheet = rows_of(out / "answers.csv")
    assert len(sheet) == answer["trials"] == 4 * (2 + 2 + 4) and not any(row["answer"] for row in sheet)
    for p in range(1, 5):
        played = (out / "playlists" / f"participant-{p:02d}.m3u").read_text().splitlines()[1:]
        assert played == [f"../{key[row['stimulus']]['file']}" for row in sheet if row["participant"] == str(p)]
    text = (out / "README.txt").read_text()
    assert "not sure" in text and "sentence 0" in text and "{" not in text
    assert json.loads((out / "study.json").read_text())["plan"]["seed"] == 2002

    # filled in, the answers become tables
    filled = tmp_path / "filled.csv"
    filled.write_text((out / "answers.csv").read_text().replace(",\n", ",happiness\n"))
    code, said, err = efase("stimuli-table", filled, "--key", out / "key.csv", "--csv", tmp_path / "cells.csv")
    assert (code, err) == (0, "") and "TABLE III" in said and "TABLE VI:" in said and "4 participants" in said
    cells = rows_of(tmp_path / "cells.csv")
    assert {(c["count"], c["of"]) for c in cells if c["answer"] == "happiness"} == {("4", "4")}
    code, _, err = efase("stimuli-table", filled, "--key", out / "key.csv", "--interval", "wald")
    assert code == 2 and "no interval 'wald'" in err


def test_captured_faces_are_shown_where_all_was_captured(tmp_path, database_path, sounds, settings_folder):
    job = StimuliJob(tmp_path / "study", database_path, table=sounds, expressions=("neutral",), n_participants=2,
                     video=VideoSettings(width=96, height=64, style="markers"), film=".avi")  # fmt: skip
    asked_for = []
    synthesise = SearchEngine.synthesise

    def spy(engine, speech, *more):
        asked_for.append(speech)
        return synthesise(engine, speech, *more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(SearchEngine, "synthesise", spy)
        answer = run(job)
    assert answer["faces"] == ["synthetic", "captured"] and answer["warnings"] != []
    files = {(r["kind"], r["audio"], r["face"]): r["file"] for r in rows_of(tmp_path / "study" / "key.csv")}
    one, other = ((tmp_path / "study" / files["bimodal", "one", face]).read_bytes() for face in answer["faces"])
    assert one != other
    # no capture of the same words may be used
    nodes = open_database(database_path).nodes
    for speech, sentence in zip(asked_for, ("s0", "s4")):
        of_sentence = {nodes.name(n) for n in range(len(nodes)) if nodes.name(n).startswith(f"{sentence}:")}
        assert speech.removed == of_sentence and of_sentence


def test_films_of_a_real_speaker_are_the_captured_faces(efase, tmp_path, database_path, sounds, settings_folder):
    folder = tmp_path / "real"
    folder.mkdir()
    colours = {}
    for n, (audio, expression) in enumerate(itertools.product(("one", "two"), EXPRESSIONS)):
        colours[audio, expression] = 50 + 40 * n
        picture = np.full((40, 40, 3), colours[audio, expression], np.uint8)
        write_video(folder / f"{audio}-{expression}.avi", [picture] * 15, 15, Fraction(10))
    out = tmp_path / "study"
    words = asked(out, database_path, sounds, "--expressions", "neutral,happiness", "--films", folder, "--film", "avi")
    code, _, err = efase(*words)
    assert (code, err) == (0, "")
    for row in rows_of(out / "key.csv"):
        if row["face"] != "captured":
            continue
        facts = probe(out / row["file"])
        assert (facts.width, facts.height, facts.fps) == (96, 64, 30)
        assert (facts.audio_duration_s is None) == (row["kind"] == "silent")
        with av.open(str(out / row["file"])) as container:
            last = list(container.decode(video=0))[-1].to_ndarray(format="rgb24").astype(int)
        # the square stands as large as it can, with black beside it
        assert abs(last[32, 48] - colours[row["audio"], row["expression"]]).max() < 8
        assert abs(last[3, 48] - colours[row["audio"], row["expression"]]).max() < 8 and last[32, 5].max() < 12
    assert "films of a real speaker" in (out / "README.txt").read_text()
    (folder / "two-neutral.avi").unlink()
    code, _, err = efase(
        *asked(tmp_path / "other", database_path, sounds, "--films", folder, "--expressions", "neutral")
    )
    assert code == 2 and "has no film 'two-neutral.mp4'" in err and not (tmp_path / "other").exists()


class _EndsAfter(Progress):
    def __init__(self, steps):
        self.left = steps

    def step(self, fraction, message=""):
        self.left -= 1
        if self.left < 0:
            raise Cancelled


@pytest.mark.parametrize("steps", [3, 40, 90])
def test_nothing_is_left_of_one_that_is_cancelled(tmp_path, database_path, sounds, settings_folder, steps):
    job = StimuliJob(tmp_path / "study", database_path, table=sounds, expressions=EXPRESSIONS, n_participants=2,
                     video=VideoSettings(width=96, height=64, style="markers"))  # fmt: skip
    before = sorted(p.name for p in tmp_path.iterdir())
    with pytest.raises(Cancelled):
        run(job, _EndsAfter(steps))
    assert sorted(p.name for p in tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (("--participants", "5"), "two equal groups"),
        (("--participants", "1000000000"), "at most 10000"),
        (("--faces", "captured", "--expressions", "neutral,anger"), "were not captured in anger"),
        (("--faces", "film"), "no face 'film'"),
        (("--expressions", "joyous"), "'joyous' is not an emotion"),
        (("--engine", "magic"), "no engine 'magic'"),
        (("--design", "mine"), "no design 'mine'"),
        (("--film", "gif"), "Films end in"),
        (("--sentence", "s0"), "choose one of them"),
    ],
)
def test_what_makes_no_study_is_one_sentence(efase, tmp_path, database_path, sounds, settings_folder, more, sentence):
    code, said, err = efase(*asked(tmp_path / "study", database_path, sounds, *more))
    assert (code, said) == (2, "") and sentence in err and len(err.strip().splitlines()) == 1
    assert not (tmp_path / "study").exists()


def test_a_wrong_table_is_told_by_its_line(efase, tmp_path, database_path, sounds, settings_folder):
    for text, sentence in (
        ("audio,text\nnone.wav,words\n", "line 2: "),
        ("audio\none.wav\n", "no column 'text'"),
        ("audio,text\none.wav,\n", "line 2: a sound and its text"),
    ):
        sounds.write_text(text)
        code, _, err = efase(*asked(tmp_path / "study", database_path, sounds))
        assert code == 2 and sentence in err and "table.csv" in err
    code, _, err = efase("stimuli", "--out", tmp_path / "study", "--db", database_path)
    assert code == 2 and "No sentence of the database" in err


def test_a_folder_that_holds_something_is_left_alone(efase, tmp_path, database_path, sounds, settings_folder):
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "mine.txt").write_text("x")
    code, _, err = efase(*asked(tmp_path / "study", database_path, sounds))
    assert code == 2 and "is not empty" in err and [p.name for p in (tmp_path / "study").iterdir()] == ["mine.txt"]


@pytest.fixture
def answered(tmp_path):
    (tmp_path / "key.csv").write_text(
        "stimulus,file,kind,audio,text,expression,face\nS1,a.mp4,silent,one,hi,neutral,synthetic\n"
    )
    (tmp_path / "answers.csv").write_text("participant,group,trial,part,stimulus,answer\np1,A,1,1,S1,neutral\n")
    return tmp_path / "answers.csv"


@pytest.mark.parametrize("name", ["key.csv", "answers.csv"])
def test_what_is_read_is_not_written_over(efase, answered, name):
    target = answered.with_name(name)
    before = target.read_text()
    code, said, err = efase("stimuli-table", answered, "--csv", target)
    assert (code, said) == (2, "") and "cannot be written" in err
    assert target.read_text() == before


@pytest.mark.parametrize("interval", ["wilson", "exact"])
@pytest.mark.parametrize(
    ("confidence", "code"), [("0.999999", 0), ("1e-300", 0), ("0.9999999999999999", 2), ("nan", 2)]
)
def test_intervals_are_numbers_or_refused(efase, answered, interval, confidence, code):
    ended, said, err = efase("stimuli-table", answered, "--interval", interval, "--confidence", confidence, "--json")
    assert ended == code
    if code:
        assert said == "" and "does not lie between" in err
    else:
        assert json.loads(said)["answers"] == 1
