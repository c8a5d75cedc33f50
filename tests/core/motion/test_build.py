"""A whole small corpus through the build, and the database it leaves behind."""

from dataclasses import replace

import h5py
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.database import VERSION, open_database
from core.motion.node import NIL
from core.motion.recording import Recording
from core.progress import Cancelled, Progress
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

NAMES = ("nose", "eye_l", "eye_r", "lip_up", "lip_low", "chin", "spare")
REST = np.array([[0, 0, 0], [45, 30, -20], [-45, 30, -20], [0, -30, 5], [0, -32, 5], [0, -70, -5], [0, 90, 0]], float)


def recording(name, emotion, seed, rate=60.0):
    """A sentence of 2 s whose lower lip and chin wave, on a head that turns."""
    rng = np.random.default_rng(seed)
    times = np.arange(int(2 * rate)) / rate
    spoken = (times > 0.5) & (times < 1.6)
    opening = np.where(spoken, 8 * np.sin(2 * np.pi * (2 + seed % 3) * times) ** 2, 0)
    face = np.repeat(REST[None], len(times), axis=0)
    face[:, 4:6, 1] -= opening[:, None]
    face += rng.normal(size=face.shape) * 0.05
    moving = np.clip(times - 0.5, 0, None)  # upright in the first silence, which is where the rest pose comes from
    turn = Rotation.from_rotvec(np.c_[0.1 * moving, 0.2 * moving, 0 * times]).as_matrix()
    seen = face @ turn.transpose(0, 2, 1) + np.c_[times * 10, times, -times][:, None]
    bounds = [0, 0.5, 0.7, 0.9, 1.2, 1.6, 2.0]
    phones = ["pau", "b", "aa", "k", "iy", "pau"]
    utterances = [PhonemeUtterance(p, a, b) for p, a, b in zip(phones, bounds, bounds[1:])]
    transcript = Transcript.covering(utterances, [WordUtterance("bocky", 0.5, 1.6)], 2.0)
    return Recording(name, emotion, seen.astype(np.float32), NAMES, rate, transcript, "bocky")


@pytest.fixture
def corpus():
    emotions = ["neutral", "neutral", "anger", "sadness"]
    recordings = [recording(f"s{i}", emotion, i) for i, emotion in enumerate(emotions)]
    groups = {"origin": ("nose",), "rigid": ("nose", "eye_l", "eye_r"), "jaw": ("chin",)}
    landmarks = {"upper_lip": "lip_up", "lower_lip": "lip_low", "chin": "chin"}
    return Corpus("waves", recordings, NAMES[:6], groups, landmarks)


@pytest.fixture
def database(corpus, tmp_path):
    return build_database(corpus, tmp_path / "waves.h5")


def test_what_is_stored_is_what_comes_back(database, tmp_path):
    again = open_database(tmp_path / "waves.h5")
    assert again.content_hash == database.content_hash
    assert again.weights == database.weights
    assert again.markers.names == NAMES[:6]
    assert again.markers.groups == database.markers.groups
    assert np.array_equal(again.frames, database.frames)
    for name in database.nodes.COLUMNS:
        assert np.array_equal(getattr(again.nodes, name), getattr(database.nodes, name))
    assert again.sentences == database.sentences
    for phone, phoneme_map in database.maps.items():
        assert np.array_equal(again.maps[phone].embedding, phoneme_map.embedding)
        assert np.array_equal(again.maps[phone].triangles, phoneme_map.triangles)
    assert again.summary() == database.summary()


def test_nodes_and_clusters(database):
    assert len(database.nodes) == 16
    assert database.summary()["emotions"] == {"neutral": 2, "anger": 1, "sadness": 1}
    starts = np.flatnonzero(database.nodes.pre == NIL)
    assert [database.nodes[n].phone for n in starts] == ["b"] * 4
    assert {phone: len(m.frames) for phone, m in database.maps.items()} == {
        "b": 4 * 24, "aa": 4 * 24, "k": 4 * 36, "iy": 4 * 48,
    }  # fmt: skip
    for phone, phoneme_map in database.maps.items():
        nodes = [database.nodes[n] for n in range(16)]
        spans = [np.arange(node.start_frame, node.stop_frame) for node in nodes if node.phone == phone]
        assert np.array_equal(phoneme_map.frames, np.concatenate(spans))


def test_head_motion_is_out_of_the_face_and_can_be_put_back(database, corpus):
    face = database.pca.positions(database.frames[:240])
    assert face[:, :3] == pytest.approx(np.tile(REST[:3], (240, 1, 1)), abs=0.5)
    turn = Rotation.from_rotvec(database.head_rotation[:240]).as_matrix()
    seen = face @ turn.transpose(0, 2, 1) + database.head_translation[:240, None]
    captured = corpus.recordings[0].positions[:, :6]
    assert seen[::2] == pytest.approx(captured, abs=0.5)


def test_the_rest_pose_has_closed_lips(database):
    assert database.markers.rest == pytest.approx(REST[:6], abs=0.2)


