"""`efase bench live`: a sound played through a sound server, recorded again and spoken by the face; how late it is."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

from app.live.microphone import Microphone
from app.live.null_sink import null_sink
from app.live.session import LiveSession, TimedFrame
from core.errors import UserFacingError
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ, speech_features
from core.media.audio import Audio, resampled, write_wav
from core.progress import SILENT, Progress

PLAYED_HZ = 48_000
# no multiple of a frame, so that clicks fall anywhere between two
_CLICK_EVERY_S, _CLICK_S, _QUIET_S = 2.511, 0.0005, 0.005
_CLICK_LEVEL = 0.6  # the speech between stays below
_SPEECH_LEVEL = 0.3
_LEAD_S, _TAIL_S = 3.0, 1.0  # a sound server may take seconds until its first block
_EARLY_S, _LATE_S = 0.1, 0.5  # that a click may be heard before and after it was handed over, as clocks tell
_LAGS_S = np.arange(0.0, 0.4, 0.001)


def speech_with_clicks(duration_s: float, spoken: Audio) -> tuple[Audio, np.ndarray]:
    """Return ``spoken`` over and over, quiet, with a click every 2.511 s, and the samples at which clicks begin."""
    speech = resampled(spoken, PLAYED_HZ).samples
    n = round(duration_s * PLAYED_HZ)
    samples = _SPEECH_LEVEL * np.resize(speech / max(np.abs(speech).max(), 1e-9), n).astype(np.float32)
    first = np.round(np.arange(_CLICK_EVERY_S, duration_s - _TAIL_S, _CLICK_EVERY_S) * PLAYED_HZ).astype(int)
    for at in first:
        samples[at - round(_QUIET_S * PLAYED_HZ) : at + round(_QUIET_S * PLAYED_HZ)] = 0.0
        samples[at : at + round(_CLICK_S * PLAYED_HZ)] = 1.0
    return Audio(samples, PLAYED_HZ), first


def clicks_in(samples: np.ndarray) -> np.ndarray:
    """Return the samples at which clicks begin."""
    loud = np.flatnonzero(np.abs(samples) > _CLICK_LEVEL)
    return loud[np.diff(loud, prepend=-PLAYED_HZ) > PLAYED_HZ / 10]


def bench_live(face: SpeakingFace, spoken: Audio, duration_s: float, progress: Progress = SILENT) -> dict[str, object]:
    """Play, record and animate for ``duration_s``; return the object of ``--json``.

    delay_ms : from the moment at which the player hands a click over to the sound server to that at which the first
        frame that shows it is made; {median, p95, p99, longest, clicks}
    correlation : the delay at which the live motion agrees best with that of the played file, found without clicks
    lost : samples that are missing or too many between neighbouring clicks, and in how many places

    Raises `UserFacingError` where there is no PulseAudio, or nothing is heard.
    """
    played, clicks = speech_with_clicks(duration_s, spoken)
    frames: list[TimedFrame] = []
    failures: list[UserFacingError | None] = []
    session = LiveSession(face, frames.append, failures.append)
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    with null_sink(), tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "played.wav"
        write_wav(played, path)
        session.start(Microphone(), records=True)
        _wait_for_sound(session, failures)
        heard = _play(path, duration_s, progress)
        time.sleep(_TAIL_S)
        session.stop()
    loads = [load, os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")]
    if failures:
        raise failures[0] or UserFacingError("The recording ended before its time.")
    take = session.end_recording()
    return {
        "seconds": duration_s, "load_average": loads, "processors": os.cpu_count(),
        **_delays(heard, clicks, clicks_in(take.audio.samples), frames),
        "correlation": _correlation(face, played, heard, frames),
        "session": session.figures(), "player_underflows": heard["underflows"],
    }  # fmt: skip


def _wait_for_sound(session: LiveSession, failures: list) -> None:
    end_s = time.perf_counter() + 4 * _LEAD_S
    while session.n_frames == 0 and not failures:
        if time.perf_counter() > end_s:
            raise UserFacingError("Nothing is heard from the sound server.")
        time.sleep(0.05)
    time.sleep(_LEAD_S)
    session.waits.clear()  # a sound server hands over what it gathered before the stream began


def _play(path: Path, duration_s: float, progress: Progress) -> dict[str, object]:
    done: list[subprocess.CompletedProcess] = []
    player = threading.Thread(target=lambda: done.append(subprocess.run(
        [sys.executable, "-m", "app.live.bench_player", str(path)], capture_output=True, check=False
    )))  # fmt: skip
    player.start()
    began_s = time.perf_counter()
    while player.is_alive():
        progress.step(min(1.0, (time.perf_counter() - began_s) / duration_s), "playing and listening")
        player.join(0.2)
    with contextlib.suppress(ValueError):
        return json.loads(done[0].stdout)
    raise UserFacingError("The sound cannot be played through the sound server.", "Install libasound2-plugins.")


def matched(heard_s: np.ndarray, handed_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which heard clicks are which played ones, as rows of both; either may lack some, or have strange ones.

    heard_s, handed_s : times by one clock; a click is heard within half a second of being handed over
    """
    played = np.abs(heard_s[:, None] - handed_s).argmin(axis=1)
    wait_s = heard_s - handed_s[played]
    near = np.flatnonzero((wait_s > -_EARLY_S) & (wait_s < _LATE_S))
    first = np.unique(played[near], return_index=True)[1]
    return near[first], played[near[first]]


