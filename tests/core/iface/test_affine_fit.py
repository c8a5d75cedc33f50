import numpy as np
import pytest
from scipy.optimize import least_squares

from core.iface.affine_fit import AffineFit, PosedUnits, linear_start, refined, too_few_points

N_POINTS, N_UNITS = 40, 5


@pytest.fixture(scope="module")
def face():
    rng = np.random.default_rng(2)
    units = np.linalg.qr(rng.standard_normal((2 * N_POINTS, N_UNITS)))[0].T.reshape(N_UNITS, N_POINTS, 2)
    return PosedUnits(40 * rng.standard_normal((N_POINTS, 2)), units)


@pytest.fixture(scope="module")
def truth():
    turn = np.deg2rad(12)
    affine = np.array([[1.9 * np.cos(turn), -2.1 * np.sin(turn), 320], [1.9 * np.sin(turn), 2.0 * np.cos(turn), 240]])
    return AffineFit(np.array([12.0, -7, 5, 3, -2]), affine)


def noisy(face, truth, sigma, seed=0):
    return truth.points(face) + sigma * np.random.default_rng(seed).standard_normal((N_POINTS, 2))


def by_another(face, points, start):
    """Equation 5 by scipy's general solver."""

    def left(x):
        return (AffineFit(x[6:], x[:6].reshape(2, 3)).points(face) - points).reshape(-1)

    x = np.concatenate([start.affine.reshape(-1), start.parameters])
    return least_squares(left, x, xtol=1e-15, ftol=1e-15, gtol=1e-15)


def squared_error(fit, face, points):
    return float(((fit.points(face) - points) ** 2).sum())


def test_the_linear_start_is_exact_without_noise(face, truth):
    fit = linear_start(face, truth.points(face))
    np.testing.assert_allclose(fit.parameters, truth.parameters, atol=1e-7)
    np.testing.assert_allclose(fit.affine, truth.affine, atol=1e-7)


def test_points_that_are_lost_or_weigh_nothing_do_not_count(face, truth):
    points = truth.points(face)
    points[3] = np.nan
    points[5] += 400
    weights = np.ones(N_POINTS)
    weights[5] = 0
    for fit in (linear_start(face, points, weights), refined(face, points, truth, weights)):
        np.testing.assert_allclose(fit.parameters, truth.parameters, atol=1e-6)


def test_as_many_points_as_unknowns_need_and_no_fewer(face, truth):
    points = truth.points(face)
    needed = 3 + 2 * N_UNITS
    weights = (np.arange(N_POINTS) < needed).astype(float)
    np.testing.assert_allclose(linear_start(face, points, weights).parameters, truth.parameters, atol=1e-4)
    weights[0] = 0
    assert too_few_points(face, needed - 1)
    with pytest.raises(ValueError, match="too few points"):
        linear_start(face, points, weights)


@pytest.mark.parametrize("seed", range(5))
def test_with_noise_refinement_reaches_the_minimum_of_equation_5(face, truth, seed):
    points = noisy(face, truth, 1.0, seed)
    start = linear_start(face, points)
    fit, other = refined(face, points, start), by_another(face, points, start)
    assert squared_error(fit, face, points) == pytest.approx(2 * other.cost, rel=1e-8)
    np.testing.assert_allclose(fit.parameters, other.x[6:], atol=1e-3)


def test_refinement_is_nearer_to_the_truth_than_its_start(face, truth):
    """The linear start leaves psi free where it must be parallel to beta."""
    errors = np.zeros(2)
    for seed in range(30):
        points = noisy(face, truth, 1.0, seed)
        start = linear_start(face, points)
        for i, fit in enumerate((start, refined(face, points, start))):
            errors[i] += np.linalg.norm(fit.points(face) - truth.points(face), axis=1).mean() / 30
    assert errors[1] < 0.95 * errors[0]


def test_refinement_never_makes_it_worse(face, truth):
    points = noisy(face, truth, 3.0, 9)
    far = AffineFit(truth.parameters * -3, truth.affine + 0.4)
    assert squared_error(refined(face, points, far), face, points) <= squared_error(far, face, points)


def test_a_prior_pulls_parameters_towards_their_mean(face, truth):
    points = noisy(face, truth, 1.0, 4)
    plain = refined(face, points, truth)
    pulled = refined(face, points, truth, prior=np.full(N_UNITS, 1e6))
    assert np.abs(pulled.parameters).max() < 0.01 * np.abs(plain.parameters).max()
