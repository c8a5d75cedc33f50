import numpy as np
import pytest

from core.face.eyelids import Eyelids


@pytest.fixture(scope="module")
def lids(face, actress):
    marker_set, vertices = actress
    return Eyelids.of(face, vertices, marker_set)


def lowered(face, skin, actress, share):
    """Skin moved by markers that make ``share`` of a blink on both sides."""
    _, vertices = actress
    blink = face.units["eyeBlinkLeft"] + face.units["eyeBlinkRight"]
    return skin.deform(share * blink[vertices])


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.8])
def test_closure_follows_the_markers(face, skin, actress, lids, share):
    from core.face.eyelids import SHUT_AT

    closures = lids.closures(lowered(face, skin, actress, share))
    np.testing.assert_allclose(closures, [share / SHUT_AT] * 2, atol=0.06)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9, 1.2])
def test_no_lid_sinks_into_the_eyeball(face, skin, actress, lids, share):
    moved = lowered(face, skin, actress, share)
    lids.apply(moved)
    for lid in lids.lids:
        reach = np.linalg.norm(face.positions[lid.vertices] + moved[lid.vertices] - lid.centre, axis=1)
        rest = np.linalg.norm(face.positions[lid.vertices] - lid.centre, axis=1)
        assert (reach > np.minimum(rest, lid.radius) - 0.05).all()


def test_a_shut_lid_lies_where_the_blink_puts_it(face, skin, actress, lids):
    moved = lowered(face, skin, actress, 0.95)
    lids.apply(moved)
    for lid in lids.lids:
        at = int(np.flatnonzero(lid.vertices == lid.marker)[0])
        assert abs(moved[lid.marker, 1] - lid.blink[at, 1]) < 0.5


def test_lashes_turn_with_the_lid_and_keep_their_length(face, skin, actress, lids):
    moved = lowered(face, skin, actress, 1.0)
    lids.apply(moved)
    positions = face.positions + moved
    for lid in lids.lids:
        before = face.positions[lid.lashes] - face.positions[lid.roots]
        after = positions[lid.lashes] - positions[lid.roots]
        np.testing.assert_allclose(np.linalg.norm(after, axis=1), np.linalg.norm(before, axis=1), atol=1e-3)
        long = np.linalg.norm(before, axis=1) > 3
        assert (after[long, 1] < before[long, 1]).mean() > 0.9


def test_at_rest_nothing_moves(face, lids):
    moved = np.zeros_like(face.positions)
    lids.apply(moved)
    np.testing.assert_allclose(moved, 0.0, atol=1e-4)


def test_lids_follow_eyes_that_look_down(face, lids):
    moved = np.zeros_like(face.positions)
    lids.apply(moved, pitch_deg=-10.0)
    for lid in lids.lids:
        assert -3.0 < moved[lid.marker, 1] < -0.5
