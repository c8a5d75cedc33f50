"""Perceptrons run as scikit-learn's own do."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.neural_network import MLPRegressor
from sklearn.preprocessing import StandardScaler

from core.iface.perceptrons import Perceptron


@pytest.mark.parametrize(("activation", "hidden"), [("tanh", (15,)), ("relu", (12, 7))])
def test_it_says_what_sklearn_predicts_also_from_raw_inputs_to_raw_outputs(activation, hidden):
    rng = np.random.default_rng(0)
    raw = rng.normal(5.0, 3.0, (200, 6)) * [1, 10, 0.1, 1, 2, 5]
    wanted = np.stack([np.sin(raw[:, 0]), raw[:, 2] * 4 + raw[:, 4]], axis=1)
    scaler = StandardScaler().fit(raw)
    net = MLPRegressor(hidden_layer_sizes=hidden, activation=activation, max_iter=30, solver="lbfgs", random_state=1)
    with pytest.warns(Warning, match="failed to converge"):
        net.fit(scaler.transform(raw), wanted)
    plain = Perceptron.of_sklearn(net)
    assert plain.n_inputs == 6 and plain.n_outputs == 2
    predicted = net.predict(scaler.transform(raw))
    np.testing.assert_allclose(plain(scaler.transform(raw).astype(np.float32)), predicted, atol=1e-4)
    mixing, rest = np.array([[2.0, 1.0, 0.0], [0.0, 1.0, 3.0]]), np.array([1.0, 0.0, -5.0])
    whole = plain.taking(scaler.mean_, scaler.scale_).giving(rest, mixing)
    said = whole(raw.astype(np.float32))
    assert said.dtype == np.float32
    np.testing.assert_allclose(said, predicted @ mixing + rest, atol=1e-3)
