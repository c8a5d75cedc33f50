"""What was priced once is read the next time, to the bit; whatever is wrong with the file, it is priced again."""

from __future__ import annotations

import os

import numpy as np
import pytest

from core.search import parts_cache
from core.search.parts_cache import keep_parts, parts_path, read_parts, remembered_parts
from core.search.transitions import TransitionParts

N_NODES = 40


class Terms:
    """As much of `TransitionTerms` as names a file."""

    def __init__(self, seed=0):
        from core.motion.node import NodeTable

        rng = np.random.default_rng(seed)
        columns = {name: rng.integers(0, 9, N_NODES).astype(dtype) for name, dtype in NodeTable.COLUMNS.items()}
        self.nodes = NodeTable(**columns, sentence_names=("s",))
        self.frames, self.rate_hz = rng.normal(size=(90, 5)).astype(np.float32), 120.0


def made(seed=0):
    rng = np.random.default_rng(seed)
    return TransitionParts(*(rng.random((N_NODES, N_NODES), np.float32) for _ in range(3)))


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(parts_cache, "LEAST_NODES", 10)


def same(a, b):
    return all(np.array_equal(getattr(a, n), getattr(b, n)) for n in ("position_gap", "velocity_gap", "smoothing"))


def test_a_kept_file_is_read_to_the_bit():
    path = parts_path(Terms())
    keep_parts(path, made())
    assert same(read_parts(path, N_NODES), made())
    assert read_parts(path, N_NODES + 1) is None


def test_another_database_has_another_file():
    assert parts_path(Terms(0)) == parts_path(Terms(0)) != parts_path(Terms(1))
    slower = Terms(0)
    slower.rate_hz = 60.0
    assert parts_path(slower) != parts_path(Terms(0))


def test_it_is_priced_once(monkeypatch):
    priced = []
    monkeypatch.setattr(TransitionParts, "of", lambda terms, progress: priced.append(1) or made())
    monkeypatch.setattr(parts_cache.threading, "Thread", lambda target, args: type("Now", (), {
        "start": staticmethod(lambda: target(*args))}))  # fmt: skip
    assert same(remembered_parts(Terms()), remembered_parts(Terms()))
    assert len(priced) == 1
    parts_path(Terms()).write_bytes(b"damaged")
    assert same(remembered_parts(Terms()), made())
    assert len(priced) == 2


@pytest.mark.parametrize("at", [0, 40, -1])
def test_a_byte_that_changed_is_noticed(at):
    path = parts_path(Terms())
    keep_parts(path, made())
    content = bytearray(path.read_bytes())
    content[at] ^= 1
    path.write_bytes(content)
    assert read_parts(path, N_NODES) is None


def test_the_ones_used_longest_ago_go_first(monkeypatch):
    size = 32 + 12 * N_NODES**2
    monkeypatch.setattr(parts_cache, "MOST_BYTES", 2 * size)
    paths = [parts_path(Terms(seed)) for seed in range(3)]
    for i, path in enumerate(paths[:2]):
        keep_parts(path, made(i))
        os.utime(path, (1000 + i, 1000 + i))
    read_parts(paths[0], N_NODES)
    keep_parts(paths[2], made(2))
    assert [path.is_file() for path in paths] == [True, False, True]


def test_a_folder_that_cannot_be_written_is_no_hindrance(tmp_path):
    (tmp_path / "transitions").write_text("a file in the way")
    keep_parts(parts_path(Terms()), made())
    assert read_parts(parts_path(Terms()), N_NODES) is None
