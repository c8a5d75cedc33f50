"""An import makes what a build makes, tells what it did, drops what fails, and goes on after a kill."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from core.batch.workers import cores, workers_at
from core.errors import UserFacingError
from core.importing.plan import ImportPlan, SentencePlan, write_plan
from core.importing.report import KEY, ImportReport
from core.importing.run import import_motion, run_import
from core.motion.build import build_database
from core.motion.database import open_database
from core.motion.motion_files import write_c3d
from core.motion.readers.corpus_folder import read_corpus

NAMES = tuple(f"m{k}" for k in range(24))
RATE_HZ = 60.0


@pytest.fixture
def studio(tmp_path, capture):
    """A folder of five takes with sound and phones, which is a corpus folder too."""
    folder = tmp_path / "studio"
    folder.mkdir()
    rows = ["sentence,emotion,text"]
    for s in range(5):
        write_c3d(folder / f"t{s}.c3d", capture(s, n_frames=120).astype(np.float32), NAMES, RATE_HZ)
        soundfile.write(folder / f"t{s}.wav", 0.1 * np.random.default_rng(s).normal(size=32_000), 16_000)
        phones = ("b", "aa", "m", "iy", "w", "aa", "b", "iy")
        lines = ["0.0 0.2 pau", *(f"{0.2 + 0.2 * i:.1f} {0.4 + 0.2 * i:.1f} {p}" for i, p in enumerate(phones))]
        (folder / f"t{s}.lab").write_text("\n".join([*lines, "1.8 2.0 pau"]) + "\n")
        rows.append(f"t{s},{'anger' if s % 2 else 'neutral'},say {s}")
    (folder / "corpus.csv").write_text("\n".join(rows) + "\n")
    (folder / "markers.csv").write_text(
        "marker,kept,groups\n"
        + "\n".join(f"{name},1,{'rigid' if k < 6 else ''}" for k, name in enumerate(NAMES))
        + "\n"
    )
    return folder


@pytest.fixture
def plan(studio):
    sentences = tuple(
        SentencePlan(f"t{s}", *(str(studio / f"t{s}{suffix}") for suffix in (".c3d", ".wav", ".lab")), f"say {s}",
                     "anger" if s % 2 else "neutral")
        for s in range(5)
    )  # fmt: skip
    rigid = NAMES[:6]
    return ImportPlan("studio", sentences, {n: n for n in NAMES}, None, rigid, {"rigid": rigid}, n_dims=8)


def test_an_import_equals_the_build_of_the_same_folder(studio, plan, tmp_path):
    built = build_database(read_corpus(studio), tmp_path / "built.h5")
    imported = run_import(replace(plan, n_dims=25), tmp_path / "imported.h5", folder=tmp_path / "work")
    assert imported.database.content_hash == built.content_hash
    assert not list((tmp_path / "work").iterdir())


def test_all_workers_make_the_same(plan, tmp_path):
    one = run_import(plan, tmp_path / "one.h5", folder=tmp_path / "a")
    two = run_import(plan, tmp_path / "two.h5", workers=cores(2), folder=tmp_path / "b")
    assert one.database.content_hash == two.database.content_hash
    assert one.report == two.report


def test_the_report_travels_with_the_database(studio, plan, tmp_path, capture):
    hurt = capture(2, n_frames=120)
    hurt[30:36, 9] = np.nan
    hurt[70, 12] += 15.0
    hurt[90:96, [14, 20]] = hurt[90:96, [20, 14]]
    write_c3d(studio / "t2.c3d", hurt, NAMES, RATE_HZ)
    made = run_import(plan, tmp_path / "db.h5", folder=tmp_path / "work")
    stored = ImportReport.from_dict(open_database(tmp_path / "db.h5").report[KEY])
    assert stored == made.report
    row = stored.rows[2]
    assert (row.gaps_filled, row.gap_samples, row.spikes_cut, row.swaps_undone) == (1, 6, 1, 1)
    assert row.alignment == "given"
    assert row.rigid_residual_mm < 0.1
    assert "1 gaps filled" in stored.in_words()


def test_a_sentence_that_fails_stops_no_other(studio, plan, tmp_path):
    (studio / "t1.c3d").write_bytes(b"no motion")
    (studio / "t3.lab").unlink()
    made = run_import(plan, tmp_path / "db.h5", folder=tmp_path / "work")
    assert [row.sentence for row in made.report.failures] == ["t1", "t3"]
    assert "t1.c3d" in made.report.failures[0].failure
    assert [s.name for s in made.database.sentences] == ["t0", "t2", "t4"]


def test_nothing_is_written_when_all_fail(plan, tmp_path):
    hopeless = replace(plan, sentences=(replace(plan.sentences[0], motion=str(tmp_path / "absent.c3d")),))
    with pytest.raises(UserFacingError, match="absent"):
        run_import(hopeless, tmp_path / "db.h5", folder=tmp_path / "work")
    assert not (tmp_path / "db.h5").exists()


def test_takes_without_speech_make_motion_and_no_database(plan, tmp_path, capture):
    silent = replace(plan, sentences=tuple(replace(s, audio=None, transcript=None, text="") for s in plan.sentences))
    with pytest.raises(UserFacingError, match="speech"):
        run_import(silent, tmp_path / "db.h5", folder=tmp_path / "work")
    shown = import_motion(silent, folder=tmp_path / "work")
    take = capture(3, n_frames=120)
    apart = np.linalg.norm(take[:, 10] - take[:, 20], axis=1)
    motion = shown.motions[3].positions
    assert np.allclose(np.linalg.norm(motion[:, 10] - motion[:, 20], axis=1), apart, atol=1e-3)
    assert motion[:, :6].std(axis=0).max() < 0.05  # the head is still


def test_offsets_that_are_told_are_taken_out(plan, tmp_path):
    late = replace(plan, sentences=tuple(replace(s, offset_s=0.1) for s in plan.sentences))
    shown = import_motion(late, folder=tmp_path / "a").recordings[0].positions
    on_time = import_motion(plan, folder=tmp_path / "b").recordings[0].positions
    assert np.array_equal(shown, on_time[6:])


def test_a_change_of_plan_or_file_is_never_answered_from_old_work(studio, plan, tmp_path, capture):
    folder = tmp_path / "work"
    run = [sys.executable, "-c", _HALT_AFTER.format(n=3, plan=_written(plan, tmp_path), folder=folder)]
    subprocess.run(run, check=False, timeout=60)
    assert len(list(folder.glob("*.npz"))) == 3
    write_c3d(studio / "t0.c3d", capture(9, n_frames=120).astype(np.float32), NAMES, RATE_HZ)
    made = run_import(replace(plan, rate_hz=60.0), tmp_path / "db.h5", folder=folder)
    assert made.report.n_resumed == 2
    fresh = run_import(replace(plan, rate_hz=60.0), tmp_path / "fresh.h5", folder=tmp_path / "other")
    assert made.database.content_hash == fresh.database.content_hash


_HALT_AFTER = """
import os
from pathlib import Path
from core.importing import run
from core.importing.plan import read_plan
done = []
work = run._work
def halting(*arguments):
    if len(done) == {n}:
        os._exit(9)
    done.append(1)
    return work(*arguments)
