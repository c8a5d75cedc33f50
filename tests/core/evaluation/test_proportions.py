import pytest
from scipy.stats import binom, binomtest

from core.errors import UserFacingError
from core.evaluation.proportions import share_interval


@pytest.mark.parametrize(("count", "of"), [(0, 20), (1, 20), (7, 20), (17, 20), (20, 20), (3, 3), (55, 130)])
@pytest.mark.parametrize("confidence", [0.9, 0.95])
def test_both_intervals_are_another_librarys(count, of, confidence):
    test = binomtest(count, of)
    for kind in ("wilson", "exact"):
        expected = test.proportion_ci(confidence, kind)
        assert share_interval(count, of, kind, confidence) == pytest.approx((expected.low, expected.high), abs=1e-9)


def test_wilson_as_a_textbook_has_it():
    """Newcombe (1998), table I: 81 of 263 and 15 of 148, method 3."""
    assert share_interval(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert share_interval(15, 148) == pytest.approx((0.0624, 0.1605), abs=5e-5)


@pytest.mark.parametrize("truth", [0.1, 0.35, 0.5, 0.8])
def test_the_exact_one_holds_the_truth_as_often_as_it_says(truth):
    held = sum(
        binom.pmf(count, 20, truth)
        for count in range(21)
        if share_interval(count, 20, "exact")[0] <= truth <= share_interval(count, 20, "exact")[1]
    )
    assert held >= 0.95


def test_nobody_asked_nothing_known():
    assert share_interval(0, 0) == (0.0, 1.0)


def test_what_there_is_not_is_told():
    with pytest.raises(UserFacingError, match="no interval 'wald'"):
        share_interval(1, 2, "wald")
