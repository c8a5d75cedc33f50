"""Points are followed to a known place, or known to be lost."""

import cv2
import numpy as np
import pytest

from core.tracking.optical_flow import followed, look_of


def _texture(seed=0, size=(240, 320)):
    noise = np.random.default_rng(seed).normal(size=size).astype(np.float32)
    # spots of several sizes, as a face has
    spots = sum(blurred / blurred.std() for blurred in (cv2.GaussianBlur(noise, (0, 0), s) for s in (2.5, 5.0, 9.0)))
    return 128 + 26 * spots


def _moved(texture, by):
    matrix = np.array([[1.0, 0.0, by[0]], [0.0, 1.0, by[1]]])
    return cv2.warpAffine(texture, matrix, texture.shape[::-1], flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)


def _look(texture):
    return look_of(np.clip(np.rint(texture), 0, 255).astype(np.uint8))


POINTS = np.random.default_rng(1).uniform([60, 60], [260, 180], (30, 2))


@pytest.mark.parametrize("by", [(0.0, 0.0), (3.4, -2.2), (-9.3, 6.8)])
def test_a_shift_is_found_to_a_fraction_of_a_pixel(by):
    texture = _texture()
    flow = followed(_look(texture), _look(_moved(texture, by)), POINTS, POINTS)
    assert np.linalg.norm(flow.points - POINTS - by, axis=1).max() < 0.15
    assert flow.trust.min() > 0.8


def test_light_that_changes_slowly_across_the_picture_does_not_matter():
    texture = _texture()
    lamp = np.linspace(0.5, 1.2, 320)[None]
    flow = followed(_look(texture), _look(_moved(texture, (2.5, 1.5)) * lamp), POINTS, POINTS)
    assert np.linalg.norm(flow.points - POINTS - (2.5, 1.5), axis=1).max() < 0.3


def test_points_of_another_picture_are_hardly_trusted():
    flow = followed(_look(_texture(0)), _look(_texture(9)), POINTS, POINTS)
    assert flow.trust.mean() < 0.3


def test_a_black_picture_gives_no_trust():
    flow = followed(_look(_texture()), look_of(np.zeros((240, 320), np.uint8)), POINTS, POINTS)
    assert flow.trust.max() == 0.0


def test_points_that_leave_the_picture_have_no_trust():
    texture = _texture()
    beside = np.array([[10.0, 100.0], [160.0, 120.0]])
    flow = followed(_look(texture), _look(_moved(texture, (-15.0, 0.0))), beside, beside)
    assert flow.trust[0] == 0.0
    assert flow.trust[1] > 0.8
