from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face.binding import bind, carry_over
from core.face.face import Face
from core.face.geodesic import surface_distances
from core.face.marker_placement import ACTRESS_FILE, MARKERS, MarkerPlacement, load_marker_file, marker_set_on
from core.face.similarity import fit_similarity
from core.motion.marker_set import MarkerSet
from core.motion.marker_table import read_marker_table

TRACKS = Path(__file__).resolve().parents[3] / "../shared/data/grid-s1/tracks.npz"


def test_a_similarity_is_found_again():
    rng = np.random.default_rng(0)
    source = rng.normal(0, 30, (12, 3))
    rotation = Rotation.from_euler("xyz", [20, -35, 70], degrees=True).as_matrix()
    found = fit_similarity(source, 1.7 * source @ rotation.T + [4, -5, 6])
    assert found.scale == pytest.approx(1.7)
    np.testing.assert_allclose(found.rotation, rotation, atol=1e-9)
    np.testing.assert_allclose(found.shift, [4, -5, 6], atol=1e-9)


def test_a_mirror_image_is_not_taken_for_a_turn():
    source = np.random.default_rng(1).normal(0, 30, (12, 3))
    found = fit_similarity(source, source * [-1, 1, 1])
    assert np.linalg.det(found.rotation) == pytest.approx(1)


def test_the_actress_sits_where_her_table_says(face, actress):
    marker_set, vertices = actress
    np.testing.assert_array_equal(bind(face, marker_set), vertices)


def test_an_actress_of_another_size_and_pose_finds_nearly_her_own_vertices(face, actress):
    marker_set, vertices = actress
    turn = Rotation.from_euler("y", 25, degrees=True).as_matrix()
    away = MarkerSet(marker_set.names, 0.8 * marker_set.rest @ turn.T, marker_set.groups, marker_set.landmarks)
    found = bind(Face(**{**vars(face), "name": "no table"}), away)
    gap = np.linalg.norm(face.positions[found] - face.positions[vertices], axis=1)
    assert np.median(gap) < 1.0
    assert gap.max() < 6.0


def test_all_markers_get_skin_vertices_of_their_own(face):
    rng = np.random.default_rng(2)
    table = load_marker_file(ACTRESS_FILE)
    base = marker_set_on(face, table)
    # pairs of markers at nearly one place
    names = base.names + tuple(f"{name}_twin" for name in base.names)
    rest = np.concatenate([base.rest, base.rest + rng.normal(0, 0.1, base.rest.shape)])
    found = bind(face, MarkerSet(names, rest, base.groups, base.landmarks))
    assert len(set(found.tolist())) == len(names)
    assert (face.part[found] == 0).all()


def test_lip_markers_keep_to_their_own_lip_even_if_they_rest_on_the_other(face, actress):
    marker_set, _ = actress
    rest = marker_set.rest.copy()
    rest[marker_set.group("lower_lip"), 1] += 5.0
    pressed = MarkerSet(marker_set.names, rest, marker_set.groups, marker_set.landmarks)
    found = bind(Face(**{**vars(face), "name": "no table"}), pressed)
    triangles = face.triangles[(face.part == 0)[face.triangles].all(axis=1)]
    lips = np.array([face.landmarks["upper_lip"], face.landmarks["lower_lip"]])
    upper, lower = surface_distances(face.positions, triangles, lips)
    on_lower = found[marker_set.group("lower_lip")]
    on_upper = found[marker_set.group("upper_lip")]
    assert (lower[on_lower] <= upper[on_lower]).all()
    assert (upper[on_upper] <= lower[on_upper]).all()


def test_the_users_file_wins(face, actress):
    marker_set, vertices = actress
    wanted = int(face.landmarks["chin"]) + 1
    own = MarkerPlacement(("chin_mid",), np.array([wanted]), np.array([True]))
    found = bind(face, marker_set, own)
    assert found[marker_set.names.index("chin_mid")] == wanted
    assert len(set(found.tolist())) == len(found)
    others = np.arange(len(found)) != marker_set.names.index("chin_mid")
    gap = np.linalg.norm(face.positions[found] - face.positions[vertices], axis=1)[others]
    assert np.median(gap) < 1.0


