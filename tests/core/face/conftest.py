"""The default face, fetched by set-up; tests that need it are skipped where it cannot be had."""

import pytest

from core.face.default_face import FaceUnavailable, default_face
from core.face.marker_placement import ACTRESS_FILE, load_marker_file, marker_set_on
from core.face.skinning import MarkerSkin


@pytest.fixture(scope="session")
def face():
    try:
        return default_face()
    except FaceUnavailable as error:
        pytest.skip(f"needs the default face: {error}")


@pytest.fixture(scope="session")
def actress(face):
    """The 90 markers in use on the default face, and their vertices."""
    placement = load_marker_file(ACTRESS_FILE)
    return marker_set_on(face, placement), placement.vertices[placement.kept]


@pytest.fixture(scope="session")
def skin(face, actress):
    marker_set, vertices = actress
    return MarkerSkin.fit(face, vertices, marker_set)
