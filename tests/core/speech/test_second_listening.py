"""A boundary that is put elsewhere loses confidence, and only that one; words that are not said have none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.media.audio import load_audio
from core.speech.aligner import align
from core.speech.phoneme import PAU
from core.speech.second_listening import AlignmentConfidence, listen_again
from core.speech.transcript import Transcript

GRID = Path(__file__).resolve().parents[3] / "../shared/data/grid-s1"
needs_data = pytest.mark.skipif(not GRID.is_dir(), reason="the shared test data is not beside the repository")


def _moved(transcript, row, by_s):
    phonemes = list(transcript.phonemes)
    phonemes[row] = replace(phonemes[row], end_s=phonemes[row].end_s + by_s)
    phonemes[row + 1] = replace(phonemes[row + 1], start_s=phonemes[row + 1].start_s + by_s)
    return Transcript(tuple(phonemes), transcript.words, transcript.duration_s)


def _clip():
    path = sorted((GRID / "audio").glob("*.flac"))[40]
    words = [line.split()[2] for line in (GRID / f"align/{path.stem}.align").read_text().splitlines()]
    audio = load_audio(path)
    return audio, align(audio, " ".join(word for word in words if word not in ("sil", "sp")))


@needs_data
def test_a_boundary_moved_by_hand_is_found_among_the_others():
    audio, transcript = _clip()
    before = listen_again(audio, transcript)
    spoken = [i for i, u in enumerate(transcript.phonemes) if u.phone != PAU]
    assert np.isnan(before.confidence[[i for i, u in enumerate(transcript.phonemes) if u.phone == PAU]]).all()
    assert np.isfinite(before.confidence[spoken]).all()
    row = max(spoken[1:-1], key=lambda i: transcript.phonemes[i + 1].end_s - transcript.phonemes[i + 1].start_s)
    by_s = 0.8 * (transcript.phonemes[row + 1].end_s - transcript.phonemes[row + 1].start_s)
    after = listen_again(audio, _moved(transcript, row, by_s))
    for touched in (row, row + 1):
        assert after.shift_s[touched] == pytest.approx(by_s, abs=before.shift_s[[row, row + 1]].max() + 1e-9)
    others = [i for i in spoken if i not in (row, row + 1)]
    np.testing.assert_array_equal(after.shift_s[others], before.shift_s[others])


@needs_data
def test_the_same_sound_gives_the_same_answer_and_a_late_transcript_a_poor_one():
    audio, transcript = _clip()
    first, again = listen_again(audio, transcript), listen_again(audio, transcript)
    np.testing.assert_array_equal(first.shift_s, again.shift_s)
    late = Transcript.covering(
        [replace(u, start_s=u.start_s + 0.2, end_s=u.end_s + 0.2) for u in transcript.phonemes if u.phone != PAU],
        [replace(w, start_s=w.start_s + 0.2, end_s=w.end_s + 0.2) for w in transcript.words],
        transcript.duration_s,
    )
    assert listen_again(audio, late).of_sentence < 0.2 < first.of_sentence


def test_confidence_is_a_half_at_fifty_milliseconds_and_silence_has_none():
    judged = AlignmentConfidence(np.array([np.nan, 0.0, 0.05, 0.5]))
    np.testing.assert_allclose(judged.confidence, [np.nan, 1.0, 0.5, 1 / 101])
    assert AlignmentConfidence(np.array([np.nan])).of_sentence == 1.0
    assert judged.of_sentence == pytest.approx(1 / 101)
