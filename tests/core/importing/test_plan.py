"""A plan survives its file, and a wrong one is refused in a sentence that names what is wrong."""

from __future__ import annotations

import json

import pytest

from core.errors import UserFacingError
from core.importing.plan import ImportPlan, MendLimits, Reading, SentencePlan, check_plan, read_plan, write_plan

PLAN = ImportPlan(
    "studio", (SentencePlan("a", "in/a.c3d", "in/a.wav", None, "Hello.", "anger", "", 0.04),
               SentencePlan("b", "in/b.c3d")),
    {"M1": "chin", "M2": "nose", "M3": "left", "M4": "right"}, "nose", ("nose", "left", "right"), {"jaw": ("chin",)},
    {"chin": "chin"}, False, None, Reading(60.0, "cm", (640, 480), ("x", "z", "-y"), None, "sheet.csv"),
    MendLimits(0.3, False, 2.0, 9.0), "session", 60.0, 12, "sentences", "names.txt", "old.h5",
)  # fmt: skip


def test_a_plan_is_the_same_after_json():
    assert ImportPlan.from_json(PLAN.to_json()) == PLAN


def test_a_plan_travels_with_its_folder(tmp_path):
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    plan = ImportPlan("x", (SentencePlan("a", str(here / "in" / "a.c3d"), str(tmp_path / "far.wav")),))
    write_plan(plan, here / "plan.json")
    here.rename(there)
    read = read_plan(there / "plan.json")
    assert read.sentences[0].motion == str(there / "in" / "a.c3d")
    assert read.sentences[0].audio == str(tmp_path / "far.wav")


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"sentences": []}, "no sentence"),
        ({"sentences": [{"name": "a", "motion": "a.c3d"}, {"name": "a", "motion": "b.c3d"}]}, "'a'"),
        ({"sentences": [{"name": "a/b", "motion": "a.c3d"}]}, "a/b"),
        ({"sentences": [{"name": "a", "motion": "a.c3d", "emotion": "bored"}]}, "bored"),
        ({"sentences": [{"name": "a", "motion": "a.c3d", "offset_s": float("nan")}]}, "offset"),
        ({"markers": {"M1": "chin", "M2": "chin"}}, "chin"),
        ({"rigid": ["ear"]}, "ear"),
        ({"offsets": "maybe"}, "maybe"),
        ({"rate_hz": 0}, "rate_hz"),
        ({"reading": {"axes": ["x", "y", "y"]}}, "axes"),
        ({"reading": {"axes": ["-x", "y", "z"]}}, "mirror"),
        ({"format": "something else"}, "format"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_a_wrong_plan_is_refused_by_name(change, word):
    data = json.loads(PLAN.to_json()) | change
    with pytest.raises(UserFacingError) as caught:
        ImportPlan.from_json(json.dumps(data), "'plan.json'")
    assert word in str(caught.value)
    assert "plan.json" in str(caught.value)


def test_turned_axes_are_no_mirror():
    check_plan(PLAN)
