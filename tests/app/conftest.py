"""A small motion database and a speech file, made on the spot, and a window that knows nobody's settings."""

from __future__ import annotations

import shutil
import sys
from dataclasses import replace

import numpy as np
import pytest
import soundfile

from core.document.parts import FaceChoice
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.speech.emotion import EMOTIONS
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from gpu.choice import quickest

PHONES = ("m", "aa", "iy", "w", "ah", "b")
RATE_HZ = 60.0
WAIT_MS = 20_000
SPOKEN = ("m", "aa", "b", "iy", "w", "ah")
PHONE_S = 0.15


def _markers(n: int = 14) -> tuple[tuple[str, ...], np.ndarray]:
    angle = np.linspace(0, 2 * np.pi, n - 2, endpoint=False)
    ring = np.column_stack([50 * np.cos(angle), 60 * np.sin(angle), 20 * np.cos(2 * angle)])
    lips = np.array([[0.0, -20.0, 30.0], [0.0, -28.0, 30.0]])
    return (*(f"ring{i}" for i in range(n - 2)), "lip_up", "lip_low"), np.vstack([ring, lips])


def _recording(rng: np.random.Generator, s: int) -> Recording:
    names, rest = _markers()
    phones = [PHONES[i] for i in rng.permutation(len(PHONES))] * 2
    utterances, at_s = [PhonemeUtterance("pau", 0.0, 0.1)], 0.1
    for phone in phones:
        utterances.append(PhonemeUtterance(phone, at_s, at_s + 0.1))
        at_s += 0.1
    utterances.append(PhonemeUtterance("pau", at_s, at_s + 0.1))
    times_s = np.arange(round((at_s + 0.1) * RATE_HZ)) / RATE_HZ
    positions = np.repeat(rest[None], len(times_s), axis=0)
    opening = 4 + 3 * np.sin(2 * np.pi * 3 * times_s + s) + s % 4
    positions[:, -1, 1] -= opening
    positions[:, :-2] += 0.3 * rng.normal(size=(len(times_s), len(rest) - 2, 3)).cumsum(axis=0) * 0.1
    transcript = Transcript.covering(utterances, [WordUtterance("word", 0.1, at_s)], at_s + 0.1)
    emotion = EMOTIONS[s % 4]
    return Recording(f"s{s}", emotion, positions.astype(np.float32), names, RATE_HZ, transcript, f"sentence {s}")


@pytest.fixture(scope="session")
def tiny_corpus():
    """Return a function that makes the corpus, some sentences held out."""

    def make(held_out=None) -> Corpus:
        rng = np.random.default_rng(7)
        names, rest = _markers()
        groups = {"upper_lip": ("lip_up",), "lower_lip": ("lip_low",), "lips": ("lip_up", "lip_low")}
        recordings = [_recording(rng, s) for s in range(8)]
        return Corpus("tiny", recordings, names, groups, {}, rest, synthetic=True, held_out=held_out or {})

    return make


@pytest.fixture(scope="session")
def database_path(tmp_path_factory, tiny_corpus):
    path = tmp_path_factory.mktemp("database") / "tiny.h5"
    build_database(tiny_corpus(), path, BuildSettings(rate_hz=60.0))
    return path


@pytest.fixture(scope="session")
def speech_path(tmp_path_factory):
    """A hum with its phones beside it."""
    folder = tmp_path_factory.mktemp("speech")
    duration_s = 0.2 + PHONE_S * len(SPOKEN)
    times_s = np.arange(round(duration_s * 16_000)) / 16_000
    soundfile.write(folder / "hum.wav", 0.3 * np.sin(2 * np.pi * 140 * times_s), 16_000)
    lines, at_s = ["0.0 0.1 pau"], 0.1
    for phone in SPOKEN:
        lines.append(f"{at_s:.3f} {at_s + PHONE_S:.3f} {phone}")
        at_s += PHONE_S
    lines.append(f"{at_s:.3f} {duration_s:.3f} pau")
    (folder / "hum.lab").write_text("\n".join(lines) + "\n")
    return folder / "hum.wav"


@pytest.fixture(scope="session")
def known_backends(tmp_path_factory):
    """The file in which `auto` remembers, measured once for all tests."""
    folder = tmp_path_factory.mktemp("backends")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EFASE_CACHE_DIR", str(folder))
        quickest()
    return folder / "compute.json"


@pytest.fixture
def settings_folder(tmp_path, monkeypatch, known_backends):
    folder = tmp_path / "config"
    monkeypatch.setenv("EFASE_CONFIG_DIR", str(folder))
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    (tmp_path / "cache").mkdir()
    shutil.copy(known_backends, tmp_path / "cache")
    return folder


