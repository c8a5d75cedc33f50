"""The second face is seen as lines over the first."""

from __future__ import annotations

import numpy as np
import pytest

from app.panels.compare.faces import OverlaidView
from app.panels.compare.pens import PAINT
from app.panels.poses.posing import PosedFace
from gpu.gl.face import Style
from gpu.gl.face_arrays import FaceArrays
from tests.core.rig.small_rigs import small_rig

WAIT_MS = 20_000


@pytest.fixture
def view(qtbot, qapp, settings_folder):
    view = OverlaidView()
    view.resize(300, 300)
    view.set_rig(PosedFace(rig := small_rig(), FaceArrays.of(rig.face)))
    view.set_style(Style.SHADED)
    view.n_controls = len(rig.names)
    with qtbot.waitExposed(view):
        view.show()
    yield view
    view.release()
    view.deleteLater()
    qapp.processEvents()


def lines(view) -> np.ndarray:
    """Where the picture has the colour of B, shape (height, width)."""
    picture = view.grabFramebuffer()
    seen = np.frombuffer(picture.constBits(), np.uint8).reshape(picture.height(), -1, 4)[:, :, 2::-1].astype(int)
    lean = seen - seen.mean(axis=2, keepdims=True)
    colour = np.array(PAINT["other"]) - np.mean(PAINT["other"])
    return lean @ (colour / np.linalg.norm(colour)) > 30


def test_the_lines_are_where_b_is_whatever_a_does(view, qtbot):
    rest, moved = np.zeros(view.n_controls), np.ones(view.n_controls)
    view.show_both(rest, rest, {})
    qtbot.waitUntil(lambda: lines(view).sum() > 100, timeout=WAIT_MS)
    at_rest = lines(view)
    view.show_both(rest, moved, {})
    over_rest = lines(view)
    assert (over_rest != at_rest).mean() > 0.005
    view.show_both(moved, moved, {})
    over_moved = lines(view)
    assert (over_moved != over_rest).mean() < 0.3 * (over_rest != at_rest).mean()
