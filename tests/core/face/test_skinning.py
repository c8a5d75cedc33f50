import time

import numpy as np
import pytest

from core.face.face import Face
from core.face.geodesic import surface_distances
from core.face.marker_units import load_marker_units
from core.face.skinning import MarkerSkin, scale_to
from core.motion.marker_set import MarkerSet


def moved_alone(actress, skin, name, by):
    marker_set, _ = actress
    displacement = np.zeros((len(marker_set), 3))
    displacement[marker_set.indices([name])] = by
    return skin.deform(displacement)


def unit_motion(actress, face, unit):
    return face.units[unit][actress[1]]


def length(moved):
    return np.linalg.norm(moved, axis=-1)


def test_the_lower_lip_marker_moves_the_lower_lip_and_not_the_upper(face, actress, skin):
    marker_set, vertices = actress
    at = dict(zip(marker_set.names, vertices))
    moved = moved_alone(actress, skin, "lip_lower_mid", [0, -5, 0])
    assert moved[at["lip_lower_mid"], 1] == pytest.approx(-5, abs=0.5)
    # the rim where the lips touch, by its own measure: nearer along the surface to one lip's marker than the other's
    triangles = face.triangles[(face.part == 0)[face.triangles].all(axis=1)]
    lips = np.array([at["lip_upper_mid"], at["lip_lower_mid"]])
    upper, lower = surface_distances(face.positions, triangles, lips)
    middle = np.abs(face.positions[:, 0]) < 6
    assert length(moved)[(upper < 10) & middle].max() < 0.3
    assert length(moved)[(lower < 4) & middle].min() > 2


def test_the_upper_lid_marker_leaves_the_lower_lid(face, actress, skin):
    marker_set, vertices = actress
    at = dict(zip(marker_set.names, vertices))
    moved = moved_alone(actress, skin, "lid_upper_left", [0, -6, 0])
    assert moved[at["lid_upper_left"], 1] == pytest.approx(-6, abs=0.5)
    assert abs(moved[at["lid_lower_left"], 1]) < 0.2
    lashes = face.vertices_of("lashes_upper_left")
    roots = np.abs(face.positions[lashes, 0] - face.positions[at["lid_upper_left"], 0]) < 3
    assert moved[lashes[roots], 1].max() < -3
    assert length(moved)[face.vertices_of("lashes_upper_right")].max() < 0.01
    assert length(moved)[face.vertices_of("lashes_lower_left")].max() < 1.5


@pytest.mark.parametrize("unit", ["jawOpen", "mouthFunnel", "mouthSmileLeft", "eyeBlinkRight", "browInnerUp"])
def test_every_marker_takes_its_own_vertex_along(face, actress, skin, unit):
    wanted = unit_motion(actress, face, unit)
    found = skin.deform(wanted)[actress[1]]
    assert length(found - wanted).max() < 0.1 * length(wanted).max() + 0.05


@pytest.mark.parametrize(
    ("unit", "rms_mm"), [("jawOpen", 2.0), ("mouthPucker", 0.7), ("mouthSmileLeft", 0.9), ("browDownLeft", 0.4)]
)
def test_from_90_markers_the_sculpted_shape_comes_back(face, actress, skin, unit, rms_mm):
    # the sculptor's own displacement of all vertices is an answer that the markers' weights know nothing of
    moved = face.vertices_of("skin")[length(face.units[unit])[face.vertices_of("skin")] > 0.5]
    error = length(skin.deform(unit_motion(actress, face, unit)) - face.units[unit])[face.vertices_of("skin")]
    assert np.sqrt(np.mean(error**2)) < rms_mm
    still = np.sqrt(np.mean(length(face.units[unit])[moved] ** 2))
    error_there = length(skin.deform(unit_motion(actress, face, unit)) - face.units[unit])[moved]
    assert np.sqrt(np.mean(error_there**2)) < 0.5 * still


def test_lower_teeth_go_with_the_jaw_and_stay_rigid_while_upper_teeth_and_eyes_keep_still(face, actress, skin):
    moved = skin.deform(unit_motion(actress, face, "jawOpen"))
    teeth = face.vertices_of("lower_teeth")
    sculpted = face.units["jawOpen"][teeth]
    assert length(moved[teeth] - sculpted).max() < 0.2 * length(sculpted).max()
    rest = face.positions[teeth].astype(float)
    posed = rest + moved[teeth]
    np.testing.assert_allclose(length(posed[:, None] - posed[None]), length(rest[:, None] - rest[None]), atol=1e-3)
    for part in ("upper_teeth", "eye_left", "eye_right"):
        assert length(moved)[face.vertices_of(part)].max() == 0
    tongue = face.vertices_of("tongue")
    tip = tongue[face.positions[tongue, 2] > np.quantile(face.positions[tongue, 2], 0.8)]
    sculpted = face.units["jawOpen"][tip]
    assert length(moved[tip] - sculpted).max() < 0.25 * length(sculpted).max()


def test_the_mouth_socket_opens_with_the_jaw_below_and_keeps_still_above(face, actress, skin):
    moved = skin.deform(unit_motion(actress, face, "jawOpen"))
    socket = face.vertices_of("mouth_socket")
    y = face.positions[socket, 1]
    floor, roof = socket[y < np.quantile(y, 0.15)], socket[y > np.quantile(y, 0.85)]
    assert moved[floor, 1].mean() < -8
    assert length(moved)[roof].max() < 3


