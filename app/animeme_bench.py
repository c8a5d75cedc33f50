"""`efase bench animeme`: animemes and their rivals on sentences that they have not seen, and how long all takes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.report.charts import Line, line_chart
from core.animeme.animeme import AnimemeModel
from core.animeme.comparison import Rated, rate_methods, spoken_like
from core.animeme.dragging import wander_when_dragged
from core.animeme.examples import Example
from core.animeme.material import (
    Mapping,
    database_examples,
    face_controls,
    key_shape_controls,
    mouth_measures,
    recorded_examples,
)
from core.animeme.training import train_animemes
from core.animeme.width_search import TrainingSettings
from core.evaluation.measures import correlation
from core.media.swap_in import swapped_in
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

# Kuo et al. 2012, section 6: average L2 errors on their own, unpublished data.
PAPER_ERRORS = {"animeme": 0.406, "MMM": 0.860, "Cohen-Massaro": 1.427}
PAPER_SPEECH_S = 300.0
_COLOURS = {"animeme": "#0f6c7a", "MMM": "#b0562c", "Cohen-Massaro": "#7a3b8f"}
_SYNTHESIS_HZ, _TRIES = 60.0, 5


def bench_animemes(
    database: MotionDatabase, pictures: Path | None = None, with_face: bool = True, progress: Progress = SILENT
) -> dict[str, object]:
    """Measure everything and return the object of ``--json``.

    pictures : folder for the plots like the paper's figure 2, or None
    with_face : train the 52 units of the default face too
    """
    controls = {"key lip shapes": key_shape_controls(database), "mouth": mouth_measures(database)}
    answer: dict[str, object] = {"database": database.name, "synthetic": database.synthetic}
    for i, (title, (names, mapping)) in enumerate(controls.items()):
        stage = progress.part(0.35 * i, 0.35 * (i + 1))
        parts = _parts(database, names, mapping)
        rated = rate_methods(*parts.values(), stage)
        answer[title] = _errors(names, rated, parts)
        if pictures is not None:
            _draw(pictures, title, names, rated, parts["test"])
        if title == "key lip shapes":
            answer["speed"] = _speed(parts["train"], rated[0].model, [e.transcript for e in parts["test"]])
        else:
            answer["a vowel dragged to 2 s"] = _dragged(rated, [e.transcript for e in parts["test"]], names[0])
    if with_face:
        from core.face.default_face import default_face

        names, mapping = face_controls(database, default_face(progress.part(0.7, 0.71)))
        answer["face units"] = _face_units(database, names, mapping, progress.part(0.71, 1.0))
    progress.step(1.0, "measured")
    return answer


def as_table(answer: dict) -> str:
    """Write the errors as Markdown."""
    lines = []
    for title in ("key lip shapes", "mouth"):
        lines += [f"{title}: {', '.join(answer[title]['names'])}", ""]
        lines += ["| | train | spread | test | spread | ratio | form |", "|---|---:|---:|---:|---:|---:|---|"]
        for method, row in answer[title]["methods"].items():
            lines.append(
                f"| {method} | {row['train']:.3f} | {row['train_spread']:.3f} | {row['test']:.3f} | "
                f"{row['test_spread']:.3f} | {row['test_ratio']:.3f} | {row['form']} |"
            )
        lines.append("")
    for group in ("speed", "a vowel dragged to 2 s", "face units"):
        if group in answer:
            lines += [f"{name}: {value}" for name, value in answer[group].items()]
    return "\n".join(lines)


def _parts(database: MotionDatabase, names: Sequence[str], mapping: Mapping) -> dict[str, list[Example]]:
    parts = {"train": database_examples(database, names, mapping)}
    for split in ("tune", "test"):
        parts[split] = recorded_examples(database, database.held_out_recordings(split), names, mapping)
    return parts


def _errors(names: Sequence[str], rated: Sequence[Rated], parts: dict[str, list[Example]]) -> dict[str, object]:
    """Errors over each control's spread in the training part, mean and standard deviation over controls."""
    spread = np.concatenate([e.track.values for e in parts["train"]]).astype(float).std(axis=0)
    best = rated[0]
    methods = {}
    for found in rated:
        train, tune, test = (getattr(found, part) / spread for part in ("train", "tune", "test"))
        methods[found.method] = {
            "form": found.variant, "tried": found.tried,
            "train": float(train.mean()), "train_spread": float(train.std()),
            "tune": float(tune.mean()),
            "test": float(test.mean()), "test_spread": float(test.std()),
            "train_ratio": float((found.train / best.train).mean()),
            "test_ratio": float((found.test / best.test).mean()),
            "rms_test": dict(zip(names, found.test.tolist())),
            "rms_train": dict(zip(names, found.train.tolist())),
            "r_test": _correlations(found, parts["test"], names),
        }  # fmt: skip
    return {"names": list(names), "sentences": {part: len(e) for part, e in parts.items()}, "methods": methods}


