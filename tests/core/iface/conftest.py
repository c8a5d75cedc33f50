"""A small corpus whose mouth opens as loud as it speaks, and its database, built once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import soundfile

from core.iface.heard_takes import database_takes
from core.iface.modern_training import train_modern_face
from core.iface.paper_training import train_paper_face
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from tests.core.evaluation.conftest import NAMES, RATE_HZ, REST, recording
from tests.core.iface.quick_training import QUICK_MODERN, QUICK_PAPER

_SOUND_HZ = 16_000


@pytest.fixture(scope="session")
def loud_corpus(tmp_path_factory):
    """Twelve sentences, neutral and anger in turn, the mouth wider in anger; the last two are held out to test."""
    folder, said = tmp_path_factory.mktemp("loud"), []
    for i in range(12):
        made = recording(f"s{i:02d}", "anger" if i % 2 else "neutral", i)
        times_s = np.arange(round(made.transcript.duration_s * _SOUND_HZ)) / _SOUND_HZ
        opening = np.interp(times_s, np.arange(len(made.positions)) / RATE_HZ, REST[4, 1] - made.positions[:, 4, 1])
        hum = np.sin(2 * np.pi * 140 * times_s) + 0.3 * np.random.default_rng(i).standard_normal(len(times_s))
        path = folder / f"s{i:02d}.wav"
        soundfile.write(path, 0.02 * np.clip(opening - opening.min(), 0, 20) * hum, _SOUND_HZ)
        said.append(replace(made, audio=path))
    groups = {"origin": ("nose",), "rigid": ("nose", "eye_l", "eye_r"), "lips": ("lip_up", "lip_low"), "jaw": ("chin",)}
    landmarks = {"upper_lip": "lip_up", "lower_lip": "lip_low"}
    held_out = {"tune": ("s08", "s09"), "test": ("s10", "s11")}
    return Corpus("loud mouths", said, NAMES, groups, landmarks, REST, held_out=held_out)


@pytest.fixture(scope="session")
def loud_database(loud_corpus, tmp_path_factory):
    return build_database(loud_corpus, tmp_path_factory.mktemp("loud") / "loud.h5", BuildSettings(n_dims=6))


@pytest.fixture(scope="session")
def quick_faces(loud_database):
    """A small trained face of each variant, by name."""
    takes = database_takes(loud_database, n_noises=1)
    return {
        "modern": train_modern_face(takes, loud_database.markers, settings=QUICK_MODERN),
        "paper": train_paper_face(takes, loud_database.markers.rest, settings=QUICK_PAPER),
    }
