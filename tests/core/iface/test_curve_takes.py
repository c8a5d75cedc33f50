"""Curves of a studio with their sounds, as what the markers of the default face do."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from core.animeme.artist_curves import CurveReading
from core.errors import UserFacingError
from core.face.marker_units import load_marker_units
from core.iface import curve_takes as module
from core.iface.curve_takes import curve_takes
from core.iface.speech_features import speech_features
from core.media.audio import load_audio
from core.speech.transcript import Transcript


@pytest.fixture(scope="module")
def units():
    return load_marker_units()


@pytest.fixture(autouse=True)
def recognised(monkeypatch):
    """What is said matters here to nobody, and recognition takes seconds."""
    monkeypatch.setattr(
        module, "placed_speech", lambda audio, duration_s, **_: (Transcript.covering([], [], duration_s, []), "", "")
    )


@pytest.fixture
def take(tmp_path):
    """Two seconds; the jaw opens evenly, and is not seen in frames 20 and 21."""
    jaw = np.linspace(0.0, 1.0, 60)
    jaw[20:22] = np.nan
    np.savez(tmp_path / "bs_value_a.npz", weights=jaw[:, None], names=["jawOpen"], rate_hz=30.0)
    noise = 0.1 * np.random.default_rng(1).standard_normal(round(1.95 * 16_000))
    (tmp_path / "wav").mkdir()
    soundfile.write(tmp_path / "wav" / "a.wav", noise, 16_000)
    return tmp_path / "bs_value_a.npz"


def test_markers_move_as_the_weights_say_while_the_sound_lasts(take, units):
    (found,) = curve_takes([take], CurveReading(speech_folder=take.parent / "wav"), units)
    assert (found.name, found.emotion, len(found)) == ("a", "neutral", 58)
    jaw = units.moves[units.names.index("jawOpen")][units.kept]
    np.testing.assert_allclose(found.displacements[57], 57 / 59 * jaw, atol=1e-3)
    np.testing.assert_array_equal(np.flatnonzero(~found.used), [20, 21])
    heard = speech_features(load_audio(take.parent / "wav" / "a.wav"), 58)
    np.testing.assert_array_equal(found.features, heard)


def test_curves_without_a_sound_or_at_another_rate_are_refused(take, units):
    with pytest.raises(UserFacingError, match=r"no sound of '.*bs_value_a\.npz'"):
        curve_takes([take], CurveReading(), units)
    np.savez(take, weights=np.zeros((60, 1)), names=["jawOpen"], rate_hz=60.0)
    with pytest.raises(UserFacingError, match="60 frames a second, not 30"):
        curve_takes([take], CurveReading(speech_folder=take.parent / "wav"), units)
