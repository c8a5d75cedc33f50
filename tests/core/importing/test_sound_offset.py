"""A shift that was put in is measured; where nothing can be compared, nothing is claimed."""

from __future__ import annotations

import numpy as np
import pytest

from core.importing.shifting import shifted
from core.importing.sound_offset import audio_offset, mouth_opening, pooled_offset
from core.media.audio import Audio, load_audio
from core.motion.motion_files import read_takes
from core.speech.transcript import PhonemeUtterance, Transcript
from core.speech.transcript_files import read_transcript

RATE_HZ = 60.0


def _talk(late_s: float, n_s: float = 6.0, seed: int = 3):
    """Open vowels and closures in turn, loud and quiet with them; the mouth follows, ``late_s`` late."""
    rng = np.random.default_rng(seed)
    utterances, at_s = [PhonemeUtterance("pau", 0.0, 0.3)], 0.3
    while at_s < n_s - 0.5:
        for phone in ("b", "aa"):
            end_s = at_s + rng.uniform(0.08, 0.25)
            utterances.append(PhonemeUtterance(phone, at_s, end_s))
            at_s = end_s
    transcript = Transcript.covering(utterances, [], n_s)
    times_s = np.arange(round(n_s * 16_000)) / 16_000
    loud = np.interp(times_s, [u.start_s for u in transcript.phonemes],
                     [1.0 if u.phone == "aa" else 0.05 for u in transcript.phonemes])  # fmt: skip
    audio = Audio((0.3 * loud * rng.normal(size=len(times_s))).astype(np.float32), 16_000)
    frames_s = np.arange(round(n_s * RATE_HZ)) / RATE_HZ - late_s
    said = [next((u.phone for u in transcript.phonemes if u.start_s <= t < u.end_s), "pau") for t in frames_s]
    opening = np.convolve([10.0 if phone == "aa" else 0.0 for phone in said], np.ones(5) / 5, mode="same")
    return opening, audio, transcript


@pytest.mark.parametrize("late_s", [-0.4, -0.1, 0.0, 0.05, 0.4])
def test_a_planted_shift_is_measured(late_s):
    opening, audio, transcript = _talk(late_s)
    found = audio_offset(opening, RATE_HZ, audio, transcript)
    assert found.offset_s == pytest.approx(late_s, abs=0.02)
    assert found.confidence > 0.5


def test_what_is_not_there_is_not_claimed():
    opening, audio, transcript = _talk(0.0)
    assert audio_offset(np.zeros_like(opening), RATE_HZ, audio, transcript) is None
    assert audio_offset(np.full_like(opening, np.nan), RATE_HZ, audio, transcript) is None
    assert pooled_offset([]) is None


def test_another_sentence_is_no_sure_match():
    opening, _, _ = _talk(0.0, seed=3)
    unsure = [audio_offset(opening, RATE_HZ, *_talk(0.0, seed=seed)[1:]).confidence for seed in range(10, 16)]
    assert np.median(unsure) < 0.5


def test_the_mouth_knows_no_head(capture):
    take = capture()
    still = np.linalg.norm(take[:, 8] - take[:, 9], axis=1)
    assert np.allclose(mouth_opening(take + np.arange(600)[:, None, None], 8, 9), still)
    assert mouth_opening(take, None, None).shape == (600,)


def test_real_sentences_shifted_alike_agree_on_their_shift(shared_data):
    """Twelve GRID clips, all made 0.17 s late: together they tell it to a frame of their camera (40 ms)."""
    folder = shared_data("grid-s1")
    tracks = read_takes(folder / "tracks.npz")[:12]
    lips = [tracks[0].names.index(name) for name in ("MP013", "MP014")]
    estimates = []
    for track in tracks:
        audio = load_audio(folder / "audio" / f"{track.take}.flac")
        transcript = read_transcript(folder / "textgrid" / f"{track.take}.TextGrid", audio.duration_s)
        late = shifted(track.positions[:, lips], track.rate_hz, -0.17)
        estimates.append(audio_offset(mouth_opening(late, 0, 1), track.rate_hz, audio, transcript))
    assert pooled_offset(estimates).offset_s == pytest.approx(0.17, abs=0.04)


def test_shifting_by_whole_frames_only_renumbers(capture):
    take = capture(n_frames=50)
    take[20:22, 3] = np.nan
    assert np.array_equal(shifted(take, RATE_HZ, 4 / RATE_HZ), take[4:], equal_nan=True)
    early = shifted(take, RATE_HZ, -4 / RATE_HZ)
    assert np.isnan(early[:4]).all()
    assert np.array_equal(early[4:], take, equal_nan=True)


def test_shifting_between_frames_follows_the_motion():
    times_s = np.arange(120) / RATE_HZ
    wave = np.stack([np.sin(7 * times_s), np.cos(5 * times_s), times_s], axis=1)[:, None]
    moved = shifted(wave, RATE_HZ, 0.0123)
    inside = times_s[2 : len(moved) - 2] + 0.0123
    expected = np.stack([np.sin(7 * inside), np.cos(5 * inside), inside], axis=1)
    assert np.abs(moved[2:-2, 0] - expected).max() < 1e-4


def test_shifting_there_and_back_loses_only_the_ends(capture):
    take = capture(n_frames=80)
    back = shifted(shifted(take, RATE_HZ, 0.037), RATE_HZ, -0.037)
    assert np.nanmax(np.abs(back[10:70] - take[10:70])) < 0.1
