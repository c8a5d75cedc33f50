"""Splats by GL against the numpy reference.

Tolerance: float32 sums of up to thousands of splats differ by about 1e-6; a pixel on the very edge of a splat's square
may fall on either side of it, which is worth ρ·exp(−9/2) at most a splat.
"""

import numpy as np
import pytest

from core.manifold.splat import splat_image
from gpu.gl.splats import SplatRenderer

BOUNDS = (-3.0, -2.0, 3.0, 2.0)


@pytest.fixture(scope="module")
def splats(offscreen):
    made = SplatRenderer(offscreen.ctx)
    yield made
    made.release()


@pytest.mark.parametrize(
    ("n", "sigma_px", "rho", "size"),
    [(1, 5.0, 0.9, (40, 30)), (200, 3.0, 0.3, (160, 90)), (3000, 8.0, 0.02, (128, 128)), (500, 0.7, 0.5, (301, 77))],
)
def test_gl_and_numpy_agree(splats, n, sigma_px, rho, size):
    chance = np.random.default_rng(n)
    points, colours = chance.normal(size=(n, 2)), chance.random((n, 3))
    reference = splat_image(points, colours, sigma_px, rho, BOUNDS, size)
    image = splats.image(points, colours, sigma_px, rho, BOUNDS, size)
    assert image.shape == reference.shape
    assert image.dtype == np.float32
    difference = np.abs(image - reference)
    assert difference.max() <= 2 * rho * np.exp(-4.5)
    assert np.quantile(difference, 0.98) < 2e-5


def test_drawn_in_pieces_it_is_the_same_picture_and_can_be_stopped(splats):
    chance = np.random.default_rng(8)
    points, colours = chance.normal(size=(5000, 2)), chance.random((5000, 3))
    arguments = points, colours, 8.0, 0.01, BOUNDS, (128, 128)
    shares = []
    pieces = splats.image(*arguments, between=shares.append)
    assert len(shares) > 3
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert np.array_equal(pieces, splats.image(*arguments))

    def stop(_share):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        splats.image(*arguments, between=stop)
    assert np.array_equal(pieces, splats.image(*arguments))


def test_no_points_and_points_that_are_not_numbers_leave_it_dark(splats):
    assert not splats.image(np.empty((0, 2)), np.empty((0, 3)), 4.0, 0.5, BOUNDS, (20, 10)).any()
    assert not splats.image(np.full((2, 2), np.nan), np.ones((2, 3)), 4.0, 0.5, BOUNDS, (20, 10)).any()


def test_the_same_size_again_starts_from_black(splats):
    point, colour = np.zeros((1, 2)), np.ones((1, 3))
    first = splats.image(point, colour, 4.0, 0.5, BOUNDS, (21, 21))
    np.testing.assert_array_equal(splats.image(point, colour, 4.0, 0.5, BOUNDS, (21, 21)), first)
