"""The rendered scenes are what they say they are, and tracking them is measured against what is known."""

from fractions import Fraction
from itertools import islice

import numpy as np
import pytest

from app.tracking_bench import alone, as_table, bench_tracking, request_for
from app.tracking_scene import Scene, Trouble
from core.actress.capture import markers_of
from core.actress.corpus import actress_marker_set, database_sentences, tuning_sentences
from core.actress.performance import bundled_marker_units, perform
from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable, default_face
from core.face.marker_placement import ACTRESS_FILE, load_marker_file
from core.iface.motion_unit import MotionUnits
from core.media.video import write_video
from core.tracking.face_model import FaceModel
from core.tracking.optical_flow import look_of
from core.tracking.track import track_video
from core.tracking.video_pictures import pictures


@pytest.fixture(scope="module")
def face():
    try:
        return default_face(download=False)
    except FaceUnavailable:
        pytest.skip("the default face is not on this machine")


@pytest.fixture(scope="module")
def scene(face):
    return Scene.of(face, tuning_sentences()[1], head_gain=2.0, n_frames=30)


def test_a_marker_s_track_is_that_of_its_vertex(scene):
    placement = load_marker_file(ACTRESS_FILE)
    kept = placement.vertices[placement.kept]
    true = np.array([scene.pixels(v[kept].astype(float)) for v in scene.vertices])
    np.testing.assert_allclose(scene.tracks(true[0]), true, atol=1e-3)
    assert np.linalg.norm(true[-1] - true[0], axis=1).min() > 2.0  # all of the head moves


def test_a_spot_within_a_triangle_moves_between_its_corners(scene):
    placement = load_marker_file(ACTRESS_FILE)
    nose = placement.vertices[placement.names.index("nose_tip")]
    corners = scene.face.triangles[(scene.face.triangles == nose).any(axis=1)][0]
    true = np.array([scene.pixels(v[corners].astype(float)) for v in scene.vertices])
    found = scene.tracks(true[0].mean(axis=0)[None])[:, 0]
    assert np.linalg.norm(found - true.mean(axis=1), axis=1).max() < 0.2


def test_the_first_picture_is_neutral_and_stays_so_a_moment(scene):
    np.testing.assert_array_equal(scene.vertices[0], scene.face.positions)


def test_trouble_is_as_strong_as_it_says():
    grey = [np.full((60, 80, 3), 120, np.uint8)] * 20
    noisy = np.array(list(Trouble(noise=10.0).of(iter(grey))))
    assert noisy.std() == pytest.approx(10.0, rel=0.02)
    assert abs(noisy.mean() - 120) < 0.2
    lit = np.array(list(Trouble(light=0.3).of(iter(grey))))
    assert np.ptp(lit.astype(float), axis=0).max() > 30
    assert np.array_equal(list(Trouble().of(iter(grey)))[3], grey[3])


def test_constrained_points_of_a_rendered_face_are_nearer_than_points_alone(scene, tmp_path):
    """Noise of 10 grey levels; the units are of other sentences."""
    moved = markers_of(
        np.concatenate([perform(_transcript(s), s.emotion, s.sentence, 30.0) for s in database_sentences()[:6]]),
        bundled_marker_units(),
    )[:, bundled_marker_units().kept]
    markers = actress_marker_set()
    model = FaceModel.of(markers, MotionUnits.fit({"neutral": moved - markers.rest}))
    path = tmp_path / "scene.mp4"
    write_video(path, Trouble(noise=10.0).of(scene.pictures()), len(scene.vertices), Fraction(30))
    request = request_for(scene, path, model)
    track = track_video(request)
    truth = scene.tracks(track.points[0])
    ours = np.linalg.norm(track.points - truth, axis=2)[1:].mean()
    looks = [look_of(picture.grey) for picture in islice(pictures(path), len(scene.vertices))]
    free = np.linalg.norm(alone(request, looks) - truth, axis=2)[1:].mean()
    assert ours < 1.5
    assert ours < 0.7 * free


def _transcript(spoken):
    from core.actress.corpus import transcript_of

    return transcript_of(spoken)


def test_unknown_conditions_and_parts_are_refused():
    with pytest.raises(UserFacingError, match="'fog'"):
        bench_tracking(None, conditions=["fog"])
    with pytest.raises(UserFacingError, match="'all of it'"):
        bench_tracking(None, part="all of it")


def test_the_table_has_a_row_a_condition():
    methods = {"alone": 9.0, "alone, first picture": 8.0, "paper": 5.0, "constrained": 1.0}
    row = {"condition": "noise", "frames": 10, "lost": 0, "frames_per_s": 40.0,
           "cpu_ms_per_frame": 17.2, "mean_px": methods, "p95_px": methods,
           "less_than_alone": 0.875}  # fmt: skip
    assert (
        as_table({"rows": [row]}).splitlines()[-1] == "| noise | 10 | 9.00 | 8.00 | 5.00 | 1.00 | 88% | 1.0 | 40 | 17 |"
    )
