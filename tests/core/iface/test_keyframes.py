import numpy as np
import pytest
from scipy.optimize import nnls

from core.iface.keyframes import Keyframes, parameters_of_weights, weights_of_parameters
from core.iface.motion_unit import MotionUnits

N_POINTS, NAMES = 10, ("smile", "a", "o", "m")


@pytest.fixture(scope="module", params=[False, True], ids=["whole shapes", "displacements"])
def keyframes(request):
    rng = np.random.default_rng(5)
    neutral = 40 * rng.standard_normal((N_POINTS, 3))
    shapes = neutral + 5 * rng.standard_normal((len(NAMES), N_POINTS, 3))
    return Keyframes(NAMES, shapes, neutral, request.param)


def units_that_span(keyframes):
    """Units learned from mixes of the keyframes, so that nothing is lost between the two."""
    weights = np.random.default_rng(6).uniform(-1, 2, (500, len(NAMES)))
    return MotionUnits.fit({"neutral": keyframes.faces(weights) - keyframes.neutral}, n_utterance=len(NAMES))


def test_weights_travel_to_parameters_and_back(keyframes):
    units = units_that_span(keyframes)
    weights = np.random.default_rng(7).uniform(0, 1, (20, len(NAMES)))
    parameters = parameters_of_weights(units, keyframes, weights)
    np.testing.assert_allclose(weights_of_parameters(units, keyframes, parameters), weights, atol=1e-8)


def test_equation_4_as_printed(keyframes):
    units = units_that_span(keyframes)
    parameters = np.random.default_rng(8).standard_normal(units.n_parameters())
    face = (units.deformations(parameters) + keyframes.neutral).reshape(-1)
    if keyframes.of_displacements:
        matrix, wanted = (
            (keyframes.shapes - keyframes.neutral).reshape(len(NAMES), -1).T,
            face - keyframes.neutral.ravel(),
        )
    else:
        matrix, wanted = keyframes.shapes.reshape(len(NAMES), -1).T, face
    printed = np.linalg.inv(matrix.T @ matrix) @ matrix.T @ wanted
    np.testing.assert_allclose(weights_of_parameters(units, keyframes, parameters), printed, atol=1e-7)


def test_only_displacements_know_neutral(keyframes):
    weights = keyframes.weights(keyframes.neutral)
    missed = np.abs(keyframes.faces(weights) - keyframes.neutral).max()
    if keyframes.of_displacements:
        np.testing.assert_allclose(weights, 0.0, atol=1e-10)
        assert missed < 1e-9
    else:
        assert missed > 0.1


def test_bounded_weights_stay_within_and_are_the_best_there(keyframes):
    faces = keyframes.faces(np.random.default_rng(9).uniform(-0.5, 1.5, (6, len(NAMES))))
    weights = keyframes.weights(faces, bounded=True)
    assert weights.min() >= 0.0 and weights.max() <= 1.0
    error = ((keyframes.faces(weights) - faces) ** 2).sum(axis=(1, 2))
    for other in np.random.default_rng(10).uniform(0, 1, (300, len(NAMES))):
        assert (((keyframes.faces(other) - faces) ** 2).sum(axis=(1, 2)) >= error - 1e-6).all()


def test_where_only_the_lower_bound_holds_another_library_agrees():
    rng = np.random.default_rng(11)
    neutral = np.zeros((N_POINTS, 3))
    keyframes = Keyframes(NAMES, rng.standard_normal((len(NAMES), N_POINTS, 3)), neutral, True)
    face = keyframes.faces(np.array([0.6, -0.4, 0.3, -0.2])) + 0.01 * rng.standard_normal((N_POINTS, 3))
    expected = nnls(keyframes.shapes.reshape(len(NAMES), -1).T, face.reshape(-1))[0]
    assert expected.max() < 1.0
    np.testing.assert_allclose(keyframes.weights(face, bounded=True), expected, atol=1e-6)


def test_keyframes_that_repeat_one_another_do_no_harm():
    neutral = np.zeros((N_POINTS, 3))
    shape = np.random.default_rng(12).standard_normal((N_POINTS, 3))
    twice = Keyframes(("a", "again"), np.array([shape, shape]), neutral, True)
    np.testing.assert_allclose(twice.weights(shape), [0.5, 0.5])
