"""The quickest backend is measured once and remembered; whatever is wrong with the memory only costs time."""

import json

import pytest

from core.errors import UserFacingError
from gpu import choice, device, trial

SLOW_GLSL = {"backend": "glsl", "device": "a card", "api": "OpenGL 4.6", "software": False, "driver": "", "step_s": 9.0}
NO_OPENCL = {"backend": "opencl", "missing": "There is no OpenCL platform on this machine."}


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache" / "compute.json"


@pytest.fixture
def trials(monkeypatch):
    """The backends that were tried out, instead of trying them."""
    names = []

    def tried(backend):
        names.append(backend)
        return [SLOW_GLSL if backend == "glsl" else NO_OPENCL]

    monkeypatch.setattr(choice, "tried", tried)
    return names


def test_measured_once_and_remembered(cache, trials):
    first = choice.quickest()
    assert [entry["backend"] for entry in first] == ["numpy", "glsl", "opencl"]  # the quickest first, missing ones last
    assert trials == ["opencl", "glsl"]
    assert choice.quickest() == first
    assert trials == ["opencl", "glsl"]
    choice.forget()
    choice.quickest()
    assert len(trials) == 4


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: "",
        lambda text: text[: len(text) // 2],
        lambda text: "[]",
        lambda text: "[" * 100_000,
        lambda text: text.replace('"measured": [', '"measured": ["no entry",'),
        lambda text: json.dumps({**json.loads(text), "measured": []}),
        lambda text: json.dumps({**json.loads(text), "version": 99}),
        lambda text: text.replace('"numpy", ', '"abacus", ').replace('"backend": "numpy"', '"backend": "abacus"'),
        lambda text: text.replace('"step_s": 9.0', '"step_s": "soon"'),
        lambda text: text.replace("numpy ", "an older numpy "),
    ],
)
def test_a_damaged_or_outdated_memory_is_measured_again(cache, trials, damage):
    whole = choice.quickest()
    cache.write_text(damage(cache.read_text()))
    again = choice.quickest()
    assert [entry["backend"] for entry in again] == [entry["backend"] for entry in whole]
    assert len(trials) == 4
    assert json.loads(cache.read_text())["measured"] == again


def test_bytes_that_are_no_text_are_measured_again(cache, trials):
    choice.quickest()
    cache.write_bytes(b"\xff\xfe\x00{")
    choice.quickest()
    assert len(trials) == 4


def test_another_driver_is_measured_again(cache, trials, monkeypatch):
    choice.quickest()
    monkeypatch.setenv("MESA_LOADER_DRIVER_OVERRIDE", "zink")
    choice.quickest()
    assert len(trials) == 4


def test_a_cache_that_cannot_be_written_is_no_hindrance(tmp_path, trials, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "file" / "cache"))
    assert choice.quickest()[0]["backend"] == "numpy"


def test_auto_says_what_it_took_and_why(cache, trials):
    kernels, sentence = device.open_kernels()
    assert kernels.report.backend == "numpy"
    assert sentence.startswith("numpy · CPU (software, numpy ") and "the quickest here (" in sentence
    assert "glsl 9000.0" in sentence


def test_auto_says_what_is_missing(cache, monkeypatch):
    monkeypatch.setattr(choice, "tried", lambda backend: [{"backend": backend, "missing": f"There is no {backend}."}])
    kernels, sentence = device.open_kernels()
    assert kernels.report.backend == "numpy"
    assert sentence.startswith("There is no opencl. There is no glsl. The search runs on numpy · CPU")


def test_a_remembered_device_that_is_gone_is_forgotten(cache, monkeypatch):
    def gone(backend, name=""):
        raise UserFacingError("The card is gone.")

    quick = {**SLOW_GLSL, "step_s": 1e-9}
    monkeypatch.setattr(choice, "tried", lambda backend: [quick if backend == "glsl" else NO_OPENCL])
    monkeypatch.setattr(device, "_open", gone)
    kernels, sentence = device.open_kernels()
    assert (kernels.report.backend, sentence) == ("numpy", "The card is gone. The search runs on numpy.")
    assert not cache.exists()


def test_both_backends_of_this_machine_pass_their_trial():
    # the drivers are installed by set-up, so a sentence about a missing one is a failure
    for backend in ("opencl", "glsl"):
        entries = trial.tried(backend)
        assert all(entry["backend"] == backend and entry["step_s"] > 0 for entry in entries)


def test_a_trial_that_crashes_is_one_sentence(monkeypatch):
    crash = ["-c", "import os; os.abort()"]
    real_run = trial.subprocess.run
    monkeypatch.setattr(trial.subprocess, "run", lambda command, **how: real_run([command[0], *crash], **how))
    (entry,) = trial.tried("opencl")
    assert entry == {"backend": "opencl", "missing": "The trial of opencl ended with code -6."}


def test_a_trial_that_hangs_is_one_sentence(monkeypatch):
    real_run = trial.subprocess.run
    sleep = ["-c", "import time; time.sleep(60)"]
    monkeypatch.setattr(
        trial.subprocess, "run", lambda command, **how: real_run([command[0], *sleep], **{**how, "timeout": 0.5})
    )
    (entry,) = trial.tried("glsl")
    assert "gave no answer within" in entry["missing"]
