"""Live frames are those of the whole sound, however it comes."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import UserFacingError
from core.iface.expression_ease import eased_strengths
from core.iface.live import LiveFace
from core.iface.speech_features import speech_features
from core.media.audio import Audio
from core.speech.emotion import EmotionModifier
from tests.core.iface.linear_face import LinearFace

REST = np.random.default_rng(3).normal(size=(6, 3)) * 20


def sound(rate_hz, duration_s=1.5, seed=4):
    """Noise under a slow swell, so that features move."""
    rng, n = np.random.default_rng(seed), round(duration_s * rate_hz)
    return (0.08 * rng.normal(size=n) * (1 + np.sin(np.arange(n) / rate_hz * 9))).astype(np.float32)


def heard(live, samples, block):
    frames = []
    for first in range(0, len(samples), block):
        frames += live.accept(samples[first : first + block])
    return frames + live.finish()


@pytest.mark.parametrize("rate_hz", [16_000, 48_000, 44_100, 22_050, 8_000])
def test_frames_are_those_of_the_whole_at_any_rate(rate_hz):
    samples, face = sound(rate_hz), LinearFace(REST)
    frames = heard(LiveFace(face, rate_hz), samples, round(rate_hz / 100))
    whole = face.motion(speech_features(Audio(samples, rate_hz)), {})
    assert [frame.frame for frame in frames] == list(range(len(frames)))
    assert abs(len(frames) - len(whole)) <= 1
    n = min(len(frames), len(whole)) - face.n_ahead - 1  # the last frames hear silence, each in its own way
    assert n > 35
    np.testing.assert_allclose([frame.positions for frame in frames[:n]], whole[:n], atol=1e-4)


@pytest.mark.parametrize("rate_hz", [16_000, 44_100])
def test_block_sizes_do_not_change_frames(rate_hz):
    samples, face, rng = sound(rate_hz), LinearFace(REST), np.random.default_rng(5)
    whole = heard(LiveFace(face, rate_hz, "anger"), samples, len(samples))
    for block in (1, 77, 480, 5000):
        again = heard(LiveFace(face, rate_hz, "anger"), samples[: 20_000 if block == 1 else None], block)
        common = len(again) if block > 1 else len(again) - 2 - face.n_ahead
        np.testing.assert_array_equal(
            [frame.positions for frame in again[:common]], [frame.positions for frame in whole[:common]]
        )
    live, at, frames = LiveFace(face, rate_hz, "anger"), 0, []
    while at < len(samples):
        n = int(rng.integers(0, 3000))
        frames, at = frames + live.accept(samples[at : at + n]), at + n
    frames += live.finish()
    np.testing.assert_array_equal([f.positions for f in frames], [f.positions for f in whole])


def test_a_frame_comes_with_the_sound_a_tenth_of_a_second_after_it():
    face = LinearFace(REST, n_ahead=3)
    live, samples = LiveFace(face, 16_000), sound(16_000)
    for first in range(0, len(samples), 160):
        for frame in live.accept(samples[first : first + 160]):
            assert frame.heard_s - frame.time_s == pytest.approx(0.1, abs=0.010 + 1e-9)
    late = LiveFace(face, 48_000)
    waits = [f.heard_s - f.time_s for n in range(0, 72_000, 480) for f in late.accept(np.zeros(480, np.float32))]
    assert len(waits) > 35 and max(waits) < 0.1 + 0.010 + 0.040  # the resampler holds back some


def test_keys_change_the_expression_smoothly_and_as_their_span_would():
    face, samples = LinearFace(REST), sound(16_000, 2.0)
    live, frames = LiveFace(face, 16_000), []
    for n, first in enumerate(range(0, len(samples), 1600)):
        if n == 8:
            live.ask("sadness", 0.7)
        frames += live.accept(samples[first : first + 1600])
    first = next(frame.frame for frame in frames if frame.asked == ("sadness", 0.7))
    strength = np.array([frame.strengths["sadness"] for frame in frames])
    assert 20 <= first <= 22 and not strength[:first].any()
    steps = np.diff(strength)
    assert steps.max() < 0.7 * 0.2 and steps.min() >= 0.0 and strength[-1] > 0.69
    spans = [EmotionModifier(first / 30, 9.0, "sadness", 0.7)]
    whole = face.motion(speech_features(Audio(samples, 16_000)), eased_strengths(face.expressions, spans, 60))
    np.testing.assert_allclose([f.positions for f in frames[:57]], whole[:57], atol=1e-4)


def test_silence_and_samples_that_are_no_numbers_leave_the_face_in_peace():
    live, face = LiveFace(LinearFace(REST), 48_000), LinearFace(REST)
    silent = np.array([frame.positions for frame in heard(live, np.zeros(96_000, np.float32), 480)])
    assert np.isfinite(silent).all()
    assert np.abs(np.diff(silent[1:-4], axis=0)).max() < 1e-4  # nothing moves
    broken, clean = sound(16_000), sound(16_000)
    broken[4000:4010], clean[4000:4010] = np.nan, 0.0
    broken[5000], clean[5000] = np.inf, 0.0
    live = LiveFace(face, 16_000)
    got = heard(live, broken, 480)
    wanted = heard(LiveFace(face, 16_000), clean, 480)
    np.testing.assert_array_equal([f.positions for f in got], [f.positions for f in wanted])
    assert live.faulty == 11


def test_what_cannot_be_is_one_sentence():
    for rate_hz in (0, 100, 2_000_000):
        with pytest.raises(UserFacingError, match=f"rate of {rate_hz}"):
            LiveFace(LinearFace(REST), rate_hz)
    with pytest.raises(UserFacingError, match="not trained on 'joy'") as raised:
        LiveFace(LinearFace(REST), 16_000).ask("joy")
    assert "sadness" in raised.value.remedy
    LiveFace(LinearFace(REST, expressions=()), 16_000).ask("neutral")
