"""The markers that keep their places are found under any head motion, and their residual is what was put in."""

from __future__ import annotations

import numpy as np
import pytest

from core.importing.steady_markers import propose_steady, rigid_residual_mm
from core.motion.motion_files import read_motion

NAMES = tuple(f"m{k}" for k in range(24))
README_RMS_MM = {"Eyebrows": 0.5, "Jaw": 0.8, "Nose": 0.8, "Cheeks": 1.6}


def test_the_rigid_markers_are_found_in_spite_of_the_head(capture):
    steady = propose_steady(NAMES, [capture(1), capture(2)], midline=("m20", "m3"))
    assert set(steady.rigid) == {f"m{k}" for k in range(6)}
    assert steady.origin == "m3"


def test_the_residual_is_the_jitter_that_was_made(capture):
    """Jitter of σ a coordinate leaves √3 σ a marker, less what the fit of six markers takes up (6 of 18 freedoms)."""
    residual = rigid_residual_mm(capture(jitter_mm=0.3, n_frames=3000), range(6))
    assert np.sqrt((residual**2).mean()) == pytest.approx(0.3 * np.sqrt(3 * (1 - 6 / 18)), rel=0.05)


def test_missing_samples_are_no_residual(capture):
    take = capture(jitter_mm=0.1)
    take[::7, 2] = np.nan
    assert np.isfinite(rigid_residual_mm(take, range(6))).all()
    assert rigid_residual_mm(take, range(6)).max() < 0.3


@pytest.mark.parametrize("take", README_RMS_MM)
def test_the_residual_is_the_one_that_the_data_state(shared_data, take):
    """The corpus's own note gives the error of its seven steady markers, to a tenth of a millimetre."""
    positions, names, _ = read_motion(shared_data("animface-mocap") / f"{take}.c3d")
    steady = ("NoseTop", "Leye_Inside", "Reye_Inside", "Leye_Outside", "Reye_Outside", "Lcheek_Outside",
              "Rcheek_Outside")  # fmt: skip
    residual = rigid_residual_mm(positions, [names.index(name) for name in steady])
    assert np.sqrt((residual**2).mean()) == pytest.approx(README_RMS_MM[take], abs=0.11)


def test_the_steady_markers_of_a_real_face_are_those_that_its_author_names(shared_data):
    folder = shared_data("animface-mocap")
    takes = [read_motion(folder / f"{take}.c3d") for take in README_RMS_MM]
    steady = propose_steady(takes[0][1], [positions for positions, _, _ in takes], ("NoseTop",))
    assert {"NoseTop", "Leye_Inside", "Reye_Inside", "Leye_Outside", "Reye_Outside", "Lcheek_Outside",
            "Rcheek_Outside"} <= set(steady.rigid)  # fmt: skip
    assert len(steady.rigid) <= 10
    assert steady.origin == "NoseTop"
