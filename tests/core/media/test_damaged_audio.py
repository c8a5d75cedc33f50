"""Damaged sound files are read, or refused in one sentence; and reading them can be interrupted."""

from __future__ import annotations

import signal
import sys
import threading

import numpy as np
import pytest
import soundfile

from core.media.audio import load_audio

KINDS = {"a.wav": "PCM_16", "f.wav": "FLOAT", "a.flac": "PCM_16", "a.ogg": "VORBIS"}


def finite(path):
    samples = load_audio(path).samples
    assert np.isfinite(samples).all()


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("n", [100, pytest.param(2500, marks=pytest.mark.prove)])
def test_damaged_copies_are_read_or_refused(tmp_path, survives_damage, name, n):
    path = tmp_path / name
    soundfile.write(path, np.random.default_rng(0).normal(size=2000) * 0.1, 16_000, subtype=KINDS[name])
    assert survives_damage(path, finite, n) > n / 4


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no signal to a thread")
def test_a_signal_that_comes_while_a_file_is_read_is_not_swallowed(tmp_path):
    path = tmp_path / "long.flac"
    soundfile.write(path, np.random.default_rng(0).normal(size=16_000 * 120) * 0.1, 16_000)

    class Stop(Exception):
        pass

    def stop(*_):
        raise Stop

    before = signal.signal(signal.SIGUSR1, stop)
    try:
        for delay_s in np.linspace(0.002, 0.05, 8):
            teller = threading.Timer(delay_s, signal.pthread_kill, (threading.main_thread().ident, signal.SIGUSR1))
            teller.start()
            with pytest.raises(Stop):
                while True:
                    load_audio(path)
            teller.join()
    finally:
        signal.signal(signal.SIGUSR1, before)
