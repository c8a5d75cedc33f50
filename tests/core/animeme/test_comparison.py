"""Methods are compared in the form that the tuning part prefers, on what none of them has seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.animeme import comparison
from core.animeme import form as forms
from core.animeme.comparison import METHODS, rate_methods, rms_errors, spoken_like
from core.rig.control_track import ControlTrack

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral


class Still:
    """Says the same value whatever is said."""

    def __init__(self, value):
        self.value = value

    def curves(self, transcript, rate_hz):
        n_frames = max(1, round(transcript.duration_s * rate_hz) - 3)  # three too few: the last one is held
        return ControlTrack(("jawOpen", "mouthPucker"), np.full((n_frames, 2), self.value), rate_hz)


@pytest.fixture
def parts(known_model, babble, taught):
    return [taught(known_model(PRINTED), babble(n, seed=seed), noise=0.05) for seed, n in enumerate((10, 3, 4))]


def test_errors_are_root_mean_squares_over_all_frames(parts):
    values = np.concatenate([e.track.values for e in parts[0]]).astype(float)
    np.testing.assert_allclose(rms_errors(Still(0.3), parts[0]), np.sqrt(((values - 0.3) ** 2).mean(axis=0)), rtol=1e-6)
    assert spoken_like(Still(0.3), parts[0][0]).shape == parts[0][0].track.values.shape


def test_the_variant_that_does_best_on_the_tuning_part_is_kept(parts, monkeypatch):
    fixed = {str(v): (lambda examples, progress, v=v: Still(v)) for v in (5.0, 0.1, -5.0)}
    monkeypatch.setattr(comparison, "METHODS", {"still": fixed})
    train, tune, test = parts
    tune = [replace(e, track=replace(e.track, values=np.full_like(e.track.values, 5.0))) for e in tune]
    (rated,) = rate_methods(train, tune, test)
    assert (rated.variant, rated.tried) == ("5.0", 3)
    np.testing.assert_allclose(rated.tune, 0.0, atol=1e-6)
    np.testing.assert_allclose(rated.test, rms_errors(Still(5.0), test))


def test_animemes_beat_a_constant_target_on_speech_that_animemes_made(parts, monkeypatch):
    kept = {method: METHODS[method] for method in ("animeme, as printed", "Cohen-Massaro")}
    monkeypatch.setattr(comparison, "METHODS", kept)
    animeme, constant = rate_methods(*parts)
    assert (animeme.test < 0.5 * constant.test).all()
