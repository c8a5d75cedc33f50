"""Videos of known motion: how near, what a correction changes, and what becomes of a face that is lost."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from core.errors import UserFacingError
from core.progress import Cancelled, Progress
from core.tracking.optical_flow import followed, look_of
from core.tracking.track import TrackingRequest, track_video
from core.tracking.video_pictures import pictures


@pytest.fixture(scope="module")
def request_of(film, model, clicks, tmp_path_factory):
    """Return a function from a sheet to a request to track its film."""
    folder = tmp_path_factory.mktemp("films")

    def make(made, name):
        return TrackingRequest(film(made, folder / f"{name}.avi"), model, clicks)

    return make


@pytest.fixture(scope="module")
def noisy(sheet, request_of):
    made = sheet(noise=14.0)
    request = request_of(made, "noisy")
    return made, request, track_video(request)


def _errors(track, made, model):
    return np.linalg.norm(track.points - made.truth(model.seen * [1, -1]), axis=2)


def test_constrained_points_are_much_nearer_than_points_alone(noisy, model):
    made, request, track = noisy
    looks = [look_of(picture.grey) for picture in pictures(request.video)]
    alone = [track.points[0]]
    for before, now in pairwise(looks):
        alone.append(followed(before, now, alone[-1], alone[-1]).points)
    free = np.linalg.norm(np.array(alone) - made.truth(model.seen * [1, -1]), axis=2)[1:]
    ours = _errors(track, made, model)[1:]
    assert ours.mean() < 0.7
    assert ours.mean() < 0.7 * free.mean()
    assert not track.lost.any()


def test_times_are_those_of_the_video(noisy):
    np.testing.assert_allclose(noisy[2].times_s, np.arange(24) / 25.0, atol=1e-6)


def test_a_correction_stays_and_nothing_before_it_changes(noisy, model):
    _, request, track = noisy
    row = model.names.index("m3")
    place = track.points[10, row] + (6.0, -5.0)
    again = track_video(replace(request, corrections={10: {"m3": tuple(place)}}), earlier=track)
    np.testing.assert_array_equal(again.points[:10], track.points[:10])
    np.testing.assert_allclose(again.points[10, row], place)
    # it goes on from there: the distance to where it was before stays, turned and scaled with the face
    after = np.linalg.norm(again.points[11:, row] - track.points[11:, row], axis=1)
    assert np.abs(after - np.hypot(6, 5)).max() < 2.0
    others = np.delete(np.arange(len(model.names)), row)
    assert np.abs(again.points[:, others] - track.points[:, others]).max() < 1.0


def test_taking_up_gives_the_bytes_of_beginning_anew(noisy):
    _, request, track = noisy
    first = replace(request, corrections={8: {"m1": tuple(track.points[8, 7] + 3.0)}})
    step = track_video(first, earlier=track)
    second = replace(first, corrections={**first.corrections, 15: {"m9": tuple(track.points[15, 15] - 4.0)}})
    taken_up, anew = track_video(second, earlier=step), track_video(second)
    for name in ("points", "trust", "drift_px", "lost", "times_s"):
        np.testing.assert_array_equal(getattr(taken_up, name), getattr(anew, name))
    undone = track_video(request, earlier=taken_up)
    np.testing.assert_array_equal(undone.points, track.points)


def test_a_correction_of_the_first_picture_moves_the_start(noisy, model):
    _, request, track = noisy
    row = model.names.index("m5")
    place = track.points[0, row] + (4.0, 3.0)
    again = track_video(replace(request, corrections={0: {"m5": tuple(place)}}), earlier=track)
    np.testing.assert_allclose(again.points[0, row], place)
    away = np.linalg.norm(again.points[:, row] - track.points[:, row], axis=1)
    assert np.abs(away - 5.0).max() < 1.5


def test_a_drag_from_a_wrong_place_is_believed_over_the_pictures(sheet, request_of, model):
    """A face that was lost for good is found again where a hand puts some of its points."""
    t = np.arange(24)
    jump = np.zeros((24, 2))
    jump[6:] = (-70.0, 20.0)
    made = sheet(shift=jump, dark=frozenset(range(3, 6)), turn=0.0 * t)
    request = request_of(made, "jump")
    truth = made.truth(model.seen * [1, -1])
    hand = {name: tuple(truth[6, model.names.index(name)]) for name in ("mouth_corner_left", "outer_eye_right")}
    track = track_video(replace(request, corrections={6: hand}))
    assert np.linalg.norm(track.points[7:] - truth[7:], axis=2).mean() < 1.0


def test_dark_pictures_are_lost_and_the_face_is_found_again(sheet, request_of, model):
    made = sheet(dark=frozenset(range(8, 14)), noise=4.0)
    track = track_video(request_of(made, "dark"))
    assert track.lost.tolist() == [8 <= f < 14 for f in range(24)]
    assert track.trust[8:14].max() == 0.0
    np.testing.assert_array_equal(track.points[8:14], np.repeat(track.points[7:8], 6, axis=0))
    assert np.isnan(track.frame_drift_px[8:14]).all()
    assert _errors(track, made, model)[14:].mean() < 1.0


def test_taking_up_within_dark_pictures_gives_the_same_too(sheet, request_of, model):
    request = request_of(sheet(dark=frozenset({5, 6, 7}), n=14), "dark-short")
    track = track_video(request)
    for frame in (6, 8):
        changed = replace(request, corrections={frame: {"m2": tuple(track.points[4, 8] + 2.0)}})
        np.testing.assert_array_equal(track_video(changed, earlier=track).points, track_video(changed).points)


def test_a_face_that_comes_back_elsewhere_is_looked_for(sheet, request_of, model):
    jump = np.zeros((24, 2))
    jump[12:] = (65.0, -18.0)
    made = sheet(shift=jump, dark=frozenset(range(8, 12)))
    track = track_video(request_of(made, "elsewhere"))
    assert track.lost[8:12].all()
    assert not track.lost[12:].any()
    assert _errors(track, made, model)[12:].mean() < 1.0


def test_a_jump_between_two_pictures_is_followed(sheet, request_of, model):
    jump = np.zeros((24, 2))
    jump[12:] = (40.0, 12.0)
    made = sheet(shift=jump)
    track = track_video(request_of(made, "jumping"))
    assert _errors(track, made, model)[13:].mean() < 1.0


def test_points_out_of_the_picture_are_carried_by_the_others(sheet, request_of, model):
    t = np.linspace(0, np.pi, 24)
    made = sheet(shift=np.stack([130.0 * np.sin(t), 0.0 * t], 1))
    track = track_video(request_of(made, "leaving"))
    truth = made.truth(model.seen * [1, -1])
    outside = truth[..., 0] > 322
    assert outside.any(axis=0).sum() > 5
    assert track.trust[outside].max() == 0.0
    assert not track.lost.any()
    error = np.linalg.norm(track.points - truth, axis=2)
    assert error[~outside].mean() < 1.0
    assert error[-1].mean() < 1.0


def test_a_still_picture_stays_still(sheet, request_of, model):
    made = sheet(n=8)
    still = replace(made, parameters=0 * made.parameters, turn=0 * made.turn, grow=0 * made.grow + 1,
                    shift=0 * made.shift)  # fmt: skip
    track = track_video(request_of(still, "still"))
    assert np.abs(track.points - track.points[0]).max() < 0.1
    assert track.trust.min() > 0.9


def test_a_correction_of_an_unknown_point_is_refused(noisy):
    with pytest.raises(UserFacingError, match="'nose'"):
        track_video(replace(noisy[1], corrections={4: {"nose": (3.0, 4.0)}}))


def test_cancelling_ends_between_two_pictures(noisy):
    class Impatient(Progress):
        def step(self, fraction, message=""):
            if fraction > 0.3:
                raise Cancelled

    with pytest.raises(Cancelled):
        track_video(noisy[1], Impatient())
