import csv
import io
import random
from dataclasses import replace

import pytest

from core.errors import UserFacingError
from core.evaluation.stimuli import AUDIO, NOT_SURE, SILENT, StudyPlan, stimuli_of, trials_of
from core.evaluation.stimuli_files import KEY_FILE, key_text, playlist_text, read_answers, sheet_text
from core.evaluation.stimuli_tables import CSV_COLUMNS, answer_tables, as_csv, as_text

TRACKS, EXPRESSIONS = ("audio1", "audio2", "audio3"), ("neutral", "happiness", "sadness")
TEXTS = {"audio1": "It is normal.", "audio2": "It is good.", "audio3": "It is bad."}
PLAN = StudyPlan(TRACKS, EXPRESSIONS, n_participants=20)

# Tables III to VII as printed; rows neutral, happy, sad, not sure; columns neutral S R, smile S R, sad S R
PRINTED = {
    "III": [[20, 20, 3, 2, 0, 0], [0, 0, 17, 18, 0, 0], [0, 0, 0, 0, 20, 20], [0] * 6],
    "IV": [[20, 7, 6], [0, 13, 0], [0, 0, 14], [0, 0, 0]],
    "V": [[20, 20, 4, 2, 1, 0], [0, 0, 16, 18, 0, 0], [0, 0, 0, 0, 19, 20], [0] * 6],
    "VI": [[16, 17, 2, 0, 0, 0], [4, 3, 18, 20, 0, 0], [0, 0, 0, 0, 12, 15], [0, 0, 0, 0, 8, 5]],
    "VII": [[13, 14, 14, 13, 0, 0], [0, 0, 2, 4, 0, 0], [7, 6, 0, 0, 20, 20], [0, 0, 4, 3, 0, 0]],
}


def column_of(stimulus):
    """Table and column of a stimulus."""
    if stimulus.kind == AUDIO:
        return "IV", TRACKS.index(stimulus.track)
    column = 2 * EXPRESSIONS.index(stimulus.expression) + ("synthetic", "captured").index(stimulus.face)
    return ("III" if stimulus.kind == SILENT else ("V", "VI", "VII")[TRACKS.index(stimulus.track)]), column


def written(folder, plan, answer):
    """Write a study's key and its sheet, filled by ``answer(trial)``; return the sheet."""
    stimuli = stimuli_of(plan)
    files = {s.code: f"stimuli/{s.code}.mp4" for s in stimuli}
    (folder / KEY_FILE).write_text(key_text(stimuli, files, TEXTS))
    rows = list(csv.reader(io.StringIO(sheet_text(trials_of(plan)))))
    for row, trial in zip(rows[1:], trials_of(plan)):
        assert row[:5] == [
            str(x) for x in (trial.participant, trial.group, trial.trial, trial.part, trial.stimulus.code)
        ]
        row[5] = answer(trial)
    sheet = folder / "filled.csv"
    sheet.write_text("\n".join(",".join(row) for row in rows))
    return sheet


@pytest.fixture
def as_printed(tmp_path):
    """A sheet of twenty participants who answer as the paper's did."""
    left = {
        (table, c): [name for name, row in zip((*EXPRESSIONS, NOT_SURE), rows) for _ in range(row[c])]
        for table, rows in PRINTED.items()
        for c in range(len(rows[0]))
    }
    return written(tmp_path, PLAN, lambda trial: left[column_of(trial.stimulus)].pop())


def test_the_papers_answers_make_the_papers_tables(as_printed):
    tables = answer_tables(read_answers(as_printed))
    assert [table.number for table in tables] == list(PRINTED)
    for table in tables:
        assert [[cell.count for cell in row] for row in table.cells] == PRINTED[table.number]
        assert all(cell.of == 20 for row in table.cells for cell in row)
        assert table.answers == (*EXPRESSIONS, NOT_SURE)
    assert "It is good." in tables[3].title
    # 17 of 20 by Wilson, worked out by hand: (0.85 + 1.9207/20 ± 1.96 √(0.1275/20 + 0.9604/400)) / (1 + 3.8415/20)
    smile = tables[0].cells[1][2]
    assert (smile.low, smile.high) == pytest.approx((0.6396, 0.9476), abs=1e-4)


def test_tables_are_read_by_people_and_by_programs(as_printed):
    tables = answer_tables(read_answers(as_printed))
    text = as_text(tables)
    for line in ("TABLE III: silent faces", "TABLE VII: faces with audio audio3, “It is bad.”"):
        assert line in text
    assert max(len(line) for line in text.splitlines()) <= 100
    rows = list(csv.DictReader(io.StringIO(as_csv(tables))))
    assert tuple(rows[0]) == CSV_COLUMNS and len(rows) == 4 * (6 + 3 + 18)
    place = ("VI", "sadness", "captured", NOT_SURE)
    found = [r for r in rows if (r["table"], r["condition"], r["face"], r["answer"]) == place]
    assert [(r["count"], r["of"], float(r["share"])) for r in found] == [("5", "20", 0.25)]


