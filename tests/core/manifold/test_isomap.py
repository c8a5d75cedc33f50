import numpy as np
import pytest
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import procrustes
from scipy.spatial.distance import cdist
from sklearn.manifold import Isomap

from core.manifold.isomap import PhonemeIsomap, PhonemeMap, delaunay_triangles, joined_neighbour_graph
from core.manifold.picking import pick


@pytest.fixture(scope="module")
def roll():
    rng = np.random.default_rng(0)
    turn, height = rng.uniform(0, 3 * np.pi, 800), rng.uniform(0, 10, 800)
    return np.c_[turn * np.cos(turn), height, turn * np.sin(turn)], turn


def test_equals_sklearn_where_the_graph_is_whole(roll):
    frames, _ = roll
    ours = PhonemeIsomap(n_neighbors=12).fit(frames)
    assert ours.n_joined_ == 0
    assert ours.n_landmarks_ == 0
    theirs = Isomap(n_neighbors=12, n_components=2).fit_transform(frames)
    assert procrustes(ours.embedding_, theirs)[2] < 1e-10


def test_landmarks_agree_with_the_full_method(roll):
    frames, _ = roll
    full = PhonemeIsomap().fit(frames)
    landmark = PhonemeIsomap(landmark_above=100, n_landmarks=150).fit(frames)
    assert landmark.n_landmarks_ == 150
    assert procrustes(full.embedding_, landmark.embedding_)[2] < 1e-3


def test_the_roll_is_unrolled(roll):
    frames, turn = roll
    length = (turn * np.sqrt(1 + turn**2) + np.arcsinh(turn)) / 2  # arc length of the spiral
    along = PhonemeIsomap().fit(frames).embedding_[:, 0]
    assert abs(np.corrcoef(length, along)[0, 1]) > 0.99


def test_components_are_joined_by_a_shortest_spanning_tree():
    rng = np.random.default_rng(1)
    centres = rng.uniform(-500, 500, (9, 4))
    frames = (centres[:, None] + rng.normal(size=(9, 14, 4))).reshape(-1, 4)
    graph, joined = joined_neighbour_graph(frames, 3)
    assert joined >= 8
    between = np.array(
        [[cdist(frames[i * 14 : i * 14 + 14], frames[j * 14 : j * 14 + 14]).min() for j in range(9)] for i in range(9)]
    )
    bridges = graph.tocoo()
    crossing = bridges.row // 14 != bridges.col // 14
    assert bridges.data[crossing].sum() / 2 == pytest.approx(minimum_spanning_tree(between).sum())


def test_equal_data_give_an_equal_map(roll):
    frames, _ = roll
    assert np.array_equal(PhonemeIsomap().fit(frames).embedding_, PhonemeIsomap().fit(frames.copy()).embedding_)


@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_tiny_and_degenerate_clusters_still_have_a_map(n):
    for frames in (np.zeros((n, 4)), np.arange(n * 4.0).reshape(n, 4)):
        phoneme_map = PhonemeMap.make(np.arange(n), frames)
        assert phoneme_map.embedding.shape == (n, 2)
        assert np.isfinite(phoneme_map.embedding).all()
        for point in phoneme_map.embedding:
            assert np.isfinite(pick(phoneme_map, point).blend(frames)).all()


def test_no_frame_is_refused():
    with pytest.raises(ValueError, match="at least one frame"):
        PhonemeIsomap().fit(np.zeros((0, 4)))


def test_triangles_fill_the_hull():
    points = np.random.default_rng(2).uniform(size=(60, 2)).astype(np.float32)
    a, b, c = points[delaunay_triangles(points)].transpose(1, 2, 0).astype(float)
    area = np.abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).sum() / 2
    from scipy.spatial import ConvexHull

    assert area == pytest.approx(ConvexHull(points).volume, rel=1e-6)
