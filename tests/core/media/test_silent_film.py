from fractions import Fraction

import av
import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.silent_film import without_sound
from core.media.video import probe, write_video


def pictures_of(path):
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_the_same_pictures_at_the_same_times_and_no_sound(tmp_path, suffix):
    rng = np.random.default_rng(3)
    frames = [np.kron(rng.integers(0, 255, (6, 8, 3)), np.ones((8, 8, 1))).astype(np.uint8) for _ in range(20)]
    film, silent = tmp_path / f"film{suffix}", tmp_path / f"silent{suffix}"
    sound = Audio(0.1 * rng.standard_normal(16_000 * 20 // 25).astype(np.float32), 16_000)
    write_video(film, frames, 20, Fraction(25), sound)
    without_sound(film, silent)
    before, after = probe(film), probe(silent)
    assert before.audio_duration_s is not None and after.audio_duration_s is None
    for name in ("width", "height", "n_frames", "fps", "video_start_s", "video_duration_s"):
        assert getattr(after, name) == getattr(before, name)
    np.testing.assert_array_equal(pictures_of(silent), pictures_of(film))


def test_what_is_no_film_is_told(tmp_path):
    (tmp_path / "no.avi").write_text("no film")
    with pytest.raises(UserFacingError, match=r"no\.avi"):
        without_sound(tmp_path / "no.avi", tmp_path / "out.avi")
    assert not (tmp_path / "out.avi").exists()