def _delays(
    heard: dict[str, object], clicks: np.ndarray, found: np.ndarray, frames: list[TimedFrame]
) -> dict[str, object]:
    n, times_s = np.array(heard["handed_over"]).T
    handed_s = times_s[np.searchsorted(n, clicks, side="right") - 1]
    said_s, made_s = np.array([(frame.said_s, frame.made_s) for frame in frames]).T
    rows, played = matched(np.interp(found / PLAYED_HZ * RATE_HZ, np.arange(len(said_s)), said_s), handed_s)
    if len(rows) < 2:
        raise UserFacingError("The clicks that were played were not heard.")
    shown = np.ceil(found[rows] / PLAYED_HZ * RATE_HZ - 1e-9).astype(int)  # the first frame that stands after the click
    inside = shown < len(made_s)
    delays_ms = 1000.0 * (made_s[shown[inside]] - handed_s[played[inside]])
    off = np.diff(found[rows] - clicks[played])
    return {
        "delay_ms": {"median": float(np.median(delays_ms)), "p95": float(np.percentile(delays_ms, 95)),
                     "p99": float(np.percentile(delays_ms, 99)), "longest": float(delays_ms.max()),
                     "clicks": len(delays_ms)},
        "lost": {"clicks_missed": len(clicks) - len(rows), "places": int(np.count_nonzero(np.abs(off) > 1)),
                 "samples_missing": int(-off[off < -1].sum()), "samples_added": int(off[off > 1].sum())},
    }  # fmt: skip


def _correlation(
    face: SpeakingFace, played: Audio, heard: dict[str, object], frames: list[TimedFrame]
) -> dict[str, float]:
    """The delay at which live motion, by the clock, looks most like the motion of the played file."""
    whole = face.motion(speech_features(played), {})
    moved = (whole - whole.mean(axis=0)).reshape(len(whole), -1)
    way = np.linalg.svd(moved[: 60 * RATE_HZ], full_matrices=False)[2][0]  # how the face moves most
    wanted = moved @ way
    n, times_s = np.array(heard["handed_over"]).T
    made_s = np.array([frame.made_s for frame in frames])
    live = np.array([(frame.live.positions - whole.mean(axis=0)).reshape(-1) @ way for frame in frames])
    best = max(
        (_agreement(live, np.interp(made_s - lag_s, times_s, n, np.nan, np.nan) / PLAYED_HZ, wanted), lag_s)
        for lag_s in _LAGS_S
    )
    return {"delay_ms": 1000.0 * float(best[1]), "r": float(best[0])}


def _agreement(live: np.ndarray, at_s: np.ndarray, wanted: np.ndarray) -> float:
    inside = np.isfinite(at_s)
    there = np.interp(at_s[inside], np.arange(len(wanted)) / RATE_HZ, wanted)
    return float(np.corrcoef(live[inside], there)[0, 1])


def as_table(answer: dict[str, object]) -> str:
    """Return the figures in words."""
    delay, waits, lost = answer["delay_ms"], answer["session"]["waits_ms"], answer["lost"]
    lines = [
        f"{answer['seconds']:g} s played, recorded and animated; load average {answer['load_average'][0]:.1f} before, "
        f"{answer['load_average'][1]:.1f} after, on {answer['processors']} processors",
        f"delay, played to face: median {delay['median']:.0f} ms, 95 % {delay['p95']:.0f}, 99 % {delay['p99']:.0f}, "
        f"longest {delay['longest']:.0f} ({delay['clicks']} clicks); by correlation "
        f"{answer['correlation']['delay_ms']:.0f} ms (R {answer['correlation']['r']:.3f})",
        *(f"  {name.replace('_', '-')}: median {part['median']:.1f} ms, 99 % {part['p99']:.1f}, "
          f"longest {part['longest']:.1f}" for name, part in waits.items()),
        f"drop-outs: {lost['places']} ({lost['samples_missing']} samples missing, {lost['samples_added']} added); "
        f"the device told of {answer['session']['overflows']}, the player of {answer['player_underflows']}",
    ]  # fmt: skip
    return "\n".join(lines)
