"""A project is what it was, or one sentence says why not."""

from __future__ import annotations

import json
import random
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core import sqlite_file
from core.document import project_file
from core.document.content import ProjectContent
from core.document.content_checks import Unbelievable
from core.document.document import Document
from core.document.edits import SetSpeech
from core.document.project_file import ProjectFile, ReadOnlyProject, read_project
from core.document.project_lock import ProjectLocked
from core.document.project_tables import KIND
from core.errors import UserFacingError
from core.media.audio import Audio, audio_from_bytes
from core.search.weights import SearchWeights
from tests.core.document.random_edits import made_speech, random_edit

EXAMPLES = sorted((Path(__file__).parent / "examples").glob("*.efase"))


@pytest.fixture(autouse=True)
def own_data(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))


def worked_on(seed: int, n_edits: int = 60) -> Document:
    """Return a document after some random edits."""
    chance, document = random.Random(seed), Document()
    document.apply(SetSpeech.on(document, made_speech(seed)))
    document.weights = SearchWeights(pnt=2.5, alpha6=0.3)
    for _ in range(n_edits):
        edit = random_edit(document, chance)
        if edit is not None:
            document.apply(edit)
    return document


def saved(path: Path, document: Document) -> ProjectContent:
    project = ProjectFile.create(path)
    content = ProjectContent.of(document)
    project.save(content, document.speech.audio)
    project.close()
    return content


@pytest.mark.parametrize("seed", range(8))
def test_a_project_is_read_as_it_was_saved(tmp_path, seed):
    document = worked_on(seed)
    content = saved(tmp_path / "a.efase", document)
    again, audio = read_project(tmp_path / "a.efase")
    assert again == content
    assert audio.samples.tolist() == document.speech.audio.samples.tolist()
    other = Document()
    other.load(again.state(audio, None))
    assert ProjectContent.of(other) == content


def test_sound_of_24_bits_is_kept_to_the_bit_and_louder_is_clipped():
    fine = (np.random.default_rng(0).integers(-(2**23), 2**23, 40_000) / 2**23).astype(np.float32)
    kept = audio_from_bytes(Audio(fine, 44_100).kept)
    assert np.array_equal(kept.samples, fine)
    assert kept.digest == Audio(fine, 44_100).digest
    for rate_hz in (44_100, 768_000):
        loud = audio_from_bytes(Audio(2 * fine, rate_hz).kept)
        assert np.abs(loud.samples - np.clip(2 * fine, -1, 1)).max() < 2e-7


def test_sounds_that_undo_may_want_stay_until_the_project_is_closed(tmp_path):
    document = Document()
    project = ProjectFile.create(tmp_path / "a.efase")
    edits = [SetSpeech.on(document, made_speech(seed)) for seed in range(6)]
    contents = []
    for edit in edits:
        document.apply(edit)
        contents.append(ProjectContent.of(document))
        project.save(contents[-1], document.speech.audio)
    assert all(project.audio(content).digest == content.sound.digest for content in contents)
    project.save(contents[2])
    project.save_version("third")
    project.save(contents[4])
    project.close()
    project = ProjectFile.open(tmp_path / "a.efase")
    kept = [content.sound.digest for content in contents if _has_sound(project, content)]
    assert kept == [contents[2].sound.digest, contents[4].sound.digest]
    assert project.version("third") == contents[2]
    project.close()


def _has_sound(project, content):
    try:
        return project.audio(content) is not None
    except UserFacingError:
        return False


def test_named_versions(tmp_path):
    document = worked_on(1)
    project = ProjectFile.create(tmp_path / "a.efase")
    first = ProjectContent.of(document)
    project.save(first, document.speech.audio)
    project.save_version(" one ")
    project.save(replace(first, modifiers=()))
    project.save_version("two")
    assert [version.name for version in project.versions()] == ["one", "two"]
    assert project.version("one") == first
    assert project.version("two").modifiers == ()
    project.save_version("one")
    assert project.version("one").modifiers == ()
    project.forget_version("one")
    assert [version.name for version in project.versions()] == ["two"]
    with pytest.raises(UserFacingError, match="no version “one”"):
        project.version("one")
    with pytest.raises(UserFacingError, match="needs a name"):
        project.save_version("  ")
    project.close()


