"""Head motion is removed exactly, and can be put back."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.motion.normalise import normalise


@pytest.fixture
def capture():
    """A face that deforms on all but seven rigid markers, moved about at random."""
    rng = np.random.default_rng(0)
    reference = rng.normal(size=(20, 3)) * 30
    reference -= reference[3]
    face = reference + rng.normal(size=(50, 20, 3))
    face[:, :7] = reference[:7]
    rotation = Rotation.random(50, random_state=0).as_matrix()
    shift = rng.normal(size=(50, 1, 3)) * 100
    return reference, face, rotation, shift


def test_with_an_origin_marker_the_face_is_recovered(capture):
    reference, face, rotation, shift = capture
    found, head = normalise(face @ rotation.transpose(0, 2, 1) + shift, reference, np.arange(7), origin=3)
    assert found == pytest.approx(face, abs=1e-9)
    assert head.rotation == pytest.approx(rotation)


def test_scale_is_estimated_when_asked_for(capture):
    reference, face, rotation, shift = capture
    size = np.linspace(0.5, 2.0, 50)
    seen = face / size[:, None, None] @ rotation.transpose(0, 2, 1) + shift
    found, head = normalise(seen, reference, np.arange(7), with_scale=True)
    assert head.scale == pytest.approx(size)
    assert found == pytest.approx(face - reference[:7].mean(axis=0), abs=1e-9)
    assert head.put_back(found) == pytest.approx(seen)


def test_a_missing_rigid_marker_does_not_move_the_face(capture):
    reference, face, rotation, shift = capture
    seen = face @ rotation.transpose(0, 2, 1) + shift
    whole, _ = normalise(seen, reference, np.arange(7))
    seen[10, 2] = np.nan
    holed, _ = normalise(seen, reference, np.arange(7))
    assert np.isnan(holed[10, 2]).all()
    others = np.arange(20) != 2
    assert holed[10, others] == pytest.approx(whole[10, others])


def test_a_frame_that_shows_too_little_is_lost_not_guessed(capture):
    reference, face, _, _ = capture
    face[4, :5] = np.nan
    found, _ = normalise(face, reference, np.arange(7))
    assert np.isnan(found[4]).all()
    assert np.isfinite(found[5]).all()


def test_a_mirrored_face_is_turned_never_reflected():
    reference = np.random.default_rng(1).normal(size=(12, 3))
    _, head = normalise((reference * [-1, 1, 1])[None], reference)
    assert np.linalg.det(head.rotation[0]) == pytest.approx(1.0)


def test_rotation_equals_scipys_answer(capture):
    reference, face, rotation, _ = capture
    seen = face @ rotation.transpose(0, 2, 1)
    _, head = normalise(seen, reference, origin=3)
    for f in range(0, 50, 10):
        independent, _ = Rotation.align_vectors(seen[f] - seen[f, 3], reference - reference[3])
        assert head.rotation[f] == pytest.approx(independent.as_matrix(), abs=1e-9)
