"""Videos as phones and editors leave them: read upright and in time, or refused in one sentence."""

import struct
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.video import write_video
from core.media.video_reader import VideoReader
from core.tracking.track import TrackingRequest, track_video
from core.tracking.video_pictures import format_of, pictures, sound_of


def _ramps(n=12, width=96, height=80):
    """Pictures that grow brighter to the right, each a little more than the last."""
    across = np.linspace(20, 180, width)[None, :, None]
    return [np.broadcast_to(across + 4.0 * f, (height, width, 3)).astype(np.uint8) for f in range(n)]


def _hum(seconds):
    return Audio(
        (0.3 * np.sin(2 * np.pi * 220 * np.arange(round(16_000 * seconds)) / 16_000)).astype(np.float32), 16_000
    )


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_pictures_come_in_order_and_again_from_any_time(tmp_path, suffix):
    path = tmp_path / f"ramps{suffix}"
    write_video(path, _ramps(), 12, Fraction(25))
    form = format_of(path)
    assert (form.width, form.height, form.rate_hz, form.n_frames) == (96, 80, 25.0, 12)
    every = list(pictures(path))
    np.testing.assert_allclose([p.time_s for p in every], np.arange(12) / 25, atol=1e-6)
    assert all(b.grey.mean() > a.grey.mean() + 1 for a, b in pairwise(every))
    for f in (1, 7, 11):
        again = list(pictures(path, from_s=every[f].time_s))
        assert len(again) == 12 - f
        assert all(np.array_equal(a.grey, b.grey) for a, b in zip(again, every[f:]))


def test_smaller_pictures_show_the_same(tmp_path):
    write_video(tmp_path / "r.avi", _ramps(), 12, Fraction(25))
    whole, half = (next(pictures(tmp_path / "r.avi", share)).grey for share in (1.0, 0.5))
    assert half.shape == (40, 48)
    np.testing.assert_allclose(half, whole.reshape(40, 2, 48, 2).mean(axis=(1, 3)), atol=1.5)


def _lying_down(path):
    """Write into an MP4 that it is to be shown a quarter turn to the right, as phones do."""
    raw = bytearray(path.read_bytes())
    at = raw.index(b"tkhd") + 4 + 40
    raw[at : at + 36] = struct.pack(">9i", 0, 1 << 16, 0, -(1 << 16), 0, 0, 0, 0, 1 << 30)
    path.write_bytes(raw)


def test_a_film_that_lies_down_is_turned_upright(tmp_path):
    write_video(tmp_path / "r.mp4", _ramps(), 12, Fraction(25))
    lying = next(pictures(tmp_path / "r.mp4")).grey
    _lying_down(tmp_path / "r.mp4")
    upright = next(pictures(tmp_path / "r.mp4")).grey
    np.testing.assert_array_equal(upright, np.rot90(lying, -1))
    assert (format_of(tmp_path / "r.mp4").width, format_of(tmp_path / "r.mp4").height) == (80, 96)
    reader = VideoReader(tmp_path / "r.mp4")  # as the window shows it
    assert np.corrcoef(reader.frame_at(0.0)[..., 1].ravel(), upright.ravel())[0, 1] > 0.99
    reader.close()


def test_the_sound_is_that_of_the_film(tmp_path):
    write_video(tmp_path / "r.avi", _ramps(25), 25, Fraction(25), _hum(1.0))
    sound = sound_of(tmp_path / "r.avi")
    assert sound.rate_hz == 16_000
    np.testing.assert_allclose(sound.samples, _hum(1.0).samples, atol=2e-4)
    write_video(tmp_path / "silent.avi", _ramps(), 12, Fraction(25))
    assert sound_of(tmp_path / "silent.avi") is None


def test_tiny_pictures_are_refused(tmp_path):
    write_video(tmp_path / "tiny.avi", _ramps(width=48, height=32), 12, Fraction(25))
    with pytest.raises(UserFacingError, match="only 48 by 32 pixels"):
        format_of(tmp_path / "tiny.avi")


def test_what_is_no_video_is_refused(tmp_path):
    (tmp_path / "empty.mp4").write_bytes(b"")
    (tmp_path / "text.mp4").write_text("frame,time_s\n")
    for name in ("empty.mp4", "text.mp4", "none.mp4", "."):
        with pytest.raises(UserFacingError):
            format_of(tmp_path / name)
    import soundfile

    soundfile.write(tmp_path / "only.wav", _hum(0.5).samples, 16_000)
    with pytest.raises(UserFacingError, match="no pictures"):
        format_of(tmp_path / "only.wav")


def test_a_film_that_breaks_off_is_tracked_as_far_as_it_goes(tmp_path, film, sheet, model, clicks):
    whole = film(sheet(), tmp_path / "whole.avi")
    raw = whole.read_bytes()
    (tmp_path / "cut.avi").write_bytes(raw[: len(raw) // 2])
    track = track_video(TrackingRequest(tmp_path / "cut.avi", model, clicks))
    assert 6 < len(track.points) < 24
    every = track_video(TrackingRequest(whole, model, clicks))
    whole_ones = len(track.points) - 1  # the last one may be half a picture
    np.testing.assert_array_equal(track.points[:whole_ones], every.points[:whole_ones])


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_damaged_films_are_read_or_refused(tmp_path, survives_damage, suffix):
    path = tmp_path / f"r{suffix}"
    write_video(path, _ramps(6), 6, Fraction(25), _hum(0.2))

    def read(copy):
        format_of(copy)
        list(pictures(copy))
        sound_of(copy)

    survives_damage(path, read, 40)