def test_a_copy_is_whole_and_apart(tmp_path):
    document = worked_on(2)
    project = ProjectFile.create(tmp_path / "a.efase")
    content = ProjectContent.of(document)
    project.save(content, document.speech.audio)
    project.copy_to(tmp_path / "b.efase")
    project.save(replace(content, text="changed"))
    assert read_project(tmp_path / "b.efase")[0] == content
    with pytest.raises(UserFacingError, match="itself"):
        project.copy_to(tmp_path / "a.efase")
    with pytest.raises(UserFacingError, match="cannot be written"):
        project.copy_to(tmp_path / "nowhere" / "c.efase")
    project.close()


def test_one_window_a_project(tmp_path):
    project = ProjectFile.create(tmp_path / "a.efase")
    with pytest.raises(ProjectLocked, match="open in another window"):
        ProjectFile.open(tmp_path / "a.efase")
    (tmp_path / "link.efase").symlink_to(tmp_path / "a.efase")
    with pytest.raises(ProjectLocked):
        ProjectFile.open(tmp_path / "link.efase")
    assert read_project(tmp_path / "a.efase")[0] == ProjectContent()
    project.close()
    ProjectFile.open(tmp_path / "a.efase").close()


def test_what_another_machine_wrote_is_not_overwritten(tmp_path, monkeypatch):
    path = tmp_path / "a.efase"
    mine = ProjectFile.create(path)
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "another machine"))
    theirs = ProjectFile.open(path)
    theirs.save(ProjectContent(text="theirs"))
    with pytest.raises(UserFacingError, match="changed by another window"):
        mine.save(ProjectContent(text="mine"))
    assert read_project(path)[0].text == "theirs"
    theirs.close()
    mine.close()


def test_a_file_that_cannot_be_written_can_be_read(tmp_path, monkeypatch):
    document = worked_on(3)
    content = saved(tmp_path / "a.efase", document)
    connected = sqlite_file._connected

    def read_only(path, mode, more=""):
        return connected(path, mode.replace("rw", "ro"), more)

    monkeypatch.setattr(sqlite_file, "_connected", read_only)
    with pytest.raises(ReadOnlyProject, match="read-only"):
        ProjectFile.open(tmp_path / "a.efase")
    assert read_project(tmp_path / "a.efase")[0] == content


def test_a_full_disk_loses_nothing_that_was_saved(tmp_path):
    project = ProjectFile.create(tmp_path / "a.efase")
    project.save(ProjectContent(text="before"))
    (pages,) = project._connection.execute("PRAGMA page_count").fetchone()
    project._connection.execute(f"PRAGMA max_page_count = {pages}")
    with pytest.raises(UserFacingError, match="the disk is full"):
        project.save(ProjectContent(text="x" * 200_000))
    assert read_project(tmp_path / "a.efase")[0].text == "before"
    project._connection.execute("PRAGMA max_page_count = 1000000")
    project.save(ProjectContent(text="x" * 200_000))
    project.close()
    assert len(read_project(tmp_path / "a.efase")[0].text) == 200_000


@pytest.mark.parametrize("read", [ProjectFile.open, read_project])
def test_what_is_no_project_is_refused_in_one_sentence(tmp_path, read):
    path = tmp_path / "a.efase"
    with pytest.raises(UserFacingError, match="There is no eFASE project"):
        read(path)
    for content in (b"", b"RIFF", b"\x89HDF\r\n\x1a\n" + bytes(2000)):
        path.write_bytes(content)
        with pytest.raises(UserFacingError, match="is not an eFASE project"):
            read(path)
    path.unlink()
    with closing(sqlite3.connect(path)) as foreign:
        foreign.execute("CREATE TABLE songs (name)")
    with pytest.raises(UserFacingError, match="SQLite file, but not an eFASE project"):
        read(path)
    with pytest.raises(UserFacingError):
        read(tmp_path)


def _altered(path: Path, *statements: str) -> Path:
    saved(path, worked_on(4))
    with closing(sqlite3.connect(path)) as connection, connection:
        for statement in statements:
            connection.execute(statement)
    return path


