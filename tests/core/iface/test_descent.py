"""Gradient descent: slopes by finite differences, and what is learned."""

from __future__ import annotations

import numpy as np
import pytest

from core.iface.descent import DescentSettings, descend, gradient, started
from core.progress import Cancelled, Progress


def _loss(layers, inputs, wanted, told):
    values = inputs
    for i in range(0, len(layers) - 2, 2):
        values = np.maximum(values @ layers[i] + layers[i + 1], 0.0)
    missed = values @ layers[-2] + layers[-1] - wanted
    return (told * missed**2).sum() / len(inputs)


def test_slopes_are_those_of_finite_differences():
    rng = np.random.default_rng(0)
    layers = [layer.astype(float) + rng.normal(0, 0.1, layer.shape) for layer in started((4, 6, 5, 3), rng)]
    inputs, wanted = rng.normal(size=(7, 4)), rng.normal(size=(7, 3))
    told = (rng.random((7, 3)) < 0.6).astype(float)
    slopes = gradient(layers, inputs, wanted, told)
    for layer, slope in zip(layers, slopes):
        for place in np.ndindex(layer.shape):
            kept, h = layer[place], 1e-6
            losses = []
            for moved in (kept + h, kept - h):
                layer[place] = moved
                losses.append(_loss(layers, inputs, wanted, told))
            layer[place] = kept
            assert slope[place] == pytest.approx((losses[0] - losses[1]) / (2 * h), abs=1e-6)


def test_slopes_of_shares_are_those_of_cross_entropy():
    rng = np.random.default_rng(3)
    layers = [layer.astype(float) for layer in started((4, 6, 3), rng)]
    inputs, wanted = rng.normal(size=(7, 4)), np.eye(3)[rng.integers(3, size=7)]

    def loss():
        outputs = np.maximum(inputs @ layers[0] + layers[1], 0.0) @ layers[2] + layers[3]
        return -2.0 * (wanted * (outputs - np.log(np.exp(outputs).sum(axis=1, keepdims=True)))).sum() / len(inputs)

    slopes = gradient(layers, inputs, wanted, np.ones((7, 3)), as_shares=True)
    for layer, slope in zip(layers, slopes):
        for place in np.ndindex(layer.shape):
            kept, h = layer[place], 1e-6
            layer[place] = kept + h
            above = loss()
            layer[place] = kept - h
            below = loss()
            layer[place] = kept
            assert slope[place] == pytest.approx((above - below) / (2 * h), abs=1e-6)


def test_outputs_that_a_sample_does_not_tell_of_are_learned_from_the_others():
    rng = np.random.default_rng(1)
    inputs = rng.normal(size=(600, 3)).astype(np.float32)
    truth = np.stack([inputs[:, 0] - inputs[:, 1], np.abs(inputs[:, 2])], axis=1)
    told = np.zeros((600, 2), np.float32)
    told[:300, 0] = told[300:, 1] = 1.0
    wanted = np.where(told > 0, truth, 99.0).astype(np.float32)
    settings = DescentSettings(n_passes=60, noise=0.0, batch=32)
    net = descend(lambda _: inputs, wanted, told, (24,), settings, seed=0)
    assert np.abs(net(inputs) - truth).mean() < 0.05
    again = descend(lambda _: inputs, wanted, told, (24,), settings, seed=0)
    assert all((a == b).all() for a, b in zip(net.weights, again.weights))


def test_it_can_be_cancelled_between_passes():
    class Stop(Progress):
        def step(self, fraction, message=""):
            if fraction > 0.5:
                raise Cancelled

    zeros = np.zeros((10, 2), np.float32)
    with pytest.raises(Cancelled):
        descend(lambda _: zeros, zeros, zeros, (2,), DescentSettings(n_passes=4), 0, Stop())
