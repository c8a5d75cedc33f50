"""The bent sheet, for the tests of tracking."""

import numpy as np
import pytest

from core.iface.motion_unit import MotionUnits
from core.tracking.face_model import FaceModel
from tests.core.tracking.bent_sheet import bent_markers, clicks_on, film_of, sheet_markers, speaking_sheet


@pytest.fixture(scope="session")
def model():
    """Units learned from other motion than any that is tracked."""
    units = MotionUnits.fit({"neutral": bent_markers(np.random.default_rng(3).normal(size=(200, 3)) * 3.0)}, 0.9999)
    return FaceModel.of(sheet_markers(), units)


@pytest.fixture(scope="session")
def sheet():
    """Return a function that makes a sheet, see `speaking_sheet`."""
    return speaking_sheet


@pytest.fixture(scope="session")
def film():
    """Return a function that writes a sheet to a file."""
    return film_of


@pytest.fixture(scope="session")
def clicks(model):
    """Where mouth and eye corners are in the first picture of any sheet."""
    return clicks_on(model)
