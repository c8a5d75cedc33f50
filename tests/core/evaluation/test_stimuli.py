import itertools
import subprocess
import sys
from collections import Counter
from dataclasses import replace

import pytest

from core.errors import UserFacingError
from core.evaluation.stimuli import AUDIO, BIMODAL, DESIGNS, ONCE, SILENT, StudyPlan, stimuli_of, trials_of

TRACKS, EXPRESSIONS = ("good", "bad", "normal"), ("neutral", "happiness", "sadness")
PAPER_PLAN = StudyPlan(TRACKS, EXPRESSIONS, n_participants=24, seed=5)
ONCE_PLAN = replace(PAPER_PLAN, design=ONCE, n_participants=42)
PLANS = [PAPER_PLAN, ONCE_PLAN, replace(PAPER_PLAN, faces=("synthetic",)), StudyPlan(TRACKS[:1], EXPRESSIONS[:2])]


def by_participant(plan):
    trials = trials_of(plan)
    return {p: [t for t in trials if t.participant == p] for p in range(1, plan.n_participants + 1)}


@pytest.mark.parametrize("plan", PLANS)
def test_every_combination_is_a_stimulus_once(plan):
    stimuli = stimuli_of(plan)
    combinations = set(itertools.product(plan.tracks, plan.expressions, plan.faces))
    for kind in (SILENT, BIMODAL):
        assert Counter((s.track, s.expression, s.face) for s in stimuli if s.kind == kind) == Counter(combinations)
    assert Counter(s.track for s in stimuli if s.kind == AUDIO) == Counter(plan.tracks)
    assert len({s.code for s in stimuli}) == len(stimuli)


@pytest.mark.parametrize("plan", PLANS)
def test_nobody_meets_a_stimulus_twice_and_trials_count_through(plan):
    for trials in by_participant(plan).values():
        assert max(Counter(t.stimulus.code for t in trials).values()) == 1
        assert [t.trial for t in trials] == list(range(1, len(trials) + 1))
        assert [t.part for t in trials] == sorted(t.part for t in trials)


@pytest.mark.parametrize("plan", PLANS)
def test_groups_are_equal_and_meet_the_kinds_of_face_in_opposite_order(plan):
    everybody = by_participant(plan)
    groups = Counter(trials[0].group for trials in everybody.values())
    assert groups["A"] == groups["B"] == plan.n_participants // 2
    for trials in everybody.values():
        order = list(dict.fromkeys(t.stimulus.face for t in trials if t.stimulus.kind == BIMODAL))
        expected = list(plan.faces if trials[0].group == "A" else plan.faces[::-1])
        assert order == [face for face in expected if face in order]
        kinds = [t.stimulus.kind for t in trials]
        assert kinds == sorted(kinds, key=(SILENT, AUDIO, BIMODAL).index)


def test_in_the_papers_design_everybody_meets_everything_and_each_audio_alone_once():
    for trials in by_participant(PAPER_PLAN).values():
        bimodal = Counter((t.stimulus.track, t.stimulus.expression, t.stimulus.face) for t in trials
                          if t.stimulus.kind == BIMODAL)  # fmt: skip
        assert bimodal == Counter(itertools.product(TRACKS, EXPRESSIONS, PAPER_PLAN.faces))
        assert Counter(t.stimulus.track for t in trials if t.stimulus.kind == AUDIO) == Counter(TRACKS)


def test_heard_once_is_heard_once_in_all():
    for trials in by_participant(ONCE_PLAN).values():
        assert Counter(t.stimulus.track for t in trials if t.stimulus.kind != SILENT) == Counter(TRACKS)


@pytest.mark.parametrize("design", DESIGNS)
def test_in_each_group_combinations_are_met_equally_often(design):
    plan = replace(PAPER_PLAN, design=design)
    plan = replace(plan, n_participants=2 * plan.balanced_by)
    for group in "AB":
        met = Counter()
        for t in trials_of(plan):
            if t.group == group:
                met[t.stimulus.kind, t.stimulus.track, t.stimulus.expression, t.stimulus.face] += 1
        for kind in (SILENT, AUDIO, BIMODAL):
            of_kind = [n for what, n in met.items() if what[0] == kind]
            assert len(set(of_kind)) == 1
            assert len(of_kind) == (3 if kind == AUDIO else 18)


@pytest.mark.parametrize("design", DESIGNS)
def test_everybody_sees_each_silent_cell_once(design):
    for trials in by_participant(replace(PAPER_PLAN, design=design)).values():
        silent = Counter((t.stimulus.expression, t.stimulus.face) for t in trials if t.stimulus.kind == SILENT)
        assert silent == Counter(itertools.product(EXPRESSIONS, PAPER_PLAN.faces))


def test_orders_differ_between_participants_and_are_no_favourites():
    """Over many participants each stimulus stands first, and last, about as often as any other."""
    plan = replace(PAPER_PLAN, n_participants=450)
    firsts = Counter()
    for trials in by_participant(plan).values():
        part = [t for t in trials if t.part == 3]
        firsts[part[0].stimulus.code] += 1
        assert all(a.stimulus.track != b.stimulus.track for a, b in itertools.pairwise(part))
    assert len(firsts) == 18
    assert all(5 < n < 47 for n in firsts.values())  # 25 expected; 4.5 standard deviations to either side


def test_with_one_kind_of_face_the_groups_mirror_each_other():
    plan = replace(PAPER_PLAN, faces=("synthetic",))
    everybody = by_participant(plan)
    for p in range(1, plan.n_participants, 2):
        for part in (1, 2, 3):
            one, other = ([t.stimulus for t in everybody[q] if t.part == part] for q in (p, p + 1))
            assert other == one[::-1]


def test_a_seed_gives_the_same_in_another_process_and_another_seed_does_not():
    script = (
        "from core.evaluation.stimuli import *; "
        f"print([(t.participant, t.trial, t.stimulus.code, t.stimulus.track) for t in trials_of({PAPER_PLAN!r})])"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.strip()
    assert said == str([(t.participant, t.trial, t.stimulus.code, t.stimulus.track) for t in trials_of(PAPER_PLAN)])
    other = replace(PAPER_PLAN, seed=6)
    assert [t.stimulus for t in trials_of(other)] != [t.stimulus for t in trials_of(PAPER_PLAN)]
    assert stimuli_of(other) != stimuli_of(PAPER_PLAN)


def test_codes_tell_nothing():
    """The order of the codes is not that of the conditions."""
    kinds = [s.kind for s in sorted(stimuli_of(PAPER_PLAN), key=lambda s: s.code)]
    assert sum(a != b for a, b in itertools.pairwise(kinds)) > 8


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"n_participants": 7}, "7 participants do not make two equal groups"),
        ({"tracks": ()}, "one audio or more"),
        ({"expressions": ("sadness", "sadness")}, "'sadness' twice"),
        ({"design": "mine"}, "no design 'mine'"),
    ],
)
def test_what_makes_no_study_is_told(change, sentence):
    with pytest.raises(UserFacingError, match=sentence):
        replace(PAPER_PLAN, **change)
