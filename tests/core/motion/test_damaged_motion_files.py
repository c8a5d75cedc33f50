"""Damaged marker files and tables are read, or refused in one sentence."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.marker_table import read_marker_table
from core.motion.motion_files import read_motion, write_c3d, write_markers_csv

TABLE = "marker,kept,groups,landmark\nnose_bridge,1,origin;rigid,nose_bridge\nlip,1,lower_lip;lips,lower_lip\near,0,,\n"


def written(folder, kind):
    positions = np.random.default_rng(0).normal(size=(6, 3, 3)) * 30
    path = folder / {"c3d": "m.c3d", "csv": "m.csv", "table": "markers.csv"}[kind]
    if kind == "table":
        path.write_text(TABLE)
    else:
        {"c3d": write_c3d, "csv": write_markers_csv}[kind](path, positions, ("a", "b", "c"), 60.0)
    return path


def finite_or_missing(path):
    positions, names, rate_hz = read_motion(path)
    assert positions.shape[1:] == (len(names), 3)
    assert not np.isinf(positions).any() and np.isfinite(rate_hz) and rate_hz > 0


READ = {"c3d": finite_or_missing, "csv": finite_or_missing, "table": read_marker_table}


@pytest.mark.parametrize("kind", READ)
@pytest.mark.parametrize("n", [150, pytest.param(5000, marks=pytest.mark.prove)])
def test_damaged_copies_are_read_or_refused(tmp_path, survives_damage, kind, n):
    assert survives_damage(written(tmp_path, kind), READ[kind], n) > n / 3


def test_a_table_that_is_no_table_is_refused(tmp_path):
    path = tmp_path / "markers.csv"
    for text in ("", "marker\n", f"marker\n{'x' * 200_000}\n"):
        path.write_text(text)
        with pytest.raises(UserFacingError, match=r"markers\.csv"):
            read_marker_table(path)
    with pytest.raises(UserFacingError, match="is not a file"):
        read_marker_table(tmp_path)
