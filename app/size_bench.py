"""What a database of the paper's full size costs: to build, to open, to browse, and to search the first time."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from pathlib import Path

import numpy as np

from app.child_process import run_apart
from app.machine import forget_peak, peak_mb, timed
from core.manifold.picking import Picker
from core.motion.database import MotionDatabase, open_database
from core.progress import SILENT, Progress

PAPER_FRAMES = 135 * 60 * 120
_MAPS = 3  # the largest are looked at
_PICKS = 200
_SAMPLED_S = 0.2


def bench_size(
    source: MotionDatabase | None, n_frames: int, path: Path, progress: Progress = SILENT
) -> dict[str, object]:
    """Build a database of ``n_frames`` at ``path`` from ``source`` (None: it is there), then use it in a new process.

    returns : {build, use}, see `bench_build` and `bench_use`
    """
    answer = {}
    if source is not None:
        answer["build"] = bench_build(source, n_frames, path, progress.part(0.0, 0.9))
    answer["use"] = run_apart(bench_use, (path,), progress.part(0.9, 1.0), "The process that opened it has died.")
    return answer


def bench_build(source: MotionDatabase, n_frames: int, path: Path, progress: Progress = SILENT) -> dict[str, object]:
    """Build ``source``, repeated with variation to ``n_frames``, at ``path``, and say what it took.

    ``stages_s`` are seconds by stage; ``cpu_s`` is processor time of all processes, which other work on the machine
    disturbs less; ``peak_mb`` is the largest sum of resident sizes of this process and its workers, sampled five times
    a second: memory that they share is counted for each, so it is no less than what was taken.
    """
    from core.motion.build import build_database
    from core.motion.repeated_corpus import repeated_corpus

    stages = _Stages(progress)
    with _Family() as family:
        began = time.perf_counter()
        database = build_database(repeated_corpus(source, n_frames), path, progress=stages)
        seconds = time.perf_counter() - began
    largest = max(database.maps, key=lambda phone: len(database.maps[phone].frames))
    return {
        "seconds": seconds, "stages_s": stages.seconds(), "cpu_s": family.cpu_s, "peak_mb": family.peak_mb,
        "file_mb": path.stat().st_size / 2**20,
        "frames": len(database.frames), "nodes": len(database.nodes), "sentences": len(database.sentences),
        "largest_map": largest, "largest_map_frames": len(database.maps[largest].frames),
        "minutes": len(database.frames) / database.rate_hz / 60,
    }  # fmt: skip


def bench_use(path: Path, progress: Progress = SILENT) -> dict[str, object]:
    """Open a database, look at its largest maps and synthesise a sentence, the first time and the second.

    ``open_s`` is until maps can be looked at, ``engine_s`` until the search can be asked; a map's ``page_ms`` is until
    its points, nodes and picker are there, ``pick_ms`` the median of many picks.
    """
    from app.panels.isomap.shown_map import ShownMap
    from core.actress.corpus import demo_sentences, transcript_of
    from core.search.compute import NumpyKernels
    from core.search.engine import SearchEngine
    from core.synthesis.engine import SpeechInput

    forget_peak()
    began = time.perf_counter()
    database = open_database(path)
    opened = time.perf_counter()
    engine = SearchEngine(database, NumpyKernels())
    ready = time.perf_counter()
    progress.step(0.2, "looking at maps")
    maps = []
    for phone in sorted(database.maps, key=lambda phone: -len(database.maps[phone].frames))[:_MAPS]:
        page_s = time.perf_counter()
        shown = ShownMap.isomap(database, phone)
        picker = shown.picker
        _ = shown.emotion, shown.relative_time, shown.at_share(0.5)
        page_s = time.perf_counter() - page_s
        left, bottom, right, top = shown.bounds
        points = np.random.default_rng(0).uniform((left, bottom), (right, top), (_PICKS, 2))
        picks = [_pick_s(picker, at, database) for at in points]
        maps.append({"phone": phone, "frames": len(shown.points), "page_ms": 1e3 * page_s,
                     "pick_ms": 1e3 * float(np.median(picks)), "slowest_pick_ms": 1e3 * max(picks)})  # fmt: skip
    spoken = demo_sentences()[0]
    speech = SpeechInput(transcript_of(spoken))
    progress.step(0.5, "synthesising")
    answers = []
    synth_s = [timed(lambda: answers.append(engine.synthesise(speech))) for _ in range(2)]
    return {
        "open_s": opened - began, "engine_s": ready - opened, "maps": maps, "first_synth_s": synth_s[0],
        "second_synth_s": synth_s[1], "phonemes": len(speech.transcript.phonemes),
        "search_gap": answers[0].path.gap, "peak_mb": peak_mb(),
    }  # fmt: skip


def _pick_s(picker: Picker, at: np.ndarray, database: MotionDatabase) -> float:
    return timed(lambda: picker.pick(at).blend(database.frames))


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    lines = []
    if "build" in answer:
        build = answer["build"]
        stages = ", ".join(f"{name} {seconds:.0f} s" for name, seconds in build["stages_s"].items())
        lines += [f"{build['frames']} frames ({build['minutes']:.0f} min), {build['nodes']} motion nodes, "
                  f"{build['sentences']} sentences",
                  f"built in {build['seconds']:.0f} s ({stages}; {build['cpu_s']:.0f} s of processor time), "
                  f"peak {build['peak_mb']:.0f} MiB, "
                  f"file {build['file_mb']:.0f} MiB"]  # fmt: skip
    use = answer["use"]
    lines.append(f"opened in {use['open_s']:.2f} s, engine {use['engine_s']:.2f} s, peak {use['peak_mb']:.0f} MiB")
    for row in use["maps"]:
        lines.append(f"map of /{row['phone']}/, {row['frames']} frames: page {row['page_ms']:.0f} ms, pick "
                     f"{row['pick_ms']:.1f} ms (slowest {row['slowest_pick_ms']:.1f})")  # fmt: skip
    lines.append(f"first synthesis {use['first_synth_s']:.1f} s, second {use['second_synth_s']:.1f} s "
                 f"({use['phonemes']} phonemes)")  # fmt: skip
    return "\n".join(lines)


class _Stages(Progress):
    """Notes when each stage began, known by the first word of what it says."""

    def __init__(self, onward: Progress) -> None:
        self._onward = onward
        self._began: dict[str, float] = {}

    def step(self, fraction: float, message: str = "") -> None:
        self._began.setdefault(message.partition(" ")[0], time.perf_counter())
        self._onward.step(fraction, message)

    def seconds(self) -> dict[str, float]:
        """Return how long each stage took; the last one until now."""
        ends = [*list(self._began.values())[1:], time.perf_counter()]
        return {name: end - began for (name, began), end in zip(self._began.items(), ends)}


class _Family:
    """Watches this process and all that came of it, while the block runs, where the system tells.

    peak_mb : the largest sum of their resident sizes; cpu_s : their processor time together
    """

    peak_mb = cpu_s = 0.0

    def __enter__(self) -> _Family:
        self._cpu_s: dict[int, float] = {}
        self._ended = threading.Event()
        self._before_s = time.process_time()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()
        self._cpu_s[os.getpid()] = time.process_time() - self._before_s
        self.cpu_s = sum(self._cpu_s.values())

    def _watch(self) -> None:
        page_mb, ticks = os.sysconf("SC_PAGE_SIZE") / 2**20, os.sysconf("SC_CLK_TCK")
        while not self._ended.wait(_SAMPLED_S):
            total_mb = 0.0
            for process, fields in _family().items():
                total_mb += int(fields[21]) * page_mb
                self._cpu_s[process] = (int(fields[11]) + int(fields[12])) / ticks
            self.peak_mb = max(self.peak_mb, total_mb)


def _family() -> dict[int, list[str]]:
    """What /proc says of this process and its descendants, from the third field of `stat` on."""
    known: dict[int, list[str]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            known[int(stat.parent.name)] = stat.read_text().rpartition(")")[2].split()
    family = [os.getpid()] if os.getpid() in known else []
    for process in family:
        family += [child for child, fields in known.items() if int(fields[1]) == process]
    return {process: known[process] for process in family}
