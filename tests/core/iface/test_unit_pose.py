import numpy as np
import pytest
from scipy.optimize import lsq_linear

from core.errors import UserFacingError
from core.iface.motion_unit import MotionUnits
from core.iface.unit_pose import UnitPose

N_POINTS = 8


@pytest.fixture(scope="module")
def units():
    rng = np.random.default_rng(4)
    mixing = rng.standard_normal((24, 24)) * np.geomspace(6, 0.1, 24)[:, None]
    moved = {
        name: (rng.standard_normal((300, 24)) @ mixing + 5 * rng.standard_normal(24)).reshape(300, N_POINTS, 3)
        for name in ("neutral", "anger")
    }
    return MotionUnits.fit(moved, 4, 2)


def test_all_at_zero_is_the_mean_of_neutral_speech(units):
    np.testing.assert_allclose(UnitPose.mean(units).deformation().ravel(), units.utterance.mean)


def test_one_deviation_is_one_standard_deviation_of_the_speech(units):
    pose = UnitPose.mean(units).moved(2, 1.0)
    step = pose.deformation() - UnitPose.mean(units).deformation()
    assert np.linalg.norm(step) == pytest.approx(np.sqrt(units.utterance.variance[2]))
    assert np.count_nonzero(pose.deviations) == 1


def test_intensity_scales_what_the_expression_adds(units):
    deviations = np.random.default_rng(5).standard_normal(6)
    none, half, full = (UnitPose(units, deviations, "anger", a).deformation() for a in (0.0, 0.5, 1.0))
    np.testing.assert_allclose(half, (none + full) / 2)
    np.testing.assert_allclose(none, UnitPose(units, deviations[:4]).deformation())


@pytest.mark.parametrize(("expression", "intensity"), [("neutral", 1.0), ("anger", 1.0), ("anger", 0.4)])
def test_nearest_is_the_least_squares_fit_of_equation_2(units, expression, intensity):
    wanted = 8 * np.random.default_rng(6).standard_normal((N_POINTS, 3))
    found = UnitPose.nearest(units, wanted, expression, intensity)
    base = UnitPose.mean(units, expression, intensity)
    columns = [
        (base.moved(i, 1.0).deformation() - base.deformation()).ravel() for i in range(units.n_parameters(expression))
    ]
    expected = lsq_linear(np.array(columns).T, (wanted - base.deformation()).ravel()).x
    np.testing.assert_allclose(found.deviations, expected, atol=1e-8)


def test_at_no_intensity_the_expression_stays_at_its_mean(units):
    found = UnitPose.nearest(units, np.ones((N_POINTS, 3)), "anger", 0.0)
    np.testing.assert_array_equal(found.deviations[4:], 0.0)
    np.testing.assert_allclose(found.deviations[:4], UnitPose.nearest(units, np.ones((N_POINTS, 3))).deviations)


def test_an_expression_that_there_is_not_is_told(units):
    with pytest.raises(UserFacingError, match="no motion units for 'joy'"):
        UnitPose.mean(units, "joy")
