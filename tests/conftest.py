"""Fixtures that several rooms share."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from core.motion.node import NodeTableBuilder
from core.speech.phoneme import PAU, PHONEMES

SHARED_DATA = Path(__file__).resolve().parents[1] / ".." / "shared" / "data"


@pytest.fixture
def shared_data():
    """Return a function from a folder name to the real test data, skipping where it is absent."""

    def folder(name: str) -> Path:
        path = SHARED_DATA / name
        if not path.is_dir():
            pytest.skip(f"the real test data '{name}' are not beside this checkout (../shared/data)")
        return path

    return folder


@pytest.fixture
def random_motion():
    """Return a function that makes random frames and the node table over them."""

    def make(seed: int, n_sentences: int = 6, phones_each: int = 8, n_dims: int = 5, phones: str = "aa b k iy pau"):
        rng = np.random.default_rng(seed)
        choice = [PHONEMES.index(p) for p in phones.split()]
        builder, frames, first = NodeTableBuilder(), [], 0
        for s in range(n_sentences):
            spoken = rng.choice(choice, phones_each).tolist()
            if all(p == PHONEMES.index(PAU) for p in spoken):
                spoken[0] = choice[0]
            lengths = rng.integers(1, 12, phones_each)
            stops = lengths.cumsum()
            n_frames = int(stops[-1])
            frames.append(rng.normal(size=(n_frames, n_dims)).cumsum(axis=0))
            builder.add_sentence(
                f"s{s}", int(rng.integers(4)), spoken, stops - lengths, stops, np.zeros(n_frames, bool), first
            )
            first += n_frames
        return np.concatenate(frames).astype(np.float32), builder.table()

    return make