def test_a_newer_major_version_is_refused(tmp_path):
    path = _altered(tmp_path / "a.efase", f"PRAGMA user_version = {2 << 16 | 3}")
    before = path.read_bytes()
    with pytest.raises(UserFacingError, match=r"made by a newer eFASE \(version 2\.3") as refusal:
        ProjectFile.open(path)
    assert "Update" in refusal.value.remedy
    assert path.read_bytes() == before


def test_what_a_newer_minor_version_wrote_is_kept(tmp_path):
    path = tmp_path / "a.efase"
    project = ProjectFile.create(path)
    entries = {**json.loads(ProjectContent(text="said").to_json()), "lights": {"key": [1, 2.5, None]}}
    project.save(ProjectContent.from_json(json.dumps(entries)))
    project.close()
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(f"PRAGMA user_version = {1 << 16 | 9}")
    project = ProjectFile.open(path)
    assert "newer eFASE" in project.said[0]
    project.save(replace(project.content, text="said otherwise"))
    project.close()
    again = ProjectFile.open(path)
    assert again.content.others["lights"] == {"key": [1, 2.5, None]}
    assert sqlite_file.version_of(again._connection) == (1, 9)
    again.close()


def test_an_older_minor_version_is_brought_up_to_date_and_it_is_said(tmp_path, monkeypatch):
    path = tmp_path / "a.efase"
    content = saved(path, worked_on(5))
    newer = replace(KIND, version=(1, 4))
    monkeypatch.setattr(project_file, "KIND", newer)
    project = ProjectFile.open(path)
    assert "older eFASE" in project.said[0]
    assert project.content == content
    project.close()
    again = ProjectFile.open(path)
    assert again.said == ()
    again.close()


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_a_project_of_each_version_so_far_is_read(tmp_path, example):
    path = tmp_path / example.name
    shutil.copyfile(example, path)
    project = ProjectFile.open(path)
    content = project.content
    assert content.transcript.phones == ("pau", "m", "iy", "ow", "pau")
    assert content.pins == {1: "s3:4"} and content.locks == {2: "s1:0"}
    assert [(m.emotion, m.intensity) for m in content.modifiers] == [("anger", 0.5)]
    assert content.weights.alpha6 == 1.5
    assert content.reference_video.offset_s == -0.25
    assert content.output.frame_rate == "25" and content.output.start_frame == 86400
    assert content.removed_here["s2:1"].why == "a spike" and content.kept == {"s5:5"}
    assert content.database.name == "tiny" and content.face.name == "ben"
    assert [version.name for version in project.versions()] == ["calm"]
    assert project.version("calm").modifiers == ()
    assert project.audio(content).duration_s == content.transcript.duration_s == 0.5
    assert project.said == ()
    project.close()


def test_every_version_has_an_example():
    assert f"project-{KIND.version[0]}.{KIND.version[1]}" in [p.stem for p in EXAMPLES]


@pytest.mark.parametrize(
    "statement",
    [
        "CREATE TRIGGER bad AFTER DELETE ON state0 BEGIN DELETE FROM sound0; END",
        "CREATE VIEW bad AS SELECT 1",
        "DROP TABLE version",
        "UPDATE sound0 SET data = zeroblob(100)",
    ],
)
def test_a_project_that_was_tampered_with_runs_no_code_and_is_mended_or_refused(tmp_path, statement):
    path = _altered(tmp_path / "a.efase", statement)
    try:
        project = ProjectFile.open(path)
    except UserFacingError as error:
        assert "a.efase" in str(error)
        return
    assert "was damaged" in project.said[0]
    assert project.content == ProjectContent.of(worked_on(4))
    names = {name for (name,) in project._connection.execute("SELECT name FROM sqlite_master")}
    assert "bad" not in names and "version" in names
    assert (tmp_path / "a.damaged.efase").is_file()
    project.close()


def _entries() -> dict:
    return json.loads(ProjectContent.of(worked_on(6)).to_json())


