"""A small synthetic corpus that databases are grown from, in tests."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from core.media.audio import Audio, encode_flac
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.speech.transcript import PhonemeUtterance, Transcript

NAMES = ("nose", "eye_l", "eye_r", "lip_up", "lip_low", "chin", "corner_l", "corner_r", "cheek")
REST = np.array([[0, 0, 0], [45, 30, -20], [-45, 30, -20], [0, -30, 5], [0, -32, 5], [0, -70, -5], [25, -31, 0],
                 [-25, -31, 0], [50, -10, -25]], float)  # fmt: skip
GROUPS = {"origin": ("nose",), "rigid": ("nose", "eye_l", "eye_r")}
EMOTIONS = ("neutral", "happiness", "anger", "sadness")
PHONES = ["b", "aa", "k", "iy", "s", "m", "t", "eh"]
RATE_HZ = 60.0


def spoken(name: str, seed: int, folder=None) -> Recording:
    """Make a sentence of about a second and a half: smooth random motion on a head that turns."""
    rng = np.random.default_rng(seed)
    phones = ["pau", *rng.choice(PHONES, 9), "pau"]
    ends = np.cumsum(rng.uniform(0.08, 0.2, len(phones)))
    duration_s = float(ends[-1])
    utterances = [PhonemeUtterance(str(p), float(a), float(b)) for p, a, b in zip(phones, [0.0, *ends], ends)]
    times = np.arange(int(duration_s * RATE_HZ)) / RATE_HZ
    face = np.repeat(REST[None], len(times), axis=0)
    for k in range(3, len(NAMES)):
        for axis in range(3):
            waves = sum(rng.normal() * np.sin(2 * np.pi * rng.uniform(0.5, 6) * times + rng.uniform(0, 6))
                        for _ in range(4))  # fmt: skip
            face[:, k, axis] += 1.5 * waves
    turn = Rotation.from_rotvec(np.c_[0.1 * times, 0.2 * times, 0 * times]).as_matrix()
    seen = face @ turn.transpose(0, 2, 1) + np.c_[times * 10, times, -times][:, None]
    audio = None
    if folder is not None:
        audio = folder / f"{name}.flac"
        audio.write_bytes(encode_flac(Audio(rng.normal(size=int(duration_s * 16000)).astype(np.float32) * 0.1, 16000)))
    return Recording(name, EMOTIONS[seed % 4], seen.astype(np.float32), NAMES, RATE_HZ,
                     Transcript.covering(utterances, [], duration_s), "words", audio)  # fmt: skip


def corpus_of(*seeds: int, folder=None, held_out=()) -> Corpus:
    """Make a corpus of sentences ``s<seed>``, its rest pose known; those of the seeds ``held_out`` are held out."""
    held = {"test": tuple(f"s{seed}" for seed in held_out)} if held_out else {}
    recordings = [spoken(f"s{seed}", seed, folder) for seed in (*seeds, *held_out)]
    return Corpus("grown", recordings, NAMES, GROUPS, rest=REST, synthetic=True, held_out=held)
