"""Training of the paper's face (Hong, Wen and Huang 2002, section VI), by scikit-learn, the same for the same seed."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.iface.classes import fit_classes, spoken_phones
from core.iface.heard_takes import HeardTake
from core.iface.lessons import averaged, heard_windows, shown_parameters, silence_of, units_of, usable_takes
from core.iface.motion_unit import NEUTRAL, PAPER_UTTERANCE
from core.iface.paper_face import PaperFace
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import N_CEPSTRA
from core.progress import SILENT, Progress

BACK = AHEAD = 3
_FEWEST_HIDDEN, _MOST_HIDDEN, _EXPRESSION_HIDDEN = 15, 25, 30


@dataclass(frozen=True)
class PaperSettings:
    """What the paper leaves open.

    n_components : Gaussians of a class, at most
    fewest : frames that a class must have; see `core.iface.classes.fit_classes`
    decay, expression_decay : how strongly large weights are held down (``alpha`` of scikit-learn)
    n_steps : of the optimiser, at most
    """

    n_components: int = 3
    fewest: int = 100
    decay: float = 20.0
    expression_decay: float = 1.0
    n_steps: int = 100


def train_paper_face(
    takes: Sequence[HeardTake], neutral: np.ndarray, seed: int = 0, progress: Progress = SILENT,
    settings: PaperSettings | None = None,
) -> PaperFace:  # fmt: skip
    """Train on the used frames of ``takes``; ``neutral`` is the pose s_0 that displacements are from, mm.

    Raises `UserFacingError` without neutral speech; progress may cancel it between perceptrons.
    """
    settings, takes = settings or PaperSettings(), usable_takes(takes)
    progress.step(0.0, "motion units")
    units, surroundings = units_of(takes, PAPER_UTTERANCE, 2), silence_of(takes)
    silence, takes = surroundings[:N_CEPSTRA], averaged(takes)
    said = {e: [take for take in takes if take.emotion == e] for e in (NEUTRAL, *units.expressions)}
    progress.step(0.05, "classes of sound")
    features = np.concatenate([take.features[take.used] for take in said[NEUTRAL]])
    phones = np.concatenate([spoken_phones(take)[take.used] for take in said[NEUTRAL]])
    classes = fit_classes(features, phones, settings.n_components, settings.fewest, seed)
    heard, wanted = heard_windows(said[NEUTRAL], BACK, AHEAD, silence), shown_parameters(said[NEUTRAL], units)
    best = classes.best(features)
    counts = np.bincount(best, minlength=len(classes.phones))
    spoken = []
    for c, phone in enumerate(classes.phones):
        progress.step(0.1 + 0.7 * c / len(classes.phones), f"perceptron of /{phone}/")
        share = np.sqrt(counts[c] / counts.max())
        n_hidden = round(_FEWEST_HIDDEN + (_MOST_HIDDEN - _FEWEST_HIDDEN) * share)
        mine = best == c
        spoken.append(_perceptron(heard[mine], wanted[mine], n_hidden, settings.decay, settings.n_steps, seed))
    face = PaperFace(units, np.asarray(neutral, np.float32), surroundings, BACK, AHEAD, classes, tuple(spoken), ())
    expressive = []
    for k, expression in enumerate(units.expressions):
        progress.step(0.8 + 0.2 * k / len(units.expressions), f"perceptron of {expression}")
        mine = said[expression]
        estimated = face.utterance(
            heard_windows(mine, BACK, AHEAD, silence), np.concatenate([t.features[t.used] for t in mine])
        )
        wanted = shown_parameters(mine, units)
        expressive.append(
            _perceptron(estimated, wanted, _EXPRESSION_HIDDEN, settings.expression_decay, settings.n_steps, seed)
        )
    progress.step(1.0, "trained")
    return PaperFace(units, face.neutral, surroundings, BACK, AHEAD, classes, face.spoken, tuple(expressive))


def _perceptron(
    inputs: np.ndarray, wanted: np.ndarray, n_hidden: int, decay: float, n_steps: int, seed: int
) -> Perceptron:
    """Three layers; MUPs are scaled together, so that an error of 1 mm counts the same in each."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.neural_network import MLPRegressor
    from threadpoolctl import threadpool_limits

    mean, scale = inputs.mean(axis=0, dtype=float), inputs.std(axis=0, dtype=float)
    scale = np.where(scale > 1e-6, scale, 1.0)
    rest, size = wanted.mean(axis=0), max(float(wanted.std(axis=0).max(initial=0.0)), 1e-6)
    if 0 in (inputs.shape[1], wanted.shape[1]):  # a face that holds still has no units
        return Perceptron.of_layers([np.zeros((inputs.shape[1], wanted.shape[1]))], [rest], "tanh")
    net = MLPRegressor(hidden_layer_sizes=(n_hidden,), activation="tanh", solver="lbfgs", alpha=decay,
                       max_iter=n_steps, random_state=seed)  # fmt: skip
    with threadpool_limits(1), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # stopping early is part of it
        towards = (wanted - rest) / size
        net.fit((inputs - mean) / scale, towards if towards.shape[1] > 1 else towards[:, 0])
    return Perceptron.of_sklearn(net).taking(mean, scale).giving(rest, size * np.eye(wanted.shape[1]))
