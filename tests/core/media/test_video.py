"""Written videos, read back by PyAV: right length, right colours, picture and sound together."""

from fractions import Fraction

import av
import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.video import FRAME_RATES, n_video_frames, probe, timecode, write_video
from core.progress import Cancelled, Progress

RATE_HZ = 16_000
# the last AAC block is filled up with silence
_AAC_PADDING_S = 1024 / RATE_HZ


def flash(n_frames: int, width: int = 64, height: int = 48):
    """Dark pictures, each with its own shade of red, and a white one at a third of the way."""
    for k in range(n_frames):
        picture = np.full((height, width, 3), (40 + k, 90, 160), np.uint8)
        yield np.full_like(picture, 255) if k == n_frames // 3 else picture


def clicking(n_frames: int, fps: Fraction, rate_hz: int = RATE_HZ) -> Audio:
    """Faint noise with a loud burst that begins with the white picture of `flash`."""
    duration_s = n_frames / fps
    samples = np.random.default_rng(1).normal(scale=0.01, size=int(duration_s * rate_hz)).astype(np.float32)
    start = round(n_frames // 3 / fps * rate_hz)
    samples[start : start + rate_hz // 50] += np.random.default_rng(2).normal(scale=0.25, size=rate_hz // 50)
    return Audio(samples, rate_hz)


def decoded(path):
    """Pictures with their times, and the sound as it plays from time zero."""
    with av.open(str(path)) as container:
        pictures = [(f.pts * f.time_base, f.to_ndarray(format="rgb24")) for f in container.decode(video=0)]
    with av.open(str(path)) as container:
        blocks = list(container.decode(audio=0))
    rate_hz = blocks[0].sample_rate
    played = np.zeros(max(round(b.pts * b.time_base * rate_hz) + b.samples for b in blocks))
    for block in blocks:
        samples = block.to_ndarray().ravel()
        samples = samples / 32768 if samples.dtype == np.int16 else samples
        start = round(block.pts * block.time_base * rate_hz)
        played[start : start + len(samples)] = samples
    return pictures, played


def lag(played: np.ndarray, meant: np.ndarray) -> int:
    """Samples by which ``played`` comes late, by cross-correlation."""
    n = 1 << int(np.ceil(np.log2(len(played) + len(meant))))
    match = np.fft.irfft(np.fft.rfft(played, n) * np.conj(np.fft.rfft(meant, n)), n)
    at = int(match.argmax())
    return at if at < n // 2 else at - n


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
@pytest.mark.parametrize("fps", FRAME_RATES.values(), ids=FRAME_RATES)
def test_picture_and_sound_start_together_and_last_as_long(tmp_path, suffix, fps):
    path = tmp_path / f"film{suffix}"
    audio = clicking(31, fps)
    write_video(path, flash(31), 31, fps, audio)
    facts = probe(path)
    assert facts.fps == fps
    assert facts.n_frames == 31
    assert facts.video_start_s == 0
    assert abs(facts.audio_start_s) < 1e-3
    assert facts.video_duration_s == pytest.approx(float(31 / fps), abs=1e-4)
    pictures, played = decoded(path)
    assert [round(at * fps) for at, _ in pictures] == list(range(31))
    assert max(abs(at - k / fps) for k, (at, _) in enumerate(pictures)) < Fraction(1, 10_000)
    assert np.argmax([picture.mean() for _, picture in pictures]) == 31 // 3
    assert lag(played, audio.samples) == 0
    assert abs(len(played) / RATE_HZ - facts.video_duration_s) < 1 / fps + _AAC_PADDING_S


def test_avi_sound_is_exact_to_its_last_bit(tmp_path):
    audio = clicking(40, Fraction(25))
    write_video(tmp_path / "a.avi", flash(40), 40, Fraction(25), audio)
    _, played = decoded(tmp_path / "a.avi")
    assert len(played) == len(audio.samples)
    assert np.abs(played - audio.samples).max() <= 0.5 / 32768


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_colours_come_back(tmp_path, suffix):
    path = tmp_path / f"c{suffix}"
    colours = [(200, 40, 40), (40, 180, 60), (30, 60, 210), (240, 230, 220), (12, 12, 14)]
    write_video(path, (np.full((48, 64, 3), c, np.uint8) for c in colours), len(colours), Fraction(25))
    with av.open(str(path)) as container:
        seen = [f.to_ndarray(format="rgb24")[24, 32] for f in container.decode(video=0)]
    assert np.abs(np.array(seen, int) - colours).max() <= 6


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_odd_sizes_grow_to_even_ones(tmp_path, suffix):
    path = tmp_path / f"odd{suffix}"
    write_video(path, flash(5, 63, 47), 5, Fraction(25))
    facts = probe(path)
    assert (facts.width, facts.height, facts.n_frames) == (64, 48, 5)
    assert facts.audio_start_s is None


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
def test_the_start_frame_is_kept_as_timecode(tmp_path, suffix):
    path = tmp_path / f"t{suffix}"
    write_video(path, flash(5), 5, Fraction(24), start_frame=24 * 3661 + 7)
    assert probe(path).timecode == "01:01:01:07"


def test_timecode_counts_nominal_frames_and_wraps_at_midnight():
    assert timecode(30 * 60, Fraction(30000, 1001)) == "00:01:00:00"
    assert timecode(25 * 86400 + 3, Fraction(25)) == "00:00:00:03"
    for measured_hz in (59.94, 59.98, 60.000001, 60.03):  # a clock that is a little off is still one of 60
        assert timecode(60 * 36_000 + 7, measured_hz) == "10:00:00:07"


@pytest.mark.parametrize("rate_hz", [5512, 44_100, 96_000, 192_000])
def test_any_sound_rate_finds_its_way_into_both_containers(tmp_path, rate_hz):
    audio = clicking(25, Fraction(25), rate_hz)
    for suffix in (".avi", ".mp4"):
        path = tmp_path / f"r{suffix}"
        write_video(path, flash(25), 25, Fraction(25), audio)
        assert probe(path).audio_duration_s == pytest.approx(1.0, abs=0.05)


def test_the_video_covers_the_sound_by_less_than_a_frame():
    for fps in FRAME_RATES.values():
        for n_samples in (800, 16_000, 16_001, 48_048, 100_003):
            duration_s = n_samples / RATE_HZ
            surplus = n_video_frames(duration_s, fps) / fps - Fraction(duration_s)
            assert -Fraction(1, 10_000_000) <= surplus < 1 / fps
    assert n_video_frames(48_048 / RATE_HZ, Fraction(30000, 1001)) == 90
    assert n_video_frames(0.0, Fraction(25)) == 1


class StopAt(Progress):
    def __init__(self, fraction: float) -> None:
        self.fraction = fraction

    def step(self, fraction, message=""):
        if fraction >= self.fraction:
            raise Cancelled


@pytest.mark.parametrize("suffix", [".avi", ".mp4"])
@pytest.mark.parametrize("fraction", [0.0, 0.5, 1.0])
def test_a_cancelled_video_leaves_the_folder_as_it_was(tmp_path, suffix, fraction):
    path = tmp_path / f"v{suffix}"
    path.write_bytes(b"the film of yesterday")
    with pytest.raises(Cancelled):
        write_video(path, flash(20), 20, Fraction(25), clicking(20, Fraction(25)), StopAt(fraction))
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == b"the film of yesterday"


@pytest.mark.parametrize("promised", [4, 6])
def test_a_wrong_number_of_frames_is_our_bug_and_leaves_nothing(tmp_path, promised):
    with pytest.raises(ValueError, match="promised"):
        write_video(tmp_path / "v.avi", flash(5), promised, Fraction(25))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["v.mov", "v", "missing/v.avi", "missing/v.mp4"])
def test_a_target_that_cannot_be_is_one_sentence(tmp_path, name):
    with pytest.raises(UserFacingError):
        write_video(tmp_path / name, flash(5), 5, Fraction(25))
    assert not list(tmp_path.iterdir())


def test_a_target_that_is_a_folder_is_one_sentence(tmp_path):
    (tmp_path / "v.avi").mkdir()
    with pytest.raises(UserFacingError, match=r"v\.avi"):
        write_video(tmp_path / "v.avi", flash(5), 5, Fraction(25))
    assert [p.name for p in tmp_path.iterdir()] == ["v.avi"]


@pytest.mark.parametrize("content", [b"", b"no film at all", None])
def test_what_is_no_video_is_one_sentence(tmp_path, content):
    path = tmp_path / "x.avi"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UserFacingError, match=r"x\.avi"):
        probe(path)
