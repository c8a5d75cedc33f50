"""A journal gives back what it was given, whatever a kill left of its end."""

from __future__ import annotations

import numpy as np

from core.evaluation.tuning_journal import TuningJournal

POINT = np.array([0.1, -1 / 3, 2e-17])


def test_what_was_measured_is_found_again_to_the_last_bit(tmp_path):
    path = tmp_path / "deep" / "run.jsonl"
    journal = TuningJournal(path)
    journal.add(POINT, False, [0, 2], [1 / 7, 3.5])
    journal.add(POINT, True, [0], [9.0])
    journal.close()
    again = TuningJournal(path)
    assert len(again) == 3
    assert [again.error(POINT, False, s) for s in (0, 1, 2)] == [1 / 7, None, 3.5]
    assert again.error(POINT, True, 0) == 9.0
    assert again.error(POINT + 1e-12, False, 0) is None
    again.close(finished=True)
    assert not path.exists()


def test_every_cut_of_the_file_keeps_the_whole_lines(tmp_path):
    path = tmp_path / "run.jsonl"
    journal = TuningJournal(path)
    for s in range(5):
        journal.add(POINT, False, [s], [float(s)])
    journal.close()
    raw = path.read_bytes()
    for cut in range(len(raw) + 1):
        path.write_bytes(raw[:cut])
        resumed = TuningJournal(path)
        whole = max(raw[:cut].count(b"\n") - 1, 0)
        assert len(resumed) == whole
        resumed.add(POINT, False, [77], [7.0])
        resumed.close()
        after = TuningJournal(path)
        assert len(after) == whole + 1
        after.close()


def test_a_file_that_is_no_journal_is_begun_anew(tmp_path):
    path = tmp_path / "run.jsonl"
    path.write_bytes(b'{"format": "something else"}\n\xff\xfe')
    journal = TuningJournal(path)
    assert len(journal) == 0
    journal.close()
    assert path.read_bytes().count(b"\n") == 1


def test_without_a_file_it_only_remembers():
    journal = TuningJournal(None)
    journal.add(POINT, False, [0], [1.0])
    assert journal.error(POINT, False, 0) == 1.0
    journal.close(finished=True)
