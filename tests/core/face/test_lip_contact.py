import numpy as np
import pytest

from core.face.lip_contact import LipContact


@pytest.fixture(scope="module")
def lips(face):
    return LipContact.of(face)


def apart(face, lips, gap_mm):
    """Vertex displacements that bring all of the lower lip ``gap_mm`` away from the upper one."""
    moved = np.zeros_like(face.positions)
    lower = face.positions[:, 1] < face.positions[face.landmarks["upper_lip"], 1]
    moved[lower, 1] = -gap_mm
    moved[lips.upper, 1] = 0.0
    moved[lips.lower, 1] = -gap_mm
    return moved


def test_the_pairs_run_from_corner_to_corner_and_face_each_other(face, lips):
    at = face.positions[lips.upper]
    corners = [face.positions[face.landmarks[f"mouth_corner_{side}"], 0] for side in ("right", "left")]
    assert np.ptp(at[:, 0]) > 0.75 * (corners[1] - corners[0])
    assert np.linalg.norm(at - face.positions[lips.lower], axis=1).max() < 2.0
    assert not set(lips.upper) & set(lips.lower)


@pytest.mark.parametrize("gap_mm", [-3.0, -1.0, 0.3, 0.7])
def test_overlap_and_slits_become_contact(face, lips, gap_mm):
    moved = apart(face, lips, gap_mm)
    for _ in range(2):
        lips.apply(moved)
    assert np.abs(np.median(lips.gaps(moved))) < 0.1
    assert lips.gaps(moved).min() > -0.4


def test_an_open_mouth_is_left_alone(face, lips):
    moved = apart(face, lips, 6.0)
    before = moved.copy()
    lips.apply(moved)
    np.testing.assert_array_equal(moved, before)


def test_a_wider_gap_never_becomes_the_smaller_one(face, lips):
    after = []
    for gap_mm in np.linspace(0.0, 5.0, 26):
        moved = apart(face, lips, gap_mm)
        lips.apply(moved)
        after.append(np.median(lips.gaps(moved)))
    assert (np.diff(after) > -1e-4).all()


def test_a_face_without_lips_has_none(face):
    from dataclasses import replace

    assert LipContact.of(replace(face, landmarks={})) is None
