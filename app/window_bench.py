"""How long the window keeps an animator waiting: two hundred actions under a watchdog, and a second start."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from app.headless import on_screen
from app.machine import MemoryReader, peak_mb
from core.errors import UserFacingError
from core.progress import SILENT, Progress

ALLOWED_S = 0.1
_LIMIT_S = 300
_WORST = 12


def bench_window(database: Path | None = None, progress: Progress = SILENT) -> dict[str, object]:
    """Run the script in a window of its own, with settings of its own; then start that project again and time it.

    Returns {machine, actions, beats, late, worst, by_action, hover, start, peak_mb}; times in ms, start in s.
    Raises `UserFacingError` when there is neither a virtual screen nor a display.
    """
    reader = MemoryReader()
    machine = reader.machine(3).as_dict()
    reader.close()
    with tempfile.TemporaryDirectory(prefix="efase-bench-", ignore_cleanup_errors=True) as folder:
        progress.step(0.05, "two hundred actions")
        session = _child("session", Path(folder), database)
        progress.step(0.9, "starting again")
        session["start"] = _child("start", Path(folder), database)
    return {"machine": machine, **session}


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    hover, start = answer["hover"], answer["start"]
    lines = [
        f"{answer['actions']} actions, {answer['beats']} beats of the main thread: 99 % late by at most "
        f"{answer['percentile_99_ms']:.0f} ms, {answer['late']} over {1000 * ALLOWED_S:.0f} ms, "
        f"worst {answer['worst'][0]['wall_ms']:.0f} ms",
        f"hover to face: median {hover['median_ms']:.0f} ms, 95 % within {hover['percentile_95_ms']:.0f} ms, "
        f"of {hover['count']}",
        f"second start: window after {start['window_s']:.2f} s, project after {start['project_s']:.2f} s, motion "
        f"after {start['motion_s']:.2f} s; peak memory {answer['peak_mb']:.0f} MiB",
        "", f"{'waited ms':>10}{'computed ms':>12}  while",
    ]  # fmt: skip
    for row in answer["worst"]:
        lines.append(f"{row['wall_ms']:10.0f}{row['cpu_ms']:12.0f}  {row['action']}   {row['where']}")
    lines += ["", f"{'longest ms':>10}{'median ms':>12}  action"]
    for row in answer["by_action"]:
        lines.append(f"{row['longest_ms']:10.0f}{row['median_ms']:12.1f}  {row['action']}")
    return "\n".join(lines)


def _child(part: str, folder: Path, database: Path | None) -> dict:
    """Run one part in a process of its own, which has a screen, and keeps out of the user's own settings."""
    answer = folder / f"{part}.json"
    command = [sys.executable, "-m", "app.window_bench", part, str(answer), str(database or ""), str(time.time())]
    command, environment = on_screen(command)
    environment |= {"EFASE_CONFIG_DIR": str(folder / "config"), "EFASE_DATA_DIR": str(folder / "data")}
    try:
        done = subprocess.run(command, env=environment, timeout=_LIMIT_S, capture_output=True, text=True, check=False)
    except subprocess.TimeoutExpired:
        raise UserFacingError(f"The window did not come to an end within {_LIMIT_S} s.") from None
    if done.returncode or not answer.is_file():
        last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        raise UserFacingError(f"The window could not be measured: {last}")
    return json.loads(answer.read_text(encoding="utf-8"))


# In the child


def _wait_for(what, limit_s: float = 240.0) -> float:
    """Let the window live until ``what()``; returns the time then."""
    from app.window_script import pause

    end_s = time.time() + limit_s
    while not what():
        if time.time() > end_s:
            raise UserFacingError("The window did not get ready.")
        pause(5)
    return time.time()


def _session(database: Path | None) -> dict[str, object]:
    from app.main import _application, _window
    from app.watchdog import Watchdog
    from app.window import DEMO_START
    from app.window_script import ScriptedAnimator, script

    app = _application()
    app.setQuitOnLastWindowClosed(False)
    window = _window()
    watchdog = Watchdog()
    watchdog.action = "start"
    watchdog.start()
    window.show()
    window.keeper.new()
    window.authoring.open_database(database)
    window.authoring.open_demo_sentence(DEMO_START)
    _wait_for(lambda: window.authoring.document.prices is not None and window.authoring.jobs.is_idle)
    animator = ScriptedAnimator(window, watchdog)
    actions = script()
    animator.perform(actions)
    watchdog.action = "settle"
    _wait_for(lambda: window.authoring.jobs.is_idle)
    watchdog.stop()
    window.close()
    return _figures(watchdog.blocks, animator.hover_s, len(actions))


def _figures(blocks: list, hover_s: list[float], n_actions: int) -> dict[str, object]:
    acted = [block for block in blocks if block.action not in ("start", "settle")]
    late = np.array([block.wall_s for block in acted])
    hover = np.array(hover_s or [np.nan])
    longest = sorted(blocks, key=lambda block: -block.wall_s)[:_WORST]
    by_action = {}
    for block in blocks:
        by_action.setdefault(block.action, []).append(block.wall_s)
    return {
        "actions": n_actions, "beats": len(acted), "late": int((late > ALLOWED_S).sum()),
        "percentile_99_ms": float(1000 * np.percentile(late, 99)), "peak_mb": peak_mb(),
        "worst": [{"action": b.action, "wall_ms": 1000 * b.wall_s, "cpu_ms": 1000 * b.cpu_s, "where": b.where}
                  for b in longest],
        "by_action": sorted(({"action": action, "longest_ms": 1000 * max(waits),
                              "median_ms": float(1000 * np.median(waits))} for action, waits in by_action.items()),
                            key=lambda row: -row["longest_ms"]),
        "hover": {"count": len(hover_s), "median_ms": float(1000 * np.median(hover)),
                  "percentile_95_ms": float(1000 * np.percentile(hover, 95))},
    }  # fmt: skip


def _start_again(began_s: float) -> dict[str, float]:
    from app.main import _application, _start, _window

    app = _application()
    app.setQuitOnLastWindowClosed(False)
    window = _window()
    window.show()
    _start(window, None)
    exposed_s = _wait_for(lambda: window.windowHandle() is not None and window.windowHandle().isExposed())
    document = window.authoring.document
    project_s = _wait_for(lambda: document.speech is not None and document.database is not None)
    motion_s = _wait_for(lambda: not window.motion.is_empty and document.answer is not None)
    window.close()
    return {"window_s": exposed_s - began_s, "project_s": project_s - began_s, "motion_s": motion_s - began_s}


def main(arguments: list[str]) -> int:
    """Answer ``python -m app.window_bench session|start ANSWER DATABASE BEGAN``."""
    part, answer, database, began_s = arguments
    try:
        figures = _start_again(float(began_s)) if part == "start" else _session(Path(database) if database else None)
    except UserFacingError as error:
        print(error, file=sys.stderr)
        return 2
    Path(answer).write_text(json.dumps(figures), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