def _correlations(found: Rated, examples: Sequence[Example], names: Sequence[str]) -> dict[str, float]:
    r = []
    for example in examples:
        said = spoken_like(found.model, example)
        r.append([correlation(a, b) for a, b in zip(said.T, example.track.values.T.astype(float))])
    return dict(zip(names, np.mean(r, axis=0).tolist()))


def _speed(train: Sequence[Example], model: AnimemeModel, transcripts: Sequence) -> dict[str, float]:
    few, seconds = [], 0.0
    for example in train:
        if seconds >= PAPER_SPEECH_S:
            break
        few.append(example)
        seconds += example.track.duration_s
    began = time.perf_counter()
    trained = train_animemes(few)
    took_s = time.perf_counter() - began
    to_the_end = train_animemes(few, settings=replace(TrainingSettings(), least_gain=1e-7, most_steps=200))
    model.curves(transcripts[0], _SYNTHESIS_HZ)
    times_s = []
    for transcript in transcripts:
        tries_s = []
        for _ in range(_TRIES):
            began = time.perf_counter()
            model.curves(transcript, _SYNTHESIS_HZ)
            tries_s.append(time.perf_counter() - began)
        times_s.append(min(tries_s))
    said_s = np.array([transcript.duration_s for transcript in transcripts])
    return {
        "speech_s": round(seconds, 1), "controls": len(train[0].track.names), "seconds_to_train": round(took_s, 2),
        "residual": trained.residual, "residual_converged": to_the_end.residual,
        "steps": trained.n_steps, "steps_converged": to_the_end.n_steps,
        "times_real_time": float(np.median(said_s / times_s)), "first_curves_ms": float(np.median(times_s)) * 1e3,
        "first_curves_ms_worst": float(np.max(times_s)) * 1e3,
    }  # fmt: skip


def _dragged(rated: Sequence[Rated], transcripts: Sequence, control: str) -> dict[str, float]:
    """See `wander_when_dragged`; for the animemes, plain and held."""
    return {
        f"{found.method}{', held' if holds else ''}": wander_when_dragged(
            found.model, transcripts, control, holds=holds
        )
        for found in rated if isinstance(found.model, AnimemeModel) for holds in (False, True)
    }  # fmt: skip


def _face_units(database: MotionDatabase, names: Sequence[str], mapping: Mapping, progress: Progress) -> dict:
    began = time.perf_counter()
    train = database_examples(database, names, mapping, progress=progress.part(0.0, 0.5))
    mapped_s = time.perf_counter() - began
    began = time.perf_counter()
    trained = train_animemes(train, progress=progress.part(0.5, 1.0))
    return {
        "units": len(names), "seconds_to_map": round(mapped_s, 2),
        "seconds_to_train": round(time.perf_counter() - began, 2), "residual_of_face_units": trained.residual,
    }  # fmt: skip


def _draw(folder: Path, title: str, names: Sequence[str], rated: Sequence[Rated], test: Sequence[Example]) -> None:
    """Plot the sentence whose error is the median, as the paper's figure 2: the first control, all methods."""
    shown = [found for found in rated if found.method in _COLOURS]
    errors = [float(((spoken_like(shown[0].model, e) - e.track.values)[:, 0] ** 2).mean()) for e in test]
    example = test[int(np.argsort(errors)[len(errors) // 2])]
    x, label = example.track.times_s, f"{names[0]}, mm" if title == "mouth" else names[0]
    lines = [Line("captured", x, example.track.values[:, 0].astype(float), "#3b4450", "dashed")]
    lines += [Line(f.method, x, spoken_like(f.model, example)[:, 0], _COLOURS[f.method]) for f in shown]
    said = [(u.start_s, u.end_s, u.phone) for u in example.transcript.phonemes]
    files = {
        f"animeme-{title.replace(' ', '-')}.svg": line_chart(
            f"{names[0]}, captured and synthesised", lines, ("s", label), said
        )
    }
    model = shown[0].model
    if isinstance(model, AnimemeModel):
        ruling = model.rule(example.transcript, 100.0, round(example.transcript.duration_s * 100))
        times_s = np.arange(ruling.shape[1]) / 100.0
        shades = ("#0f6c7a", "#b0562c", "#7a3b8f", "#51733a")
        rule = [
            Line("", times_s[(seen := row > 1e-3)], row[seen], shades[i % 4])
            for i, row in enumerate(ruling) if (row > 1e-3).any()
        ]  # fmt: skip
        files[f"animeme-{title.replace(' ', '-')}-dominance.svg"] = line_chart(
            "Dominance of each phoneme", rule, ("s", "share"), said, (860, 220)
        )
    folder.mkdir(parents=True, exist_ok=True)
    for name, svg in files.items():
        with swapped_in(folder / name) as beside:
            beside.write_text(svg, encoding="utf-8")
