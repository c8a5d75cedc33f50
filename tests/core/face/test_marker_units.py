import numpy as np
import pytest

from core.face.marker_placement import ACTRESS_FILE, load_marker_file
from core.face.marker_units import MARKER_UNITS_FILE, load_marker_units, marker_units_of, write_marker_units


@pytest.fixture(scope="module")
def units():
    return load_marker_units()


def move(units, unit, marker):
    return units.moves[units.names.index(unit), units.markers.names.index(marker)]


def test_the_bundled_file_is_what_the_default_face_gives(face, units):
    fresh = marker_units_of(face, load_marker_file(ACTRESS_FILE))
    assert fresh.names == units.names
    np.testing.assert_allclose(units.moves, fresh.moves, atol=1e-4)
    np.testing.assert_allclose(units.markers.rest, fresh.markers.rest, atol=1e-3)


def test_it_can_be_made_anew(face, tmp_path, units):
    write_marker_units(face, tmp_path / "units.npz")
    np.testing.assert_array_equal(load_marker_units(tmp_path / "units.npz").moves, units.moves)
    assert list(tmp_path.iterdir()) == [tmp_path / "units.npz"]


def test_it_is_small_and_holds_all_52_units_of_102_markers(units):
    assert MARKER_UNITS_FILE.stat().st_size < 50_000
    assert units.moves.shape == (52, 102, 3)
    assert units.kept.sum() == 90
    assert np.isfinite(units.moves).all()


def test_units_move_what_their_names_say(units):
    assert -45 < move(units, "jawOpen", "lip_lower_mid")[1] < -25
    assert abs(move(units, "jawOpen", "lip_upper_mid")[1]) < 5
    assert move(units, "eyeBlinkLeft", "lid_upper_left")[1] < -6
    assert np.abs(move(units, "eyeBlinkLeft", "lid_upper_right")).max() < 0.5
    assert move(units, "mouthSmileRight", "mouth_corner_right")[1] > 4
    assert move(units, "mouthSmileRight", "mouth_corner_right")[0] < 0
    assert move(units, "jawLeft", "chin_tip")[0] > 4
    assert move(units, "jawForward", "chin_tip")[2] > 4
    assert move(units, "browInnerUp", "brow_inner_left")[1] > 2
    assert move(units, "mouthPucker", "mouth_corner_left")[0] < -3


def test_mouth_close_undoes_the_opening_of_the_lips(units):
    rest = units.markers.rest
    names = units.markers.names
    upper, lower = names.index("lip_upper_mid"), names.index("lip_lower_mid")
    posed = rest + units.moves[units.names.index("jawOpen")] + units.moves[units.names.index("mouthClose")]
    assert posed[upper, 1] - posed[lower, 1] == pytest.approx(rest[upper, 1] - rest[lower, 1], abs=4)


def test_markers_that_were_dropped_are_those_that_hardly_speak(units):
    speaking = np.linalg.norm(units.moves, axis=2).max(axis=0)
    assert speaking[~units.kept].max() < 1.5
