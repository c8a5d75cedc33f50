"""Speech that is made up, and animemes that are known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from core.animeme.animeme import AnimemeModel
from core.animeme.examples import Example
from core.animeme.form import AnimemeForm
from core.animeme.levels import N_PHONEMES, levels_of
from core.rig.control_track import ControlTrack
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import PhonemeUtterance, Transcript

PHONES = ("pau", "b", "aa", "iy", "k", "s")
RATE_HZ = 60.0


@pytest.fixture(scope="session")
def babble() -> Callable[..., list[Transcript]]:
    """Return a function that makes transcripts of random phones of random lengths."""

    def make(n: int, seed: int = 0, phones: tuple[str, ...] = PHONES, said: int = 12) -> list[Transcript]:
        rng = np.random.default_rng(seed)
        made = []
        for _ in range(n):
            ends_s = np.cumsum(rng.uniform(0.06, 0.25, said))
            names = rng.choice(phones, said)
            spoken = [PhonemeUtterance(str(p), a, b) for p, a, b in zip(names, [0.0, *ends_s], ends_s)]
            made.append(Transcript(tuple(spoken), (), float(ends_s[-1])))
        return made

    return make


@pytest.fixture(scope="session")
def known_model() -> Callable[..., AnimemeModel]:
    """Return a function that makes animemes of random coefficients and widths for two controls."""

    def make(form: AnimemeForm, seed: int = 1) -> AnimemeModel:
        rng = np.random.default_rng(seed)
        levels = levels_of(form, {})
        tables = {v.name: rng.normal(size=(v.n_rows, v.degree + 1, 2)) for v in levels}
        for table in tables.values():
            table /= 1.0 + np.arange(table.shape[1])[None, :, None] ** 2
        widths = np.ones((1, 2, N_PHONEMES))
        said = [PHONEME_INDEX[p] for p in PHONES]
        widths[0][:, said] = rng.uniform(0.6, 1.6, (2, len(said)))
        span_s = np.repeat([[0.06], [0.25]], N_PHONEMES, axis=1)
        return AnimemeModel(form, ("jawOpen", "mouthPucker"), np.array([0.2, 0.0]), widths, np.zeros(2, int), tables,
                            span_s)  # fmt: skip

    return make


@pytest.fixture(scope="session")
def taught() -> Callable[..., list[Example]]:
    """Return a function that lets a model speak transcripts, and makes examples of what it says."""

    def make(model: AnimemeModel, transcripts, emotions=None, noise: float = 0.0) -> list[Example]:
        rng = np.random.default_rng(9)
        examples = []
        for s, transcript in enumerate(transcripts):
            felt = "neutral" if emotions is None else emotions[s]
            track = model.curves(transcript, RATE_HZ, [EmotionModifier(0.0, transcript.duration_s, felt)])
            values = track.values + noise * rng.normal(size=track.values.shape)
            examples.append(Example(transcript, ControlTrack(track.names, values, RATE_HZ), felt))
        return examples

    return make
