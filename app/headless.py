"""The workstation's main job without a display: four films and a picture of the window."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from app.demo import demo_database
from app.export import VideoSettings, export
from app.pictures import FaceRig
from core.actress.corpus import demo_sentences, transcript_of
from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable
from core.media.audio import load_audio
from core.media.swap_in import swapped_in
from core.progress import SILENT, Progress
from core.search.engine import SearchEngine
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import SpeechInput
from gpu.device import open_kernels

WINDOW_SIZE = (1600, 1000)
_PICTURE_LIMIT_S = 240


def write_demo(out: Path, progress: Progress = SILENT) -> dict[str, object]:
    """Write ``demo-<emotion>.avi`` for each demo sentence and ``workstation.png`` into ``out``.

    Returns {outputs, notes, seconds}; a note is a sentence about something that had to be left out.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(f"The folder '{out}' cannot be made: {error.strerror}.") from error
    began = time.perf_counter()
    database = demo_database(progress.part(0.0, 0.2))
    kernels, backend = open_kernels()
    engine = SearchEngine(database, kernels)
    notes = [backend]
    rig, settings = None, VideoSettings()
    try:
        rig = FaceRig.of("default", database.markers, progress=progress.part(0.2, 0.25))
    except FaceUnavailable as error:
        notes.append(str(error))
        settings = VideoSettings(style="markers")
    outputs = []
    sentences = demo_sentences()
    for i, spoken in enumerate(sentences):
        stage = progress.part(0.25 + 0.15 * i, 0.4 + 0.15 * i)
        transcript = transcript_of(spoken)
        painted = [EmotionModifier(0.0, transcript.duration_s, spoken.emotion)]
        answer = engine.synthesise(SpeechInput(transcript, painted), stage.part(0.0, 0.2))
        path = out / f"demo-{spoken.emotion}.avi"
        export(answer.motion, load_audio(spoken.audio), rig, path, settings, stage.part(0.2, 1.0), transcript)
        outputs.append(str(path))
    progress.step(0.88, "drawing the window")
    picture = out / "workstation.png"
    trouble = draw_window(picture)
    if trouble:
        notes.append(trouble)
    else:
        outputs.append(str(picture))
    return {"outputs": outputs, "notes": notes, "seconds": round(time.perf_counter() - began, 2)}


def draw_window(path: Path) -> str:
    """Draw the real main window under a virtual screen; return a sentence about what went wrong, or nothing."""
    # all that the screen and the window leave behind, however they end, goes into a folder that is removed
    with tempfile.TemporaryDirectory(prefix="efase-window-", ignore_cleanup_errors=True) as folder:
        drawn = Path(folder) / "window.png"
        command = [sys.executable, "-m", "app.main", "--picture", str(drawn)]
        try:
            command, environment = on_screen(command)
        except UserFacingError as error:
            return f"The window was not drawn: {error}"
        code, said = _run(command, {**environment, "TMPDIR": folder})
        if code is None:
            return f"The window was not drawn within {_PICTURE_LIMIT_S} s."
        if code or not drawn.is_file():
            last = (said.strip().splitlines() or ["it said nothing"])[-1]
            return f"The window was not drawn: {last}"
        with swapped_in(path) as beside:
            shutil.copyfile(drawn, beside)
    return ""


def on_screen(command: list[str]) -> tuple[list[str], dict[str, str]]:
    """Return how to run ``command`` where it has a screen, a virtual one if there is no other, and its environment.

    Raises `UserFacingError` when there is neither.
    """
    environment = dict(os.environ)
    if os.environ.get("DISPLAY") or sys.platform in ("darwin", "win32"):
        return command, environment
    virtual = shutil.which("xvfb-run")
    if virtual is None:
        raise UserFacingError("There is no display and no xvfb-run (Debian package xvfb).")
    width, height = WINDOW_SIZE
    environment["QT_QPA_PLATFORM"] = "xcb"
    environment.pop("WAYLAND_DISPLAY", None)
    return [virtual, "-a", "-s", f"-screen 0 {width}x{height}x24", *command], environment


def _run(command: list[str], environment: dict[str, str]) -> tuple[int | None, str]:
    """Return exit code and standard error; no code when it took too long. None of its processes outlives the call."""
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
        start_new_session=os.name == "posix",
    ) as process:  # fmt: skip
        try:
            _, said = process.communicate(timeout=_PICTURE_LIMIT_S)
        except subprocess.TimeoutExpired:
            end_with_children(process)
            return None, ""
        except BaseException:
            end_with_children(process)
            raise
        return process.returncode, said


def end_with_children(process: subprocess.Popen) -> None:
    """End a process that was started in a session of its own, and all that it started."""
    # xvfb-run would leave its server and the window running
    if os.name == "posix":
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
    else:
        process.kill()
