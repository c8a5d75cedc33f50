"""A small corpus with a mouth, and its database, built once."""

from __future__ import annotations

import numpy as np
import pytest

from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.speech.emotion import EMOTIONS
from core.speech.transcript import PhonemeUtterance, Transcript

NAMES = ("nose", "eye_l", "eye_r", "lip_up", "lip_low", "chin")
REST = np.array([[0, 0, 0], [45, 30, -20], [-45, 30, -20], [0, -30, 5], [0, -32, 5], [0, -70, -5]], float)
OPENING_MM = {"pau": 0.0, "b": 0.0, "aa": 12.0, "iy": 5.0, "k": 3.0}
RATE_HZ = 60.0


def recording(name: str, emotion: str, seed: int) -> Recording:
    """Two seconds of phones whose opening is theirs, wider in anger, on a head that drifts."""
    rng = np.random.default_rng(seed)
    phones = ["pau", *rng.permutation(["b", "aa", "iy", "k", "b", "aa"]), "pau"]
    ends_s = np.cumsum([0.3, *rng.uniform(0.15, 0.25, 6), 0.3])
    times_s = np.arange(round(ends_s[-1] * RATE_HZ)) / RATE_HZ
    middles_s = ends_s - np.diff(ends_s, prepend=0.0) / 2
    size = 1.5 if emotion == "anger" else 1.0
    opening = size * np.interp(times_s, middles_s, [OPENING_MM[p] for p in phones])
    positions = np.repeat(REST[None], len(times_s), axis=0)
    positions[:, 4:, 1] -= opening[:, None]
    positions += 0.02 * rng.normal(size=positions.shape) + np.c_[5 * times_s, times_s, 0 * times_s][:, None]
    utterances = [PhonemeUtterance(p, a, b) for p, a, b in zip(phones, [0.0, *ends_s], ends_s)]
    transcript = Transcript(tuple(utterances), (), float(ends_s[-1]))
    return Recording(name, emotion, positions.astype(np.float32), NAMES, RATE_HZ, transcript, f"sentence {name}")


@pytest.fixture(scope="session")
def mouth_corpus():
    """Sixteen sentences in two emotions; two are held out to tune, two to test."""
    recordings = [recording(f"s{i:02d}", EMOTIONS[2 * (i % 2)], i) for i in range(16)]
    groups = {
        "origin": ("nose",), "rigid": ("nose", "eye_l", "eye_r"), "lips": ("lip_up", "lip_low"), "jaw": ("chin",),
    }  # fmt: skip
    landmarks = {"upper_lip": "lip_up", "lower_lip": "lip_low"}
    held_out = {"tune": ("s12", "s13"), "test": ("s14", "s15")}
    return Corpus("mouths", recordings, NAMES, groups, landmarks, REST, held_out=held_out)


@pytest.fixture(scope="session")
def mouth_database(mouth_corpus, tmp_path_factory):
    return build_database(mouth_corpus, tmp_path_factory.mktemp("mouths") / "mouths.h5", BuildSettings(n_dims=6))
