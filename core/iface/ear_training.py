"""Training of the ears: which phone is heard, by the transcripts of the sentences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.iface.descent import DescentSettings, descend
from core.iface.ear import AROUND, ear_windows, fine_rows
from core.iface.fine_cepstra import RATE_HZ as FINE_RATE_HZ
from core.iface.heard_takes import HeardTake
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import FINE_PER_FRAME
from core.iface.varied_speech import VariedSpeech
from core.progress import SILENT, Progress
from core.speech.phoneme import PAU, PHONEME_INDEX, PHONEMES


def train_ears(
    speech: VariedSpeech, n_ears: int, hidden: Sequence[int], settings: DescentSettings, seed: int,
    progress: Progress = SILENT,
) -> tuple[Perceptron, ...]:  # fmt: skip
    """Train ``n_ears`` perceptrons on every window of the used frames, three a frame; outputs are those of `PHONEMES`.

    speech : with two frames or more before and after each take
    """
    takes = speech.takes
    used = [np.repeat(take.used, FINE_PER_FRAME) for take in takes]
    fine = np.concatenate([fine_rows(take.features[take.used]) for take in takes])
    mean, scale = fine.mean(axis=0, dtype=float), fine.std(axis=0, dtype=float).clip(1e-6)
    first, after = (FINE_PER_FRAME * n - AROUND for n in (speech.n_back, speech.n_ahead))

    def heard(rng: np.random.Generator) -> np.ndarray:
        rows = (((fine_rows(context) - mean) / scale).astype(np.float32) for context in speech.contexts(rng))
        return np.concatenate([ear_windows(r[first : len(r) - after])[u] for r, u in zip(rows, used)])

    phones = np.concatenate([_phones_of_windows(take)[u] for take, u in zip(takes, used)])
    wanted = np.eye(len(PHONEMES), dtype=np.float32)[phones]
    told, n_windows, ears = np.ones_like(wanted), 2 * AROUND + 1, []
    for e in range(n_ears):
        stage = progress.part(e / n_ears, (e + 1) / n_ears)
        stage.step(0.0, f"phones, perceptron {e + 1} of {n_ears}")
        ear = descend(heard, wanted, told, hidden, settings, seed * n_ears + e, stage, as_shares=True)
        ears.append(ear.taking(np.tile(mean, n_windows), np.tile(scale, n_windows)))
    return tuple(ears)


def _phones_of_windows(take: HeardTake) -> np.ndarray:
    """Return what is said in the middle of the ninetieth of a second after each window's end: rows of `PHONEMES`.

    An ear hears as much before that as after it.
    """
    times_s = (np.arange(FINE_PER_FRAME * len(take)) - (FINE_PER_FRAME - 1) + 0.5) / FINE_RATE_HZ
    phones = np.full(len(times_s), PHONEME_INDEX[PAU])
    for said in take.transcript.phonemes:
        phones[(times_s >= said.start_s) & (times_s < said.end_s)] = PHONEME_INDEX[said.phone]
    return phones
