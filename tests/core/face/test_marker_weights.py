import numpy as np
import pytest

from core.face.marker_weights import local_spacing, marker_weights

SIDE = 60


def plane(step=1.0):
    """Return a square of SIDE² vertices, ``step`` mm apart."""
    x, y = np.meshgrid(np.arange(SIDE) * step, np.arange(SIDE) * step)
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i = np.arange(x.size).reshape(x.shape)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return positions, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]), i


def regular(i, every):
    return i[10:51:every, 10:51:every].ravel()


def test_rows_are_shares_that_never_exceed_one():
    positions, triangles, i = plane()
    weights = marker_weights(positions, triangles, regular(i, 10))
    assert (weights.data > 0).all()
    assert weights.sum(axis=1).max() <= 1.0


@pytest.mark.parametrize("every", [5, 10, 20])
def test_any_spacing_of_markers_covers_what_lies_between_them(every):
    positions, triangles, i = plane()
    covered = np.asarray(marker_weights(positions, triangles, regular(i, every)).sum(axis=1)).ravel()
    between = i[10:51, 10:51].ravel()
    assert covered[between].min() > 0.8


def test_far_from_all_markers_nothing_moves_and_on_the_way_there_it_fades_without_a_step():
    positions, triangles, i = plane()
    markers = i[28:33:2, 28:33:2].ravel()
    covered = np.asarray(marker_weights(positions, triangles, markers).sum(axis=1)).ravel()[i]
    assert covered[0].max() == 0
    outward = covered[30, 32:]
    assert (np.diff(outward) <= 1e-9).all()
    assert np.abs(np.diff(outward)).max() < 0.45


def test_weights_do_not_depend_on_the_unit_of_the_mesh():
    positions, triangles, i = plane()
    small = marker_weights(positions, triangles, regular(i, 10)).toarray()
    large = marker_weights(positions * 25.4, triangles, regular(i, 10)).toarray()
    np.testing.assert_allclose(large, small, atol=2e-3)


def test_mirrored_markers_get_mirrored_weights():
    positions, triangles, i = plane()
    left, right = i[30, 20], i[20, 30]
    weights = marker_weights(positions, triangles, np.array([left, right])).toarray()[i]
    # the grid with this diagonal is symmetric about x = y
    np.testing.assert_allclose(weights[:, :, 0], weights[:, :, 1].T, atol=1e-3)


def test_spacing_follows_the_markers_thereabouts():
    positions, _, i = plane()
    markers = np.concatenate([i[5:20:3, 5:20:3].ravel(), i[30:60:12, 30:60:12].ravel()])
    distance = np.linalg.norm(positions[markers][:, None] - positions[None], axis=2)
    spacing = local_spacing(distance, markers)
    assert 3 < spacing[i[11, 11]] < 5
    assert 12 < spacing[i[42, 42]] < 25


def test_one_marker_alone_still_moves_its_surroundings():
    positions, triangles, i = plane()
    weights = marker_weights(positions, triangles, np.array([i[30, 30]]))
    assert weights[i[30, 30], 0] > 0.9
    assert np.isfinite(weights.data).all()
