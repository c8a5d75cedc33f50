"""How long the window keeps an animator waiting: two hundred actions under a watchdog, and a second start."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from app.headless import end_with_children, on_screen
from app.machine import MemoryReader
from app.window_session import ALLOWED_S, COMPUTED_S
from core.errors import UserFacingError
from core.progress import SILENT, Progress

ACTIONS = 200
# nothing that the window does takes as long, on a busy machine either
STILL_LIMIT_S = 180


def bench_window(
    database: Path | None = None, n_actions: int = ACTIONS, progress: Progress = SILENT
) -> dict[str, object]:
    """Run the script in a window of its own, with settings of its own; then start that project again and time it.

    n_actions : how many of the script's actions, from its first
    Returns {machine, actions, stuck, start, hover, peak_mb} and what `app.window_session.figures` does; times in ms, of
    the start in s. Raises `UserFacingError` when there is neither a virtual screen nor a display, or the window hangs.
    """
    reader = MemoryReader()
    machine = reader.machine(3).as_dict()
    reader.close()
    with tempfile.TemporaryDirectory(prefix="efase-bench-", ignore_cleanup_errors=True) as folder:
        seen = measured("session", Path(folder), database, n_actions, progress.part(0.05, 0.9))
        seen["start"] = measured("start", Path(folder), database, n_actions, progress.part(0.9, 1.0))
    return {"machine": machine, **seen}


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    hover, start, allowed_ms = answer["hover"], answer["start"], 1000 * ALLOWED_S
    lines = [
        f"{answer['actions']} actions, {answer['beats']} beats of the main thread; late, by the clock: 99 % by at most "
        f"{answer['percentile_99_ms']:.0f} ms, {answer['late']} over {allowed_ms:.0f} ms, worst "
        f"{answer['longest_ms']:.0f} ms",
        f"less what it queued for a processor: 99 % by at most {answer['own_percentile_99_ms']:.0f} ms, "
        f"{answer['own_late']} over {allowed_ms:.0f} ms, worst {answer['longest_own_ms']:.0f} ms; computed itself: "
        f"{answer['computed_late']} over {1000 * COMPUTED_S:.0f} ms, worst {answer['longest_computed_ms']:.0f} ms",
        f"hover to face: median {hover['median_ms']:.0f} ms, 95 % within {hover['percentile_95_ms']:.0f} ms, "
        f"of {hover['count']}",
        f"second start: window after {start['window_s']:.2f} s, project after {start['project_s']:.2f} s, motion "
        f"after {start['motion_s']:.2f} s; peak memory {answer['peak_mb']:.0f} MiB",
    ]  # fmt: skip
    if answer["stuck"]:
        lines.append(f"ended by force: {', '.join(answer['stuck'])}")
    for title, rows in {
        "longest waits, less what was queued": answer["worst"],
        "most computed": answer["computed"],
        "second start, most computed": start["computed"],
    }.items():
        lines += ["", f"{'waited ms':>10}{'not queued':>12}{'computed':>10}  {title}"]
        for row in rows:
            lines.append(f"{row['wall_ms']:10.0f}{row['own_ms']:12.0f}{row['cpu_ms']:10.0f}  "
                         f"{row['action']}   {row['where']}")  # fmt: skip
    lines += ["", f"{'waited ms':>10}{'not queued':>12}{'computed':>10}{'median':>9}  longest of each action"]
    for row in answer["by_action"]:
        lines.append(f"{row['longest_ms']:10.0f}{row['own_ms']:12.0f}{row['computed_ms']:10.0f}"
                     f"{row['median_ms']:9.1f}  {row['action']}")  # fmt: skip
    return "\n".join(lines)


def measured(
    part: str, folder: Path, database: Path | None, n_actions: int, progress: Progress = SILENT
) -> dict[str, object]:
    """Run one part, ``session`` or ``start``, in a process with a screen that keeps out of the user's own settings.

    Raises `UserFacingError` when it fails, or says nothing for `STILL_LIMIT_S`.
    """
    answer, errors = folder / f"{part}.json", folder / f"{part}.txt"
    command = [sys.executable, "-m", "app.window_session", part, str(answer), str(database or ""), str(time.time()),
               str(n_actions)]  # fmt: skip
    command, environment = on_screen(command)
    environment |= {"EFASE_CONFIG_DIR": str(folder / "config"), "EFASE_DATA_DIR": str(folder / "data")}
    with errors.open("w", encoding="utf-8") as said, subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=said, text=True, start_new_session=os.name == "posix"
    ) as process:  # fmt: skip
        try:
            _listen(process, progress)
        except BaseException:
            end_with_children(process)
            raise
    if process.returncode or not answer.is_file():
        last = (errors.read_text(encoding="utf-8", errors="replace").strip().splitlines() or ["it said nothing"])[-1]
        raise UserFacingError(f"The window could not be measured: {last}")
    return json.loads(answer.read_text(encoding="utf-8"))


def _listen(process: subprocess.Popen, progress: Progress) -> None:
    """Pass on what it does until it ends."""
    heard, doing = threading.Event(), ["starting"]

    def hear() -> None:
        for line in process.stdout:
            doing[:] = [line.strip()]
            heard.set()
        heard.set()

    ear = threading.Thread(target=hear, daemon=True)
    ear.start()
    while ear.is_alive():
        if not heard.wait(STILL_LIMIT_S):
            message = f"The window stood still for {STILL_LIMIT_S} s at '{doing[0].partition(' ')[2]}'."
            raise UserFacingError(message, "Leave the machine to itself, or ask for fewer --actions.")
        heard.clear()
        fraction, _, what = doing[0].partition(" ")
        progress.step(float(fraction) if what else 0.0, what)
        ear.join(0.01)
    process.wait()
