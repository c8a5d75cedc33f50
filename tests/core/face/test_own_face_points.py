import json

import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.own_face_points import PointFile, feature_points, generic_points, load_points, save_points


def test_what_is_saved_is_read_again(tmp_path):
    path = tmp_path / "points.json"
    file = PointFile(
        {"chin": np.array([1.5, -2, 1e-3])}, {"nose_tip": 12}, {"chin": np.array([0.0, -80, 20])},
        {"nose_tip": np.array([320.5, 200])},
    )  # fmt: skip
    save_points(path, file)
    back = load_points(path)
    np.testing.assert_allclose(back.points["chin"], [1.5, -2, 1e-3])
    assert back.vertices == {"nose_tip": 12}
    np.testing.assert_allclose(back.moved["chin"], [0, -80, 20])
    np.testing.assert_allclose(back.photo["nose_tip"], [320.5, 200])
    places = back.on(np.arange(60.0).reshape(20, 3), "head.obj")
    np.testing.assert_allclose(places["nose_tip"], [36, 37, 38])


def test_a_vertex_beyond_the_scan_is_refused():
    with pytest.raises(UserFacingError, match=r"nose_tip is on vertex 12, but head\.obj has only 10"):
        PointFile(vertices={"nose_tip": 12}).on(np.zeros((10, 3)), "head.obj")


GOOD = {"format": "efase-face-points", "version": 1}


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ([], "holds no feature points"),
        ({"format": "other"}, "holds no feature points"),
        ({**GOOD, "version": 9}, "another version"),
        ({**GOOD, "points": []}, "'points' is not a table"),
        ({**GOOD, "points": {"knee": [0, 0, 0]}}, "no feature point 'knee'"),
        ({**GOOD, "points": {"chin": [0, 0]}}, "chin needs 3 finite numbers"),
        ({**GOOD, "points": {"chin": [0, 0, None]}}, "chin needs 3 finite numbers"),
        ({**GOOD, "points": {"chin": [0, 0, float("nan")]}}, "chin needs 3 finite numbers"),
        ({**GOOD, "points": {"chin": [0, 0, float("inf")]}}, "chin needs 3 finite numbers"),
        ({**GOOD, "points": {"chin": True}}, "chin needs 3 finite numbers"),
        ({**GOOD, "points": {"chin": -4}}, "chin needs 3 finite numbers"),
        ({**GOOD, "photo": {"chin": [1, 2, 3]}}, "chin needs 2 finite numbers"),
    ],
)
def test_a_file_that_holds_no_points_is_one_sentence(tmp_path, document, message):
    path = tmp_path / "points.json"
    path.write_text(json.dumps(document))
    with pytest.raises(UserFacingError, match=message) as caught:
        load_points(path)
    assert path.name in caught.value.message


def test_files_that_are_no_json_or_not_there(tmp_path):
    path = tmp_path / "points.json"
    with pytest.raises(UserFacingError, match="cannot be read"):
        load_points(path)
    for raw in (b"", b"\xff\xfe\x00", b"[" * 100_000):
        path.write_bytes(raw)
        with pytest.raises(UserFacingError, match="not a JSON file"):
            load_points(path)


def test_damaged_files_are_refused_by_name(tmp_path, survives_damage):
    path = tmp_path / "points.json"
    save_points(path, PointFile({point.key: np.ones(3) for point in feature_points()}))
    assert survives_damage(path, load_points, 120) > 20


def test_points_lie_on_the_generic_face_mirrored_and_where_they_were_moved(face):
    places = generic_points(face, {"chin": np.array([1.0, 2, 3])})
    np.testing.assert_array_equal(places["chin"], [1, 2, 3])
    for key, place in places.items():
        if key.endswith("_left"):
            np.testing.assert_allclose(places[key.replace("_left", "_right")], place * [-1, 1, 1], atol=0.1)
            assert place[0] > 0
