"""Damage, as files meet it: cut, overwritten, with pieces lost, doubled or put in."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from core.errors import UserFacingError

_INTRUDERS = (b"nan", b"inf", b"-1", b"\xc2\xb2", b"\0", b'"', b"9" * 5000, b"1e400", b",", b"\n", b"\r", b"\xff\xfe",
              b"\xd9\xa3", b"-", b"#", b"[" * 40)  # fmt: skip


def _damaged(raw: bytes, n: int) -> Iterator[bytes]:
    for seed in range(n):
        chance = random.Random(seed)
        data = bytearray(raw)
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
def survives_damage(tmp_path) -> Callable[[Path, Callable[[Path], object], int], int]:
    """Return a function that reads ``n`` damaged copies of a file and counts the refusals.

    Each copy must be read, or refused in one sentence that names it; any other failure goes through.
    """

    def read_all(path: Path, read: Callable[[Path], object], n: int) -> int:
        raw = path.read_bytes()
        copy = tmp_path / f"damaged{path.suffix}"
        refused = 0
        for data in _damaged(raw, n):
            copy.write_bytes(data)
            try:
                read(copy)
            except UserFacingError as error:
                assert copy.name in str(error)
                refused += 1
        return refused

    return read_all
