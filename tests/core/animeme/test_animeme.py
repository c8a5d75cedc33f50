"""Equation 1, emotions, and the file of a model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.animeme import form as forms
from core.animeme.animeme import load_animemes
from core.animeme.form import BEST, AnimemeForm
from core.errors import UserFacingError
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PHONEME_INDEX, VISEME_OF_PHONEME
from core.speech.transcript import PhonemeUtterance, Transcript

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral


def by_hand(model, transcript, time_s):
    """Equations 1, 2 and 7 in powers of t, phoneme by phoneme."""
    value = model.rest.copy()
    for u in transcript.phonemes:
        p, d = PHONEME_INDEX[u.phone], u.end_s - u.start_s
        legendre = model.coefficients["phoneme"][p] + model.coefficients["class"][VISEME_OF_PHONEME[p]]
        t = (time_s - u.start_s) / d
        shape = [
            np.polyval(np.polynomial.legendre.leg2poly(column)[::-1], 2 * t - 1) for column in legendre.T
        ]  # fmt: skip
        away = abs(time_s - (u.start_s + u.end_s) / 2)
        inside = min(away, d / 2)
        keep, reach = model.widths[0][:, p]
        ruling = np.exp(-((inside / (d * keep + 1e-3) + (away - inside) / (d * reach + 1e-3)) ** 2))
        value = value + ruling * np.array(shape)
    return value


def test_the_printed_form_is_the_papers_sum(known_model, babble):
    model = known_model(PRINTED)
    (transcript,) = babble(1, said=7)
    track = model.curves(transcript, 50.0)
    wanted = [by_hand(model, transcript, time_s) for time_s in track.times_s]
    np.testing.assert_allclose(track.values, wanted, atol=1e-3)


def test_any_rate_samples_the_same_curves(known_model, babble):
    (transcript,) = babble(1, seed=3)
    slow, fast = (known_model(BEST).curves(transcript, rate_hz) for rate_hz in (30.0, 120.0))
    n = min(len(slow), len(fast) // 4)
    np.testing.assert_allclose(slow.values[:n], fast.values[::4][:n], atol=1e-6)


def test_far_phonemes_come_in_without_a_step(known_model, babble):
    model = known_model(BEST)
    (transcript,) = babble(1, seed=4, said=40)
    values = model.curves(transcript, 2000.0).values
    assert np.abs(np.diff(values, n=2, axis=0)).max() < 0.02 * np.ptp(values)


def test_an_emotion_at_half_strength_is_half_way(known_model, babble):
    model, (transcript,) = known_model(BEST), babble(1)
    none, half, full = (
        model.curves(transcript, 60.0, [EmotionModifier(0.0, 99.0, "anger", strength)]).values
        for strength in (0.0, 0.5, 1.0)
    )
    assert np.abs(full - none).max() > 0.1
    np.testing.assert_allclose(half, (none + full) / 2, atol=1e-5)
    np.testing.assert_array_equal(none, model.curves(transcript, 60.0).values)


def test_shares_of_a_normalised_form_sum_to_one_and_each_phoneme_rules_its_own_middle(known_model, babble):
    (transcript,) = babble(1)
    rate_hz, n_frames = 100.0, round(transcript.duration_s * 100)
    ruling = known_model(replace(BEST)).rule(transcript, rate_hz, n_frames)
    np.testing.assert_allclose(ruling.sum(axis=0), 1.0, atol=1e-6)
    middles = [min(n_frames - 1, round((u.start_s + u.end_s) / 2 * rate_hz)) for u in transcript.phonemes]
    ruled = known_model(PRINTED).rule(transcript, rate_hz, n_frames)
    assert all(ruled[p, f] > 0.95 for p, f in enumerate(middles))


def test_a_dragged_vowel_fades_unless_it_is_held(known_model):
    model = known_model(PRINTED)
    spoken = (PhonemeUtterance("b", 0.0, 0.1), PhonemeUtterance("aa", 0.1, 2.1), PhonemeUtterance("b", 2.1, 2.2))
    dragged = Transcript(spoken, (), 2.2)
    fading, held = (model.rule(dragged, 100.0, 220, holds=holds)[1] for holds in (False, True))
    assert fading[15] < 0.9 * fading[110]
    assert (held[30:190] == 1.0).all()
    usual = Transcript(spoken[:1], (), 0.1)
    np.testing.assert_array_equal(model.curves(usual, 60.0, holds=True).values, model.curves(usual, 60.0).values)


def test_a_file_gives_back_what_was_saved(known_model, babble, tmp_path):
    model = replace(known_model(BEST), content="abc")
    model.save(tmp_path / "talk.npz")
    back = load_animemes(tmp_path / "talk.npz")
    assert (back.form, back.names, back.content) == (model.form, model.names, "abc")
    (transcript,) = babble(1)
    np.testing.assert_array_equal(back.curves(transcript, 30.0).values, model.curves(transcript, 30.0).values)


def test_a_damaged_file_is_refused_in_one_sentence(known_model, tmp_path, survives_damage):
    path = tmp_path / "talk.npz"
    known_model(PRINTED).save(path)
    assert survives_damage(path, load_animemes, 40) > 10


def test_another_thing_is_refused(tmp_path):
    with pytest.raises(UserFacingError, match="no animemes at"):
        load_animemes(tmp_path / "none.npz")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    with pytest.raises(UserFacingError, match="no file of animemes"):
        load_animemes(tmp_path / "other.npz")


def test_a_degree_that_cannot_be_is_told():
    with pytest.raises(UserFacingError, match="degree 9"):
        AnimemeForm(degree=9)
    assert AnimemeForm.from_dict(PRINTED.as_dict()) == PRINTED