def test_the_back_of_the_head_and_the_shoulders_keep_still(face, actress, skin):
    moved = length(skin.deform(np.full((len(actress[0]), 3), 10.0)))
    far = (face.positions[:, 1] < -170) | (face.positions[:, 2] < -120)
    assert moved[far & (face.part == 0)].max() == 0


def test_neighbouring_vertices_move_alike(face, actress, skin):
    # no creases: the change along an edge stays in proportion to the edge, as in the sculpted shape
    moved = skin.deform(unit_motion(actress, face, "jawOpen"))
    triangles = face.triangles[(face.part == 0)[face.triangles].all(axis=1)]
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
    size = length(face.positions[edges[:, 0]] - face.positions[edges[:, 1]])
    long_enough = size > 1.5

    def steepest(field):
        slope = length(field[edges[:, 0]] - field[edges[:, 1]])[long_enough] / size[long_enough]
        return np.quantile(slope, 0.99)

    assert steepest(moved) < 1.5 * steepest(face.units["jawOpen"])


@pytest.mark.parametrize("count", [41, 148, 300])
def test_any_number_of_markers_covers_the_face(face, count):
    front = np.flatnonzero(
        (face.part == 0) & (face.positions[:, 2] > -10) & (face.positions[:, 1] > -95) & (face.positions[:, 1] < 60)
    )
    chosen = farthest_first(face, front, count)
    marker_set = MarkerSet(tuple(f"m{k}" for k in range(count)), face.positions[chosen].astype(float))
    moved = MarkerSkin.fit(face, chosen, marker_set).deform(np.tile([0.0, 3.0, 0.0], (count, 1)))
    inner = front[(face.positions[front, 2] > 5) & (np.abs(face.positions[front, 0]) < 40)]
    assert np.quantile(moved[inner, 1], 0.02) > 2.2
    assert moved[:, 1].max() < 4.0


def farthest_first(face, among, count):
    positions = face.positions[among].astype(float)
    chosen = [0]
    gap = length(positions - positions[0])
    while len(chosen) < count:
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, length(positions - positions[chosen[-1]]))
    return among[chosen]


def test_many_frames_at_once_equal_one_by_one(actress, skin):
    frames = np.random.default_rng(0).normal(0, 3, (7, len(actress[0]), 3))
    together = skin.deform_many(frames)
    assert together.dtype == np.float32
    for one, frame in zip(together, frames):
        np.testing.assert_allclose(one, skin.deform(frame), atol=1e-4)


def test_rest_stays_rest(actress, skin):
    assert np.abs(skin.deform(np.zeros((len(actress[0]), 3)))).max() == 0


def test_skin_motion_adds_up(face, actress, skin):
    a, b = np.random.default_rng(3).normal(0, 2, (2, len(actress[0]), 3))
    surface = face.vertices_of("skin")
    both = skin.deform(a + b)[surface]
    np.testing.assert_allclose(both, (skin.deform(a) + skin.deform(b))[surface], atol=1e-3)


def test_a_larger_actor_moves_the_face_no_more(face, actress):
    marker_set, vertices = actress
    giant = MarkerSet(marker_set.names, marker_set.rest * 2.5, marker_set.groups, marker_set.landmarks)
    unknown = MarkerSet(marker_set.names, marker_set.rest * 2.5, marker_set.groups)
    assert scale_to(face, vertices, marker_set) == pytest.approx(1, rel=1e-6)
    assert scale_to(face, vertices, giant) == pytest.approx(0.4, rel=1e-6)
    assert scale_to(face, vertices, unknown) == pytest.approx(0.4, rel=1e-6)


def test_a_face_without_a_jaw_group_or_landmarks_still_deforms(face, actress):
    marker_set, vertices = actress
    bare_set = MarkerSet(marker_set.names, marker_set.rest)
    bare = Face("bare", face.positions, face.triangles, np.zeros_like(face.part))
    moved = MarkerSkin.fit(bare, vertices, bare_set).deform(unit_motion(actress, face, "jawOpen"))
    assert np.isfinite(moved).all()
    assert length(moved)[vertices].max() > 20
    assert length(moved)[face.vertices_of("eye_left")].max() == 0


def test_a_frame_takes_under_three_milliseconds(actress, skin):
    frame = np.random.default_rng(0).normal(0, 3, (len(actress[0]), 3))
    skin.deform(frame)
    times = []
    for _ in range(30):
        start = time.perf_counter()
        skin.deform(frame)
        times.append(time.perf_counter() - start)
    assert np.median(times) < 0.003


def test_a_vertex_listens_to_few_markers(face, skin):
    assert skin.weights.nnz < 12 * len(face.positions)


def test_the_bundled_units_close_and_open_the_lips_on_the_face(face, actress, skin):
    units = load_marker_units()
    moves = dict(zip(units.names, units.moves[:, units.kept]))
    marker_set, vertices = actress
    at = dict(zip(marker_set.names, vertices))

    def gap(displacement):
        posed = face.positions + skin.deform(displacement)
        return posed[at["lip_upper_mid"], 1] - posed[at["lip_lower_mid"], 1]

    rest = gap(np.zeros((len(marker_set), 3)))
    assert gap(moves["jawOpen"]) > rest + 20
    assert gap(moves["jawOpen"] + moves["mouthClose"]) < rest + 4
