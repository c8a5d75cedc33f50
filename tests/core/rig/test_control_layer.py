"""Edits of control curves reach the markers, and nothing else does."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.motion.pca import MotionPca
from core.rig.control_layer import ControlBasis, control_basis, edited_curves, laid_over, motion_curves
from core.rig.control_track import ControlTrack
from core.synthesis.control_edits import NO_CONTROL_EDITS, ControlKey
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import NO_POLISH, Polish, polished

RATE_HZ = 60.0
SMALL = NO_CONTROL_EDITS.with_keys("component02", (ControlKey(0.5, 3.0, 0.2),))


@pytest.fixture
def database():
    rng = np.random.default_rng(3)
    rest = 50 * rng.normal(size=(9, 3))
    markers = MarkerSet(tuple(f"m{k}" for k in range(9)), rest)
    poses = rest + np.tensordot(rng.normal(size=(200, 4)), rng.normal(size=(4, 9, 3)), 1)
    pca = MotionPca.fit([poses], 4)
    return SimpleNamespace(markers=markers, pca=pca, rest_coefficients=pca.coefficients(rest), poses=poses)


@pytest.fixture
def motion(database):
    beyond = np.random.default_rng(4).normal(size=(60, 9, 3))  # what no component can make
    return MarkerMotion((database.poses[:60] + beyond).astype(np.float32), RATE_HZ, database.markers)


def test_without_edits_the_motion_is_the_polished_one(database, motion):
    assert laid_over(motion, database, NO_CONTROL_EDITS, NO_POLISH) is motion
    polish = Polish(articulation=1.5)
    both = laid_over(motion, database, NO_CONTROL_EDITS, polish)
    assert np.array_equal(both.positions, polished(motion, polish).positions)


def test_a_key_changes_its_own_curve_by_just_its_bump_and_leaves_what_no_control_makes(database, motion):
    edited = laid_over(motion, database, SMALL, NO_POLISH)
    change = database.pca.coefficients(edited.positions) - database.pca.coefficients(motion.positions)
    times_s = np.arange(60) / RATE_HZ
    assert np.allclose(change[:, 1], SMALL.of("component02").keys[0].at(times_s), atol=1e-4)
    assert np.allclose(change[:, [0, 2, 3]], 0, atol=1e-4)
    residual = [p.positions - database.pca.positions(database.pca.coefficients(p.positions)) for p in (motion, edited)]
    assert np.allclose(*residual, atol=1e-4)


def test_a_muted_control_is_at_rest_in_the_motion(database, motion):
    edited = laid_over(motion, database, NO_CONTROL_EDITS.muting("component01", True), NO_POLISH)
    assert np.allclose(database.pca.coefficients(edited.positions)[:, 0], database.rest_coefficients[0], atol=1e-4)


def test_a_control_that_is_not_there_changes_nothing(database, motion):
    edited = laid_over(motion, database, NO_CONTROL_EDITS.muting("jawOpen", True), NO_POLISH)
    assert np.allclose(edited.positions, motion.positions)


def test_curves_are_found_once_for_a_motion_and_basis(database, motion):
    assert motion_curves(motion, database) is motion_curves(motion, database)
    assert control_basis(database) is control_basis(database)
    assert motion_curves(replace(motion), database) is not motion_curves(motion, database)


def test_edited_units_stay_within_their_bounds():
    basis = ControlBasis(("jawOpen",), np.ones((1, 2, 3)), np.zeros(1), 0.0, 1.0, ("jawOpen",))
    curves = ControlTrack(("jawOpen",), np.full((60, 1), 0.7), RATE_HZ)
    for amount, bound in ((2.0, 1.0), (-2.0, 0.0)):
        edits = NO_CONTROL_EDITS.with_keys("jawOpen", (ControlKey(0.5, amount, 0.2),))
        values = edited_curves(curves, basis, edits).values
        assert values[30, 0] == bound and values.min() >= 0 and values.max() <= 1


def test_cross_mapping_finds_the_edited_units_again(database, monkeypatch):
    """What an artist draws is what a Live Link file holds: the same solve reads the edited motion."""
    rng = np.random.default_rng(6)
    basis = ControlBasis(
        ("jawOpen", "mouthPucker"), 9 * rng.normal(size=(2, 9, 3)), np.zeros(2), 0.0, 1.0, ("jawOpen",)
    )
    monkeypatch.setattr(ControlBasis, "of", lambda _database: basis)
    values = rng.uniform(0.2, 0.7, size=(60, 2))
    positions = database.markers.rest + np.tensordot(values, basis.moves, 1)
    motion = MarkerMotion(positions.astype(np.float32), RATE_HZ, database.markers)
    edits = NO_CONTROL_EDITS.with_keys("jawOpen", (ControlKey(0.5, 0.2, 0.2),)).muting("mouthPucker", True)
    found = basis.curves(laid_over(motion, database, edits, NO_POLISH), database).values
    assert np.allclose(found[:, 0], values[:, 0] + edits.of("jawOpen").keys[0].at(np.arange(60) / RATE_HZ), atol=5e-3)
    assert np.abs(found[:, 1]).max() < 5e-3
