"""Animemes beside their rivals on the same sentences: learnt from the same, tuned on the same, tested on the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from core.animeme.examples import Example
from core.animeme.form import BEST, COHEN_MASSARO, COHEN_MASSARO_NORMALISED, PRINTED
from core.animeme.mmm import train_mmm
from core.animeme.training import train_animemes
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.speech.transcript import Transcript


class SpeaksCurves(Protocol):
    """What animemes and MMM have in common."""

    def curves(self, transcript: Transcript, rate_hz: float) -> ControlTrack:
        """Speak ``transcript``."""


@dataclass(frozen=True, eq=False)
class Rated:
    """One method in the form that did best on the tuning part.

    variant : which form that is; tried: how many there were
    train, tune, test : RMS error of each control, float64, shape (U,), in the controls' units
    """

    method: str
    variant: str
    tried: int
    train: np.ndarray
    tune: np.ndarray
    test: np.ndarray
    model: SpeaksCurves


Maker = Callable[[Sequence[Example], Progress], SpeaksCurves]


def _animemes(form) -> Maker:
    return lambda examples, progress: train_animemes(examples, form, progress=progress).model


def _mmm(order: int, smoothness: float, is_refined: bool) -> Maker:
    return lambda examples, progress: train_mmm(examples, smoothness, order, is_refined, progress)


# Every variant of a method is trained, and the one with the least error on the tuning part is kept.
METHODS: dict[str, dict[str, Maker]] = {
    "animeme": {"context, normalised": _animemes(BEST)},
    "animeme, as printed": {"shared widths": _animemes(PRINTED)},
    "MMM": {
        f"order {order}, smoothness {smoothness:g}, {'refined' if refined else 'as counted'}": _mmm(
            order, smoothness, refined
        )
        for order, smoothness, refined in (
            (1, 1.0, False), (2, 3.0, False), (3, 1.0, False), (1, 0.3, True), (1, 3.0, True), (2, 0.3, True),
            (2, 3.0, True), (3, 1.0, True),
        )
    },
    "Cohen-Massaro": {
        "sum": _animemes(COHEN_MASSARO),
        "normalised": _animemes(COHEN_MASSARO_NORMALISED),
        "normalised, spread in time": _animemes(replace(COHEN_MASSARO_NORMALISED, spread="time")),
    },
}  # fmt: skip


def rate_methods(
    train: Sequence[Example], tune: Sequence[Example], test: Sequence[Example], progress: Progress = SILENT
) -> list[Rated]:
    """Train every variant of `METHODS` on ``train``, keep each method's best on ``tune``, and measure it on ``test``.

    The best is the one with the least mean over controls of RMS error over the control's spread in ``train``.
    """
    spread = np.concatenate([example.track.values for example in train]).astype(float).std(axis=0)
    spread = np.where(spread > 1e-9, spread, np.inf)
    rated = []
    for m, (method, variants) in enumerate(METHODS.items()):
        found = []
        for v, (variant, make) in enumerate(variants.items()):
            done = (m + v / len(variants)) / len(METHODS)
            model = make(train, progress.part(done, done + 1 / len(variants) / len(METHODS)))
            found.append((float((rms_errors(model, tune) / spread).mean()), variant, model))
        _, variant, model = min(found, key=lambda entry: entry[0])
        errors = (rms_errors(model, part) for part in (train, tune, test))
        rated.append(Rated(method, variant, len(variants), *errors, model))
    return rated


def rms_errors(model: SpeaksCurves, examples: Sequence[Example]) -> np.ndarray:
    """RMS difference of what ``model`` says and the examples, over all their frames; float64, shape (U,)."""
    squared, n_frames = 0.0, 0
    for example in examples:
        off = spoken_like(model, example) - example.track.values
        squared, n_frames = squared + (off**2).sum(axis=0), n_frames + len(off)
    return np.sqrt(squared / n_frames)


def spoken_like(model: SpeaksCurves, example: Example) -> np.ndarray:
    """Let ``model`` say an example, at its rate and for as many frames; float64, shape (n_frames, U)."""
    values = model.curves(example.transcript, example.track.rate_hz).values.astype(float)
    return values[np.minimum(np.arange(len(example.track)), len(values) - 1)]
