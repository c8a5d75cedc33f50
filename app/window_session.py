"""What `app.window_bench` measures, in a process of its own that has a screen: a session under a watchdog, a start."""

from __future__ import annotations

import faulthandler
import json
import os
import sys
import time
from pathlib import Path

import numpy as np

from app.machine import peak_mb
from core.errors import UserFacingError

ALLOWED_S = 0.1
COMPUTED_S = 0.05
_WORST = 12


def say(fraction: float, what: str) -> None:
    """Tell the process that waits for this one that it lives, and at what it is."""
    print(f"{fraction:.4f} {what}", flush=True)


def session(database: Path | None, n_actions: int) -> dict[str, object]:
    """Do the script's first actions in a window on a demo sentence; returns the figures of `figures`."""
    from app.window import DEMO_START
    from app.window_script import ScriptedAnimator, script

    window, watchdog = _watched_window()
    window.keeper.new()
    window.authoring.jobs.progressed.connect(lambda _kind, _fraction, message: say(0.0, message or "opening"))
    window.authoring.open_database(database)
    window.authoring.open_demo_sentence(DEMO_START)
    _wait_for(lambda: window.authoring.document.prices is not None and window.authoring.jobs.is_idle)
    animator = ScriptedAnimator(window, watchdog)
    actions = script()[:n_actions]
    animator.perform(actions, lambda i, action: say(i / len(actions), f"{i + 1} of {len(actions)}: {action}"))
    watchdog.action = "settle"
    _wait_for(lambda: window.authoring.jobs.is_idle)
    watchdog.stop()
    window.close()
    return {"actions": len(actions), "stuck": animator.stuck, "peak_mb": peak_mb(),
            "hover": _hover(animator.hover_s), **figures(watchdog.blocks)}  # fmt: skip


def figures(blocks: list) -> dict[str, object]:
    """Return what beats amount to: {beats, late, own_late, computed_late, percentiles, worst, computed, by_action}.

    late, own_late and computed_late count those over `ALLOWED_S` by the clock, by the clock less what was queued for a
    processor, and over `COMPUTED_S` in what the main thread itself computed; of the actions alone, without the start
    worst, computed : the longest by `Block.own_s` and by what was computed, of the start as well; times in ms
    """
    acted = [block for block in blocks if block.action not in ("start", "settle")]
    wall, own, cpu = (np.array([getattr(b, name) for b in acted] or [0.0]) for name in ("wall_s", "own_s", "cpu_s"))
    by_action: dict[str, list] = {}
    for block in blocks:
        by_action.setdefault(block.action, []).append(block)
    rows = [{"action": action, "longest_ms": 1000 * max(b.wall_s for b in waits),
             "own_ms": 1000 * max(b.own_s for b in waits), "computed_ms": 1000 * max(b.cpu_s for b in waits),
             "median_ms": float(1000 * np.median([b.wall_s for b in waits]))}
            for action, waits in by_action.items()]  # fmt: skip
    return {
        "beats": len(acted), "late": int((wall > ALLOWED_S).sum()), "own_late": int((own > ALLOWED_S).sum()),
        "computed_late": int((cpu > COMPUTED_S).sum()), "percentile_99_ms": float(1000 * np.percentile(wall, 99)),
        "own_percentile_99_ms": float(1000 * np.percentile(own, 99)), "longest_ms": float(1000 * wall.max()),
        "longest_own_ms": float(1000 * own.max()), "longest_computed_ms": float(1000 * cpu.max()),
        "worst": _longest(blocks, lambda block: block.own_s), "computed": _longest(blocks, lambda block: block.cpu_s),
        "by_action": sorted(rows, key=lambda row: -row["computed_ms"]),
    }  # fmt: skip


def start_again(began_s: float) -> dict[str, object]:
    """Start the window as a user does who has worked before; returns {window_s, project_s, motion_s, worst, computed}.

    began_s : `time.time` when the process was started
    """
    from app.main import _start

    window, watchdog = _watched_window()
    _start(window, None)
    exposed_s = _wait_for(lambda: window.windowHandle() is not None and window.windowHandle().isExposed())
    document = window.authoring.document
    project_s = _wait_for(lambda: document.speech is not None and document.database is not None)
    motion_s = _wait_for(lambda: not window.motion.is_empty and document.answer is not None)
    _wait_for(lambda: window.authoring.jobs.is_idle)
    watchdog.stop()
    window.close()
    seen = figures(watchdog.blocks)
    return {"window_s": exposed_s - began_s, "project_s": project_s - began_s, "motion_s": motion_s - began_s,
            "worst": seen["worst"], "computed": seen["computed"]}  # fmt: skip


def _watched_window() -> tuple:
    """Show a window and begin to watch its main thread; returns (window, watchdog)."""
    from app.main import _application, _window
    from app.watchdog import Watchdog

    _application().setQuitOnLastWindowClosed(False)
    window = _window()
    watchdog = Watchdog()
    watchdog.action = "start"
    watchdog.start()
    window.show()
    return window, watchdog


def _hover(hover_s: list[float]) -> dict[str, float]:
    if not hover_s:
        return {"count": 0, "median_ms": 0.0, "percentile_95_ms": 0.0}
    median_ms, percentile_95_ms = 1000 * np.percentile(hover_s, [50, 95])
    return {"count": len(hover_s), "median_ms": float(median_ms), "percentile_95_ms": float(percentile_95_ms)}


def _longest(blocks: list, by) -> list[dict[str, object]]:
    return [{"action": b.action, "wall_ms": 1000 * b.wall_s, "own_ms": 1000 * b.own_s, "cpu_ms": 1000 * b.cpu_s,
             "where": b.where} for b in sorted(blocks, key=lambda block: -by(block))[:_WORST]]  # fmt: skip


def _wait_for(what, limit_s: float = 600.0) -> float:
    """Let the window live until ``what()``; returns the time then."""
    from app.window_script import pause

    end_s = time.time() + limit_s
    while not what():
        if time.time() > end_s:
            raise UserFacingError("The window did not get ready.")
        pause(5)
    return time.time()


def main(arguments: list[str]) -> int:
    """Answer ``python -m app.window_session session|start ANSWER DATABASE BEGAN ACTIONS``."""
    part, answer, database, began_s, n_actions = arguments
    faulthandler.enable()
    say(0.0, "making the window")
    try:
        seen = start_again(float(began_s)) if part == "start" else session(
            Path(database) if database else None, int(n_actions)
        )  # fmt: skip
    except UserFacingError as error:
        print(error, file=sys.stderr)
        return 2
    Path(answer).write_text(json.dumps(seen), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
