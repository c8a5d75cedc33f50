"""The path through Gaussians, beside a dense solve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.animeme import form as forms
from core.animeme.mmm import smoothness_band, train_mmm
from core.animeme.utterances import Utterances
from core.speech.phoneme import PHONEME_INDEX

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral


def dense(lengths, smoothness, order):
    blocks = []
    for n in lengths:
        difference = np.diff(np.eye(n), n=order, axis=0)
        blocks.append(smoothness * difference.T @ difference)
    total = np.zeros((sum(lengths), sum(lengths)))
    at = 0
    for block in blocks:
        total[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return total


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_band_is_that_of_the_differences_and_couples_no_two_sentences(order):
    lengths = [9, 2, 14]
    band, wanted = smoothness_band(lengths, 2.5, order), dense(lengths, 2.5, order)
    for below in range(order + 1):
        np.testing.assert_allclose(band[below, : 25 - below], np.diag(wanted, -below), atol=1e-9)
    assert np.abs(np.tril(wanted, -order - 1)).max() == 0


@pytest.mark.parametrize("is_refined", [False, True])
def test_the_path_is_that_of_a_dense_solve(known_model, babble, taught, is_refined):
    model = train_mmm(taught(known_model(PRINTED), babble(5)), 4.0, 2, is_refined)
    transcripts = babble(2, seed=8)
    times_s = [np.arange(int(t.duration_s * model.rate_hz)) / model.rate_hz for t in transcripts]
    said = model.values(Utterances.of(transcripts), times_s)
    phoneme = [
        PHONEME_INDEX[next(u.phone for u in reversed(t.phonemes) if u.start_s <= time_s)]
        for t, times in zip(transcripts, times_s)
        for time_s in times
    ]
    system = dense([len(times) for times in times_s], 4.0, 2)
    for u in range(2):
        weights = model.precisions[phoneme, u]
        wanted = np.linalg.solve(system + np.diag(weights), weights * model.means[phoneme, u])
        np.testing.assert_allclose(said[:, u], wanted, atol=1e-8)


def test_refining_lowers_the_error_on_what_was_learnt_from(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(8))
    errors = []
    for is_refined in (False, True):
        model = train_mmm(examples, 3.0, 2, is_refined)
        said = [model.curves(e.transcript, e.track.rate_hz).values - e.track.values for e in examples]
        errors.append(np.square(np.concatenate(said)).mean(axis=0))
    assert (errors[1] < 0.95 * errors[0]).all()


def test_stiff_smoothness_gives_a_straight_line_and_none_the_means(known_model, babble, taught):
    examples = taught(known_model(PRINTED), babble(4))
    (transcript,) = babble(1, seed=2)
    stiff = train_mmm(examples, 1e9, 2, False).curves(transcript, 60.0).values
    assert np.abs(np.diff(stiff, n=2, axis=0)).max() < 1e-4
    loose = train_mmm(examples, 0.0, 2, False)
    values = loose.curves(transcript, 60.0).values
    assert {tuple(np.round(v, 5)) for v in values} <= {tuple(np.round(m, 5)) for m in loose.means.astype(np.float32)}