def test_a_file_for_another_face_is_refused(face, actress):
    beyond = MarkerPlacement(("chin_mid",), np.array([10**7]), np.array([True]))
    with pytest.raises(UserFacingError, match="Marker chin_mid sits on vertex 10000000"):
        bind(face, actress[0], beyond)


def test_too_few_known_points_are_said(face, actress):
    marker_set, _ = actress
    bare = Face("bare.obj", face.positions, face.triangles, face.part)
    with pytest.raises(UserFacingError, match=r"bare\.obj and the markers share only 0 known points"):
        bind(bare, marker_set)
    few = Face("few.obj", face.positions, face.triangles, face.part, landmarks={"chin": face.landmarks["chin"]})
    with pytest.raises(UserFacingError, match="only 1"):
        bind(few, marker_set)


@pytest.fixture(scope="module")
def tracked():
    """The mean face of the GRID talker as a marker set, y up and z forward, eyes 90 mm apart."""
    if not TRACKS.exists():
        pytest.skip(f"needs the GRID tracks at {TRACKS}")
    with open(TRACKS, "rb") as file, np.load(file) as data:
        points, start, numbers = data["xyz64"], data["start"], data["landmark_index"]
    table = read_marker_table(MARKERS / "mediapipe-148.csv")
    names = [f"MP{number:03d}" for number in numbers]
    rigid = [names.index(name) for name in table.groups["rigid"]]
    frames = points[start[:-1:8] + 1] / 64.0 * [1, -1, -1]
    reference = frames[0] - frames[0].mean(axis=0)
    fitted = []
    for frame in frames:
        fitted.append(fit_similarity(frame[rigid], reference[rigid])(frame))
    mean = np.mean(fitted, axis=0)
    eyes = np.linalg.norm(mean[names.index("MP033")] - mean[names.index("MP263")])
    rest = (mean - mean[names.index("MP168")]) * 90.0 / eyes
    return MarkerSet(tuple(names), rest, table.groups, table.landmarks)


def test_148_tracked_points_find_their_places(face, tracked):
    found = bind(face, tracked)
    assert len(set(found.tolist())) == 148
    at = dict(zip(tracked.names, face.positions[found]))
    assert np.linalg.norm(face.positions[found] - carry_over(face, tracked), axis=1).max() < 8
    for landmark in ("mouth_corner_left", "mouth_corner_right", "outer_eye_left", "nose_tip", "upper_lid_right"):
        name = tracked.landmarks[landmark]
        assert np.linalg.norm(at[name] - face.positions[face.landmarks[landmark]]) < 4, landmark
    # lids: above and below each eyeball's middle, in front of it
    for upper, lower in (("MP159", "MP145"), ("MP386", "MP374"), ("MP158", "MP153"), ("MP385", "MP380")):
        assert at[upper][1] > at[lower][1] + 5
        assert min(at[upper][2], at[lower][2]) > 10
    # lips: the inner points of both lips lie within 4 mm of where the lips touch, on either side of it
    for upper, lower in (("MP013", "MP014"), ("MP082", "MP087"), ("MP312", "MP317")):
        assert -0.5 < at[upper][1] - at[lower][1] < 4
    assert at["MP000"][1] > at["MP013"][1] + 2
    assert at["MP017"][1] < at["MP014"][1] - 4


def test_the_mediapipe_table_names_each_point_once_and_every_landmark():
    table = read_marker_table(MARKERS / "mediapipe-148.csv")
    assert len(table.kept) == 148
    assert len(table.landmarks) == 17
    assert len(table.groups["rigid"]) == 20
    assert table.groups["origin"] == ("MP168",)
    assert len(table.groups["lips"]) == 40
