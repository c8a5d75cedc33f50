"""Which phonemes are near which frame."""

from __future__ import annotations

import numpy as np

from core.animeme.form import BEST
from core.animeme.utterances import Nearby, Utterances
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import PhonemeUtterance, Transcript


def test_pairs_are_those_of_a_plain_loop_and_never_cross_sentences(babble):
    transcripts = babble(3, said=7)
    utterances = Utterances.of(transcripts)
    times_s = [np.arange(int(t.duration_s * 30)) / 30 for t in transcripts]
    nearby = Nearby.of(utterances, times_s, 2)
    wanted, frame = [], 0
    for s, (transcript, times) in enumerate(zip(transcripts, times_s)):
        for time_s in times:
            now = max(p for p, u in enumerate(transcript.phonemes) if u.start_s <= time_s)
            for p in range(max(0, now - 2), min(6, now + 2) + 1):
                said = transcript.phonemes[p]
                wanted.append((frame, 7 * s + p, time_s - (said.start_s + said.end_s) / 2))
            frame += 1
    assert nearby.n_frames == frame
    np.testing.assert_allclose(np.c_[nearby.frame, nearby.utterance, nearby.offset_s], wanted, atol=1e-12)


def test_beyond_the_edges_of_a_sentence_is_silence(babble):
    utterances = Utterances.of(babble(2, said=3, phones=("b", "aa")))
    pau = PHONEME_INDEX["pau"]
    assert utterances.previous[[0, 3]].tolist() == utterances.following[[2, 5]].tolist() == [pau, pau]
    np.testing.assert_array_equal(utterances.previous[1:3], utterances.phoneme[0:2])
    np.testing.assert_array_equal(utterances.following[3:5], utterances.phoneme[4:6])


def test_a_phoneme_without_length_is_no_trouble(known_model):
    spoken = (PhonemeUtterance("b", 0.0, 0.1), PhonemeUtterance("aa", 0.1, 0.1), PhonemeUtterance("k", 0.1, 0.3))
    track = known_model(BEST).curves(Transcript(spoken, (), 0.3), 60.0)
    assert np.isfinite(track.values).all()
