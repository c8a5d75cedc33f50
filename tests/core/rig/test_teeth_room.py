import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.face.default_face import character_face
from core.face.face import PARTS, Face
from core.rig.teeth_room import MARGIN_MM, OPEN, with_room_for_teeth


def sheet_with_a_tooth(tooth_mm, jaw_mm):
    """A wall of skin at z = 0 that looks forward, and a triangle of teeth that the jaw moves by ``jaw_mm``."""
    positions = np.array([[-50, -50, 0], [50, -50, 0], [0, 80, 0], [-1, 0, tooth_mm], [1, 0, tooth_mm],
                          [0, 1, tooth_mm]], np.float32)  # fmt: skip
    part = np.array([PARTS.index("skin")] * 3 + [PARTS.index("lower_teeth")] * 3, np.uint8)
    jaw = np.zeros((6, 3), np.float32)
    jaw[3:, 2] = jaw_mm
    return Face("wall", positions, np.array([[0, 1, 2], [3, 4, 5]], np.int32), part, units={"jawOpen": jaw})


def test_a_tooth_that_would_come_through_stays_a_margin_behind_at_every_opening():
    face = with_room_for_teeth(sheet_with_a_tooth(-3.0, 8.0))
    for share in OPEN:
        assert (face.positions + share * face.units["jawOpen"])[3:, 2].max() <= -MARGIN_MM + 1e-4
    assert (face.units["jawOpen"][:3] == 0).all()


@pytest.mark.parametrize(("tooth_mm", "jaw_mm"), [(-3.0, 1.0), (-10.0, 0.0), (-40.0, 5.0), (30.0, 5.0)])
def test_teeth_with_room_stay_as_they_are(tooth_mm, jaw_mm):
    """The last stand in front of everything, as in an open mouth before the back of the head."""
    face = sheet_with_a_tooth(tooth_mm, jaw_mm)
    assert with_room_for_teeth(face) is face


@pytest.mark.parametrize("name", CHARACTERS)
def test_of_our_characters_only_pip_needs_it(name):
    try:
        face = character_face(name, download=False)
    except UserFacingError as error:
        pytest.skip(f"needs the faces: {error}")
    assert (with_room_for_teeth(face) is face) == (name != "pip")
