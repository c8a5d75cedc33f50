import numpy as np
import pytest
from sklearn.decomposition import PCA

from core.iface.coverage import covered_by_count
from core.iface.motion_unit import MotionUnits


@pytest.fixture(scope="module")
def moved():
    rng = np.random.default_rng(1)
    mixing = rng.standard_normal((12, 12))
    return {name: (rng.standard_normal((60, 12)) @ mixing).reshape(60, 4, 3) for name in ("neutral", "anger")}


def test_shares_are_those_of_another_library(moved):
    shares = covered_by_count(moved, 3)
    pca = PCA().fit(moved["neutral"].reshape(60, -1))
    np.testing.assert_allclose(shares["neutral"], [0, *np.cumsum(pca.explained_variance_ratio_)], atol=1e-9)
    basis = pca.components_[:3]
    left = moved["anger"].reshape(60, -1) - pca.mean_
    left -= left @ basis.T @ basis
    expected = np.cumsum(PCA().fit(left).explained_variance_ratio_)
    np.testing.assert_allclose(shares["anger"], [0, *expected], atol=1e-9)


def test_a_share_asked_for_is_reached_by_so_many_units_and_no_fewer(moved):
    shares = covered_by_count(moved, 3)
    for asked in (0.3, 0.7, 0.95):
        count = len(MotionUnits.fit(moved, asked).utterance.units)
        assert shares["neutral"][count - 1] < asked <= shares["neutral"][count] + 1e-12


def test_a_face_that_never_moves_is_covered_by_no_unit():
    shares = covered_by_count({"neutral": np.ones((5, 2, 3))}, 1)
    np.testing.assert_array_equal(shares["neutral"], np.ones(7))
