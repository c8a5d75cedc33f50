"""The command line as a user meets it: results on standard output, sentences on standard error, exit codes."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time

import av
import numpy as np
import pytest
import soundfile

import app.demo
from app.demo import demo_database, demo_database_path
from core.actress.corpus import demo_sentences
from core.errors import UserFacingError
from core.motion.corpus import Corpus
from core.motion.motion_files import read_motion, write_c3d
from core.motion.recording import Recording
from core.search.compute import DeviceFailed
from core.speech.transcript import PhonemeUtterance, Transcript
from gpu.opencl.min_plus import OpenClKernels


@pytest.fixture(scope="session")
def demo():
    return demo_database()


def spoken(emotion="anger"):
    return next(s for s in demo_sentences() if s.emotion == emotion)


def one_sentence(err: str) -> bool:
    lines = err.strip().splitlines()
    return len(lines) == 1 and lines[0].startswith("efase: ") and "Traceback" not in err


def test_info_is_one_object(efase, demo):
    code, out, err = efase("info", "--json")
    answer = json.loads(out)
    assert (code, err) == (0, "")
    assert answer["nodes"] == len(demo.nodes)
    assert answer["synthetic"] is True
    assert set(answer) >= {
        "frames",
        "phonemes",
        "emotions",
        "sentences",
        "pca_dims",
        "pca_coverage",
        "markers",
        "rate_hz",
    }
    assert sum(answer["phonemes"].values()) == answer["nodes"]
    code, out, _ = efase("info")
    assert code == 0 and "synthetic" in out


def test_synth_writes_film_and_markers_and_tells_the_path(efase, demo, tmp_path):
    sentence = spoken()
    outputs = [tmp_path / name for name in ("a.avi", "a.csv", "a.c3d")]
    options = [word for path in outputs for word in ("-o", path)]
    code, out, _ = efase(
        "synth", sentence.audio, "--phones", sentence.phone_labels, "--emotion", "anger", "--style", "markers",
        "--size", "160x120", "--fps", "25", "--json", *options,
    )  # fmt: skip
    assert code == 0
    answer = json.loads(out)
    assert answer["outputs"] == [str(p) for p in outputs]
    costs = [sum(row["costs"].values()) for row in answer["phonemes"]]
    assert sum(costs) == pytest.approx(answer["cost"])
    for row in answer["phonemes"]:
        demo.nodes.row(row["node"])
    assert set(answer["seconds"]) == {"align", "search", "synthesis", "render"}
    assert "opencl" in answer["backend"] or "numpy" in answer["backend"]
    assert set(answer["device"]) == {"backend", "device", "api", "driver", "software", "lost", "method"}

    duration = soundfile.info(sentence.audio).duration
    positions, names, rate = read_motion(outputs[1])
    assert rate == pytest.approx(25)
    assert abs(len(positions) / 25 - duration) <= 1 / 25
    again, c3d_names, _ = read_motion(outputs[2])
    assert list(names) == list(c3d_names) == list(demo.markers.names)
    assert again == pytest.approx(positions, abs=1e-3)
    with av.open(outputs[0]) as film:
        video, sound = film.streams.video[0], film.streams.audio[0]
        n_frames = sum(1 for _ in film.decode(video))
        assert abs(n_frames / 25 - duration) <= 1 / 25
        assert video.start_time == 0 and sound.start_time == 0


def test_a_pin_holds_and_a_bad_one_is_explained(efase, demo, tmp_path):
    sentence = spoken("sadness")
    base = ["synth", sentence.audio, "--phones", sentence.phone_labels, "-o", tmp_path / "p.csv", "--json"]
    code, out, _ = efase(*base, "--pin", "0=n01:3", "--pin", "4=a02:5")
    rows = json.loads(out)["phonemes"]
    assert code == 0
    assert (rows[0]["node"], rows[4]["node"]) == ("n01:3", "a02:5")
    for pin in ("4", "x=n01:3", "4=nobody:1", "999=n01:3", "-1=n01:3"):
        code, out, err = efase(*base, "--pin", pin)
        assert (code, out) == (2, "") and one_sentence(err), pin


def test_backends_agree_on_a_real_request(efase, tmp_path):
    sentence = spoken("happiness")
    answers = []
    for backend in ("numpy", "opencl"):
        code, out, _ = efase(
            "synth", sentence.audio, "--phones", sentence.phone_labels, "--emotion", "joy", "--backend", backend,
            "-o", tmp_path / f"{backend}.csv", "--json",
        )  # fmt: skip
        assert code == 0
        answers.append(json.loads(out))
    assert answers[0]["phonemes"] == answers[1]["phonemes"]
    assert answers[1]["backend"].startswith("opencl")


def test_an_emotion_file_steers_the_path(efase, demo, tmp_path):
    sentence = spoken("neutral")
    painted = tmp_path / "emotions.txt"
    painted.write_text("0 100 sadness\n")
    base = ["synth", sentence.audio, "--phones", sentence.phone_labels, "-o", tmp_path / "e.csv", "--json"]
    emotions = []
    for extra in ([], ["--emotions", painted]):
        _, out, _ = efase(*base, *extra)
        nodes = [demo.nodes[demo.nodes.row(row["node"])] for row in json.loads(out)["phonemes"]]
        emotions.append([node.emotion for node in nodes].count("sadness") / len(nodes))
    assert emotions[0] < 0.1 and emotions[1] > 0.8


def broken_inputs(folder):
    """Every kind of bad sound, by name."""
    rate = 16_000
    tone = (0.3 * np.sin(np.arange(rate) / 20)).astype(np.float32)
    whole = folder / "whole.wav"
    soundfile.write(whole, tone, rate)
    files = {"missing": folder / "missing.wav", "folder": folder}
    for name, content in {
        "empty": b"",
        "truncated": whole.read_bytes()[:30],
        "foreign": b"%PDF-1.7 this is no sound" * 50,
    }.items():
        files[name] = folder / f"{name}.wav"
        files[name].write_bytes(content)
    files["blink"] = folder / "blink.wav"
    soundfile.write(files["blink"], tone[:160], rate)
    files["nan"] = folder / "nan.wav"
    soundfile.write(files["nan"], np.where(np.arange(rate) == 5, np.nan, tone), rate, subtype="FLOAT")
    return files


@pytest.mark.parametrize("kind", ["missing", "folder", "empty", "truncated", "foreign", "blink", "nan"])
@pytest.mark.parametrize("verb", ["synth", "align"])
def test_bad_sound_is_one_sentence_and_leaves_nothing(efase, tmp_path, kind, verb):
    path = broken_inputs(tmp_path)[kind]
    before = sorted(p.name for p in tmp_path.iterdir())
    target = tmp_path / ("out.avi" if verb == "synth" else "out.TextGrid")
    code, out, err = efase(verb, path, "--text", "hello", "-o", target)
    assert (code, out) == (2, "")
    assert one_sentence(err) and path.name in err
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_bad_requests_are_one_sentence_each(efase, tmp_path):
    sentence = spoken()
    early = tmp_path / "early.TextGrid"
    assert efase("align", sentence.audio, "--text", sentence.text, "-o", tmp_path / "whole.TextGrid")[0] == 0
    whole = tmp_path / "whole.TextGrid"
    soundfile.write(tmp_path / "long.wav", np.zeros(16_000 * 9, np.float32), 16_000)
    newer = tmp_path / "newer.h5"
    newer.write_bytes(demo_database().path.read_bytes())
    import h5py

    with h5py.File(newer, "r+") as file:
        file.attrs["version_major"] = 99
    early.write_text("nothing of the kind")
    base = ["--phones", sentence.phone_labels, "-o", tmp_path / "x.csv"]
    for words in (
        [sentence.audio, *base, "--db", newer],
        [sentence.audio, *base, "--db", tmp_path / "none.h5"],
        [sentence.audio, *base, "--db", sentence.audio],
        [sentence.audio, *base, "--emotion", "boredom"],
        [sentence.audio, *base, "--emotion", "anger", "--emotions", early],
        [sentence.audio, *base, "--text", "both"],
        [sentence.audio, *base, "--backend", "abacus"],
        [sentence.audio, *base, "--engine", "magic"],
        [sentence.audio, *base, "--hold"],
        [sentence.audio, *base, "--fps", "31"],
        [sentence.audio, *base, "--size", "big"],
        [sentence.audio, *base, "--style", "cubist", "-o", tmp_path / "x.avi"],
        [sentence.audio, *base, "--face", tmp_path / "none.obj", "-o", tmp_path / "x.avi"],
        [sentence.audio, "--phones", early, "-o", tmp_path / "x.csv"],
        [sentence.audio, "--phones", tmp_path / "none.lab", "-o", tmp_path / "x.csv"],
        [tmp_path / "long.wav", "--phones", whole, "-o", tmp_path / "x.csv"],
        [sentence.audio, *base, "-o", tmp_path / "x.docx"],
        [sentence.audio, *base, "-o", tmp_path / "nowhere" / "x.avi"],
    ):
        code, out, err = efase("synth", *words)
        assert (code, out) == (2, ""), words
        assert one_sentence(err), (words, err)
    assert not list(tmp_path.glob("x.*"))


def corpus_folder(folder, positions):
    """A corpus folder of one sentence; returns the folder."""
    sentence = spoken("neutral")
    sound, rate = soundfile.read(sentence.audio)
    (folder / "corpus.csv").write_text("sentence,emotion,text\none,neutral,anything\n")
    soundfile.write(folder / "one.wav", sound, rate)
    (folder / "one.lab").write_bytes(sentence.phone_labels.read_bytes())
    write_c3d(folder / "one.c3d", positions, [f"m{k}" for k in range(positions.shape[1])], 60.0)
    return folder


def moving_markers(n_frames=300, n_markers=8):
    rng = np.random.default_rng(0)
    rest = rng.normal(size=(1, n_markers, 3)) * 40
    return (rest + rng.normal(size=(n_frames, n_markers, 3))).astype(np.float32)


def test_a_corpus_folder_becomes_a_database_that_synthesises(efase, tmp_path):
    folder = tmp_path / "corpus"
    folder.mkdir()
    corpus_folder(folder, moving_markers())
    database = tmp_path / "made.h5"
    code, out, _ = efase("build", folder, "-o", database, "--json")
    assert code == 0
    answer = json.loads(out)
    assert answer["markers"] == 8 and answer["synthetic"] is False
    sentence = spoken()
    target = tmp_path / "m.csv"
    code, _, _ = efase("synth", sentence.audio, "--phones", sentence.phone_labels, "--db", database, "-o", target)
    assert code == 0
    assert read_motion(target)[0].shape[1] == 8


def test_bad_corpora_are_one_sentence_and_leave_nothing(efase, tmp_path):
    folder = tmp_path / "corpus"
    folder.mkdir()
    target = tmp_path / "made.h5"

    def refused():
        code, out, err = efase("build", folder, "-o", target)
        return (code, out) == (2, "") and one_sentence(err) and not target.exists()

    assert refused()
    corpus_folder(folder, np.full((300, 8, 3), np.nan, np.float32))
    assert refused()
    corpus_folder(folder, moving_markers())
    (folder / "one.c3d").write_bytes((folder / "one.c3d").read_bytes()[:700])
    assert refused()
    corpus_folder(folder, moving_markers())
    for text in (
        "sentence\none\n",
        "sentence,emotion\n",
        "sentence,emotion\none,rage\n",
        "sentence,emotion\n../one,anger\n",
        "sentence,emotion,motion\none,neutral,../../etc/passwd\n",
    ):
        (folder / "corpus.csv").write_text(text)
        assert refused(), text


def test_a_corpus_with_names_that_cannot_be_is_refused_line_by_line(efase, tmp_path):
    folder = tmp_path / "corpus"
    folder.mkdir()
    corpus_folder(folder, moving_markers())
    (folder / "loop").symlink_to("loop")
    for text, says in (
        ("sentence,emotion\none,neutral\none,neutral\n", "Line 3"),
        ("sentence,emotion\n.one,neutral\n", "Line 2"),
        ("sentence,emotion\na\\b,neutral\n", "Line 2"),
        ('sentence,emotion\n"a\nb",neutral\n', "cannot be the name"),
        (f"sentence,emotion\n{'x' * 300},neutral\n", "cannot be the name"),
        ("sentence,emotion,audio\none,neutral,loop\n", "Line 2"),
        (f"sentence,emotion,audio\none,neutral,{'x' * 300}\n", "Line 2"),
        (f"sentence,emotion\n{'x' * 200_000},neutral\n", "cannot be read as a table"),
        ("\0" * 30, "corpus.csv"),
    ):
        (folder / "corpus.csv").write_text(text)
        code, out, err = efase("build", folder, "-o", tmp_path / "made.h5")
        assert (code, out) == (2, "") and one_sentence(err) and says in err, (text[:40], err)


def test_extreme_requests_are_one_sentence_each(efase, demo, tmp_path):
    sentence = spoken()
    blink = tmp_path / "blink.wav"
    soundfile.write(blink, np.random.default_rng(0).normal(size=960) * 0.1, 16_000)
    given = tmp_path / "given.csv"
    given.write_bytes(sentence.phone_labels.read_bytes())
    phones = ["--phones", sentence.phone_labels]
    long, target = "9" * 5000, ["-o", tmp_path / "x.csv"]
    for words in (
        ["synth", sentence.audio, *phones, *target, "--size", f"{long}x64"],
        ["synth", sentence.audio, *phones, *target, "--pin", f"{long}=n01:3"],
        ["synth", sentence.audio, *phones, *target, "--pin", f"3=n01:{long}"],
        ["synth", f"{long}.wav", *phones, *target],
        ["synth", sentence.audio, "--phones", long, *target],
        ["synth", sentence.audio, "--text", long, *target],
        ["synth", blink, "--text", "a", *target],
        ["synth", sentence.audio, *phones, "-o", tmp_path / f"{long}.csv"],
        ["synth", sentence.audio, *phones, "-o", tmp_path],
        ["synth", sentence.audio, "--phones", given, "-o", given],
        ["synth", sentence.audio, *phones, *target, "--markers", tmp_path],
        ["align", sentence.audio, "--text", "hello", "-o", tmp_path / "none" / "x.TextGrid"],
        ["build", tmp_path, "-o", tmp_path],
        ["info", long],
        ["info", "two\nlines \x1b[31mred"],
        ["demo", "--out", blink],
    ):
        code, out, err = efase(*words)
        assert (code, out) == (2, ""), (words[:2], err)
        assert one_sentence(err) and "\x1b" not in err, (words[:2], err)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["blink.wav", "given.csv"]


def test_a_file_name_that_is_no_text_comes_back_in_json(efase, demo, tmp_path):
    sentence = spoken()
    target = tmp_path / "o\udcff.csv"
    code, out, _ = efase("synth", sentence.audio, "--phones", sentence.phone_labels, "-o", target, "--json")
    assert code == 0
    assert json.loads(out)["outputs"] == [str(target)]


def test_without_opencl_numpy_does_the_work_and_says_so(efase, demo, tmp_path, monkeypatch):
    def missing():
        raise UserFacingError("There is no OpenCL driver.")

    monkeypatch.setattr("gpu.opencl.min_plus.able_devices", missing)
    monkeypatch.setattr(
        "gpu.choice.tried", lambda backend: [{"backend": backend, "missing": f"There is no {backend}."}]
    )
    monkeypatch.setattr("gpu.choice.cache_dir", lambda: tmp_path)
    sentence = spoken()
    words = ["synth", sentence.audio, "--phones", sentence.phone_labels, "-o", tmp_path / "x.csv"]
    code, out, err = efase(*words)
    assert code == 0 and "There is no opencl." in err and "The search runs on numpy" in err
    code, out, err = efase(*words, "--backend", "opencl")
    assert (code, out) == (2, "") and one_sentence(err)


def test_bench_takes_several_values_after_one_option(efase, demo):
    words = ["bench", "search", "--nodes", "60", "--repeats", "1", "--json"]
    code, out, _ = efase(*words, "--phonemes", "3", "5", "--backends", "numpy", "relaxation")
    assert code == 0
    rows = json.loads(out)["rows"]
    expected = [("numpy", 3), ("numpy", 5), ("relaxation", 3), ("relaxation", 5)]
    assert [(row["backend"], row["phonemes"]) for row in rows] == expected
    code, out, err = efase(*words, "--phonemes", "3", "--backends", "numpy", "abacus")
    assert (code, out) == (2, "") and one_sentence(err) and "abacus" in err


def test_a_device_lost_in_mid_work_is_a_warning_and_the_answer_the_same(efase, demo, tmp_path, monkeypatch):
    sentence = spoken()
    words = ["synth", sentence.audio, "--phones", sentence.phone_labels, "-o", tmp_path / "x.csv", "--json"]
    _, out, _ = efase(*words, "--backend", "opencl")
    whole = json.loads(out)
    assert whole["device"]["backend"] == "opencl" and whole["device"]["method"] == "exhaustive"
    assert whole["device"]["software"] in (True, False) and whole["device"]["api"].startswith("OpenCL")
    steps = iter(range(5))
    step = OpenClKernels.min_plus

    def failing(kernels, front):
        if next(steps, None) is None:
            raise DeviceFailed("The OpenCL device failed (OUT_OF_RESOURCES).")
        return step(kernels, front)

    monkeypatch.setattr(OpenClKernels, "min_plus", failing)
    code, out, _ = efase(*words, "--backend", "opencl")
    lost = json.loads(out)
    assert code == 0
    assert "The OpenCL device failed (OUT_OF_RESOURCES). The search goes on with numpy." in lost["warnings"]
    assert lost["device"]["backend"] == "numpy"
    assert (lost["phonemes"], lost["cost"]) == (whole["phonemes"], whole["cost"])
    _, out, _ = efase(*words)
    assert json.loads(out)["device"]["method"] == "relaxation"


@pytest.fixture
def quick_demo(monkeypatch, tmp_path):
    """The demo database of a corpus that is built in a second, in a cache of its own."""
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    positions = moving_markers()
    said = [PhonemeUtterance(p, 0.5 * i, 0.5 * i + 0.5) for i, p in enumerate(("pau", "n", "ow", "pau"))]
    names = tuple(f"m{k}" for k in range(positions.shape[1]))
    recording = Recording("one", "neutral", positions, names, 60.0, Transcript(tuple(said), (), 2.0))
    monkeypatch.setattr("app.demo.demo_corpus", lambda progress: Corpus("quick", [recording], names))
    return demo_database_path()


def test_a_damaged_demo_database_is_made_again(efase, quick_demo):
    assert efase("info", "--json")[0] == 0
    whole = quick_demo.read_bytes()
    quick_demo.write_bytes(whole[: len(whole) // 2])
    code, out, _ = efase("info", "--json")
    assert code == 0 and json.loads(out)["nodes"] == 2
    assert [p.name for p in quick_demo.parent.iterdir()] == [quick_demo.name]


def test_a_cache_that_cannot_be_written_is_one_sentence_with_a_remedy(efase, quick_demo):
    quick_demo.parent.write_text("a file where the folder should be")
    code, out, err = efase("info")
    assert (code, out) == (2, "") and one_sentence(err) and "EFASE_CACHE_DIR" in err


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no polite kill")
@pytest.mark.parametrize(("number", "expected"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_kill_in_the_middle_leaves_nothing_behind(tmp_path, demo, number, expected):
    noise = np.random.default_rng(0).normal(size=16_000 * 60).astype(np.float32) * 0.1
    speech, phones = tmp_path / "long.wav", tmp_path / "long.lab"
    soundfile.write(speech, noise, 16_000)
    phones.write_text("0 1 pau\n1 2 aa\n2 60 pau\n")
    folder = tmp_path / "out"
    folder.mkdir()
    command = [
        sys.executable,
        "-c",
        "from app.cli import main; main()",
        "synth",
        speech,
        "--phones",
        phones,
        "-o",
        folder / "a.avi",
    ]
    command += ["--style", "markers", "--fps", "60"]
    with subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 60
        while not any(folder.iterdir()) and time.monotonic() < until and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(number)
        _, err = process.communicate(timeout=60)
    assert process.returncode == expected
    assert "Traceback" not in err
    assert list(folder.iterdir()) == []


def test_our_own_fault_is_a_sentence_too(efase, monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(app.demo, "open_named", lambda path, progress: 1 / 0)
    code, out, err = efase("info")
    assert (code, out) == (1, "")
    assert one_sentence(err)
    assert "ZeroDivisionError" in (tmp_path / "last-failure.txt").read_text()


@pytest.mark.parametrize("verb", ["demo", "build", "info", "align", "synth", "evaluate"])
def test_every_verb_has_help(efase, verb):
    code, out, _ = efase(verb, "--help")
    assert code == 0 and verb in out


def test_the_help_of_synth_names_every_engine(efase):
    from core.synthesis.registry import ENGINES

    code, out, _ = efase("synth", "--help")
    named = set(re.findall("[a-z-]+", re.sub(r"-\s*\n\s+", "-", out)))
    assert code == 0 and set(ENGINES) <= named
