"""How well the lateness of motion against its sound is measured, on captures that are in step and are then shifted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.importing.run import SURE
from core.importing.shifting import shifted
from core.importing.sound_offset import OffsetEstimate, audio_offset, mouth_opening, pooled_offset
from core.media.audio import load_audio
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.progress import SILENT, Progress

LARGEST_S = 0.4
SESSION = 20
_SEED = 1
# The weights of the comparison were chosen on every sixth sentence of GRID; those take no part.
_CHOSEN_ON = 6


def bench_offsets(corpus: Corpus, most: int = 200, progress: Progress = SILENT) -> dict[str, object]:
    """Shift each sentence by up to 0.4 s either way and measure it, alone and by sessions of 20 that share a shift."""
    rng = np.random.default_rng(_SEED)
    names = corpus.recordings[0].marker_names
    lips = [names.index(corpus.landmarks[lip]) for lip in ("upper_lip", "lower_lip")]
    chosen = [r for i, r in enumerate(corpus.recordings) if i % _CHOSEN_ON and r.audio is not None][:most]
    off_s, confidence = [], []
    for i, recording in enumerate(chosen):
        progress.step(0.5 * i / len(chosen), f"sentence {recording.sentence}")
        late_s = rng.uniform(-LARGEST_S, LARGEST_S)
        found = _measured(recording, lips, late_s)
        if found is not None:
            off_s.append(found.offset_s - late_s)
            confidence.append(found.confidence)
    sessions = []
    for start in range(0, len(chosen) - SESSION + 1, SESSION):
        progress.step(0.5 + 0.5 * start / len(chosen), "sessions")
        late_s = rng.uniform(-LARGEST_S, LARGEST_S)
        found = [_measured(r, lips, late_s) for r in chosen[start : start + SESSION]]
        sessions.append(pooled_offset([f for f in found if f is not None]).offset_s - late_s)
    off_s, sure = np.array(off_s), np.array(confidence) >= SURE
    return {
        "corpus": corpus.name, "synthetic": corpus.synthetic, "sentences": len(off_s), **_figures(off_s),
        "sure": {"sentences": int(sure.sum()), **_figures(off_s[sure])},
        "sessions": {"sessions": len(sessions), **_figures(np.array(sessions))},
    }  # fmt: skip


def _measured(recording: Recording, lips: Sequence[int], late_s: float) -> OffsetEstimate | None:
    late = shifted(recording.positions[:, lips], recording.rate_hz, -late_s)
    audio = load_audio(Path(recording.audio))
    return audio_offset(mouth_opening(late, 0, 1), recording.rate_hz, audio, recording.transcript)


def _figures(off_s: np.ndarray) -> dict[str, float]:
    if not len(off_s):
        return {}
    away_ms = 1000 * np.abs(off_s)
    return {
        "median_ms": round(float(1000 * np.median(off_s)), 1), "median_away_ms": round(float(np.median(away_ms)), 1),
        "p95_away_ms": round(float(np.quantile(away_ms, 0.95)), 1),
        "within_40_ms": round(float((away_ms <= 40).mean()), 3),
    }  # fmt: skip


def as_table(answer: dict[str, object]) -> str:
    """Say it in lines."""

    def said(figures: dict) -> str:
        return (f"median {figures['median_away_ms']:.0f} ms off, 95 % within {figures['p95_away_ms']:.0f} ms, "
                f"{figures['within_40_ms']:.0%} within 40 ms") if "median_ms" in figures else "none"  # fmt: skip

    kind = " (synthetic)" if answer["synthetic"] else ""
    return "\n".join([
        f"{answer['corpus']}{kind}, shifts up to {LARGEST_S:g} s either way",
        f"{answer['sentences']} sentences: {said(answer)}",
        f"{answer['sure']['sentences']} of them sure: {said(answer['sure'])}",
        f"{answer['sessions']['sessions']} sessions of {SESSION}: {said(answer['sessions'])}",
    ])  # fmt: skip
