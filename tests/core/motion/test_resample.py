import numpy as np
import pytest
from scipy.signal import resample_poly

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


def strength(track: np.ndarray, rate_hz: float, at_hz: float) -> float:
    """Amplitude of a wave in the middle of a track, by its Fourier sum; windowed, for waves that do not fit evenly."""
    window = np.hanning(len(track))
    return (
        2 * abs((track * window * np.exp(-2j * np.pi * at_hz * np.arange(len(track)) / rate_hz)).sum()) / window.sum()
    )


@pytest.mark.parametrize(("rate_hz", "new_hz"), [(240, 120), (240, 100), (240, 60), (120, 30), (120, 25), (60, 25)])
def test_going_down_every_wave_is_weakened_as_stated_and_none_comes_back_as_another(rate_hz, new_hz):
    cutoff_hz = new_hz / 2
    for share in (0.2, 0.5, 0.8, 1.3, 1.6):
        wave_hz = share * cutoff_hz
        if wave_hz > 0.8 * rate_hz / 2:
            continue
        wave = np.sin(2 * np.pi * wave_hz * np.arange(20 * rate_hz) / rate_hz)
        seen_at_hz = wave_hz if share < 1 else new_hz - wave_hz
        left = strength(resample(wave, rate_hz, new_hz, 20 * new_hz), new_hz, seen_at_hz)
        assert left == pytest.approx(2 ** -(share**2), abs=0.03)


@pytest.mark.parametrize(("rate_hz", "new_hz"), [(25, 120), (30, 120), (60, 120), (100, 120), (240, 120)])
def test_slow_motion_is_what_scipys_polyphase_filter_makes_of_it(rate_hz, new_hz):
    """Waves up to 4 Hz, as jaws and lips move; scipy's windowed sinc is another method altogether."""
    times = np.arange(8 * rate_hz) / rate_hz
    motion = sum(a * np.sin(2 * np.pi * f * times + f) for a, f in ((9.0, 0.7), (5.0, 2.1), (2.0, 4.0)))
    gcd = np.gcd(rate_hz, new_hz)
    theirs = resample_poly(motion, new_hz // gcd, rate_hz // gcd, window=("kaiser", 10.0), padtype="line")
    ours = resample(motion, rate_hz, new_hz, 8 * new_hz)
    middle = slice(new_hz, 7 * new_hz)
    assert np.abs(ours[middle] - theirs[middle]).max() < 0.02


def test_a_track_of_many_columns_is_each_of_them_alone():
    tracks = np.random.default_rng(0).normal(size=(240, 4, 3)).cumsum(axis=0)
    for new_hz in (60, 119.88, 200):
        together = resample(tracks, 120, new_hz, int(2 * new_hz))
        alone = resample(tracks[:, 2, 1], 120, new_hz, int(2 * new_hz))
        np.testing.assert_allclose(together[:, 2, 1], alone, atol=1e-12)


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
