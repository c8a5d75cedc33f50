"""Is the emotion there? A simple classifier, trained on captures, looks at what engines make."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from core.evaluation.comparison import CapturedTruth
from core.motion.database import MotionDatabase
from core.motion.resample import resample
from core.speech.emotion import EMOTION_INDEX

WINDOW_S = 1.0
_Z_95 = 1.959963984540054  # two-sided 95 % of the normal distribution


class Recognition(NamedTuple):
    """How often the emotion was named rightly; ``low`` to ``high`` is the 95 % confidence interval of ``share``."""

    windows: int
    share: float
    low: float
    high: float


class EmotionClassifier:
    """Linear discriminants on mean and spread of every PCA coefficient over one second, trained on a database.

    Captures and synthesis go through the same components, so that only motion which the database can show is judged.
    """

    def __init__(self, database: MotionDatabase) -> None:
        from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

        self._database = database
        rows, labels = [], []
        for sentence in database.sentences:
            found = windows(database.frames[sentence.start_frame : sentence.stop_frame].astype(float), database.rate_hz)
            rows += found
            labels += [EMOTION_INDEX[sentence.emotion]] * len(found)
        self._judge = LinearDiscriminantAnalysis().fit(np.array(rows), np.array(labels))

    def recognition(self, pairs: Sequence[tuple[CapturedTruth, np.ndarray]]) -> Recognition:
        """Judge the windows of motion (positions at the rate of the capture), each by its sentence's emotion."""
        right = n = 0
        for truth, positions in pairs:
            database = self._database
            n_frames = max(1, round((len(positions) - 1) * database.rate_hz / truth.rate_hz) + 1)
            raised = resample(positions, truth.rate_hz, database.rate_hz, n_frames)
            named = self._judge.predict(np.array(windows(database.pca.coefficients(raised), database.rate_hz)))
            right += int((named == EMOTION_INDEX[truth.recording.emotion]).sum())
            n += len(named)
        return Recognition(n, right / n, *wilson_interval(right, n))


def tells_emotions(database: MotionDatabase) -> bool:
    """Whether the database has more than one emotion to tell apart."""
    return len({sentence.emotion for sentence in database.sentences}) > 1


def windows(track: np.ndarray, rate_hz: float) -> list[np.ndarray]:
    """Mean and spread over each whole second of ``track``, shape (n_frames, n_dims); a shorter track is one window."""
    length = min(len(track), round(WINDOW_S * rate_hz))
    spans = (track[f : f + length] for f in range(0, len(track) - length + 1, length))
    return [np.concatenate([span.mean(axis=0), span.std(axis=0)]) for span in spans]


def wilson_interval(right: int, n: int) -> tuple[float, float]:
    """95 % confidence interval of a share (Wilson 1927); windows of one sentence are alike, so the truth is wider."""
    share, z2 = right / n, _Z_95**2
    middle = (share + z2 / (2 * n)) / (1 + z2 / n)
    half = _Z_95 / (1 + z2 / n) * np.sqrt(share * (1 - share) / n + z2 / (4 * n * n))
    return float(max(0.0, middle - half)), float(min(1.0, middle + half))