@pytest.fixture(scope="session")
def own_faces(tmp_path_factory):
    """A data folder with this machine's faces, and nothing else of its user's."""
    from core.face.characters import CHARACTERS
    from core.face.default_face import character_path

    faces = [character_path(name) for name in CHARACTERS]
    if not all(path.is_file() for path in faces):
        pytest.skip("the faces are not on this machine")
    folder = tmp_path_factory.mktemp("faces")
    for path in faces:
        shutil.copy(path, folder)
    return folder


@pytest.fixture
def open_window(qtbot, qapp, settings_folder, monkeypatch):
    """Return a function that shows a main window without a demo, with a face if asked; all are closed at the end."""
    from app.authoring import Authoring
    from app.theme import apply_theme
    from app.window import MainWindow

    apply_theme(qapp)
    opened = []

    def make(face: FaceChoice | None = None) -> MainWindow:
        window = MainWindow(Authoring(face))
        opened.append(window)
        with qtbot.waitExposed(window):
            window.show()
        with qtbot.waitActive(window):  # shortcuts belong to the active window; no window manager makes it so here
            window.activateWindow()
        return window

    yield make
    for window in opened:
        # a question that nobody answers would stand for ever
        monkeypatch.setattr(window, "_gives_up_export", lambda: True)
        monkeypatch.setattr(window, "_gives_up", lambda why: True)
        window.close()
        window.deleteLater()
    qapp.processEvents()


@pytest.fixture
def choose(monkeypatch):
    """Return a function that makes the next file dialogs answer with these paths."""
    from PySide6.QtWidgets import QFileDialog

    def answer(*paths) -> None:
        queue = [str(path) for path in paths]
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (queue.pop(0), ""))
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (queue.pop(0), ""))

    return answer


@pytest.fixture
def animated(animated_late):
    """A window in which the hum was opened and Synthesise pressed, all through its buttons."""
    return animated_late()


@pytest.fixture
def animated_late(qtbot, open_window, choose, database_path, speech_path):
    """Return a function that makes such a window."""
    from PySide6.QtCore import Qt
    from PySide6.QtTest import QTest

    def click(widget):
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=widget.rect().center())

    def make():
        window = open_window()
        choose(database_path, speech_path)
        click(window.control.database.open_button)
        qtbot.waitUntil(lambda: window.authoring.document.database is not None, timeout=WAIT_MS)
        window.control.speech.open_action.trigger()
        qtbot.waitUntil(lambda: window.authoring.document.speech is not None, timeout=WAIT_MS)
        click(window.control.synthesise_button)
        qtbot.waitUntil(lambda: window.authoring.document.answer is not None, timeout=WAIT_MS)
        qtbot.waitUntil(lambda: not window.motion.is_empty)
        return window

    return make


@pytest.fixture
def efase(monkeypatch, capsys):
    """Run the command in this process; returns (exit code, stdout, stderr)."""

    from app import cli

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["efase", *map(str, words)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        answer = capsys.readouterr()
        return stop.value.code or 0, answer.out, answer.err

    return run


@pytest.fixture(scope="session")
def mouth_database_path(tmp_path_factory, tiny_corpus):
    """The tiny corpus with a mouth that can be measured, each sentence its own word; s6 and s7 are held out."""
    corpus = tiny_corpus({"test": ("s6", "s7")})
    recordings = []
    for recording in corpus.recordings:
        said = recording.transcript
        words = tuple(replace(word, word=f"word{recording.sentence}") for word in said.words)
        recordings.append(replace(recording, transcript=replace(said, words=words), text=words[0].word))
    landmarks = {
        "upper_lip": "lip_up", "lower_lip": "lip_low", "mouth_corner_left": "ring0", "mouth_corner_right": "ring6",
    }  # fmt: skip
    path = tmp_path_factory.mktemp("mouths") / "mouths.h5"
    build_database(replace(corpus, recordings=recordings, landmarks=landmarks), path, BuildSettings(rate_hz=60.0))
    return path


@pytest.fixture(scope="session")
def held_out_speech_path(tmp_path_factory, mouth_database_path):
    """A hum as long as the sentence s7 of `mouth_database_path`, which was held out, with its TextGrid beside it."""
    from core.motion.database import open_database
    from core.speech.textgrid import write_textgrid

    said = open_database(mouth_database_path).held_out_recordings("test")[1].transcript
    folder = tmp_path_factory.mktemp("held-out")
    times_s = np.arange(round(said.duration_s * 16_000)) / 16_000
    soundfile.write(folder / "s7.wav", 0.3 * np.sin(2 * np.pi * 140 * times_s), 16_000)
    write_textgrid(said, folder / "s7.TextGrid")
    return folder / "s7.wav"