@pytest.mark.parametrize(
    "change",
    [
        lambda e: e["transcript"]["phonemes"][0].__setitem__(0, "xx"),
        lambda e: e["transcript"]["phonemes"][0].__setitem__(2, -1),
        lambda e: e["transcript"]["phonemes"][1].__setitem__(1, 0.0),
        lambda e: e["transcript"].__setitem__("duration_s", 1e9),
        lambda e: e["transcript"].__setitem__("phonemes", []),
        lambda e: e["transcript"].__setitem__("phonemes", [["aa", 0, 1]] * 200_000),
        lambda e: e["emotions"].append([0, 1, "envy", 1]),
        lambda e: e["emotions"].append([0, 1, "anger", 1.5]),
        lambda e: e["emotions"].append([1, 0, "anger", 1]),
        lambda e: e["emotions"].append([0, 1, ["anger"], 1]),
        lambda e: e["pins"].append([10_000, "s1:1"]),
        lambda e: e["pins"].append([True, "s1:1"]),
        lambda e: e["pins"].append([0, 7]),
        lambda e: e.__setitem__("weights", {"pnt": -1}),
        lambda e: e.__setitem__("weights", {"pnt": 1, "alpha99": 1}),
        lambda e: e.__setitem__("sound", {"digest": "../../etc"}),
        lambda e: e.__setitem__("sound", None),
        lambda e: e.__setitem__("face", {"name": "x" * 100_000}),
        lambda e: e.__setitem__("output", {"frame_rate": "31"}),
        lambda e: e.__setitem__("polish", {"articulation": 99}),
        lambda e: e.__setitem__("polish", {"curves": {"nose": []}}),
        lambda e: e.__setitem__("polish", {"curves": {"lips": [[0, -1]]}}),
        lambda e: e.__setitem__("controls", {"jawOpen": {"keys": [[0, 1, 0]], "smoothed": [], "is_muted": False}}),
        lambda e: e.__setitem__("controls", {"jawOpen": {"keys": [], "smoothed": [[0]], "is_muted": False}}),
        lambda e: e.__setitem__("controls", {"jawOpen": {"keys": [], "smoothed": [], "is_muted": 1}}),
        lambda e: e.__setitem__("output", {"start_frame": 1e300}),
        lambda e: e.__setitem__("view", {"playhead_s": True}),
        lambda e: e.__setitem__("kept", {"a": 1}),
        lambda e: e.__setitem__("database", [1, 2]),
        lambda e: e.__setitem__("reference_video", {"path": "a", "offset_s": "soon"}),
        lambda e: e.__setitem__("text", ["a"]),
    ],
)
def test_what_cannot_be_is_not_believed(change):
    entries = _entries()
    ProjectContent.from_json(json.dumps(entries))
    change(entries)
    with pytest.raises(Unbelievable):
        ProjectContent.from_json(json.dumps(entries))


@pytest.mark.parametrize(
    "text", ["", "[]", "null", "{", '{"text": NaN}', "[" * 100_000, '{"emotions": [[0, 1e999, "anger", 1]]}']
)
def test_what_is_no_content_is_not_believed(text):
    with pytest.raises(Unbelievable):
        ProjectContent.from_json(text)


def test_damaged_projects_are_mended_or_refused(tmp_path, survives_damage):
    path = tmp_path / "a.efase"
    content = saved(path, worked_on(7))
    read = []

    def open_it(damaged: Path) -> None:
        try:
            project = ProjectFile.open(damaged)
        finally:
            (damaged.parent / f"{damaged.stem}.damaged.efase").unlink(missing_ok=True)
        read.append(project.content)
        project.audio(project.content)
        project.close()

    refused = survives_damage(path, open_it, 150)
    assert refused < 150
    assert sum(one == content for one in read) > 20


def test_names_that_no_text_encoding_knows_survive(tmp_path):
    document = worked_on(8)
    odd = replace(document.speech.audio, path=Path("odd\udcff\n.wav"))
    document.apply(SetSpeech.on(document, replace(document.speech, audio=odd, text="zero \0 and \u2028")))
    content = saved(tmp_path / "a.efase", document)
    assert read_project(tmp_path / "a.efase")[0] == content
