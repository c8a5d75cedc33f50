"""Both trained faces: the same live as of a whole, expressions mixed, and learned what there is to learn."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.measures import correlation
from core.iface.heard_takes import database_takes, recorded_takes
from core.iface.modern_training import train_modern_face
from core.iface.paper_training import train_paper_face
from core.progress import Cancelled, Progress
from tests.core.iface.quick_training import QUICK_MODERN, QUICK_PAPER

VARIANTS = ("modern", "paper")


@pytest.fixture(params=VARIANTS)
def face(request, quick_faces):
    return quick_faces[request.param]


@pytest.fixture(scope="module")
def heard(loud_database):
    return recorded_takes(loud_database, loud_database.held_out_recordings("test"))[0].features


def _train(variant, takes, database, progress=None):
    more = {} if progress is None else {"progress": progress}
    if variant == "modern":
        return train_modern_face(takes, database.markers, 1, settings=QUICK_MODERN, **more)
    return train_paper_face(takes, database.markers.rest, 1, settings=QUICK_PAPER, **more)


@pytest.mark.parametrize("sizes", [[1], [2, 0, 5], [400]])
def test_the_frames_of_a_stream_are_those_of_the_whole_and_come_100_ms_behind(face, heard, sizes):
    whole, stream, live, at = face.motion(heard, {"anger": 0.4}), face.stream(), [], 0
    while at < len(heard):
        size = sizes[len(live) % len(sizes)]
        live.append(stream.accept(heard[at : at + size], {"anger": 0.4}))
        at += size
    assert face.n_ahead <= 3 and sum(map(len, live)) == len(heard) - face.n_ahead
    live.append(stream.finish())
    assert whole.dtype == live[0].dtype == np.float32
    np.testing.assert_allclose(np.concatenate(live), whole, atol=1e-3)
    np.testing.assert_allclose(stream.accept(heard, {"anger": 0.4}), whole[: len(heard) - face.n_ahead], atol=1e-3)


def test_deformations_mix_by_their_strengths_and_never_beyond_1(face, heard):
    calm, angry = (face.motion(heard, {"anger": a}) - face.neutral for a in (0.0, 1.0))
    assert np.abs(angry - calm).max() > 0.5
    rising = np.linspace(0.0, 2.0, len(heard))
    share = np.minimum(rising, 1.0)[:, None, None]
    mixed = face.motion(heard, {"anger": rising, "neutral": 0.7}) - face.neutral
    np.testing.assert_allclose(mixed, (1 - share) * calm + share * angry, atol=1e-3)


def test_each_state_is_equation_2_at_full_strength(face, heard):
    context = np.concatenate([face._silent(face.n_back), heard, face._silent(face.n_ahead)])
    calm, angry = face.parameters(context)
    np.testing.assert_allclose(face.motion(heard, {}) - face.neutral, face.units.deformations(calm), atol=1e-3)
    shown = face.motion(heard, {"anger": 1.0}) - face.neutral
    np.testing.assert_allclose(shown, face.units.deformations(angry, "anger"), atol=1e-3)


def test_what_it_cannot_show_or_hear_is_told(face, heard):
    with pytest.raises(UserFacingError, match=r"not trained on 'joy'.*neutral, anger"):
        face.motion(heard, {"joy": 0.0})
    with pytest.raises(ValueError, match="features of shape"):
        face.motion(heard[:, :9], {})
    assert face.motion(heard[:0], {}).shape == (0, *face.neutral.shape)


def test_the_paper_face_is_a_class_and_a_perceptron_frame_by_frame(quick_faces, heard):
    face = quick_faces["paper"]
    assert len(face.classes.phones) > 1
    padded = np.concatenate([np.repeat(face.silence[None], 3, 0), heard, np.repeat(face.silence[None], 3, 0)])
    calm, angry = face.parameters(padded)
    for f in range(0, len(heard), 7):
        best = int(np.argmax(face.classes.scores(heard[f, None, :10])[0]))
        spoken = face.spoken[best](padded[f : f + 7, :10].reshape(1, 70))
        np.testing.assert_allclose(calm[f], spoken[0], atol=1e-3)
        np.testing.assert_allclose(angry[f], face.expressive[0](spoken)[0], atol=1e-3)


def test_a_mouth_that_opens_as_loud_as_it_speaks_is_learned(face, loud_database):
    for take in recorded_takes(loud_database, loud_database.held_out_recordings("test")):
        shown = face.motion(take.features, {take.emotion: 1.0})
        opening = face.neutral[4, 1] + take.displacements[:, 4, 1]
        assert correlation(shown[:, 4, 1].astype(float), opening.astype(float)) > 0.8


@pytest.mark.parametrize("variant", VARIANTS)
def test_the_same_seed_gives_the_same_face_and_it_can_be_cancelled(loud_database, heard, variant):
    takes = database_takes(loud_database)[:6]
    one, two = (_train(variant, takes, loud_database).motion(heard, {"anger": 0.5}) for _ in range(2))
    assert (one == two).all()

    class Stop(Progress):
        def step(self, fraction, message=""):
            if fraction > 0.5:
                raise Cancelled

    with pytest.raises(Cancelled):
        _train(variant, takes, loud_database, Stop())


@pytest.mark.parametrize("variant", VARIANTS)
def test_an_expression_of_a_moment_is_left_out_and_neutral_speech_is_needed(loud_database, heard, variant):
    takes = database_takes(loud_database)
    calm = [take for take in takes if take.emotion == "neutral"]
    moment = next(take for take in takes if take.emotion == "anger")
    blind = dataclasses.replace(moment, used=np.arange(len(moment)) == 3)
    assert _train(variant, [*calm[:2], blind], loud_database).expressions == ()
    with pytest.raises(UserFacingError, match="no neutral speech"):
        _train(variant, [moment], loud_database)


@pytest.mark.parametrize("variant", VARIANTS)
def test_two_frames_and_a_still_face_can_be_learned_from(loud_database, heard, variant):
    take = database_takes(loud_database)[0]
    brief = dataclasses.replace(take, used=np.arange(len(take)) < 2)
    still = dataclasses.replace(
        take, features=np.zeros_like(take.features), displacements=np.zeros_like(take.displacements)
    )
    for odd in (brief, still):
        shown = _train(variant, [odd], loud_database).motion(heard, {})
        assert np.isfinite(shown).all()
    np.testing.assert_allclose(shown, np.broadcast_to(loud_database.markers.rest, shown.shape), atol=1e-3)
