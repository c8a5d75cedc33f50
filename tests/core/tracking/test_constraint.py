"""Points that went astray do not pull the face along."""

import numpy as np

from core.iface.affine_fit import AffineFit, PosedUnits, refined
from core.tracking.constraint import constrained, fresh_start


def _case(model, seed, n_astray):
    chance = np.random.default_rng(seed)
    face = PosedUnits(model.rest[:, :2].copy(), model.flat_units)
    prior = 1.0 / model.flat_variance
    parameters = chance.normal(size=len(face.units)) * np.sqrt(model.flat_variance)
    true = AffineFit(parameters, np.array([[2.0, 0.1, 200.0], [-0.1, 2.0, 150.0]]))
    points = true.points(face) + 0.3 * chance.normal(size=face.base.shape)
    astray = chance.choice(len(points), n_astray, replace=False)
    points[astray] += chance.normal(size=(n_astray, 2)) * 40.0
    start = AffineFit(np.zeros(len(parameters)), np.array([[2.0, 0.0, 198.0], [0.0, 2.0, 152.0]]))
    return face, prior, true, points, astray, start


def test_a_quarter_of_the_points_may_go_astray(model):
    for seed in range(6):
        face, prior, true, points, astray, start = _case(model, seed, 10)
        answer = constrained(face, points, np.ones(len(points)), start, prior)
        plain = refined(face, points, start, np.ones(len(points)), prior)
        off = np.linalg.norm(answer.fit.points(face) - true.points(face), axis=1).mean()
        off_plain = np.linalg.norm(plain.points(face) - true.points(face), axis=1).mean()
        assert off < 0.6 < off_plain
        far = np.linalg.norm(points - true.points(face), axis=1)[astray] > 8
        assert answer.weights[astray][far].max() < 0.05


def test_untrusted_points_count_for_nothing(model):
    face, prior, _, points, astray, start = _case(model, 3, 12)
    trust = np.ones(len(points))
    trust[astray] = 0.0
    moved = points.copy()
    moved[astray] += 1000.0
    one, other = (constrained(face, each, trust, start, prior).fit.points(face) for each in (points, moved))
    np.testing.assert_array_equal(one, other)


def test_without_a_last_frame_appendix_a_begins(model):
    face, _, true, _, _, _ = _case(model, 4, 0)
    true.parameters[-2:] = 0.0  # the head looks ahead
    points, n_units, every = true.points(face), len(model.units), np.ones(len(face.base))
    np.testing.assert_allclose(fresh_start(face, points, every, n_units).points(face), points, atol=1e-6)
    assert fresh_start(face, points, np.r_[np.ones(5), 0 * every[5:]], n_units) is None
