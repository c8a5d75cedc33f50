import numpy as np
from scipy.integrate import solve_ivp

from core.actress.dynamics import follow
from core.actress.gestures import GestureScore

STEP_S = 1 / 240


def _score(targets, stiffness_rad_s):
    targets = np.asarray(targets, float)[:, None]
    return GestureScore(targets, np.broadcast_to(np.asarray(stiffness_rad_s, float), (len(targets), 1)))


def test_agrees_with_a_numeric_solver_of_the_same_equation():
    targets = np.where(np.arange(120) < 60, 1.0, -0.5)
    stiffness = np.where(np.arange(120) < 80, 30.0, 50.0)[:, None]

    def derivative(time_s, state):
        f = min(int(time_s / STEP_S), 119)
        w = stiffness[f, 0]
        return [state[1], -2 * w * state[1] - w * w * (state[0] - targets[f])]

    times_s = np.arange(120) * STEP_S
    solved = solve_ivp(derivative, (0, 0.5), [0.2, 0.0], t_eval=times_s, max_step=STEP_S / 8, rtol=1e-8, atol=1e-10)
    assert np.allclose(follow(_score(targets, stiffness), STEP_S, np.array([0.2]))[:, 0], solved.y[0], atol=2e-3)


def test_glides_to_its_target_without_overshoot():
    path = follow(_score(np.ones(240), 35.0), STEP_S, np.zeros(1))[:, 0]
    assert np.all(np.diff(path) >= 0) and 0.999 < path[-1] <= 1


def test_falls_short_when_time_is_short():
    peaks = []
    for frames in (10, 20, 40):
        targets = np.where(np.arange(120) < frames, 1.0, 0.0)
        peaks.append(follow(_score(targets, 30.0), STEP_S, np.zeros(1)).max())
    assert peaks[0] < 0.6 < peaks[1] < 0.9 < peaks[2]
