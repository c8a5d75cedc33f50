import numpy as np
import pytest

from core.motion.resample import fill_gaps, resample


def test_a_slow_wave_survives_going_up():
    times = np.arange(75) / 25
    wave = np.sin(2 * np.pi * 3 * times)
    raised = resample(wave, 25, 120, 357)
    expected = np.sin(2 * np.pi * 3 * np.arange(357) / 120)
    inside = slice(12, 340)
    assert np.abs(raised[inside] - expected[inside]).max() < 0.02
    assert raised[::24][1:10] == pytest.approx(wave[::5][1:10], abs=1e-12)


def test_going_down_takes_out_what_cannot_be_carried():
    times = np.arange(2400) / 240
    kept = resample(np.sin(2 * np.pi * 5 * times), 240, 60, 600)
    gone = resample(np.sin(2 * np.pi * 100 * times), 240, 60, 600)
    assert np.abs(kept).max() > 0.95
    assert np.abs(gone[20:-20]).max() < 0.05


@pytest.mark.parametrize("n_old", [1, 2, 3])
def test_short_tracks_are_held(n_old):
    values = np.arange(n_old * 2.0).reshape(n_old, 2)
    raised = resample(values, 30, 120, 20)
    assert raised.shape == (20, 2)
    assert raised[0] == pytest.approx(values[0])
    assert raised[-1] == pytest.approx(values[-1])


def test_no_frames_is_refused():
    with pytest.raises(ValueError, match="without frames"):
        resample(np.zeros((0, 3)), 30, 120, 5)


def test_short_gaps_are_bridged_and_long_ones_masked():
    line = np.repeat(np.arange(40.0)[:, None, None], 3, axis=2).repeat(2, axis=1)
    holed = line.copy()
    holed[5:9, 0] = np.nan
    holed[20:32, 1] = np.nan
    holed[38:, 0] = np.nan
    filled, n_filled, masked = fill_gaps(holed, longest_frames=6)
    assert n_filled == 6
    assert filled[5:9] == pytest.approx(line[5:9])
    assert np.flatnonzero(masked).tolist() == list(range(20, 32))
    assert np.isfinite(filled).all()


def test_a_marker_that_was_never_seen_masks_everything():
    positions = np.zeros((10, 2, 3))
    positions[:, 1] = np.nan
    filled, _, masked = fill_gaps(positions, 5)
    assert masked.all()
    assert np.isfinite(filled).all()
