"""The voice of the synthetic actress, made by Festival; only needed to remake the bundled speech.

``python -m core.actress.speech OUT`` writes ``OUT/audio/*.ogg`` (Vorbis, 16 kHz mono), ``OUT/labels.csv`` (see
`core.actress.labels`) and, to try an aligner's file with, ``OUT/labels/demo-*.lab`` (xwaves lines ``end colour
phone``). It asks for the program ``festival`` with the voice ``cmu_us_slt_arctic_hts`` and for the Python package
``pyworld``; the workstation itself never does.
"""

from __future__ import annotations

import csv
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.actress.labels import SentenceLabels, write_labels
from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER, Line, bundled_lines
from core.errors import UserFacingError
from core.progress import SILENT, Progress
from core.speech.phoneme import PAU

RATE_HZ = 16000
# One sentence differs from the next by this much, so that no two emotions share their timing and none is sung alike.
RATE_VARIATION = 0.05
PITCH_VARIATION_SEMITONES = 0.6
RANGE_VARIATION = 0.12
LOUDNESS_VARIATION_DB = 0.8
# libsndfile's scale, 0 best and 1 smallest; at this level nothing of the coding is heard.
COMPRESSION_LEVEL = 0.4
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
    lines = bundled_lines()
    voice_of = {line.sentence: varied(voices()[line.emotion], line.sentence) for line in lines}
    for name in ("audio", "labels"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    labels = {}
    with tempfile.TemporaryDirectory() as scratch:
        progress.step(0.0, "speaking with Festival")
        _run_festival(lines, voice_of, Path(scratch))
        for i, line in enumerate(lines):
            name = line.sentence
            progress.step((i + 1) / (len(lines) + 1), f"colouring {name}")
            samples, rate_hz = soundfile.read(Path(scratch) / f"{name}.wav")
            coloured = colour(samples, rate_hz, voice_of[name])
            coloured = soxr.resample(coloured, rate_hz, RATE_HZ)
            soundfile.write(
                folder / "audio" / f"{name}.ogg", coloured, RATE_HZ, subtype="VORBIS",
                compression_level=COMPRESSION_LEVEL,
            )  # fmt: skip
            segments = (Path(scratch) / f"{name}.lab").read_text()
            if line.role == "demo":
                (folder / "labels" / f"{name}.lab").write_text(segments)
            duration_s = len(coloured) / RATE_HZ
            labels[name] = SentenceLabels(
                _phones(segments, duration_s), _words((Path(scratch) / f"{name}.words").read_text(), duration_s)
            )
    write_labels(folder / "labels.csv", labels)


def varied(voice: Voice, sentence: str) -> Voice:
    """Return ``voice`` as it sounds in this sentence."""
    chance = Chance(f"voice {sentence}")

    def around(width: float) -> float:
        return chance.between(-width, width)

    return replace(
        voice,
        rate=voice.rate * (1 + around(RATE_VARIATION)),
        pitch_semitones=voice.pitch_semitones + around(PITCH_VARIATION_SEMITONES),
        pitch_range=voice.pitch_range * (1 + around(RANGE_VARIATION)),
        loudness_db=voice.loudness_db + around(LOUDNESS_VARIATION_DB),
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


def _run_festival(lines: list[Line], voice_of: dict[str, Voice], folder: Path) -> None:
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
    for line in lines:
        script.append(f'(speak "{folder / line.sentence}" "{line.text}" {voice_of[line.sentence].rate:.4f})')
    path = folder / "speak.scm"
    path.write_text("\n".join(script) + "\n", encoding="utf-8")
    done = subprocess.run(["festival", "-b", str(path)], capture_output=True, text=True)
    missing = [line.sentence for line in lines if not (folder / f"{line.sentence}.wav").exists()]
    if missing:
        reason = (done.stderr or done.stdout).strip().splitlines()
        raise UserFacingError(
            f"Festival did not speak sentence '{missing[0]}' ({reason[-1] if reason else 'it said nothing'}).",
            "On Debian: apt install festvox-us-slt-hts.",
        )


def _phones(segments: str, duration_s: float) -> list[tuple[str, float]]:
    """Read Festival's segments (xwaves); the last one, silence, ends with the sound."""
    rows = [line.split() for line in segments.partition("#\n")[2].splitlines()]
    ends = [(phone, float(end)) for end, _, phone in rows]
    return [*ends[:-1], (ends[-1][0], duration_s)]


def _words(lines: str, duration_s: float) -> list[tuple[str, float]]:
    """Lay words (lines ``word start end``) over the whole sentence, silence as ``pau``; ``'s`` joins its word."""
    labels: list[tuple[str, float]] = []
    now_s = 0.0
    for line in lines.splitlines():
        word, start, end = line.split()
        if word.startswith("'"):
            word = labels.pop()[0] + word
        elif float(start) - now_s > 1e-3:
            labels.append((PAU, float(start)))
        labels.append((word.lower(), float(end)))
        now_s = float(end)
    if duration_s - now_s > 1e-3:
        labels.append((PAU, duration_s))
    return labels


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m core.actress.speech OUT")
    try:
        speak_corpus(Path(sys.argv[1]))
    except UserFacingError as error:
        sys.exit(str(error))
