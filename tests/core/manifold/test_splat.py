"""The splat image of equation 3, checked by hand."""

import numpy as np
import pytest

from core.manifold.splat import splat_image

SQUARE = (0.0, 0.0, 10.0, 10.0)
SIZE = (10, 10)


def test_one_point_shines_with_rho_at_its_place_and_falls_as_a_gaussian():
    image = splat_image([[2.5, 7.5]], [[1.0, 0.5, 0.0]], 2.0, 0.4, SQUARE, SIZE)
    np.testing.assert_allclose(image[2, 2], [0.4, 0.2, 0.0], atol=1e-7)  # row 2 from the top
    np.testing.assert_allclose(image[2, 5, 0], 0.4 * np.exp(-9 / 8), rtol=1e-6)
    np.testing.assert_allclose(image[5, 6, 0], 0.4 * np.exp(-25 / 8), rtol=1e-6)


def test_splats_add_up_in_any_order_and_never_pass_one():
    chance = np.random.default_rng(3)
    points, colours = chance.uniform(0, 10, (30, 2)), chance.random((30, 3))
    image = splat_image(points, colours, 1.0, 0.05, SQUARE, SIZE)
    each = sum(splat_image(p[None], c[None], 1.0, 0.05, SQUARE, SIZE) for p, c in zip(points, colours, strict=True))
    np.testing.assert_allclose(image, each, atol=1e-6)
    shuffled = chance.permutation(30)
    np.testing.assert_allclose(
        image, splat_image(points[shuffled], colours[shuffled], 1.0, 0.05, SQUARE, SIZE), atol=1e-6
    )
    assert splat_image(np.full((50, 2), 5.0), np.ones((50, 3)), 2.0, 0.5, SQUARE, SIZE).max() == 1.0


def test_beyond_three_sigma_it_is_dark():
    image = splat_image([[0.5, 5.5]], [[1.0, 1.0, 1.0]], 1.0, 0.9, SQUARE, SIZE)
    assert (image[:, :4] > 0).any()
    assert not image[:, 4:].any()


@pytest.mark.parametrize(
    "change",
    [
        {"rho": 0.0},
        {"rho": 1.0},
        {"sigma_px": 0.0},
        {"bounds": (0, 0, 0, 1)},
        {"size": (0, 4)},
        {"colours": np.ones((2, 3))},
    ],
)
def test_what_has_no_meaning_is_refused(change):
    given = {"points": [[1.0, 1.0]], "colours": [[1.0, 1.0, 1.0]], "sigma_px": 1.0, "rho": 0.5}
    with pytest.raises(ValueError):
        splat_image(**({**given, "bounds": SQUARE, "size": SIZE} | change))
