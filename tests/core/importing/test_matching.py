"""Markers find their partners: by name whatever the spelling, by place whatever order, turn, size and gaps."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.actress.corpus import actress_marker_set
from core.face.similarity import fit_similarity
from core.importing.geometry_matching import assigned
from core.importing.marker_parts import propose_parts
from core.importing.matching import match_markers, typical_pose
from core.importing.name_matching import likeness
from core.motion.marker_set import MarkerSet
from core.motion.motion_files import read_motion


@pytest.mark.parametrize(
    ("found", "wanted"),
    [("Actor01:LBrow_Out", "eyebrow_outer_left"), ("Lcheek_Up", "cheek_upper_left"), ("CHIN", "jaw"),
     ("Mouth_Rend", "mouth_corner_right"), ("lip.upper.m", "upper_lip_mid"), ("M07", "m_7")],
)  # fmt: skip
def test_names_that_mean_the_same_are_one(found, wanted):
    assert likeness(found, wanted) >= 0.95


@pytest.mark.parametrize(("found", "wanted"), [("cheek_left", "cheek_right"), ("chin1", "chin2"), ("eye_up", "lip_up")])
def test_another_side_number_or_part_is_never_alike(found, wanted):
    assert likeness(found, wanted) == 0.0


def test_the_similarity_is_that_of_another_library():
    rng = np.random.default_rng(3)
    points = rng.normal(size=(20, 3))
    goal = 1.3 * Rotation.random(random_state=3).apply(points) + [4, 5, 6] + rng.normal(0, 0.05, (20, 3))
    fit = fit_similarity(points, goal)
    turned, _ = Rotation.align_vectors(goal - goal.mean(axis=0), points - points.mean(axis=0))
    assert np.allclose(fit.rotation, turned.as_matrix(), atol=1e-9)
    assert fit.scale == pytest.approx(1.3, abs=0.05)


def test_the_assignment_is_the_best_of_all():
    rng = np.random.default_rng(4)
    ours, theirs = rng.normal(size=(5, 3)), rng.normal(size=(6, 3))
    _, _, distance = assigned(ours, theirs)
    least = min(
        np.linalg.norm(ours - theirs[list(order)], axis=1).sum() for order in itertools.permutations(range(6), 5)
    )
    assert distance.sum() == pytest.approx(least)


@pytest.mark.parametrize("seed", range(6))
def test_nameless_markers_are_told_by_place_alone(seed, shared_data):
    """Another take of the same face, six markers lost, shuffled, turned, 20 % larger: every one is found."""
    folder = shared_data("animface-mocap")
    known, names, _ = read_motion(folder / "Jaw.c3d")
    pose = typical_pose(known)
    wanted = MarkerSet(names, pose - pose.mean(axis=0))
    take, _, _ = read_motion(folder / "Nose.c3d")
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(names))[:-6]
    turned = 1.2 * take[:, order].astype(float) @ Rotation.random(random_state=seed).as_matrix().T + 300
    turned[rng.random(turned.shape[:2]) < 0.05] = np.nan
    matching = match_markers([f"#{i}" for i in range(len(order))], turned, wanted)
    assert {m.found: m.wanted for m in matching.matches} == {f"#{i}": names[k] for i, k in enumerate(order)}
    assert set(matching.unmatched_wanted) == set(names) - {names[k] for k in order}
    assert all(m.how == "place" for m in matching.matches)


def test_a_marker_that_is_nobodys_stays_alone():
    wanted = actress_marker_set()
    names = [*wanted.names, "hat"]
    pose = np.vstack([wanted.rest, wanted.rest.max(axis=0) + np.array([0, 120, 0])])
    matching = match_markers(names, pose, wanted)
    assert matching.unmatched_found == ("hat",)
    assert all(m.found == m.wanted and m.confidence == 1.0 for m in matching.matches)


def test_parts_of_an_unknown_set_are_told_by_a_known_one(shared_data):
    """By the data's own names: NoseHead is the tip of the nose, Mouth_Lend the left corner of the mouth."""
    take, names, _ = read_motion(shared_data("animface-mocap") / "Eyebrows.c3d")
    parts = propose_parts(names, typical_pose(take), actress_marker_set())
    expected = {"chin": "Chin", "nose_tip": "NoseHead", "mouth_corner_left": "Mouth_Lend", "upper_lip": "Mouth_Up",
                "mouth_corner_right": "Mouth_Rend", "lower_lip": "Mouth_Down",
                "outer_eye_left": "Leye_Outside"}  # fmt: skip
    assert expected.items() <= parts.landmarks.items()
    assert {"Chin", "Chin_L1", "Chin_R1"} <= set(parts.groups["jaw"])


def test_markers_that_are_never_seen_break_nothing():
    wanted = actress_marker_set()
    pose = wanted.rest.copy()
    pose[5] = np.nan
    matching = match_markers([f"m{i}" for i in range(len(wanted))], pose, wanted)
    assert "m5" in matching.unmatched_found
    assert match_markers(["a", "b"], np.full((2, 3), np.nan), wanted).matches == ()
