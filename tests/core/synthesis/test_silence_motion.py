"""Silence as it was captured."""

import numpy as np
import pytest

from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX
from core.synthesis.concatenate import SlotFrames
from core.synthesis.silence_motion import CapturedSilences

ANY = np.ones(len(EMOTIONS))
PAU, AA = PHONEME_INDEX["pau"], PHONEME_INDEX["aa"]


def slots_of(lengths):
    stop = np.cumsum(lengths)
    return SlotFrames(stop - np.asarray(lengths), stop)


def sentence_of(database, s):
    """Frames, phonemes and slots of a captured sentence."""
    sentence = database.sentences[s]
    spoken = sentence.transcript.phonemes
    slots = SlotFrames.of([u.start_s for u in spoken], [u.end_s for u in spoken], database.rate_hz)
    phonemes = np.array([PHONEME_INDEX[u.phone] for u in spoken])
    return database.frames[sentence.start_frame : sentence.stop_frame].astype(float), phonemes, slots


def everywhere(phonemes):
    return np.tile(ANY, (len(phonemes), 1))


def test_a_captured_sentence_gets_its_own_silences_at_the_ends_back(talking_database):
    for seed in range(4):
        database = talking_database(seed, n_sentences=1)
        silences = CapturedSilences(database, database.frames)
        captured, phonemes, slots = sentence_of(database, 0)
        mute = captured.copy()
        for p in np.flatnonzero(phonemes == PAU):
            mute[slots.start[p] : slots.stop[p]] = np.nan
        filled = silences.fill(mute, phonemes, slots, everywhere(phonemes), set())
        assert np.array_equal(
            filled[phonemes[frame_slots(slots)] != PAU], captured[phonemes[frame_slots(slots)] != PAU]
        )
        assert np.isfinite(filled).all()
        # one frame beside speech stands for the other, and their difference dies away
        settled = round(0.7 * database.rate_hz)
        assert filled[: slots.stop[0] - settled] == pytest.approx(captured[: slots.stop[0] - settled], abs=0.05)
        assert filled[slots.start[-1] + settled :] == pytest.approx(captured[slots.start[-1] + settled :], abs=0.05)


def frame_slots(slots):
    return np.repeat(np.arange(len(slots.start)), slots.stop - slots.start)


@pytest.mark.parametrize("n_silent", [1, 5, 25, 200])
def test_silence_joins_speech_without_a_jump(talking_database, n_silent):
    database = talking_database(2)
    silences = CapturedSilences(database, database.frames)
    speech = database.frames[database.nodes.start[5] : database.nodes.stop[5]].astype(float)
    lengths = [n_silent, len(speech), n_silent, len(speech), n_silent]
    motion = np.full((sum(lengths), 6), np.nan)
    slots = slots_of(lengths)
    for p in (1, 3):
        motion[slots.start[p] : slots.stop[p]] = speech
    filled = silences.fill(motion, [PAU, AA, PAU, AA, PAU], slots, everywhere(lengths), set())
    assert np.isfinite(filled).all()
    steps = np.abs(np.diff(filled, axis=0)).max(axis=1)
    joins = np.concatenate([slots.start[1:], slots.stop[:-1]]) - 1
    assert steps[joins].max() <= np.abs(np.diff(database.frames, axis=0)).max() + 1.0


@pytest.mark.parametrize("every_s", [1.0, 4.0])
def test_long_silence_blinks_as_often_as_the_captured_ones(talking_database, every_s):
    database = talking_database(3, n_sentences=60, blink_every_s=every_s)
    silences = CapturedSilences(database, database.frames)
    seconds = 60
    n = round(seconds * database.rate_hz)
    filled = silences.fill(np.zeros((n, 6)), [PAU], slots_of([n]), ANY[None], set())

    def blinks_a_second(track):
        shut = track < -2.5
        return np.count_nonzero(shut[1:] & ~shut[:-1]) / (len(track) / database.rate_hz)

    beside = round(0.25 * database.rate_hz)
    quiet = []
    for s in range(60):
        captured, _, slots = sentence_of(database, s)
        quiet += [captured[: slots.stop[0] - beside, 0], captured[slots.start[-1] + beside :, 0]]
    assert blinks_a_second(filled[:, 0]) == pytest.approx(blinks_a_second(np.concatenate(quiet)), rel=0.35)


def test_pieces_are_of_the_emotion_asked_for(talking_database):
    database = talking_database(4, emotions=("neutral", "anger"))
    silences = CapturedSilences(database, database.frames)
    for emotion, level in (("neutral", 0.0), ("anger", 2.0 * EMOTION_INDEX["anger"])):
        wanted = np.eye(len(EMOTIONS))[[EMOTION_INDEX[emotion]]]
        filled = silences.fill(np.zeros((300, 6)), [PAU], slots_of([300]), wanted, set())
        assert np.median(filled[100:, 1]) == pytest.approx(level, abs=0.3)


def test_what_is_taken_is_left_to_others(talking_database):
    database = talking_database(5)
    silences = CapturedSilences(database, database.frames)
    captured, phonemes, slots = sentence_of(database, 0)
    taken = set()
    first = silences.fill(captured, phonemes, slots, everywhere(phonemes), taken)
    used = set(taken)
    second = silences.fill(captured, phonemes, slots, everywhere(phonemes), taken)
    assert len(used) == 3 and len(taken) == 6
    assert np.abs(first - second)[: slots.stop[0]].max() > 0.05


def test_without_captured_silence_the_face_goes_to_rest(talking_database):
    database = talking_database(6, silence_s=0.02)
    silences = CapturedSilences(database, database.frames)
    motion = np.full((300, 6), 3.0)
    filled = silences.fill(motion, [PAU, AA, PAU], slots_of([130, 40, 130]), everywhere(range(3)), set())
    assert filled[:20] == pytest.approx(np.tile(database.rest_coefficients, (20, 1)), abs=0.01)
    assert filled[-20:] == pytest.approx(np.tile(database.rest_coefficients, (20, 1)), abs=0.01)
    assert filled[130:170] == pytest.approx(3.0)
    assert np.abs(np.diff(filled, axis=0)).max() < 1.0
