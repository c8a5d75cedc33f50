"""A capture of some words under another voice that says the same: its frames at that voice's times."""

from __future__ import annotations

import numpy as np

from core.speech.phoneme import PAU
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.marker_motion import MarkerMotion


def dubbed(motion: MarkerMotion, said: Transcript, heard: Transcript) -> MarkerMotion:
    """Return ``motion``, captured as ``said``, at the times of ``heard``, which has the same words.

    Phone by phone, each stretched to the length that it has in what is heard; silences before, between and after with
    them. Where the two were not aligned to the same phones, speech is stretched as a whole, from its first phone to
    its last.
    """
    wanted_s, known_s = matched_times_s(heard, said)
    n_frames = max(1, round(heard.duration_s * motion.rate_hz))
    times_s = np.interp(np.arange(n_frames) / motion.rate_hz, wanted_s, known_s)
    return MarkerMotion(motion.at_times(times_s), motion.rate_hz, motion.markers)


def matched_times_s(one: Transcript, other: Transcript) -> tuple[np.ndarray, np.ndarray]:
    """Return moments of two transcripts of the same words that belong together, both ascending, seconds."""
    of_one, of_other = _spoken(one), _spoken(other)
    if [u.phone for u in of_one] == [u.phone for u in of_other]:
        pairs = [(a.start_s, b.start_s) for a, b in zip(of_one, of_other)]
        pairs += [(a.end_s, b.end_s) for a, b in zip(of_one, of_other)]
    else:
        pairs = [(of_one[0].start_s, of_other[0].start_s), (of_one[-1].end_s, of_other[-1].end_s)]
    pairs = sorted({(0.0, 0.0), *pairs, (one.duration_s, other.duration_s)})
    return tuple(np.array(times) for times in zip(*pairs))


def _spoken(transcript: Transcript) -> list[PhonemeUtterance]:
    spoken = [u for u in transcript.phonemes if u.phone != PAU]
    return spoken or list(transcript.phonemes)
