"""Captured motion of the right phones, otherwise any: what the search has to be better than."""

from __future__ import annotations

import numpy as np

from core.evaluation.engines.static_face import PlainAnswer
from core.progress import SILENT, Progress
from core.search.engine import SearchEngine
from core.speech.phoneme import VISEME_OF_PHONEME
from core.synthesis.concatenate import SlotFrames
from core.synthesis.engine import SpeechInput


class RandomNodes:
    """For each phone a random motion node of that phone and of the emotion wanted most, laid out as the search does.

    Where the database has none of that emotion any other will do, then one of its viseme class, then any at all. The
    choice is seeded, and goes on from sentence to sentence.
    """

    name = "random"

    def __init__(self, search: SearchEngine, seed: int = 2008) -> None:
        self._search = search
        self._rng = np.random.default_rng(seed)

    def prepare(self, progress: Progress = SILENT) -> None:
        """Nothing is to be done before the first sentence."""

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> PlainAnswer:
        """Draw a path and lay it out."""
        request, nodes = self._search.request(speech), self._search.database.nodes
        viseme = np.asarray(VISEME_OF_PHONEME)
        path = []
        for phone, mix in zip(request.phonemes, request.emotions):
            same = nodes.phoneme == phone
            likely = (same & (nodes.emotion == mix.argmax()), same, nodes.viseme == viseme[phone], nodes.phoneme >= 0)
            rows = next(rows for rows in likely if rows.any())
            path.append(int(self._rng.choice(np.flatnonzero(rows))))
        starts_s, ends_s = zip(*((u.start_s, u.end_s) for u in speech.transcript.phonemes))
        slots = SlotFrames.of(starts_s, ends_s, self._search.database.rate_hz)
        return PlainAnswer(self._search.motion_of(np.array(path), request.phonemes, slots))
