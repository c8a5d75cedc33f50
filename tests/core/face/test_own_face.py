"""A face whose every vertex is known, warped smoothly and handed back as a scan: the fit must find it again."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face import own_face_closing
from core.face.binding import bind
from core.face.blink_fitting import fitted_blink
from core.face.eyelids import Eyelids, eye_opening
from core.face.face import PARTS
from core.face.face_file import read_face, save_face
from core.face.lip_contact import LipContact
from core.face.marker_placement import ACTRESS_FILE, load_marker_file
from core.face.own_face import fit_own_face, painted
from core.face.own_face_closing import cotangent_laplacian
from core.face.own_face_parts import local_frames
from core.face.own_face_points import generic_points
from core.face.own_face_protected import Protected
from core.face.own_face_scan import Scan
from core.progress import Cancelled, Progress

TURN = Rotation.from_euler("xyz", [20, -30, 10], degrees=True).as_matrix()
SHIFT = np.array([30.0, -4.0, 80.0])


def other_person(places):
    """A smooth warp of space, up to 12 mm: longer, narrower, another nose, cheeks and chin."""
    x, y, z = np.asarray(places, float).T
    moved = np.column_stack([0.94 * x, 1.08 * y, 1.03 * z])
    for centre, reach, push in (
        ((0, -35, 40), 22.0, (0, -2, 5)), ((0, -85, 20), 30.0, (0, -5, 4)), ((45, -40, 5), 30.0, (4, 0, 3)),
        ((-45, -40, 5), 30.0, (-4, 0, 3)), ((0, 50, 15), 40.0, (0, 2, -4)), ((0, -62, 30), 25.0, (0, 1, 3)),
    ):  # fmt: skip
        weight = np.exp(-(((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2) / reach**2))
        moved += weight[:, None] * np.array(push, float)
    return moved


def scan_of(face, positions, unit_mm=10.0, keep=None):
    """The skin alone, turned, in cm, as a scanner would have it."""
    triangles = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    if keep is not None:
        triangles = triangles[keep(positions[triangles].mean(axis=1))]
    return Scan("other", positions @ TURN.T / unit_mm + SHIFT, triangles.astype(int))


def clicked(points, unit_mm=10.0, jitter_mm=0.0):
    rng = np.random.default_rng(5)
    return {
        key: TURN @ (place + rng.normal(scale=jitter_mm, size=3)) / unit_mm + SHIFT for key, place in points.items()
    }


@pytest.fixture(scope="module")
def truth(face):
    return other_person(face.positions)


@pytest.fixture(scope="module")
def true_points(face, truth):
    points = generic_points(replace(face, positions=truth.astype(np.float32)))
    return {key: np.asarray(place, float) for key, place in points.items()}


@pytest.fixture(scope="module")
def own(face, truth, true_points):
    return fit_own_face(face, scan_of(face, truth), clicked(true_points), name="other")


def opening(face, side):
    return eye_opening(face, face.positions[face.vertices_of(f"eye_{side}")])


@pytest.fixture
def few_rounds(monkeypatch):
    """For what does not need the last tenth of a millimetre."""
    monkeypatch.setattr(own_face_closing, "REACH_MM", (60.0, 25.0, 12.0, 6.0))


def in_scan(own, truth):
    return own.placement(truth @ TURN.T / 10.0 + SHIFT)


def test_the_face_lies_on_the_scan(own):
    assert own.closed.median < 0.1
    assert own.closed.p95 < 0.8
    assert own.closed.covered > 0.95
    assert own.warped.p95 > 2 * own.closed.p95
    assert own.doubtful == ()


def test_every_vertex_comes_to_its_own_place(face, own, truth):
    skin = face.vertices_of("skin")
    front = skin[(face.positions[skin, 2] > -20) & (face.positions[skin, 1] > -100)]
    off = np.linalg.norm(own.face.positions - in_scan(own, truth), axis=1)[front]
    assert np.median(off) < 0.6
    assert np.quantile(off, 0.95) < 2.0
    # the points alone leave more
    assert own.placement.scale == 10.0


def test_eyes_stay_balls_behind_their_lids(face, own):
    for side in ("left", "right"):
        ball = own.face.positions[own.face.vertices_of(f"eye_{side}")].astype(float)
        before = face.positions[face.vertices_of(f"eye_{side}")].astype(float)
        size, old_size = np.ptp(ball, axis=0), np.ptp(before, axis=0)
        np.testing.assert_allclose(size / old_size, np.full(3, (size / old_size)[0]), rtol=1e-4)
        for positions, ball_at, allowed in ((face.positions, before, None), (own.face.positions, ball, 0.3)):
            centre, radius = (ball_at.min(axis=0) + ball_at.max(axis=0)) / 2, np.ptp(ball_at[:, 0]) / 2
            centre[2] = ball_at[:, 2].max() - radius
            rim = opening(face, side)
            away = np.linalg.norm(positions[rim] - centre, axis=1) / radius
            if allowed is None:
                rest = away
            else:
                assert np.abs(away - rest).max() < allowed
        # the ball is seen between the lids: its foremost point lies inside of the opening
        lids = own.face.positions[rim]
        middle = ball[ball[:, 2].argmax()]
        assert (lids[:, :2].min(axis=0) < middle[:2]).all()
        assert (middle[:2] < lids[:, :2].max(axis=0)).all()


def test_a_blink_still_shuts_the_eyes(own):
    for side in ("left", "right"):
        rim = opening(own.face, side)
        shut = own.face.positions + own.face.units[f"eyeBlink{side.capitalize()}"]
        at = own.face.positions[rim]
        first, last = at[at[:, 0].argmin()], at[at[:, 0].argmax()]
        across = (at[:, 0] - first[0]) / (last[0] - first[0])
        above = at[:, 1] > first[1] + across * (last[1] - first[1])
        middle = (across > 0.3) & (across < 0.8)
        lower = shut[rim[~above]]
        lower = lower[np.argsort(lower[:, 0])]
        upper = shut[rim[above & middle]]
        slit = upper[:, 1] - np.interp(upper[:, 0], lower[:, 0], lower[:, 1])
        assert slit.max() < 0.0
        ball = own.face.positions[own.face.vertices_of(f"eye_{side}")]
        again = fitted_blink(own.face.positions, own.face.units[f"eyeBlink{side.capitalize()}"], rim, ball)
        assert (
            np.abs(again - own.face.units[f"eyeBlink{side.capitalize()}"]).max() < 1.0
        )  # fitting it again changes little


def test_lips_still_meet_at_rest_and_over_an_open_jaw(face, own):
    before, after = LipContact.of(face), LipContact.of(own.face)
    assert abs(len(after.upper) - len(before.upper)) < 12
    rest = np.linalg.norm(own.face.positions[after.upper] - own.face.positions[after.lower], axis=1)
    assert rest.max() < 2.2
    gap = after.gaps(own.face.units["jawOpen"] + own.face.units["mouthClose"])
    assert np.abs(gap).max() < 1.0
    assert after.gaps(own.face.units["jawOpen"]).max() > 20.0


def test_teeth_and_tongue_stay_behind_the_lips(face, own):
    for part in ("upper_teeth", "lower_teeth", "tongue"):
        vertices = face.vertices_of(part)
        for lip in ("upper_lip", "lower_lip"):
            behind = [f.positions[f.landmarks[lip], 2] - f.positions[vertices, 2].max() for f in (face, own.face)]
            assert behind[1] > 0.5 * behind[0] > 0


def test_shapes_turn_and_stretch_with_the_face(face, own, truth):
    """On a warp that is known, a shape ought to be what the warp makes of the moved face."""
    for name in ("jawOpen", "mouthSmileLeft", "browInnerUp", "cheekPuff"):
        moved = in_scan(own, other_person(face.positions + face.units[name])) - in_scan(own, truth)
        unit, skin = own.face.units[name], face.vertices_of("skin")
        alike = (unit[skin] * moved[skin]).sum() / np.linalg.norm(unit[skin]) / np.linalg.norm(moved[skin])
        assert alike > 0.97, name
        assert np.linalg.norm(unit[skin]) / np.linalg.norm(moved[skin]) == pytest.approx(1.0, abs=0.1), name


def test_eyes_turn_as_far_as_before(face, own):
    ball = face.vertices_of("eye_left")
    sizes = [np.ptp(f.positions[ball], axis=0)[0] for f in (face, own.face)]
    turned = [np.linalg.norm(f.units["eyeLookUpLeft"][ball], axis=1).max() / s for f, s in zip((face, own.face), sizes)]
    assert turned[1] == pytest.approx(turned[0], rel=1e-3)


def test_the_actresss_markers_sit_on_the_same_vertices(own, actress):
    marker_set, vertices = actress
    assert own.face.is_kin
    np.testing.assert_array_equal(bind(own.face, marker_set), vertices)
    assert len(Eyelids.of(own.face, vertices, marker_set).lids) == 2
    assert set(marker_set.names) <= set(load_marker_file(ACTRESS_FILE).names)


def test_a_scan_with_holes_and_without_a_back_does_as_well(face, truth, true_points):
    def seen(at):
        hole = np.linalg.norm(at - [50, -35, 10], axis=1) < 14
        return (at[:, 2] > -60) & ~hole & (at[:, 1] > -120)

    points = {key: place for key, place in true_points.items() if not key.startswith("ear")}
    own = fit_own_face(face, scan_of(face, truth, keep=seen), clicked(points, jitter_mm=1.0))
    assert own.closed.median < 0.2
    assert own.closed.p95 < 1.5
    assert 0.4 < own.closed.covered < 0.95
    skin = face.vertices_of("skin")
    front = skin[(face.positions[skin, 2] > -20) & (face.positions[skin, 1] > -90)]
    off = np.linalg.norm(own.face.positions - in_scan(own, truth), axis=1)
    assert np.median(off[front]) < 1.5
    in_hole = np.linalg.norm(truth - [50, -35, 10], axis=1) < 12
    assert off[in_hole & (face.part == PARTS.index("skin"))].max() < 5.0
    # the back was never seen, and is still a head's
    assert off[skin].max() < 40.0


def test_hair_on_a_scan_does_not_draw_the_face_out(face, truth, true_points, few_rounds):
    hairy = truth.copy()
    lift = np.clip((face.masks["hair"] - 12.0) / 10.0, 0, 1)[:, None] * 30.0
    hairy += lift * (truth - truth.mean(axis=0)) / np.linalg.norm(truth - truth.mean(axis=0), axis=1, keepdims=True)
    own = fit_own_face(face, scan_of(face, hairy), clicked(true_points))
    skin = face.vertices_of("skin")
    front = skin[(face.positions[skin, 2] > 0) & (face.positions[skin, 1] > -90) & (face.positions[skin, 1] < 40)]
    off = np.linalg.norm(own.face.positions - in_scan(own, truth), axis=1)[front]
    assert np.quantile(off, 0.95) < 2.5


def test_an_inside_out_scan_is_the_same_scan(face, truth, true_points, few_rounds):
    scan = scan_of(face, truth)
    own = fit_own_face(face, scan, clicked(true_points))
    turned = replace(scan, triangles=scan.triangles[:, ::-1])
    other = fit_own_face(face, turned, clicked(true_points))
    assert np.abs(other.face.positions - own.face.positions).max() < 1e-3
    assert other.closed.p95 < 1.0


def test_a_point_far_off_is_left_out_and_named(face, truth, true_points, few_rounds):
    wrong = {**true_points, "upper_lip_top": true_points["nose_bridge"] + [0, 4.0, 0]}
    other = fit_own_face(face, scan_of(face, truth), clicked(wrong))
    assert other.doubtful == ("upper_lip_top",)
    assert "left out: Upper edge of the upper lip" in other.notes[-1]
    assert other.closed.p95 < 1.5


def test_points_that_are_not_on_the_scan_are_one_sentence(face, truth, true_points):
    scan = scan_of(face, truth)
    floating = clicked({key: place + np.array([0, 0, 40.0]) for key, place in true_points.items()})
    with pytest.raises(UserFacingError, match="off its surface") as caught:
        fit_own_face(face, scan, floating)
    assert "another scan" in caught.value.remedy
    elsewhere = clicked({key: place + np.array([1e6, 0, 0]) for key, place in true_points.items()})
    with pytest.raises(UserFacingError, match="far off the scan's surface"):
        fit_own_face(face, scan, elsewhere)
    with pytest.raises(UserFacingError, match="lacks needed points"):
        fit_own_face(face, scan, {})


def test_what_is_saved_is_taken_where_a_face_is_chosen(tmp_path, own):
    from core.face.mesh_files import load_face
    from core.rig.rig_files import load_rig

    coloured = replace(own, scan=replace(own.scan, colours=np.full((len(own.scan.positions), 3), 120, np.uint8)))
    face = painted(coloured, size_px=96)
    assert face.texture.min() == face.texture.max() == 120
    assert face.look.hair_mm == 0.0
    assert painted(own) is own.face
    path = tmp_path / "own.npz"
    save_face(face, path)
    for back in (read_face(path), load_face(path), load_rig(str(path)).face):
        assert back.is_kin
        np.testing.assert_array_equal(back.texture, face.texture)
        np.testing.assert_array_equal(back.positions, face.positions)
        np.testing.assert_array_equal(back.uv, face.uv)


def test_a_fit_can_be_stopped(face, truth, true_points):
    class Stopping(Progress):
        def step(self, fraction, message=""):
            if fraction > 0.4:
                raise Cancelled

    with pytest.raises(Cancelled):
        fit_own_face(face, scan_of(face, truth), clicked(true_points), progress=Stopping())


def test_mouth_and_lids_are_protected(face):
    protected = Protected.of(face)
    part = face.part[protected.surface]
    assert (protected.share[part == PARTS.index("mouth_socket")] == 0).all()
    at = {int(v): k for k, v in enumerate(protected.surface)}
    for side in ("left", "right"):
        assert protected.share[[at[int(v)] for v in opening(face, side)]].max() == 0
    for name in ("nose_tip", "chin", "cheek_left", "nose_bridge"):
        assert protected.share[at[face.landmarks[name]]] == 1
    upper, lower = face.positions[protected.surface[protected.pairs]].transpose(1, 0, 2)
    assert len(upper) > 30
    assert np.linalg.norm(upper - lower, axis=1).max() < 2.0


def test_the_laplacian_is_zero_for_planes_and_two_for_paraboloids():
    x, y = (g.ravel().astype(float) for g in np.meshgrid(np.arange(12), np.arange(12)))
    corner = (np.arange(11)[:, None] * 12 + np.arange(11)).ravel()
    triangles = np.concatenate([np.column_stack([corner, corner + 1, corner + 12]),
                                np.column_stack([corner + 1, corner + 13, corner + 12])])  # fmt: skip
    laplacian, areas = cotangent_laplacian(np.column_stack([x, y, 0 * x]), triangles)
    inner = (x > 0) & (x < 11) & (y > 0) & (y < 11)
    assert areas.sum() == pytest.approx(121)
    np.testing.assert_allclose((laplacian @ (3 * x - y + 2))[inner], 0, atol=1e-9)
    np.testing.assert_allclose((laplacian @ (x * x))[inner] / areas[inner], 2.0, atol=1e-9)


def test_local_frames_of_an_affine_map_are_the_map_drawn_to_its_similarity():
    rest = np.random.default_rng(0).normal(scale=20, size=(300, 3))
    turn = Rotation.from_euler("xyz", [10, 40, -70], degrees=True).as_matrix()
    frames = local_frames(rest, 1.3 * rest @ turn.T + 7.0, np.arange(0, 300, 30))
    np.testing.assert_allclose(frames, np.tile(1.3 * turn, (10, 1, 1)), atol=1e-9)
    stretch = np.diag([1.4, 1.0, 1.0])
    frame = local_frames(rest, rest @ stretch.T, np.array([0]))[0]
    assert 1.2 < frame[0, 0] < 1.4
    assert abs(frame[1, 1] - 1.0) < 0.1
