import numpy as np
import pytest
from sklearn.decomposition import PCA
from threadpoolctl import threadpool_limits

from core.motion.pca import MotionPca


def poses(n=400, markers=12, seed=0):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 6)) @ rng.normal(size=(6, markers * 3)) * 5 + rng.normal(size=markers * 3) * 100


def test_equals_sklearn():
    packed = poses() + np.random.default_rng(1).normal(size=(400, 36)) * 0.1
    blocks = np.array_split(packed.reshape(400, 12, 3), 7)
    ours = MotionPca.fit(blocks, 4)
    theirs = PCA(4).fit(packed)
    assert ours.mean == pytest.approx(theirs.mean_)
    assert np.abs(ours.basis.T @ theirs.components_.T) == pytest.approx(np.eye(4), abs=1e-8)
    assert ours.coverage == pytest.approx(theirs.explained_variance_ratio_.sum())


def test_distances_between_poses_are_distances_between_coefficients():
    packed = poses()
    pca = MotionPca.fit([packed.reshape(-1, 12, 3)], 25)
    assert pca.n_dims == 6  # no more than the poses span
    coefficients = pca.coefficients(packed.reshape(-1, 12, 3))
    assert pca.positions(coefficients).reshape(-1, 36) == pytest.approx(packed, abs=1e-6)
    apart = np.linalg.norm(packed[3] - packed[77])
    assert np.linalg.norm(coefficients[3] - coefficients[77]) == pytest.approx(apart)


def test_the_number_of_threads_changes_no_bit():
    poses = np.random.default_rng(3).normal(size=(6000, 90, 3)).cumsum(axis=0)
    bases = []
    for n_threads in (1, 2):
        with threadpool_limits(n_threads):
            bases.append(MotionPca.fit([poses]).basis.tobytes())
    assert bases[0] == bases[1]
