"""Blinks where no silence was captured that is long enough to hold one."""

from dataclasses import replace

import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.motion.pca import MotionPca
from core.synthesis.blinks import CapturedBlinks
from core.synthesis.concatenate import SlotFrames
from core.synthesis.silence_motion import CapturedSilences

NAMES = ("nose", "eye_l", "eye_r", "lid_l", "lid_r", "lip")
REST = np.array([[0, 0, 0], [20, 30, 0], [-20, 30, 0], [30, 36, 0], [-30, 36, 0], [0, -30, 0]], float)
LANDMARKS = {"nose_tip": "nose", "inner_eye_left": "eye_l", "inner_eye_right": "eye_r", "upper_lid_left": "lid_l",
             "upper_lid_right": "lid_r"}  # fmt: skip


def blinking(database, every_s):
    """The database with a face whose lips speak and whose lids come down by 8 mm for 0.1 s, ``every_s``."""
    rng = np.random.default_rng(7)
    n, rate_hz = len(database.frames), database.rate_hz
    positions = np.repeat(REST[None], n, axis=0) + 0.05 * rng.normal(size=(n, 6, 3))
    positions[:, 5] += database.frames[:, :3]
    downs = np.arange(round(every_s * rate_hz / 2), n - 6, round(every_s * rate_hz))
    for at in downs:
        positions[at : at + 6, 3:5, 1] -= 8.0
    markers = MarkerSet(NAMES, REST, {}, LANDMARKS)
    pca = MotionPca.fit([positions], 12)
    frames = pca.coefficients(positions).astype(np.float32)
    return replace(database, markers=markers, pca=pca, frames=frames)


def lids_down(database, coefficients):
    height = database.pca.positions(coefficients)[:, 3:5, 1].mean(axis=1)
    shut = height < 36.0 - 4.0
    return np.count_nonzero(shut[1:] & ~shut[:-1])


@pytest.mark.parametrize("every_s", [1.5, 5.0])
def test_a_long_silence_blinks_as_often_as_captured_speech(talking_database, every_s):
    database = blinking(talking_database(8, n_sentences=60, silence_s=0.02), every_s)
    captured = lids_down(database, database.frames.astype(float)) / (len(database.frames) / database.rate_hz)
    n = round(120 * database.rate_hz)
    silences = CapturedSilences(database, database.frames)
    filled = silences.fill(np.zeros((n, 12)), [0], SlotFrames(np.array([0]), np.array([n])), np.ones((1, 4)), set())
    assert lids_down(database, filled) / 120 == pytest.approx(captured, rel=0.35)
    lips = database.pca.positions(filled)[:, 5]
    assert lips == pytest.approx(np.tile(REST[5], (n, 1)), abs=1.0)
    assert np.abs(np.diff(filled, axis=0)).max() <= 1.5 * np.abs(np.diff(database.frames, axis=0)).max()


def test_a_face_that_never_blinked_or_shows_no_lids_stays_still(talking_database):
    database = talking_database(9)
    assert not CapturedBlinks(database, database.frames).within(600, 1).any()
    still = blinking(database, every_s=1e4)
    assert not CapturedBlinks(still, still.frames).within(600, 1).any()
