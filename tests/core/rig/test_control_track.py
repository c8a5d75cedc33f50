import numpy as np
import pytest

from core.errors import UserFacingError
from core.rig.control_track import ControlTrack


def track(values, rate_hz=25.0, **more):
    values = np.asarray(values, float)
    return ControlTrack(tuple(f"c{u}" for u in range(values.shape[1])), values, rate_hz, **more)


def test_sampling_at_a_multiple_of_the_rate_keeps_every_frame():
    rng = np.random.default_rng(1)
    curves = track(rng.uniform(size=(20, 3)))
    fine = curves.at_rate(100)
    assert len(fine) == 80 and fine.rate_hz == 100
    np.testing.assert_allclose(fine.values[::4], curves.values, atol=1e-6)


@pytest.mark.parametrize("rate_hz", [7.0, 24.0, 30000 / 1001, 60.0, 333.3])
def test_at_no_rate_do_curves_leave_the_span_that_they_were_in(rate_hz):
    rng = np.random.default_rng(2)
    sampled = track(rng.integers(0, 2, size=(60, 4))).at_rate(rate_hz)
    assert sampled.values.min() >= 0 and sampled.values.max() <= 1
    assert not sampled.beyond()
    assert abs(sampled.duration_s - 60 / 25) <= 1 / rate_hz


def test_a_ramp_is_a_ramp_at_any_rate_and_its_end_is_held():
    ramp = track(np.arange(10)[:, None] / 10, rate_hz=10.0)
    np.testing.assert_allclose(ramp.at_rate(40, 44).values[:37, 0], np.arange(37) / 40, atol=1e-6)
    assert (ramp.at_rate(40, 44).values[37:] == ramp.values[-1]).all()


def test_one_frame_is_held():
    assert (track([[0.25]]).at_rate(60, 5).values == 0.25).all()


def test_the_start_stays_the_same_moment():
    assert track(np.zeros((5, 1)), start_frame=25 * 3600).at_rate(60).start_frame == 60 * 3600


def test_clipping_is_asked_for_and_told():
    curves = track([[-0.2, 0.5], [1.4, 0.6]])
    assert curves.values.max() > 1
    assert curves.beyond() == ("c0",)
    assert curves.clipped().values[:, 0].tolist() == [0.0, 1.0]
    assert not curves.clipped().beyond()


def test_controls_are_arranged_by_name_and_rest_where_there_is_none():
    arranged = track([[1.0, 2.0]]).arranged(["c1", "other", "c0"])
    assert arranged.values.tolist() == [[2.0, 0.0, 1.0]]


def test_a_part_begins_where_its_first_frame_was():
    part = track(np.arange(50)[:, None], rate_hz=25.0, start_frame=100).between(1.0, 1.2)
    assert part.values[:, 0].tolist() == [25, 26, 27, 28, 29] and part.start_frame == 125


@pytest.mark.parametrize(
    ("names", "values"), [(("a", "a"), [[0, 0]]), (("", "b"), [[0, 0]]), (("a", "b"), [[0, np.nan]])]
)
def test_bad_names_and_numbers_are_refused(names, values):
    with pytest.raises(UserFacingError):
        ControlTrack(names, np.array(values, float), 25.0)


def test_what_is_not_there_is_refused_by_name():
    with pytest.raises(UserFacingError, match="jawOpen"):
        track([[0.0]]).column("jawOpen")
    with pytest.raises(UserFacingError, match="no frame"):
        track([[0.0]]).between(3, 4)
