"""New frames on an old map: it does not move, and they land where the out-of-sample Isomap puts them."""

import numpy as np
import pytest
from sklearn.manifold import Isomap

from core.manifold.isomap import PhonemeIsomap, PhonemeMap
from core.manifold.placing import grow_map, place_frames


def roll(seed, n):
    rng = np.random.default_rng(seed)
    turn, height = rng.uniform(0, 3 * np.pi, n), rng.uniform(0, 10, n)
    return np.c_[turn * np.cos(turn), height, turn * np.sin(turn)]


@pytest.fixture(scope="module")
def old():
    frames = roll(0, 900)
    return frames, PhonemeIsomap().fit(frames).embedding_


def test_equals_sklearn_when_every_old_frame_is_an_anchor(old):
    frames, places = old
    new = roll(1, 150)
    theirs = Isomap(n_neighbors=12, n_components=2).fit(frames)
    signs = np.sign((theirs.embedding_ * places).sum(axis=0))
    assert theirs.embedding_ * signs == pytest.approx(places, abs=1e-6)
    ours = place_frames(frames, places, new, n_anchors=len(frames))
    assert ours == pytest.approx(theirs.transform(new) * signs, abs=1e-6)


def test_few_anchors_do_nearly_as_well(old):
    frames, places = old
    new = roll(1, 150)
    every = place_frames(frames, places, new, n_anchors=len(frames))
    few = place_frames(frames, places, new, n_anchors=100)
    assert np.sqrt(((few - every) ** 2).sum(axis=1).mean()) < 0.02 * places.std()


def test_a_frame_that_is_captured_again_lands_where_it_is(old):
    frames, places = old
    again = place_frames(frames, places, frames[::50], n_anchors=100)
    assert again == pytest.approx(places[::50], abs=1e-4)


def test_a_map_that_was_turned_and_thinned_out_is_placed_on_as_it_is(old):
    frames, places = old
    turned = places[100:] @ np.array([[0.0, -2.0], [2.0, 0.0]]) + 7.0
    new = roll(1, 150)
    direct = place_frames(frames, places, new) @ np.array([[0.0, -2.0], [2.0, 0.0]]) + 7.0
    shown = place_frames(frames[100:], turned, new)
    assert np.sqrt(((shown - direct) ** 2).sum(axis=1).mean()) < 0.03 * turned.std()


@pytest.mark.parametrize("n", [1, 2, 3, 13])
def test_few_and_degenerate_frames_can_be_placed_on(n):
    for frames in (np.zeros((n, 4)), np.arange(n * 4.0).reshape(n, 4)):
        places = PhonemeMap.make(np.arange(n), frames).embedding
        assert np.isfinite(place_frames(frames, places, np.ones((5, 4)))).all()


def test_the_linear_map_goes_on_as_it_was():
    frames = np.random.default_rng(3).normal(size=(300, 6)) * np.arange(6, 0, -1)
    old_map = PhonemeMap.make(np.arange(250), frames[:250])
    rows, is_new = np.arange(300), np.arange(300) >= 250
    grown = grow_map(old_map, np.arange(250), rows, is_new, frames)
    mean = frames[:250].mean(axis=0)
    _, _, axes = np.linalg.svd(frames[:250] - mean, full_matrices=False)
    assert grown.pca == pytest.approx((frames - mean) @ axes[:2].T, abs=1e-3)
    assert np.array_equal(grown.embedding[:250], old_map.embedding)
    assert grown.n_placed == 50


def test_frames_that_go_leave_the_others_where_they_are():
    frames = np.random.default_rng(4).normal(size=(200, 5))
    old_map = PhonemeMap.make(np.arange(200), frames)
    kept = np.flatnonzero(np.arange(200) % 3 > 0)
    thinned = grow_map(old_map, kept, np.arange(len(kept)), np.zeros(len(kept), bool), frames[kept])
    assert np.array_equal(thinned.embedding, old_map.embedding[kept])
    assert thinned.triangles.max() < len(kept)


def test_a_large_map_needs_only_a_part_of_itself(old):
    frames, places = old
    new = roll(1, 150)
    whole = place_frames(frames, places, new)
    part = place_frames(frames, places, new, most_carriers=300)
    assert np.sqrt(((part - whole) ** 2).sum(axis=1).mean()) < 0.05 * places.std()
    again = place_frames(frames, places, frames[::50], most_carriers=300)
    assert again == pytest.approx(places[::50], abs=1e-4)
