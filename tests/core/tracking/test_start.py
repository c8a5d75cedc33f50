"""Clicks lay the face on the picture."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.tracking.face_model import CLICKED
from core.tracking.start import named_clicks, placed

SIZE = (640, 480)


def _clicked(model, turn, scale, shift):
    cos, sin = np.cos(turn), np.sin(turn)
    matrix = scale * np.array([[cos, -sin], [sin, cos]])
    return {name: tuple(model.seen[model.landmarks[name]] @ matrix.T + shift) for name in CLICKED}, matrix


def _plain(places):
    return {name: (float(x), float(y)) for name, (x, y) in places.items()}


@pytest.mark.parametrize("turn", [0.0, 0.4, -1.2])
@pytest.mark.parametrize("count", [2, 4])
def test_a_similarity_is_recovered_exactly(model, turn, count):
    clicks, matrix = _clicked(model, turn, 2.3, (300.0, 240.0))
    placement = placed(model, dict(list(clicks.items())[:count]), SIZE)
    expected = model.seen @ matrix.T + (300.0, 240.0)
    np.testing.assert_allclose(placement.pixels(model.seen), expected, atol=1e-9)
    np.testing.assert_allclose(placement.millimetres(expected), model.seen, atol=1e-9)


def test_the_order_within_a_pair_does_not_matter(model):
    clicks, _ = _clicked(model, 0.2, 2.0, (320.0, 240.0))
    right, left, eye_right, eye_left = (clicks[name] for name in CLICKED)
    assert named_clicks([left, right, eye_right, eye_left]) == _plain(clicks)
    assert named_clicks([right, left, eye_left, eye_right]) == _plain(clicks)


def test_a_face_on_its_side_is_told_by_its_eyes(model):
    clicks, _ = _clicked(model, 1.6, 2.0, (320.0, 240.0))
    assert named_clicks([clicks[name] for name in CLICKED]) == _plain(clicks)


def test_what_lies_far_back_is_seen_smaller(model):
    far = model.rest[:, 2] < model.rest[list(model.landmarks.values())[:4], 2].mean() - 1.0
    assert far.any()
    assert (np.linalg.norm(model.seen, axis=1) < np.linalg.norm(model.rest[:, :2], axis=1))[far].all()


@pytest.mark.parametrize("points", [[(1.0, 2.0)], [(1.0, 2.0)] * 3, []])
def test_other_numbers_of_points_are_refused(points):
    with pytest.raises(UserFacingError, match="2 or 4"):
        named_clicks(points)


@pytest.mark.parametrize(
    ("mouth", "why"), [(((300, 300), (305, 300)), "apart"), (((300, 300), (900, 300)), "outside"),
                       (((-3, 300), (300, 300)), "outside")]
)  # fmt: skip
def test_impossible_clicks_are_refused(model, mouth, why):
    with pytest.raises(UserFacingError, match=why):
        placed(model, dict(zip(CLICKED, mouth)), SIZE)


@pytest.mark.parametrize("eyes", [((250, 330), (390, 330)), ((320, 330), (321, 330)), ((10, 10), (10, 470))])
def test_eyes_that_lie_nowhere_near_a_face_are_refused(model, eyes):
    clicks = dict(zip(CLICKED, ((250, 330), (390, 330), *eyes)))
    with pytest.raises(UserFacingError, match="do not lie as"):
        placed(model, clicks, SIZE)


@pytest.mark.parametrize("shape", [(0.75, 1.0), (1.0, 0.75), (1.2, 0.9)])
def test_a_turned_a_nodding_and_a_broad_face_are_laid(model, shape):
    clicks, _ = _clicked(model, 0.0, 2.0, (320.0, 240.0))
    squeezed = {
        name: (320.0 + shape[0] * (x - 320.0), 240.0 + shape[1] * (y - 240.0)) for name, (x, y) in clicks.items()
    }
    assert placed(model, squeezed, SIZE).scale > 0
