"""How well captures are mended: faults put into a copy of real takes, beside lines and splines through the gaps."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.importing.mending import SPIKE, SWAP, MendRow, mend
from core.importing.plan import MendLimits
from core.importing.steady_markers import propose_steady
from core.motion.motion_files import read_motion
from core.progress import SILENT, Progress

# The takes that the limits were chosen on, and those that they are judged by.
TUNED_ON, JUDGED_BY = ("Nose", "Eyebrows"), ("Jaw", "Cheeks")
GAP_LENGTHS = (3, 6, 12, 24, 30, 60)
# The published takes were smoothed; cameras jitter by about a tenth of a millimetre an axis.
JITTERS_MM = (0.0, 0.1)
SEEDS = (1, 2, 3)
_GAPS, _SPIKES, _SWAPS = 20, 20, 8
_APART = 12
_SAME_EDGE = 1


@dataclass
class _Hurt:
    """A take with faults put in: what it was, what it is, and rows (kind, marker, other, start, stop)."""

    sound: np.ndarray
    hurt: np.ndarray
    rows: list[tuple[str, int, int, int, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._busy = np.zeros(self.sound.shape[:2], bool)

    def claim(self, markers: list[int], start: int, stop: int) -> bool:
        """Whether nothing was put near these frames of these markers yet; they are taken from now on."""
        if self._busy[max(0, start - _APART) : stop + _APART, markers].any():
            return False
        self._busy[start:stop, markers] = True
        return True


def hurt_take(take: np.ndarray, seed: int) -> _Hurt:
    """Put 8 swaps of near neighbours (4 to 90 frames), 20 spikes (1 or 2 frames, 3 to 25 mm) and 20 gaps (3 to 30
    frames) into a copy of ``take``, shape (n_frames, n_markers, 3), mm; 12 sound frames between any two of a marker.
    """
    rng = np.random.default_rng(seed)
    n_frames, n_markers = take.shape[:2]
    done = _Hurt(np.asarray(take, float), np.array(take, float))
    middle = done.sound.mean(axis=0)
    wanted = {"swap": _SWAPS, "spike": _SPIKES, "gap": _GAPS}
    lengths = {"swap": (4, 91), "spike": (1, 3), "gap": (3, 31)}
    for kind, count in wanted.items():
        while sum(row[0] == kind for row in done.rows) < count:
            k, length = int(rng.integers(n_markers)), int(rng.integers(*lengths[kind]))
            start = int(rng.integers(20, n_frames - 20 - length))
            span = slice(start, start + length)
            near = np.argsort(np.linalg.norm(middle - middle[k], axis=1))
            other = int(near[rng.integers(1, 4)]) if kind == "swap" else -1
            if not done.claim([k] if other < 0 else [k, other], start, start + length):
                continue
            if kind == "swap":
                done.hurt[span, [k, other]] = done.hurt[span, [other, k]]
            elif kind == "spike":
                push = rng.normal(size=3)
                done.hurt[span, k] += rng.uniform(3, 25) * push / np.linalg.norm(push)
            else:
                done.hurt[span, k] = np.nan
            done.rows.append((kind, k, other, start, start + length))
    return done


def bench_mending(folder: Path, progress: Progress = SILENT) -> dict[str, object]:
    """Measure on a folder laid out like animface-mocap, on the takes that no limit was chosen on.

    Raises `UserFacingError` when a take is not there.
    """
    takes = {name: read_motion(_file(folder, name)) for name in JUDGED_BY}
    names, rate_hz = next(iter(takes.values()))[1:]
    everything = [read_motion(_file(folder, name))[0] for name in (*TUNED_ON, *JUDGED_BY)]
    rigid = [names.index(name) for name in propose_steady(names, everything).rigid]
    counts = {kind: [0, 0, 0] for kind in (SPIKE, SWAP)}
    n = len(takes) * len(SEEDS)
    errors: dict[str, list[np.ndarray]] = {}
    for i, (take, seed) in enumerate((t, s) for t in takes for s in SEEDS):
        progress.step(0.5 * i / n, f"faults in {take}")
        hurt = hurt_take(takes[take][0], seed)
        mended = mend(hurt.hurt, names, rate_hz, MendLimits(), rigid)
        _count(counts, hurt, mended.rows, names)
        filled = np.zeros(hurt.sound.shape[:2], bool)
        for kind, k, _, start, stop in hurt.rows:
            filled[start:stop, k] |= kind != "swap"
        _compare(errors, hurt.sound, mended.positions, filled)
    by_length = []
    for i, (jitter_mm, length) in enumerate((j, n) for j in JITTERS_MM for n in GAP_LENGTHS):
        progress.step(0.5 + 0.5 * i / (len(JITTERS_MM) * len(GAP_LENGTHS)), f"gaps of {length} frames")
        of_length: dict[str, list[np.ndarray]] = {}
        for take in takes:
            for seed in SEEDS:
                sound = takes[take][0].astype(float)
                sound += jitter_mm * np.random.default_rng([seed, length]).normal(size=sound.shape)
                missing = _gaps(sound.shape[:2], length, seed)
                cut = np.where(missing[:, :, None], np.nan, sound)
                mended = mend(cut, names, rate_hz, MendLimits(longest_gap_s=2.0, faults=False), rigid)
                _compare(of_length, sound, mended.positions, missing)
        by_length.append({"jitter_mm": jitter_mm, "frames": length, "seconds": round(length / rate_hz, 3),
                          **_rms(of_length)})  # fmt: skip
    return {
        "takes": list(takes), "seeds": list(SEEDS), "rate_hz": rate_hz,
        "faults": {kind: {"planted": p, "found": f, "told": t} for kind, (f, p, t) in counts.items()},
        "rms_mm": _rms(errors), "gaps": by_length,
    }  # fmt: skip


def _file(folder: Path, take: str) -> Path:
    path = folder / f"{take}.c3d"
    if not path.is_file():
        raise UserFacingError(f"There is no take '{path}'.", "Name a folder laid out like animface-mocap.")
    return path


def _gaps(shape: tuple[int, int], length: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    missing = np.zeros(shape, bool)
    for _ in range(60):
        k, start = rng.integers(shape[1]), rng.integers(20, shape[0] - 20 - length)
        if not missing[max(0, start - 8) : start + length + 8, k].any():
            missing[start : start + length, k] = True
    return missing


def _count(counts: dict[str, list[int]], hurt: _Hurt, rows: tuple[MendRow, ...], names: tuple[str, ...]) -> None:
    for kind, tally in counts.items():
        planted = [row[1:] for row in hurt.rows if row[0] == kind]
        told = [row for row in rows if row.kind == kind]
        tally[0] += sum(any(_same(p, t, names) for t in told) for p in planted)
        tally[1] += len(planted)
        tally[2] += len(told)


def _same(planted: tuple[int, int, int, int], told: MendRow, names: tuple[str, ...]) -> bool:
    marker, other, start, stop = planted
    concerned = {names[marker]} if other < 0 else {names[marker], names[other]}
    edges = abs(start - told.start) <= _SAME_EDGE and abs(stop - told.stop) <= _SAME_EDGE
    return edges and {told.marker, told.other} - {""} == concerned


def _compare(errors: dict[str, list[np.ndarray]], sound: np.ndarray, mended: np.ndarray, missing: np.ndarray) -> None:
    """Add the errors (mm) of the mended motion and of its rivals, which are told where to fill."""
    from scipy.interpolate import CubicSpline

    frames = np.arange(len(sound))
    line, cubic = sound.copy(), sound.copy()
    for k in np.flatnonzero(missing.any(axis=0)):
        seen = ~missing[:, k]
        line[~seen, k] = np.stack([np.interp(frames[~seen], frames[seen], sound[seen, k, d]) for d in range(3)], 1)
        cubic[~seen, k] = CubicSpline(frames[seen], sound[seen, k])(frames[~seen])
    for name, motion in (("mended", mended), ("linear", line), ("cubic", cubic)):
        errors.setdefault(name, []).append(np.linalg.norm((motion - sound)[missing], axis=1))


def _rms(errors: dict[str, list[np.ndarray]]) -> dict[str, float]:
    return {name: round(float(np.sqrt((np.concatenate(e) ** 2).mean())), 3) for name, e in errors.items()}


def as_table(answer: dict[str, object]) -> str:
    """Say it in lines."""
    lines = [f"takes {', '.join(answer['takes'])}, seeds {', '.join(map(str, answer['seeds']))}"]
    lines += [f"{kind}s: {n['found']} of {n['planted']} found, {n['told']} told"
              for kind, n in answer["faults"].items()]  # fmt: skip
    errors = answer["rms_mm"]
    lines.append(f"gaps and spikes: mended {errors['mended']:.3f} mm RMS, linear {errors['linear']:.3f}, cubic "
                 f"{errors['cubic']:.3f} (both told where)")  # fmt: skip
    lines.append(f"{'jitter':>9} {'gap':>10} {'mended':>8} {'linear':>8} {'cubic':>8}  mm RMS")
    for row in answer["gaps"]:
        errors = "".join(f" {row[name]:8.3f}" for name in ("mended", "linear", "cubic"))
        lines.append(f"{row['jitter_mm']:6.1f} mm {row['seconds']:8.2f} s{errors}")
    return "\n".join(lines)
