"""Damage, as files meet it: cut, overwritten, with pieces lost, doubled or put in; and a database that talks."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from core.errors import UserFacingError
from core.motion.database import CapturedSentence, MotionDatabase
from core.motion.marker_set import MarkerSet
from core.motion.node import NodeTableBuilder
from core.motion.pca import MotionPca
from core.search.terms import default_weights
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX, PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript

_INTRUDERS = (b"nan", b"inf", b"-1", b"\xc2\xb2", b"\0", b'"', b"9" * 5000, b"1e400", b",", b"\n", b"\r", b"\xff\xfe",
              b"\xd9\xa3", b"-", b"#", b"[" * 40)  # fmt: skip


def _damaged(raw: bytes, n: int, others: Sequence[bytes] = ()) -> Iterator[bytes]:
    for seed in range(n):
        chance = random.Random(seed)
        data = bytearray(raw)
        if others and chance.random() < 0.25:
            # the tail of another file on the head of this one
            other = chance.choice(others)
            data[chance.randrange(len(data)) :] = other[chance.randrange(len(other)) :]
        if chance.random() < 0.15:
            del data[chance.randrange(len(data)) :]
        for _ in range(chance.choice((1, 1, 2, 8, 40))):
            if not data:
                break
            at = chance.randrange(min(len(data), chance.choice((len(data), 100, 600))))  # headers matter most
            kind = chance.random()
            if kind < 0.6:
                flipped = data[at] ^ (1 << chance.randrange(8))
                data[at] = chance.choice((chance.randrange(256), 0, 255, 127, 128, flipped))
            elif kind < 0.8:
                data[at : at + chance.randrange(8)] = chance.choice(_INTRUDERS)
            elif kind < 0.9:
                del data[at : at + chance.randrange(1, 30)]
            else:
                data[at:at] = data[chance.randrange(len(data)) :][: chance.randrange(60)]
        yield bytes(data)


@pytest.fixture
def survives_damage(tmp_path) -> Callable[..., int]:
    """Return a function that reads ``n`` damaged copies of a file and counts the refusals.

    Each copy must be read, or refused in one sentence that names it; any other failure goes through. ``others`` are
    files whose tails take the place of some copies' own.
    """

    def read_all(path: Path, read: Callable[[Path], object], n: int, others: Sequence[bytes] = ()) -> int:
        raw = path.read_bytes()
        copy = tmp_path / f"damaged{path.suffix}"
        refused = 0
        for data in _damaged(raw, n, others):
            copy.write_bytes(data)
            try:
                read(copy)
            except UserFacingError as error:
                assert copy.name in str(error)
                refused += 1
        return refused

    return read_all


@pytest.fixture
def talking_database() -> Callable[..., MotionDatabase]:
    """Return a function that makes a small database of sentences with silence before, within and after speech.

    Six coefficients of six markers; in silence the first one blinks, by 5 mm for 0.1 s, once in ``blink_every_s``.
    """

    def make(
        seed: int = 1, n_sentences: int = 16, emotions: Sequence[str] = EMOTIONS[:1], silence_s: float = 1.0,
        blink_every_s: float = 2.0,
    ) -> MotionDatabase:  # fmt: skip
        rng = np.random.default_rng(seed)
        rate_hz, builder, frames, sentences, first = 60.0, NodeTableBuilder(), [], [], 0
        poses = 4.0 * rng.normal(size=(len(PHONEMES), 6))
        poses[0] = 0.0
        for s in range(n_sentences):
            emotion = emotions[s % len(emotions)]
            said = rng.choice([PHONEME_INDEX[p] for p in ("aa", "b", "k", "iy", "s")], 6).tolist()
            phones = [0, *said[:3], 0, *said[3:], 0]
            lengths_s = np.where(np.array(phones) == 0, silence_s, rng.uniform(0.08, 0.2, len(phones)))
            lengths_s[4] = 0.15
            stops = np.cumsum(np.maximum(1, np.rint(lengths_s * rate_hz))).astype(int)
            starts = np.concatenate([[0], stops[:-1]])
            motion = np.repeat(poses[phones], np.diff(stops, prepend=0), axis=0)
            motion = gaussian_filter1d(motion, 2.0, axis=0, mode="nearest") + 0.05 * rng.normal(size=motion.shape)
            motion += EMOTION_INDEX[emotion] * np.array([0, 2.0, 0, 0, 0, 0])
            for p in (0, len(phones) - 1):
                for at in range(starts[p], stops[p]):
                    if rng.random() < 1.0 / (rate_hz * blink_every_s):
                        motion[at : min(at + 6, stops[p]), 0] -= 5.0
            builder.add_sentence(
                f"s{s}", EMOTION_INDEX[emotion], phones, starts, stops, np.zeros(len(motion), bool), first
            )
            spoken = [PhonemeUtterance(PHONEMES[p], a / rate_hz, b / rate_hz) for p, a, b in zip(phones, starts, stops)]
            transcript = Transcript(tuple(spoken), (), stops[-1] / rate_hz)
            sentences.append(CapturedSentence(f"s{s}", emotion, "", first, first + len(motion), transcript))
            frames.append(motion)
            first += len(motion)
        frames, nodes = np.concatenate(frames).astype(np.float32), builder.table()
        markers = MarkerSet(tuple("abcdef"), rng.normal(size=(6, 3)), {"lips": ("a", "b")})
        pca = MotionPca(markers.rest.ravel(), np.linalg.qr(rng.normal(size=(18, 6)))[0], np.ones(6), 1.0)
        head = np.zeros((len(frames), 3), np.float32)
        return MotionDatabase(
            name="talk", synthetic=True, rate_hz=rate_hz, markers=markers, pca=pca, frames=frames, head_rotation=head,
            head_translation=head, nodes=nodes, sentences=tuple(sentences), maps={},
            weights=default_weights(frames, nodes, rate_hz), content_hash=f"talk-{seed}",
        )  # fmt: skip

    return make