def test_known_rates_are_recovered_and_intervals_hold_them(tmp_path):
    """Two hundred simulated people: the truth lies in about 95 % of the intervals, and near every share."""
    chance = random.Random(11)
    rates = {}

    def answer(trial):
        cell = column_of(trial.stimulus)
        if cell not in rates:
            cuts = sorted(chance.random() for _ in range(3))
            rates[cell] = [b - a for a, b in zip([0, *cuts], [*cuts, 1])]
        return chance.choices((*EXPRESSIONS, NOT_SURE), rates[cell])[0]

    sheet = written(tmp_path, replace(PLAN, n_participants=200), answer)
    for interval, fewest in (("wilson", 0.90), ("exact", 0.92)):
        held, n = 0, 0
        for table in answer_tables(read_answers(sheet), interval):
            for row, truths in zip(table.cells, zip(*[rates[table.number, c] for c in range(len(table.columns))])):
                for cell, truth in zip(row, truths):
                    assert abs(cell.count / cell.of - truth) < 4.5 * (truth * (1 - truth) / 200) ** 0.5 + 0.005
                    held, n = held + (cell.low <= truth <= cell.high), n + 1
        assert n == 108 and held / n >= fewest


def test_answers_are_understood_as_people_write_them(tmp_path):
    said = iter(["Sadness ", "NOT  SURE", "?", "unsure", ""] * 200)
    sheet = written(tmp_path, PLAN, lambda trial: next(said))
    answers = read_answers(sheet)
    assert {a.answer for a in answers.given} == {"sadness", NOT_SURE}
    assert answers.unanswered == len(trials_of(PLAN)) // 5
    # as a spreadsheet saves it
    sheet.write_bytes(b"\xef\xbb\xbf" + sheet.read_text().replace(",", ";").replace("\n", "\r\n").encode())
    assert read_answers(sheet) == answers


def test_a_study_half_done_is_counted_over_those_who_were_asked(tmp_path):
    sheet = written(tmp_path, PLAN, lambda trial: "neutral" if trial.participant <= 3 and trial.part == 1 else "")
    (table,) = answer_tables(read_answers(sheet))
    assert table.number == "III"
    assert {(cell.count, cell.of) for cell in table.cells[0]} == {(3, 3)}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda lines: [*lines[:3], "9,A,1,1,s99,neutral"], "line 4: the key knows no stimulus 's99'"),
        (lambda lines: [*lines[:2], lines[2].rsplit(",", 1)[0] + ",surprise"], "line 3: 'surprise' is no answer"),
        (lambda lines: [*lines[:2], lines[1]], "line 3: participant 1 has answered 's.*' in line 2"),
        (lambda lines: [lines[0], "," + lines[1].split(",", 1)[1]], "line 2: there is no participant"),
        (lambda lines: ["participant,stimulus"], "no column 'answer'"),
        (lambda lines: [lines[0]], "lists nothing"),
    ],
)
def test_a_wrong_sheet_is_told_by_its_line(tmp_path, change, sentence):
    sheet = written(tmp_path, PLAN, lambda trial: "neutral")
    sheet.write_text("\n".join(change(sheet.read_text().splitlines())))
    with pytest.raises(UserFacingError, match=sentence):
        read_answers(sheet)


def test_a_wrong_or_missing_key_is_told(tmp_path):
    sheet = written(tmp_path, PLAN, lambda trial: "neutral")
    key = tmp_path / KEY_FILE
    lines = key.read_text().splitlines()
    for wrong, sentence in (
        ([*lines, lines[1]], "is there twice"),
        ([lines[0], "s01,f,smell,audio1,,,"], "no stimulus of a study"),
        ([lines[0], "s01,f,audio,audio1,,sadness,"], "sound alone neither"),
    ):
        key.write_text("\n".join(wrong))
        with pytest.raises(UserFacingError, match=sentence):
            read_answers(sheet)
    key.unlink()
    with pytest.raises(UserFacingError, match="There is no key"):
        read_answers(sheet)


def test_damaged_sheets_are_read_or_refused_in_a_sentence(tmp_path, survives_damage):
    sheet = written(tmp_path, replace(PLAN, n_participants=2), lambda trial: "sadness")
    assert survives_damage(sheet, lambda path: read_answers(path, tmp_path / KEY_FILE), 150) > 20


def test_a_playlist_names_the_films_in_order():
    trials = [t for t in trials_of(PLAN) if t.participant == 2]
    files = {s.code: f"stimuli/{s.code}.mp4" for s in stimuli_of(PLAN)}
    lines = playlist_text(trials, files).splitlines()
    assert lines[0] == "#EXTM3U" and lines[1:] == [f"../stimuli/{t.stimulus.code}.mp4" for t in trials]
