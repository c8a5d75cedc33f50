from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sklearn.decomposition import PCA

from core.errors import UserFacingError
from core.iface.units_of_database import spoken_deformations, units_of_database
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.speech.transcript import PhonemeUtterance, Transcript

EMOTIONS = ("neutral", "anger", "sadness")
NAMES = tuple(f"m{k}" for k in range(12))


@pytest.fixture
def database(talking_database):
    return talking_database(emotions=EMOTIONS, n_sentences=9)


def nodes_by_hand(database, emotion):
    """Positions less rest of all nodes of an emotion, every second frame of 60 Hz."""
    rows = []
    for n in range(len(database.nodes)):
        node = database.nodes
        sentence = database.sentences[node.sentence[n]]
        if sentence.emotion == emotion:
            rows += [f for f in range(node.start[n], node.stop[n]) if f % 2 == 0]
    return np.array([database.pca.positions(database.frames[f].astype(float)) for f in rows]) - database.markers.rest


def test_the_frames_of_all_nodes_at_the_papers_rate(database):
    moved = spoken_deformations(database)
    assert tuple(moved) == EMOTIONS
    for emotion in EMOTIONS:
        np.testing.assert_allclose(moved[emotion], nodes_by_hand(database, emotion), atol=1e-9)


def test_removed_nodes_do_not_count(database):
    removed = {database.nodes.name(n) for n in range(len(database.nodes)) if database.nodes.emotion[n] == 0}
    kept = removed.pop()
    n = database.nodes.row(kept)
    frames = [f for f in range(database.nodes.start[n], database.nodes.stop[n]) if f % 2 == 0]
    moved = spoken_deformations(database, removed)
    assert len(moved["neutral"]) == len(frames)
    with pytest.raises(UserFacingError, match="'talk' has no neutral speech"):
        units_of_database(database, removed=removed | {kept})


def test_units_are_the_principal_components_of_neutral_nodes(database):
    units = units_of_database(database, n_utterance=3)
    vectors = nodes_by_hand(database, "neutral").reshape(-1, 18)
    other = PCA(3).fit(vectors)
    np.testing.assert_allclose(np.abs(np.sum(units.utterance.units * other.components_, axis=1)), 1.0, atol=1e-6)
    assert units.utterance.coverage == pytest.approx(other.explained_variance_ratio_.sum())
    assert set(units.expressions) == {"anger", "sadness"}


def test_an_expression_of_one_frame_is_left_out(database):
    of_anger = np.flatnonzero(database.nodes.emotion == 2)
    last = of_anger[-1]
    one = database.nodes.start[last] + database.nodes.start[last] % 2
    stop = database.nodes.stop.copy()
    stop[last] = one + 1
    shorter = replace(database, nodes=replace(database.nodes, stop=stop))
    removed = {database.nodes.name(n) for n in of_anger[:-1]}
    assert set(units_of_database(shorter, removed=removed).expressions) == {"sadness"}


def talking_head(moves_head):
    """A corpus of four sentences in which five of twelve markers speak, and the head wanders, or not."""
    rng, of_head = np.random.default_rng(3), np.random.default_rng(4)
    rest = 40 * rng.standard_normal((12, 3))
    rest -= rest[0]
    recordings = []
    for s in range(4):
        times_s = np.arange(120) / 60.0
        face = np.repeat(rest[None], 120, axis=0)
        face[:, 7:] += 6 * np.sin(2 * np.pi * times_s * (2 + s))[:, None, None] * rng.standard_normal((5, 3))
        if moves_head:
            turn = Rotation.from_rotvec(0.3 * np.sin(times_s)[:, None] * of_head.standard_normal(3)).as_matrix()
            face = face @ turn.transpose(0, 2, 1) + 50 * np.cos(times_s)[:, None, None]
        spoken = [PhonemeUtterance("aa", 0.2 * p, 0.2 * (p + 1)) for p in range(10)]
        recordings.append(Recording(f"s{s}", EMOTIONS[s % 2], face.astype(np.float32), NAMES, 60.0,
                                    Transcript.covering(spoken, [], 2.0), ""))  # fmt: skip
    return Corpus("head", recordings, NAMES, {"rigid": NAMES[:7], "origin": NAMES[:1]}, {}, rest, synthetic=True)


def test_head_motion_is_no_motion_unit(tmp_path):
    still, turned = (
        units_of_database(build_database(talking_head(moves), tmp_path / f"{moves}.h5", BuildSettings(rate_hz=60.0)), 3)
        for moves in (False, True)
    )
    np.testing.assert_allclose(turned.utterance.variance, still.utterance.variance, rtol=1e-4)
    overlap = np.linalg.svd(turned.utterance.units @ still.utterance.units.T, compute_uv=False)
    np.testing.assert_allclose(overlap, 1.0, atol=1e-4)
