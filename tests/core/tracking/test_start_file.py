"""What a hand said of a video comes back as it was, or is refused in one sentence."""

import json

import pytest

from core.errors import UserFacingError
from core.tracking.start_file import TrackingStart, read_start, write_start

START = TrackingStart(
    {"mouth_corner_right": (10.5, 20.25), "mouth_corner_left": (60.0, 21.0)},
    {0: {"chin": (30.0, 70.0)}, 117: {"chin": (31.5, 72.125), "lip": (1.0, 2.0)}}, "happiness",
)  # fmt: skip


def test_it_comes_back(tmp_path):
    write_start(START, tmp_path / "start.json")
    assert read_start(tmp_path / "start.json") == START


@pytest.mark.parametrize(
    ("change", "why"),
    [({"format": "other"}, "does not hold"), ({"clicks": {"elbow": [1, 2]}}, "no point of a face"),
     ({"clicks": {"chin": [1]}}, "pair of pixels"), ({"clicks": {"chin": [1, float("nan")]}}, "pair of pixels"),
     ({"clicks": {"chin": [1, 10**4000]}}, "pair of pixels"), ({"clicks": {"chin": [-1e300, 1]}}, "pair of pixels"),
     ({"clicks": []}, "lacks clicks"), ({"corrections": {"-1": {}}}, "not frames"),
     ({"corrections": {"3": {"chin": "x"}}}, "pair of pixels"), ({"expression": 3}, "not a name")],
)  # fmt: skip
def test_what_it_cannot_be_is_refused(tmp_path, change, why):
    write_start(START, tmp_path / "start.json")
    data = json.loads((tmp_path / "start.json").read_text()) | change
    (tmp_path / "start.json").write_text(json.dumps(data))
    with pytest.raises(UserFacingError, match=why) as refused:
        read_start(tmp_path / "start.json")
    assert "start.json" in str(refused.value)


def test_damage_is_refused(tmp_path, survives_damage):
    write_start(START, tmp_path / "start.json")
    assert survives_damage(tmp_path / "start.json", read_start, 150) > 50
