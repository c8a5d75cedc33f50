"""A growth that is cut, by a kill or a full disk, leaves the database as it was; long proofs on real and demo data."""

from __future__ import annotations

import random
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.motion.build import BuildSettings, build_database
from core.motion.database import open_database
from core.motion.growth import GrowthSettings, add_corpus, add_database
from core.motion.node import NodeTable
from core.motion.readers.corpus_folder import read_corpus
from tests.core.motion.growing import corpus_of

REPOSITORY = Path(__file__).resolve().parents[3]
SETTINGS = BuildSettings(n_dims=6, keep_captures=True)
GROW = "import sys; from pathlib import Path; from core.motion.growth import add_corpus; " \
       "from tests.core.motion.growing import corpus_of; print('begun', flush=True); " \
       "add_corpus(Path(sys.argv[1]), corpus_of(10, 11, 12)); print('done', flush=True)"  # fmt: skip
FULL = """
import resource, signal, sys
from pathlib import Path
from core.errors import UserFacingError
from core.motion.growth import add_corpus
from tests.core.motion.growing import corpus_of
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]),) * 2)
try:
    add_corpus(Path(sys.argv[1]), corpus_of(10, 11, 12))
except UserFacingError as error:
    print(error)
"""
linux_only = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of file size are set as on Linux")


def run(script: str, *words) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-c", script, *map(str, words)], cwd=REPOSITORY, text=True,
                            stdout=subprocess.PIPE)  # fmt: skip


@pytest.fixture
def path(tmp_path):
    build_database(corpus_of(*range(6)), tmp_path / "db.h5", SETTINGS)
    return tmp_path / "db.h5"


@linux_only
@pytest.mark.parametrize("share", [0.0, 0.3, 0.99])
def test_a_full_disk_leaves_the_old_database(path, share):
    before = path.read_bytes()
    with run(FULL, path, max(4096, int(share * len(before)))) as process:
        told, _ = process.communicate(timeout=60)
    assert "cannot be written" in told and len(told.strip().splitlines()) == 1
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == ["db.h5"]


@pytest.mark.prove
def test_a_kill_at_any_moment_leaves_the_old_database_or_the_new(path):
    rng = random.Random(7)
    old = path.read_bytes()
    began = time.monotonic()
    with run(GROW, path) as process:
        process.stdout.readline()
        begun_s = time.monotonic() - began
        assert process.stdout.readline() == "done\n"
    whole_s = time.monotonic() - began - begun_s
    hashes = {"old": open_database(path).content_hash}
    path.write_bytes(old)
    hashes = {open_database(path).content_hash: 0, hashes["old"]: 0}
    assert len(hashes) == 2
    for number in range(60):
        path.write_bytes(old)
        with run(GROW, path) as process:
            process.stdout.readline()
            # every third one is aimed at the writing, at the very end
            lowest = 0.85 if number % 3 == 0 else 0.0
            time.sleep(rng.uniform(lowest, 1.1) * whole_s)
            process.send_signal(signal.SIGKILL)
            process.wait()
        hashes[open_database(path).content_hash] += 1
    assert min(hashes.values()) > 0  # moments before and after the swap were met
    for left_behind in path.parent.glob(".*.part.h5"):
        left_behind.unlink()
    assert add_corpus(path, corpus_of(20)).added == ("s20",)  # the lock of the killed is taken over


@pytest.mark.prove
def test_grid_in_ten_steps_equals_one_build(shared_data, tmp_path):
    corpus = read_corpus(shared_data("grid-s1"))
    some = replace(corpus, recordings=corpus.recordings[::8])
    settings = BuildSettings(keep_captures=True)
    whole = build_database(some, tmp_path / "whole.h5", settings)
    # what the actor looks like at rest is known from the first session on, for both
    some = replace(some, rest=whole.markers.rest, outer_eye_mm=None)
    whole = build_database(some, tmp_path / "whole.h5", settings)
    steps = [replace(some, recordings=list(part)) for part in np.array_split(np.array(some.recordings, object), 10)]
    path = tmp_path / "grown.h5"
    build_database(steps[0], path, settings)
    missed_mm = [add_corpus(path, step).residual_mm for step in steps[1:]]
    grown = open_database(path)
    assert grown.nodes.sentence_names == whole.nodes.sentence_names
    for name in NodeTable.COLUMNS:
        assert np.array_equal(getattr(grown.nodes, name), getattr(whole.nodes, name)), name
    worst_mm = 0.0
    for ours, theirs in zip(np.array_split(grown.frames, 20), np.array_split(whole.frames, 20)):
        apart = grown.pca.positions(ours) - whole.pca.positions(theirs)
        worst_mm = max(worst_mm, float(np.sqrt((apart**2).sum(axis=2).mean())))
    print(f"missed a step {np.round(missed_mm, 3).tolist()} mm; worst twentieth apart {worst_mm:.3f} mm")
    assert worst_mm < 2 * max(missed_mm)
    more = replace(some, recordings=corpus.recordings[1:2])
    add_corpus(path, more, GrowthSettings(refit=True))
    with_more = build_database(
        replace(some, recordings=[*some.recordings, *more.recordings]), tmp_path / "more.h5", settings
    )
    assert open_database(path).content_hash == with_more.content_hash


@pytest.mark.prove
def test_the_demo_in_ten_steps_of_databases_equals_one_build(tmp_path):
    from app.demo import demo_corpus

    corpus = replace(demo_corpus(), held_out={})
    corpus = replace(corpus, recordings=corpus.recordings[:60])
    settings = BuildSettings(keep_captures=True)
    whole = build_database(corpus, tmp_path / "whole.h5", settings)
    path, other = tmp_path / "grown.h5", tmp_path / "step.h5"
    for number in range(10):
        step = replace(corpus, recordings=corpus.recordings[6 * number : 6 * number + 6])
        build_database(step, path if number == 0 else other, settings)
        if number:
            add_database(path, other, GrowthSettings(refit=number == 9))
    assert open_database(path).content_hash == whole.content_hash
    shutil.rmtree(tmp_path)
