"""The voice of the synthetic actress, made by Festival; only needed to remake the bundled speech.

``python -m core.actress.speech OUT`` writes ``OUT/audio/*.flac`` (16 kHz mono), ``OUT/labels/*.lab`` (xwaves lines
``end colour phone``) and ``OUT/words/*.lab`` (the same, silence as ``pau``). It asks for the program ``festival`` with
the voice ``cmu_us_slt_arctic_hts`` and for the Python package ``pyworld``; the workstation itself never does.
"""

from __future__ import annotations

import csv
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.errors import UserFacingError
from core.progress import SILENT, Progress

RATE_HZ = 16000
# One sentence differs from the next by this much in rate, so that no two emotions share their timing.
RATE_VARIATION = 0.03
# Spectral tilt turns around this frequency, near the strongest harmonics of the voice.
TILT_PIVOT_HZ = 500.0
TILT_LIMIT_DB = 6.0


@dataclass(frozen=True)
class Voice:
    """How an emotion sounds (a row of ``voices.csv``): all of it relative to the voice as trained."""

    rate: float
    pitch_semitones: float
    pitch_range: float
    loudness_db: float
    tilt_db_per_octave: float


def voices() -> dict[str, Voice]:
    """Return the voice of each emotion."""
    with open(DEMO_FOLDER / "voices.csv", encoding="utf-8", newline="") as lines:
        return {
            row["emotion"]: Voice(**{name: float(row[name]) for name in Voice.__dataclass_fields__})
            for row in csv.DictReader(lines)
        }


def speak_corpus(folder: Path, progress: Progress = SILENT) -> None:
    """Speak every sentence of ``sentences.csv`` into ``folder``.

    Raises `UserFacingError` if Festival, its voice or pyworld is missing.
    """
    import soundfile
    import soxr

    if shutil.which("festival") is None:
        raise UserFacingError(
            "The program 'festival' is not installed.", "On Debian: apt install festival festvox-us-slt-hts."
        )
    with open(DEMO_FOLDER / "sentences.csv", encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    voice_of = voices()
    for name in ("audio", "labels", "words"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        progress.step(0.0, "speaking with Festival")
        _run_festival(rows, voice_of, Path(scratch))
        for i, row in enumerate(rows):
            name = row["sentence"]
            progress.step((i + 1) / (len(rows) + 1), f"colouring {name}")
            samples, rate_hz = soundfile.read(Path(scratch) / f"{name}.wav")
            coloured = colour(samples, rate_hz, voice_of[row["emotion"]])
            coloured = soxr.resample(coloured, rate_hz, RATE_HZ)
            soundfile.write(folder / "audio" / f"{name}.flac", coloured, RATE_HZ, subtype="PCM_16")
            duration_s = len(coloured) / RATE_HZ
            (folder / "labels" / f"{name}.lab").write_text((Path(scratch) / f"{name}.lab").read_text())
            (folder / "words" / f"{name}.lab").write_text(
                _word_labels((Path(scratch) / f"{name}.words").read_text(), duration_s)
            )


def colour(samples: np.ndarray, rate_hz: int, voice: Voice) -> np.ndarray:
    """Give speech the pitch, pitch range, loudness and spectral tilt of ``voice`` (WORLD vocoder); same length.

    samples : float64, shape (n_samples,), mono, -1..1
    """
    try:
        import pyworld
    except ImportError as error:
        raise UserFacingError(
            "The Python package 'pyworld' is not installed.", "It is needed only to remake the demo speech."
        ) from error
    samples = np.ascontiguousarray(samples, float)
    f0_hz, times_s = pyworld.harvest(samples, rate_hz, f0_floor=90.0, f0_ceil=500.0)
    f0_hz = pyworld.stonemask(samples, f0_hz, times_s, rate_hz)
    envelope = pyworld.cheaptrick(samples, f0_hz, times_s, rate_hz)
    aperiodicity = pyworld.d4c(samples, f0_hz, times_s, rate_hz)

    voiced = f0_hz > 0
    log_f0 = np.log(f0_hz[voiced])
    wider = log_f0.mean() + voice.pitch_range * (log_f0 - log_f0.mean())
    f0_hz[voiced] = np.exp(wider + voice.pitch_semitones * np.log(2) / 12)

    frequency_hz = np.linspace(0, rate_hz / 2, envelope.shape[1])
    octaves = np.log2(np.maximum(frequency_hz, 50.0) / TILT_PIVOT_HZ)
    tilt_db = np.clip(voice.tilt_db_per_octave * octaves, -TILT_LIMIT_DB, TILT_LIMIT_DB)
    envelope *= 10 ** (tilt_db / 10)

    spoken = pyworld.synthesize(f0_hz, envelope, aperiodicity, rate_hz)[: len(samples)]
    spoken = np.pad(spoken, (0, len(samples) - len(spoken)))
    spoken *= np.std(samples) / np.std(spoken) * 10 ** (voice.loudness_db / 20)
    # The loudest vowels of the loudest voice would clip.
    return np.tanh(spoken / 0.98) * 0.98


def _run_festival(rows: list[dict[str, str]], voice_of: dict[str, Voice], folder: Path) -> None:
    script = [
        "(voice_cmu_us_slt_arctic_hts)",
        "(define (speak name text rate)",
        '  (set! hts_engine_params (cons (list "-r" rate) cmu_us_slt_arctic_hts::hts_engine_params))',
        "  (let ((utt (utt.synth (eval (list 'Utterance 'Text text))))",
        '        (words (fopen (string-append name ".words") "w")))',
        '    (utt.save.wave utt (string-append name ".wav"))',
        '    (utt.save.segs utt (string-append name ".lab"))',
        "    (mapcar (lambda (word)",
        '              (format words "%s %f %f\\n" (item.name word)',
        "                      (item.feat word 'word_start) (item.feat word 'word_end)))",
        "            (utt.relation.items utt 'Word))",
        "    (fclose words)))",
    ]
    for row in rows:
        vary = Chance(f"rate {row['sentence']}").between(-RATE_VARIATION, RATE_VARIATION)
        rate = voice_of[row["emotion"]].rate * (1 + vary)
        script.append(f'(speak "{folder / row["sentence"]}" "{row["text"]}" {rate:.4f})')
    path = folder / "speak.scm"
    path.write_text("\n".join(script) + "\n", encoding="utf-8")
    done = subprocess.run(["festival", "-b", str(path)], capture_output=True, text=True)
    missing = [row["sentence"] for row in rows if not (folder / f"{row['sentence']}.wav").exists()]
    if missing:
        reason = (done.stderr or done.stdout).strip().splitlines()
        raise UserFacingError(
            f"Festival did not speak sentence '{missing[0]}' ({reason[-1] if reason else 'it said nothing'}).",
            "On Debian: apt install festvox-us-slt-hts.",
        )


def _word_labels(lines: str, duration_s: float) -> str:
    """Lay words (lines ``word start end``) over the whole sentence in xwaves form."""
    labels, now_s = ["#"], 0.0
    for line in lines.splitlines():
        word, start_s, end_s = line.split()
        if float(start_s) - now_s > 1e-3:
            labels.append(f"\t{float(start_s):.4f} 100\tpau")
        labels.append(f"\t{float(end_s):.4f} 100\t{word.lower()}")
        now_s = float(end_s)
    if duration_s - now_s > 1e-3:
        labels.append(f"\t{duration_s:.4f} 100\tpau")
    return "\n".join(labels) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m core.actress.speech OUT")
    try:
        speak_corpus(Path(sys.argv[1]))
    except UserFacingError as error:
        sys.exit(str(error))