run._work = halting
run.run_import(read_plan(Path({plan!r})), Path({plan!r} + ".h5"), folder=Path("{folder}"))
"""


def _written(plan: ImportPlan, folder: Path) -> str:
    write_plan(plan, folder / "plan.json")
    return str(folder / "plan.json")


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no kill -9")
def test_an_import_that_was_killed_goes_on(plan, tmp_path):
    """Killed (SIGKILL) as soon as two sentences are finished; the second run does the rest and ends the same."""
    folder = tmp_path / "work"
    code = (
        "import time\nfrom pathlib import Path\n"
        "from core.importing import run\nfrom core.importing.plan import read_plan\n"
        "work = run._work\n"
        "run._work = lambda *a: (work(*a), time.sleep(0.5))[0]\n"
        f"run.run_import(read_plan(Path({_written(plan, tmp_path)!r})), Path({str(tmp_path / 'db.h5')!r}), "
        f"folder=Path({str(folder)!r}))\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code])
    limit = time.monotonic() + 60
    while len(list(folder.glob("[!.]*.npz")) if folder.is_dir() else []) < 2 and time.monotonic() < limit:
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert not (tmp_path / "db.h5").exists()
    made = run_import(plan, tmp_path / "db.h5", folder=folder)
    assert 2 <= made.report.n_resumed < 5
    fresh = run_import(plan, tmp_path / "fresh.h5", folder=tmp_path / "other")
    assert made.database.content_hash == fresh.database.content_hash


def test_a_finished_sentence_that_was_damaged_is_done_again(plan, tmp_path):
    folder = tmp_path / "work"
    subprocess.run([sys.executable, "-c", _HALT_AFTER.format(n=2, plan=_written(plan, tmp_path), folder=folder)],
                   check=False, timeout=60)  # fmt: skip
    first, second = sorted(folder.glob("*.npz"))
    first.write_bytes(first.read_bytes()[:500])
    second.write_bytes(b"")
    assert run_import(plan, tmp_path / "db.h5", folder=folder).report.n_resumed == 0


@pytest.mark.prove
def test_the_import_of_tracked_video_equals_its_build(shared_data, tmp_path):
    """All 480 GRID sentences, through the plan that the survey proposes."""
    from core.importing.survey import survey

    folder = shared_data("grid-s1")
    plan = survey([folder]).plan("grid")
    made = run_import(plan, tmp_path / "imported.h5", folder=tmp_path / "work")
    assert made.database.content_hash == build_database(read_corpus(folder), tmp_path / "built.h5").content_hash


@pytest.mark.prove
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_makes_the_same(plan, tmp_path):
    distributed = pytest.importorskip("distributed")
    alone = run_import(plan, tmp_path / "alone.h5", folder=tmp_path / "a")
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, workers_at(cluster.scheduler_address, 1, "Importing") as workers:
        there = run_import(plan, tmp_path / "there.h5", workers=workers, folder=tmp_path / "b")
    assert there.database.content_hash == alone.database.content_hash
