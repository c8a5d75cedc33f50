"""Whatever ends the window, the project is what some completed edit made it, and no confirmed edit is lost."""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from core.document.content import ProjectContent
from core.document.document import Document
from core.document.edits import SetSpeech
from core.document.project_file import ProjectFile
from tests.core.document.random_edits import made_speech, random_edit

PAGE = 4096
REPOSITORY = Path(__file__).resolve().parents[3]


class Editor:
    """A process that edits a project; what it said is remembered by number."""

    def __init__(self, path: Path, seed: int) -> None:
        script = "import sys; from tests.core.document.random_edits import *; " \
                 "edit_until_killed(Path(sys.argv[1]), int(sys.argv[2]))"  # fmt: skip
        self.states: dict[int, str] = {}
        self.confirmed = 0
        self.process = subprocess.Popen(
            [sys.executable, "-c", script, str(path), str(seed)], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        for line in self.process.stdout:
            if not line.endswith("\n"):  # it was killed while it spoke
                return
            word, number, *content = line.split(" ", 2)
            if word == "begin":
                self.states[int(number)] = content[0].strip()
            else:
                self.confirmed = int(number)

    def wait_for(self, number: int) -> None:
        deadline_s = time.monotonic() + 60
        while self.confirmed < number:
            assert time.monotonic() < deadline_s and self.process.poll() is None
            time.sleep(0.001)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join()
        self.process.stdout.close()


@pytest.fixture
def own_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    return tmp_path


def state_of(path: Path) -> tuple[int, str, tuple[str, ...]]:
    """Open a project as a window would, and return its number, its content and what had to be said."""
    project = ProjectFile.open(path)
    try:
        assert project.audio(project.content).digest == project.content.sound.digest
        return project.content.others.get("number", 0), project.content.to_json(), project.said
    finally:
        project.close()


def kill_at_random(folder: Path, n_kills: int) -> None:
    chance = random.Random(11)
    for seed in range(n_kills):
        path = folder / f"killed-{seed}.efase"
        ProjectFile.create(path).close()
        editor = Editor(path, seed)
        try:
            editor.wait_for(chance.randrange(1, 30))
            time.sleep(chance.uniform(0.0, 0.01))
        finally:
            editor.kill()
        number, content, _ = state_of(path)
        assert number >= editor.confirmed
        assert content == editor.states[number]


def copy_while_open(folder: Path, n_copies: int) -> int:
    """Return how many of the copies had to be mended."""
    chance, mended = random.Random(5), 0
    path = folder / "open.efase"
    ProjectFile.create(path).close()
    editor = Editor(path, 99)
    try:
        editor.wait_for(5)
        for i in range(n_copies):
            time.sleep(chance.uniform(0.0, 0.02))
            before, copy = editor.confirmed, folder / f"copy-{i}.efase"
            shutil.copyfile(path, copy)
            number, content, said = state_of(copy)
            mended += bool(said)
            assert number >= before
            while number not in editor.states:
                time.sleep(0.001)
            assert content == editor.states[number]
            copy.unlink()
    finally:
        editor.kill()
    return mended


def test_a_few_kills(own_folder):
    kill_at_random(own_folder, 4)


def test_a_few_copies(own_folder):
    copy_while_open(own_folder, 25)


@pytest.mark.prove
def test_200_kills(own_folder):
    kill_at_random(own_folder, 200)


@pytest.mark.prove
def test_1000_copies(own_folder):
    copy_while_open(own_folder, 1000)


def tear_at_every_page(folder: Path, seed: int, n_edits: int) -> int:
    """Mix the file's pages before and after each edit, split at each page; return how many mixtures were mended."""
    chance, document, mended = random.Random(seed), Document(), 0
    path, torn = folder / "whole.efase", folder / "torn.efase"
    project = ProjectFile.create(path)
    document.apply(SetSpeech.on(document, made_speech(0, n_phones=250)))
    project.save(ProjectContent.of(document), document.speech.audio)
    for _ in range(n_edits):
        new_speech = chance.random() < 0.2
        edit = SetSpeech.on(document, made_speech(chance.randrange(99), 250)) if new_speech else None
        edit = edit or random_edit(document, chance)
        if edit is None:
            continue
        document.apply(edit)
        before, old = path.read_bytes(), project.content.to_json()
        project.save(ProjectContent.of(document), document.speech.audio)
        after, new = path.read_bytes(), project.content.to_json()
        pages = range(PAGE, max(len(before), len(after)), PAGE)
        for at in (at for at in pages if before[at : at + PAGE] != after[at : at + PAGE]):
            for one, other in ((before, after), (after, before)):
                torn.write_bytes(one[:at] + other[at:])
                _, content, said = state_of(torn)
                assert content in (old, new)
                mended += bool(said)
    project.close()
    return mended


def test_a_file_torn_at_any_page_is_what_it_was_before_or_after_the_edit(own_folder):
    assert tear_at_every_page(own_folder, seed=1, n_edits=4) > 10


@pytest.mark.prove
def test_many_torn_files(own_folder):
    assert tear_at_every_page(own_folder, seed=2, n_edits=15) > 30
