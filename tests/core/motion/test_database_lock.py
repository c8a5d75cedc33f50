"""One process writes to a database; its lock goes with it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from core.motion.database_lock import DatabaseLock, DatabaseLocked

REPOSITORY = Path(__file__).resolve().parents[3]
HOLD = "import sys, time; from pathlib import Path; from core.motion.database_lock import DatabaseLock; " \
       "lock = DatabaseLock(Path(sys.argv[1])); print('held', flush=True); time.sleep(60)"  # fmt: skip


@pytest.fixture
def path(tmp_path):
    return tmp_path / "db.h5"


def test_the_second_is_told_who_has_it_and_gets_it_afterwards(path):
    first = DatabaseLock(path)
    with pytest.raises(DatabaseLocked, match=r"process \d+"):
        DatabaseLock(path)
    first.release()
    first.release()
    assert list(path.parent.iterdir()) == []
    DatabaseLock(path).release()


def test_a_killed_process_loses_it(path):
    process = subprocess.Popen([sys.executable, "-c", HOLD, str(path)], cwd=REPOSITORY, stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"held\n"
    with pytest.raises(DatabaseLocked, match=f"process {process.pid}"):
        DatabaseLock(path)
    process.kill()
    process.wait()
    process.stdout.close()
    assert (path.parent / "db.h5.lock").exists()
    with DatabaseLock(path):
        assert (path.parent / "db.h5.lock").read_text().endswith(f"process {os.getpid()}")
    assert not (path.parent / "db.h5.lock").exists()


def test_two_databases_do_not_hinder_each_other(path):
    with DatabaseLock(path), DatabaseLock(path.with_name("other.h5")):
        pass