def test_pca_covers_the_motion(database):
    assert 0.9 < database.pca.coverage <= 1.0
    assert np.array_equal(database.rest_coefficients, database.pca.coefficients(database.markers.rest))


def test_the_hash_speaks_of_captured_content_only(corpus, tmp_path):
    first = build_database(corpus, tmp_path / "a.h5")
    second = build_database(replace(corpus, name="renamed"), tmp_path / "b.h5")
    assert first.content_hash == second.content_hash
    fewer = build_database(replace(corpus, recordings=corpus.recordings[:3]), tmp_path / "c.h5")
    assert fewer.content_hash != first.content_hash


def test_gaps_are_filled_or_masked_and_reported(corpus, tmp_path):
    holed = [replace(r, positions=r.positions.copy()) for r in corpus.recordings]
    holed[0].positions[40:43, 4] = np.nan  # 50 ms, inside /b/ and /aa/
    holed[1].positions[75:90, 4] = np.nan  # 250 ms, inside /iy/
    database = build_database(replace(corpus, recordings=holed), tmp_path / "holed.h5")
    assert database.report["marker_samples_filled"] == 3
    assert database.report["phones_left_out"] == 1
    assert "s1:3" not in {database.nodes.name(n) for n in range(len(database.nodes))}
    assert np.isfinite(database.frames).all()


def test_another_rate_gives_another_frame_count(corpus, tmp_path):
    database = build_database(corpus, tmp_path / "slow.h5", BuildSettings(rate_hz=30.0, n_dims=3))
    assert len(database.frames) == 4 * 60
    assert database.pca.n_dims == 3


class StopAt(Progress):
    def __init__(self, fraction):
        self.fraction = fraction

    def step(self, fraction, message=""):
        if fraction >= self.fraction:
            raise Cancelled


@pytest.mark.parametrize("fraction", [0.0, 0.2, 0.5, 0.95])
def test_a_cancelled_build_leaves_what_was_there(corpus, tmp_path, fraction):
    target = tmp_path / "old.h5"
    target.write_bytes(b"old")
    with pytest.raises(Cancelled):
        build_database(corpus, target, progress=StopAt(fraction))
    assert target.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["old.h5"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"recordings": []}, "no sentence"),
        ({"kept_markers": ("nose", "tail")}, "no marker 'tail'"),
    ],
)
def test_an_impossible_corpus_is_refused(corpus, tmp_path, change, words):
    with pytest.raises(UserFacingError, match=words):
        build_database(replace(corpus, **change), tmp_path / "x.h5")
    assert list(tmp_path.iterdir()) == []


def test_twins_and_strangers_among_the_sentences_are_refused(corpus, tmp_path):
    twins = replace(corpus, recordings=[corpus.recordings[0]] * 2)
    with pytest.raises(UserFacingError, match="two sentences named 's0'"):
        build_database(twins, tmp_path / "x.h5")
    other = replace(corpus.recordings[1], marker_names=tuple(reversed(NAMES)))
    with pytest.raises(UserFacingError, match="other markers"):
        build_database(replace(corpus, recordings=[corpus.recordings[0], other]), tmp_path / "x.h5")


def test_markers_that_are_never_seen_are_refused(corpus, tmp_path):
    blind = [replace(r, positions=np.full_like(r.positions, np.nan)) for r in corpus.recordings]
    with pytest.raises(UserFacingError, match="No frame"):
        build_database(replace(corpus, recordings=blind), tmp_path / "x.h5")


def test_an_unwritable_target_is_one_sentence(corpus, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UserFacingError, match="cannot be made"):
        build_database(corpus, tmp_path / "file" / "x.h5")


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda path: path.unlink(), "There is no motion database"),
        (lambda path: path.write_bytes(b""), "not a motion database"),
        (lambda path: path.write_bytes(b"RIFF" + bytes(5000)), "not a motion database"),
        (lambda path: path.write_bytes(path.read_bytes()[:20_000]), "damaged"),
        (lambda path: edit(path, lambda f: f.attrs.update(version_major=VERSION[0] + 1)), "newer eFASE"),
        (lambda path: edit(path, lambda f: f.attrs.update(format="other")), "not a motion database"),
        (lambda path: edit(path, lambda f: f.__delitem__("nodes/pre")), "damaged"),
        (lambda path: edit(path, lambda f: f["nodes/stop"].__setitem__(0, 10**9)), "damaged"),
        (lambda path: edit(path, lambda f: f.attrs.update(weights="{")), "damaged"),
    ],
)
def test_bad_files_are_one_sentence(database, tmp_path, damage, words):
    path = tmp_path / "waves.h5"
    damage(path)
    with pytest.raises(UserFacingError, match=words) as failure:
        open_database(path)
    assert str(path) in str(failure.value)
    assert failure.value.message.count(".") <= str(path).count(".") + 3


def edit(path, change):
    with h5py.File(path, "r+") as file:
        change(file)


def test_a_folder_is_no_database(tmp_path):
    with pytest.raises(UserFacingError, match="There is no motion database"):
        open_database(tmp_path)
