"""The polish layer scales what is there, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import Polish, polished, region_weights

RATE_HZ = 60.0
NAMES = ("lip", "chin", "brow_l", "brow_r", "eye_l", "eye_r", "crown")
REST = np.array([[0, -40, 0], [0, -70, 0], [-30, 30, 0], [30, 30, 0], [-45, 0, 0], [45, 0, 0], [0, 200, 0]], float)
MARKERS = MarkerSet(
    NAMES, REST, {"lips": ("lip",), "jaw": ("chin",)},
    {"brow_left": "brow_l", "brow_right": "brow_r", "outer_eye_left": "eye_l", "outer_eye_right": "eye_r"},
)  # fmt: skip


@pytest.fixture
def motion():
    rng = np.random.default_rng(4)
    wander = rng.normal(size=(180, len(NAMES), 3)).cumsum(axis=0) * 0.3
    return MarkerMotion((REST + wander).astype(np.float32), RATE_HZ, MARKERS)


def displacements(motion) -> np.ndarray:
    return np.asarray(motion.positions, float) - REST


def test_an_empty_layer_changes_nothing(motion):
    assert polished(motion, Polish()) is motion
    assert polished(motion, Polish(curves={"lips": ((0.5, 1.0),)})) is motion


def test_a_curve_scales_its_own_region_and_leaves_far_markers_alone(motion):
    out = displacements(polished(motion, Polish(curves={"lips": ((0.0, 2.0),)})))
    weight = region_weights(MARKERS)["lips"]
    assert out == pytest.approx(displacements(motion) * (1 + weight)[None, :, None], abs=1e-4)
    assert weight[0] > 0.9
    assert weight[6] < 1e-6


def test_a_curve_goes_through_its_keys_and_stays_outside_them():
    polish = Polish().with_curve("jaw", ((2.0, 0.0), (1.0, 2.0)))
    assert polish.gain("jaw", np.array([0.0, 1.0, 2.0, 9.0])) == pytest.approx([2.0, 2.0, 0.0, 0.0])
    between = polish.gain("jaw", np.linspace(1.0, 2.0, 20))
    assert (np.diff(between) <= 0).all()  # no overshoot
    assert polish.gain("lips", np.array([1.0])) == pytest.approx([1.0])


def test_a_still_face_stays_still_whatever_the_gains():
    still = MarkerMotion(np.repeat(REST[None], 30, axis=0).astype(np.float32), RATE_HZ, MARKERS)
    out = polished(still, Polish(2.0, 2.0, {"brows": ((0.0, 3.0),)}))
    assert out.positions == pytest.approx(still.positions, abs=1e-4)


def test_expression_scales_a_held_pose_and_articulation_does_not():
    held = MarkerMotion(np.repeat(REST[None] + 2.0, 120, axis=0).astype(np.float32), RATE_HZ, MARKERS)
    assert displacements(polished(held, Polish(expression=0.5))) == pytest.approx(1.0, abs=1e-4)
    assert displacements(polished(held, Polish(articulation=2.0))) == pytest.approx(2.0, abs=1e-4)


def test_articulation_scales_quick_motion_of_the_mouth_only():
    times_s = np.arange(240) / RATE_HZ
    quick = REST[None] + np.sin(2 * np.pi * 5 * times_s)[:, None, None]
    motion = MarkerMotion(quick.astype(np.float32), RATE_HZ, MARKERS)
    out = displacements(polished(motion, Polish(articulation=2.0)))[60:180]
    before = displacements(motion)[60:180]
    assert np.ptp(out[:, 0]) == pytest.approx(2.0 * np.ptp(before[:, 0]), rel=0.05)
    assert out[:, 6] == pytest.approx(before[:, 6], abs=1e-4)


@pytest.mark.parametrize("bad", [
    {"articulation": -0.1}, {"expression": 9.0}, {"articulation": float("nan")}, {"curves": {"nose": ((0.0, 1.0),)}},
    {"curves": {"lips": ((0.0, -1.0),)}},
])  # fmt: skip
def test_gains_out_of_range_and_unknown_regions_are_refused(bad):
    with pytest.raises(ValueError, match=r"gain|region"):
        Polish(**bad)
