"""Training finds what was there, never gets worse, and goes on where it was cut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.animeme import form as forms
from core.animeme.examples import Lesson
from core.animeme.form import BEST, COHEN_MASSARO, COHEN_MASSARO_NORMALISED
from core.animeme.training import train_animemes
from core.animeme.width_search import TrainingSettings
from core.errors import UserFacingError
from core.progress import Cancelled, Progress
from core.speech.phoneme import PHONEME_INDEX, VISEME_OF_PHONEME
from core.speech.transcript import PhonemeUtterance

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral

EXACT = TrainingSettings(ridges_s={}, width_pull=0.0, least_gain=1e-12, most_steps=200)
SAID = [PHONEME_INDEX[p] for p in ("pau", "b", "aa", "iy", "k", "s")]


def polynomials(model):
    return (model.coefficients["phoneme"] + model.coefficients["class"][list(VISEME_OF_PHONEME)])[SAID]


@pytest.mark.parametrize("form", [PRINTED, replace(PRINTED, degree=2, spread="time", edge=1.25)])
def test_coefficients_and_widths_of_a_known_model_are_recovered(known_model, babble, taught, form):
    model = known_model(form)
    found = train_animemes(taught(model, babble(16)), form, model.rest, EXACT).model
    np.testing.assert_allclose(found.widths[0][:, SAID], model.widths[0][:, SAID], rtol=2e-3)
    np.testing.assert_allclose(polynomials(found), polynomials(model), atol=2e-3)


def test_a_normalised_model_says_unheard_sentences_as_the_known_one_does(known_model, babble, taught):
    # its dominances are known up to a common factor only, so that curves are compared and not coefficients
    form = replace(BEST, context_degree=-1, duration_degree=-1)
    model = known_model(form)
    found = train_animemes(taught(model, babble(24)), form, model.rest, EXACT).model
    for transcript in babble(4, seed=5):
        wanted, said = (m.curves(transcript, 60.0).values for m in (model, found))
        assert np.sqrt(((said - wanted) ** 2).mean()) < 0.02 * wanted.std()


@pytest.mark.parametrize("form", [PRINTED, BEST, COHEN_MASSARO])
@pytest.mark.parametrize("is_projected", [True, False])
def test_what_is_made_least_never_rises(known_model, babble, taught, form, is_projected):
    examples = taught(known_model(PRINTED), babble(8), noise=0.3)
    settings = TrainingSettings(is_projected=is_projected, least_gain=1e-9, most_steps=25)
    (losses,) = train_animemes(examples, form, settings=settings).losses
    assert len(losses) > 3
    assert (np.diff(losses) < 0).all()


def test_letting_the_coefficients_follow_takes_fewer_steps_than_taking_turns(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(12), noise=0.05)
    found = {
        turns: train_animemes(examples, PRINTED, settings=TrainingSettings(is_projected=not turns, most_steps=8))
        for turns in (False, True)
    }
    assert found[False].losses[0][-1] < found[True].losses[0][-1]


def test_degree_zero_is_the_least_squares_of_cohen_and_massaro(known_model, babble, taught):
    """Constant targets under the trained dominances, made anew by a plain loop over phonemes and lstsq."""
    examples = taught(known_model(PRINTED), babble(6), noise=0.1)
    settings = TrainingSettings(ridges_s={}, width_pull=0.0)
    for form in (COHEN_MASSARO, COHEN_MASSARO_NORMALISED):
        model = train_animemes(examples, form, settings=settings).model
        assert model.coefficients["phoneme"].shape[1] == 1
        rows, values = [], []
        for example in examples:
            for time_s, value in zip(example.track.times_s, example.track.values):
                row = np.zeros(len(VISEME_OF_PHONEME))
                near = example.transcript.phonemes
                now = max(i for i, u in enumerate(near) if u.start_s <= time_s)
                for u in near[max(0, now - 8) : now + 9]:
                    p, d = PHONEME_INDEX[u.phone], u.end_s - u.start_s
                    keep, reach = model.widths[0][:, p]
                    away = abs(time_s - (u.start_s + u.end_s) / 2)
                    inside = min(away, d / 2)
                    row[p] += np.exp(-((inside / (d * keep + 1e-3) + (away - inside) / (d * reach + 1e-3)) ** 2))
                rows.append(row / row.sum() if form.is_normalised else row)
                values.append(value)
        targets, *_ = np.linalg.lstsq(np.array(rows)[:, SAID], np.array(values, float), rcond=None)
        np.testing.assert_allclose(polynomials(model)[:, 0], targets, atol=2e-3)


class CutsAt(Progress):
    def __init__(self, n):
        self.left = n

    def step(self, fraction, message=""):
        if message.startswith("step"):
            self.left -= 1
            if self.left < 0:
                raise Cancelled


@pytest.mark.parametrize("has_shared_widths", [True, False])
def test_a_run_that_was_cut_twice_ends_as_one_that_was_not(known_model, babble, taught, tmp_path, has_shared_widths):
    form = replace(PRINTED, has_shared_widths=has_shared_widths)
    examples = taught(known_model(PRINTED), babble(5), noise=0.2)
    journal = tmp_path / "cache" / "run.journal.npz"
    whole = train_animemes(examples, form)
    for n in (2, 3):
        with pytest.raises(Cancelled):
            train_animemes(examples, form, journal=journal, progress=CutsAt(n))
        assert journal.is_file()
    resumed = train_animemes(examples, form, journal=journal)
    assert resumed.losses == whole.losses
    np.testing.assert_array_equal(resumed.model.widths, whole.model.widths)
    for name, table in whole.model.coefficients.items():
        np.testing.assert_array_equal(resumed.model.coefficients[name], table)
    assert not journal.exists()


def test_the_journal_of_another_run_or_a_damaged_one_is_not_taken(known_model, babble, taught, tmp_path):
    examples, others = (taught(known_model(PRINTED, seed), babble(3), noise=0.2) for seed in (1, 2))
    journal = tmp_path / "run.journal.npz"
    with pytest.raises(Cancelled):
        train_animemes(others, PRINTED, journal=journal, progress=CutsAt(2))
    assert train_animemes(examples, PRINTED, journal=journal).losses == train_animemes(examples, PRINTED).losses
    journal.write_bytes(b"no archive")
    assert train_animemes(examples, PRINTED, journal=journal).losses == train_animemes(examples, PRINTED).losses


def test_phonemes_beyond_the_end_of_the_curves_teach_nothing_and_do_no_harm(known_model, babble, taught):
    model = known_model(PRINTED)
    example = taught(model, babble(1, said=30))[0]
    short = replace(example.track, values=example.track.values[:40])
    later = (PhonemeUtterance("zh", example.transcript.duration_s, example.transcript.duration_s + 0.1),)
    said = replace(example.transcript, phonemes=(*example.transcript.phonemes, *later),
                   duration_s=example.transcript.duration_s + 0.1)  # fmt: skip
    found = train_animemes([replace(example, transcript=said, track=short)], PRINTED, model.rest)
    assert not found.model.coefficients["phoneme"][PHONEME_INDEX["zh"]].any()
    assert found.residual < 0.5


def test_a_rare_phoneme_leans_on_its_class_and_one_never_said_is_its_class(known_model, babble, taught):
    model = known_model(PRINTED)
    found = train_animemes(taught(model, babble(10)), PRINTED, model.rest).model
    never = PHONEME_INDEX["p"]  # of the class of b
    assert not found.coefficients["phoneme"][never].any()
    assert np.abs(found.coefficients["class"][VISEME_OF_PHONEME[never]]).max() > 0.01


def test_widths_of_their_own_fit_each_control_at_least_as_well(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(6), noise=0.2)
    shared, own = (
        train_animemes(examples, replace(PRINTED, has_shared_widths=is_shared), settings=EXACT)
        for is_shared in (True, False)
    )
    assert own.model.widths.shape[0] == 2
    assert own.residual < shared.residual


def test_no_sentence_and_sentences_that_do_not_fit_are_told(known_model, babble, taught):
    with pytest.raises(UserFacingError, match="no sentences"):
        train_animemes([])
    examples = taught(known_model(PRINTED), babble(2))
    other = replace(examples[1], track=replace(examples[1].track, names=("a", "b")))
    with pytest.raises(UserFacingError, match="different controls"):
        Lesson.of([examples[0], other])


def test_a_control_that_never_moves_stays_where_it_is(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(4))
    still = [
        replace(e, track=replace(e.track, values=np.c_[e.track.values[:, :1], np.full(len(e.track), 0.5)]))
        for e in examples
    ]
    found = train_animemes(still, BEST, np.array([0.0, 0.5])).model
    np.testing.assert_allclose(found.curves(babble(1, seed=7)[0], 60.0).values[:, 1], 0.5)


def test_what_is_emphasised_is_fitted_more_closely(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(10), noise=0.5)
    off = []
    for emphasis in (1.0, 50.0):
        model = train_animemes(examples, replace(COHEN_MASSARO, bilabial_emphasis=emphasis)).model
        lesson = Lesson.of(examples)
        shut = lesson.emphasis(("b",), 2.0) == 2.0
        errors = (model.values(lesson.utterances, lesson.times_s) - lesson.values) ** 2
        off.append((errors[shut].mean(), errors[~shut].mean()))
    assert off[1][0] < 0.8 * off[0][0]
    assert off[1][1] > off[0][1]
