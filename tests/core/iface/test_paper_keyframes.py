import numpy as np
import pytest

from core.actress.corpus import actress_marker_set
from core.errors import UserFacingError
from core.face.marker_units import load_marker_units
from core.iface.keyframes import PAPER_KEYFRAMES
from core.iface.paper_keyframes import captured_keyframes, drawn_units, paper_keyframes
from core.speech.emotion import EMOTIONS
from core.speech.phoneme import PHONEMES


def drawn(name):
    """How the actress's markers move for a keyframe, mm; needs no face."""
    units = load_marker_units()
    moved = np.tensordot(drawn_units(units.names)[list(paper_keyframes()).index(name)], units.moves, axes=1)[units.kept]
    markers = actress_marker_set()
    return {landmark: moved[markers.landmark(landmark)] for landmark in markers.landmarks}


def test_they_are_the_papers_eight_and_name_what_there_is():
    assert set(paper_keyframes()) == set(PAPER_KEYFRAMES)
    names = load_marker_units().names
    for keyframe in paper_keyframes().values():
        assert (keyframe.emotion in EMOTIONS) != (keyframe.phone in PHONEMES)
        assert set(keyframe.units) <= set(names)
        assert all(0.0 < value <= 1.0 for value in keyframe.units.values())


def test_what_is_drawn_looks_as_its_name_says():
    def width(name):
        return drawn(name)["mouth_corner_left"][0] - drawn(name)["mouth_corner_right"][0]

    def gap(name):
        return drawn(name)["upper_lip"][1] - drawn(name)["lower_lip"][1]

    assert drawn("smile")["mouth_corner_left"][1] > 3 > -2 > drawn("sad")["mouth_corner_left"][1]
    assert gap("a") > gap("o") > gap("i") > 1 > gap("m")
    assert width("smile") > width("i") > width("m") > width("o") > width("u")
    assert drawn("u")["upper_lip"][2] > 2
    np.testing.assert_allclose(drawn("smile")["chin"], 0, atol=1.5)


def test_what_is_captured_goes_the_way_of_its_frames(talking_database):
    database = talking_database(emotions=("neutral", "happiness"), n_sentences=12, blink_every_s=1e9)
    keyframes, missing = captured_keyframes(database)
    assert keyframes.names == ("smile", "a", "i") and missing == ()
    coefficients = {
        name: database.pca.coefficients(shape) - database.rest_coefficients
        for name, shape in zip(keyframes.names, keyframes.shapes)
    }
    # happiness lifts the second coefficient by 2, and lips rest in silence
    smile = coefficients["smile"]
    assert smile[1] == pytest.approx(2.0, abs=0.3)
    np.testing.assert_allclose(np.delete(smile, 1), 0.0, atol=0.2)
    nodes = database.nodes
    for name, phone in (("a", "aa"), ("i", "iy")):
        of_phone = (nodes.phoneme == PHONEMES.index(phone)) & (nodes.emotion == 0)
        frames = database.frames[((nodes.start + nodes.stop - 1) // 2)[of_phone]]
        towards = frames.mean(axis=0) / np.linalg.norm(frames.mean(axis=0))
        assert coefficients[name] @ towards >= frames.mean(axis=0) @ towards
        assert coefficients[name] @ towards <= (frames @ towards).max() + 1e-6


def test_nothing_captured_and_nothing_to_draw_with_is_told(talking_database):
    with pytest.raises(UserFacingError, match="'talk' shows none"):
        captured_keyframes(talking_database(emotions=("anger",)))
