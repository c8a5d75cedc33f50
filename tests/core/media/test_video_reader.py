"""Every picture is found at its time, in any order, in every container that we write."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.video import write_video
from core.media.video_reader import VideoReader

N_FRAMES, FPS = 90, Fraction(30000, 1001)


def pictures():
    """Left half the tens, right half the ones, in shades far enough apart for any codec."""
    for k in range(N_FRAMES):
        picture = np.empty((48, 64, 3), np.uint8)
        picture[:, :32], picture[:, 32:] = 20 + 20 * (k // 10), 20 + 20 * (k % 10)
        yield picture


@pytest.fixture(scope="module", params=[".avi", ".mp4"])
def film(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("film") / f"film{request.param}"
    sound = Audio(np.zeros(round(16_000 * N_FRAMES / FPS), np.float32), 16_000)
    write_video(path, pictures(), N_FRAMES, FPS, sound)
    return path


def shown(reader: VideoReader, time_s: float) -> int:
    picture = reader.frame_at(time_s)
    tens, ones = (round((float(half.mean()) - 20) / 20) for half in (picture[:, 4:28], picture[:, 36:60]))
    return 10 * tens + ones


def test_pictures_are_found_in_any_order(film):
    reader = VideoReader(film)
    order = np.random.default_rng(2).permutation(N_FRAMES)
    for k in [*range(N_FRAMES), *order]:
        assert shown(reader, float((k + 0.5) / FPS)) == k
        assert shown(reader, float(k / FPS)) == k
    reader.close()


def test_before_the_first_and_after_the_last_picture_those_stay(film):
    reader = VideoReader(film)
    assert shown(reader, 99.0) == N_FRAMES - 1
    assert shown(reader, -3.0) == 0
    assert shown(reader, 99.0) == N_FRAMES - 1
    assert reader.duration_s == pytest.approx(N_FRAMES / FPS, abs=0.05)
    reader.close()


@pytest.mark.parametrize("content", [b"", b"RIFF", b"\x00" * 4000, b"not a film at all"])
def test_what_is_no_video_is_said_in_a_sentence(tmp_path, content):
    path = tmp_path / "x.avi"
    path.write_bytes(content)
    with pytest.raises(UserFacingError, match=r"x\.avi"):
        VideoReader(path)


def test_a_sound_file_is_no_video(tmp_path):
    import soundfile

    soundfile.write(tmp_path / "x.wav", np.zeros(1000), 8000)
    with pytest.raises(UserFacingError, match="not a video"):
        VideoReader(tmp_path / "x.wav")


def test_a_film_that_was_cut_shows_what_is_left(film, tmp_path):
    cut = tmp_path / f"cut{film.suffix}"
    cut.write_bytes(film.read_bytes()[: film.stat().st_size // 2])
    try:
        reader = VideoReader(cut)
        assert reader.frame_at(0.0).shape == (48, 64, 3)
        reader.frame_at(2.9)
    except UserFacingError as error:
        assert "cut" in error.message
