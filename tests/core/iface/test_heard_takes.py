"""Sound and motion frame by frame, from a database and from recordings that it does not hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.iface.heard_takes import database_takes, recorded_takes
from core.iface.speech_features import speech_features
from core.media.audio import load_audio
from core.motion.head_space import in_head_space

LOW_LIP, UP = 4, 1


def test_a_take_is_what_was_captured_while_that_was_heard(loud_database, loud_corpus):
    takes = database_takes(loud_database)
    assert [take.name for take in takes] == [sentence.name for sentence in loud_database.sentences]
    by_name = {recording.sentence: recording for recording in loud_corpus.recordings}
    for take in takes:
        recording = by_name[take.name]
        assert (take.emotion, take.transcript) == (recording.emotion, recording.transcript)
        assert len(take) == len(take.displacements) == len(take.used) and take.used.all()
        assert abs(len(take) - recording.transcript.duration_s * 30) <= 1
        np.testing.assert_allclose(take.features, speech_features(load_audio(recording.audio), len(take)), atol=0.05)
        face = in_head_space(recording, loud_database.markers, loud_database.with_scale).face
        seen = (face - loud_database.markers.rest)[::2][: len(take)]  # 60 Hz
        assert np.abs(take.displacements[: len(seen)] - seen).max() < 1.0
        loud, opening = take.features[:, 0], -take.displacements[:, LOW_LIP, UP]
        assert np.corrcoef(loud, opening)[0, 1] > 0.4


def test_a_recording_becomes_what_it_would_be_in_the_database(loud_database, loud_corpus):
    kept = {take.name: take for take in database_takes(loud_database)}
    recordings = [recording for recording in loud_corpus.recordings if recording.sentence in kept]
    for take in recorded_takes(loud_database, recordings):
        same = kept[take.name]
        assert abs(len(take) - len(same)) <= 1
        n = min(len(take), len(same)) - 1
        np.testing.assert_allclose(take.displacements[:n], same.displacements[:n], atol=0.05)
        np.testing.assert_allclose(take.features[:n], same.features[:n], atol=0.05)


def test_held_out_sound_is_found_in_the_database(loud_database):
    held_out = loud_database.held_out_recordings("test")
    assert all(recording.audio is None for recording in held_out)
    takes = recorded_takes(loud_database, held_out)
    assert [take.name for take in takes] == ["s10", "s11"] and all(take.used.all() for take in takes)


def test_what_long_gaps_hide_is_not_used(loud_database, loud_corpus):
    recording = loud_corpus.recordings[0]
    positions = recording.positions.copy()
    positions[30:60, LOW_LIP] = np.nan  # at 60 Hz: frames 15 to 29 of the take
    (take,) = recorded_takes(loud_database, [replace(recording, positions=positions)])
    np.testing.assert_array_equal(np.flatnonzero(~take.used), np.arange(15, 30))
    assert np.isfinite(take.displacements).all()


def test_without_sound_there_is_nothing_to_hear(loud_database, loud_corpus):
    stranger = replace(loud_corpus.recordings[0], sentence="unheard", audio=None)
    with pytest.raises(UserFacingError, match="no sound of sentence 'unheard'"):
        recorded_takes(loud_database, [stranger])
