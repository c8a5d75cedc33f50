import numpy as np
import pytest
from sklearn.decomposition import PCA

from core.errors import UserFacingError
from core.iface.motion_unit import MotionUnits

N_POINTS = 12


def orthonormal(rng, n_rows, n_columns):
    return np.linalg.qr(rng.standard_normal((n_columns, n_rows)))[0].T


@pytest.fixture(scope="module")
def known():
    """A linear model: three ways to speak, and two more when smiling, over a mean each."""
    rng = np.random.default_rng(1)
    rows = orthonormal(rng, 7, N_POINTS * 3)
    spoken, smile, m00 = rows[:3], rows[3:5], 4 * rows[5]
    offset = 6 * rows[6]
    c0 = rng.standard_normal((4000, 3)) * [9, 5, 2]
    neutral = m00 + c0 @ spoken
    c0k, ck = rng.standard_normal((3000, 3)) * [9, 5, 2], rng.standard_normal((3000, 2)) * [3, 1]
    smiling = m00 + c0k @ spoken + offset + ck @ smile
    data = {"neutral": neutral.reshape(-1, N_POINTS, 3), "smile": smiling.reshape(-1, N_POINTS, 3)}
    return data, spoken, smile, offset


def span(rows):
    return rows.T @ rows


def test_a_known_linear_model_is_recovered(known):
    data, spoken, smile, offset = known
    units = MotionUnits.fit(data, n_utterance=3, n_expression=2)
    np.testing.assert_allclose(span(units.utterance.units), span(spoken), atol=1e-8)
    np.testing.assert_allclose(span(units.expressions["smile"].units), span(smile), atol=1e-8)
    # the smile's mean is its offset, up to the mean of its own parameters (300 samples a standard deviation)
    np.testing.assert_allclose(
        units.expressions["smile"].mean - units.expressions["smile"].mean @ span(smile), offset, atol=1e-8
    )
    for name in data:
        again = units.deformations(units.parameters(data[name], name), name)
        np.testing.assert_allclose(again, data[name], atol=1e-8)


def test_the_covered_share_decides_how_many_units_there_are(known):
    data = known[0]
    by_another = PCA().fit(data["neutral"].reshape(4000, -1))
    shares = np.cumsum(by_another.explained_variance_ratio_)
    for wanted in (0.5, 0.8, 0.99):
        units = MotionUnits.fit(data, n_utterance=wanted)
        count = int((shares < wanted).sum()) + 1
        assert len(units.utterance.units) == count
        assert units.utterance.coverage == pytest.approx(shares[count - 1])
        assert units.covered(data["neutral"]) == pytest.approx(shares[count - 1])


def test_the_mean_is_counted_once(known):
    """Equation 1 as printed would leave m_00 in the residual, and equation 2 would then add it twice."""
    data = known[0]
    units = MotionUnits.fit(data, n_utterance=3, n_expression=2)
    middle = data["smile"].mean(axis=0)
    fitted = units.deformations(units.parameters(middle, "smile"), "smile")
    np.testing.assert_allclose(fitted, middle, atol=1e-8)


def test_parameters_are_the_least_squares_fit_of_equation_2(known):
    data, *_ = known
    units = MotionUnits.fit(data, n_utterance=2, n_expression=1)
    face = np.random.default_rng(3).standard_normal((N_POINTS, 3))
    both = np.concatenate([units.utterance.units, units.expressions["smile"].units])
    means = units.utterance.mean + units.expressions["smile"].mean
    expected = np.linalg.lstsq(both.T, face.reshape(-1) - means, rcond=None)[0]
    np.testing.assert_allclose(units.parameters(face, "smile"), expected, atol=1e-10)


def test_two_axes_do_as_well_as_three(known):
    flat = {name: frames[:, :, :2] for name, frames in known[0].items()}
    units = MotionUnits.fit(flat, n_utterance=7)
    np.testing.assert_allclose(units.deformations(units.parameters(flat["neutral"])), flat["neutral"], atol=1e-8)


def test_intensity_scales_what_the_expression_adds(known):
    data = known[0]
    units = MotionUnits.fit(data, n_utterance=3)
    parameters = units.parameters(data["smile"][:5], "smile")
    none, half, whole = (units.deformations(parameters, "smile", share) for share in (0.0, 0.5, 1.0))
    np.testing.assert_allclose(half, (none + whole) / 2)
    np.testing.assert_allclose(none, units.deformations(parameters[:, :3]))


def test_what_cannot_be_learned_is_one_sentence(known):
    with pytest.raises(UserFacingError, match="no neutral speech"):
        MotionUnits.fit({"smile": known[0]["smile"]})
    with pytest.raises(UserFacingError, match="two frames of 'smile'"):
        MotionUnits.fit({"neutral": known[0]["neutral"], "smile": known[0]["smile"][:1]})
    with pytest.raises(UserFacingError, match="for 'rage'"):
        MotionUnits.fit(known[0]).parameters(known[0]["smile"], "rage")


def test_a_face_that_never_moves_has_no_units():
    units = MotionUnits.fit({"neutral": np.ones((5, N_POINTS, 3))})
    assert units.n_parameters() == 0
    np.testing.assert_array_equal(units.deformations(np.zeros((2, 0))), np.ones((2, N_POINTS, 3)))
