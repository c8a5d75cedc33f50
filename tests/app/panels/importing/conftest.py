"""The assistant's window by itself, captures small enough to wait for, and the ways of a hand."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog

WAIT_MS = 60_000
TAKES = ("Jaw", "Eyebrows")
N_FRAMES = 700
CLIPS = ("bwbn3s", "lbay1a", "lwafzp", "praj3a")


@pytest.fixture
def click():
    """Return a function that clicks a widget, in its middle or where it is told."""

    def at(widget, place=None, button=Qt.MouseButton.LeftButton):
        place = widget.rect().center() if place is None else QPoint(round(place.x()), round(place.y()))
        QTest.mouseClick(widget, button, pos=place)

    return at


@pytest.fixture
def settled(qtbot):
    """Return a function that waits until an assistant has nothing left to do."""

    def wait(assistant):
        qtbot.waitUntil(lambda: assistant.jobs.is_idle, timeout=WAIT_MS)

    return wait


@pytest.fixture
def assistant(qtbot, qapp, settings_folder):
    """An import assistant without a main window behind it."""
    from app.authoring import Authoring
    from app.panels.importing.window import ImportWindow
    from app.theme import apply_theme

    apply_theme(qapp)
    authoring = Authoring(None)
    window = ImportWindow(authoring)
    with qtbot.waitExposed(window):
        window.show()
    with qtbot.waitActive(window):
        window.activateWindow()
    yield window
    window.shut_down()
    authoring.shut_down()
    window.deleteLater()
    qapp.processEvents()


@pytest.fixture
def give_folder(monkeypatch, click, settled):
    """Return a function that adds a folder by the button, and waits until it is read."""

    def give(assistant, folder):
        monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_, **__: str(folder))
        click(assistant.files.add_folder)
        settled(assistant)

    return give


@pytest.fixture
def go(settled):
    """Return a function that goes to a page by its key, and waits until it has what it needs."""

    def to(assistant, page):
        number = assistant.pages.index(page)
        QTest.keyClick(assistant, Qt.Key(Qt.Key.Key_1 + number), Qt.KeyboardModifier.AltModifier)
        assert page.isVisible()
        settled(assistant)

    return to


@pytest.fixture
def grid_examples(shared_data, tmp_path):
    """A few GRID sentences as C3D, FLAC and TextGrid."""
    folder = tmp_path / "grid"
    folder.mkdir()
    for clip in CLIPS:
        for path in (shared_data("grid-s1") / "examples").glob(f"{clip}.*"):
            shutil.copy(path, folder)
    return folder


@pytest.fixture
def grid_tracks(shared_data, tmp_path):
    """A few GRID sentences as they lie in the whole set: points of video, sound, TextGrids."""
    source, folder = shared_data("grid-s1"), tmp_path / "tracks"
    for part in ("audio", "textgrid"):
        (folder / part).mkdir(parents=True)
    with np.load(source / "tracks.npz", allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    rows = [int(np.flatnonzero(arrays["clips"] == clip)[0]) for clip in CLIPS]
    pieces = [arrays["xyz64"][arrays["start"][r] : arrays["start"][r + 1]] for r in rows]
    arrays |= {"xyz64": np.concatenate(pieces), "start": np.cumsum([0, *map(len, pieces)]),
               "clips": arrays["clips"][rows]}  # fmt: skip
    np.savez(folder / "tracks.npz", **arrays)
    for clip in CLIPS:
        shutil.copy(source / "audio" / f"{clip}.flac", folder / "audio")
        shutil.copy(source / "textgrid" / f"{clip}.TextGrid", folder / "textgrid")
    return folder


@pytest.fixture
def mocap(shared_data, tmp_path):
    """Two takes of animface-mocap, cut short, with two gaps, a spike and a swap put into the first one.

    Returns (folder, {take: whole positions}, marker names).
    """
    from core.motion.motion_files import read_motion, write_c3d

    folder = tmp_path / "mocap"
    folder.mkdir()
    whole = {}
    for take in TAKES:
        positions, names, rate_hz = read_motion(shared_data("animface-mocap") / f"{take}.c3d")
        whole[take] = positions[:N_FRAMES].copy()
        planted = whole[take].copy()
        if take == "Jaw":
            planted[200:212, names.index("Chin")] = np.nan  # 0.2 s
            planted[300:360, names.index("Rcheek_Up")] = np.nan  # 1 s, too long
            planted[450, names.index("Mouth_Up")] += (0.0, 15.0, 0.0)
            i, j = names.index("Mouth_UpL1"), names.index("Mouth_Lend")
            planted[500:508, [i, j]] = planted[500:508, [j, i]]
        write_c3d(folder / f"{take}.c3d", planted, names, rate_hz)
    return folder, whole, names
