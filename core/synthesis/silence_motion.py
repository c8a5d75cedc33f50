"""Silence as motion of its own: breath, blinks and lips that settle, as they were captured in silences.

Named as future work by Deng and Neumann (2008), who interpolate. Motion nodes hold no silence, but the frames of the
captured sentences do: before speech, between phones, and after it.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from core.motion.database import MotionDatabase
from core.motion.resample import frame_bounds
from core.search.terms import warp_matrix
from core.speech.emotion import EMOTION_INDEX
from core.speech.phoneme import PAU, PHONEME_INDEX
from core.synthesis.blinks import CapturedBlinks
from core.synthesis.concatenate import SlotFrames

_NEAR_SPEECH_S = 0.15  # how long before and after speech the mouth still belongs to it
_SETTLED_S = 0.3  # shorter stretches of settled face are not worth a join
_EASE_S = 0.125  # a gap where pieces meet decays to 1/e in this time
_LONG_PAUSE_S = 0.6  # beyond this, a pause is the end of one utterance and the beginning of the next
_SHORTFALL_S = 0.15  # a piece that is short by this much counts as twice as far off
_LEAST_GAP_MM2 = 1.0
_OTHER_EMOTION_MM2 = 1e6


@dataclass(frozen=True)
class _Pieces:
    """Captured silences of one kind: frame ranges, and the emotion of their sentences; int, shape (n_pieces,)."""

    start: np.ndarray
    stop: np.ndarray
    emotion: np.ndarray

    @classmethod
    def of(cls, found: list[tuple[int, int, int]]) -> _Pieces:
        return cls(*np.array(found, int).reshape(-1, 3).T)

    def __len__(self) -> int:
        return len(self.start)


class CapturedSilences:
    """The silences of a database, by where they stand.

    frames : float, shape (n_frames, n_dims), the database's coefficients, or what was made of them
    """

    def __init__(self, database: MotionDatabase, frames: np.ndarray) -> None:
        self._frames = frames
        self._rest = database.rest_coefficients
        self._rate_hz = database.rate_hz
        kinds: dict[str, list[tuple[int, int, int]]] = {"opening": [], "between": [], "closing": [], "settled": []}
        margin = round(_NEAR_SPEECH_S * self._rate_hz)
        for sentence in database.sentences:
            utterances = sentence.transcript.phonemes
            bounds = frame_bounds([u.start_s for u in utterances], [u.end_s for u in utterances], self._rate_hz)
            emotion, last = EMOTION_INDEX[sentence.emotion], len(utterances) - 1
            runs = itertools.groupby(zip(range(last + 1), *bounds), key=lambda entry: utterances[entry[0]].phone == PAU)
            for is_silent, run in runs:
                entries = list(run)
                if not is_silent:
                    continue
                start = sentence.start_frame + int(entries[0][1])
                stop = min(sentence.start_frame + int(entries[-1][2]), sentence.stop_frame)
                opens, closes = entries[0][0] == 0, entries[-1][0] == last
                if stop - start < 3 or (opens and closes):
                    continue
                kinds["opening" if opens else "closing" if closes else "between"].append((start, stop, emotion))
                settled = (start + margin * (not opens), stop - margin * (not closes), emotion)
                if settled[1] - settled[0] >= _SETTLED_S * self._rate_hz:
                    kinds["settled"].append(settled)
        self._blinks = CapturedBlinks(database, frames)
        self._pieces = {kind: _Pieces.of(found) for kind, found in kinds.items()}

    def fill(
        self, motion: np.ndarray, phonemes: np.ndarray, slots: SlotFrames, emotions: np.ndarray, taken: set[int]
    ) -> np.ndarray:
        """Replace the frames of silent slots by captured silence that fits what stands on either side.

        motion : shape (n_frames, n_dims); emotions : shape (n_slots, n_emotions), rows sum to 1
        taken : first frames of pieces that something else uses, left alone if there are others; those used are added
        returns : a copy with silence filled in
        """
        filled = np.array(motion, float)
        silent = np.asarray(phonemes) == PHONEME_INDEX[PAU]
        p = 0
        while p < len(silent):
            if not silent[p]:
                p += 1
                continue
            first = p
            while p < len(silent) and silent[p]:
                p += 1
            start, stop = int(slots.start[first]), int(slots.stop[p - 1])
            if stop > start:
                before = filled[start - 1] if start > 0 else None
                after = filled[stop] if stop < len(filled) else None
                filled[start:stop] = self._silence(before, after, stop - start, emotions[first], taken)
        return filled

    def _silence(
        self, before: np.ndarray | None, after: np.ndarray | None, n: int, emotion: np.ndarray, taken: set[int]
    ) -> np.ndarray:
        if before is None and after is None:
            return self._onward(self._rest, n, "settled", emotion, taken)
        if before is None:
            return self._onward(after, n, "opening", emotion, taken)[::-1]
        if after is None:
            return self._onward(before, n, "closing", emotion, taken)
        if n <= _LONG_PAUSE_S * self._rate_hz:
            return self._between(before, after, n, emotion, taken)
        closing = self._onward(before, n, "closing", emotion, taken)
        opening = self._onward(after, n, "opening", emotion, taken)[::-1]
        share = np.clip(0.5 + (np.arange(n) - (n - 1) / 2) / (_SETTLED_S * self._rate_hz), 0.0, 1.0)[:, None]
        return closing + share * share * (3.0 - 2.0 * share) * (opening - closing)

    def _between(
        self, before: np.ndarray, after: np.ndarray, n: int, emotion: np.ndarray, taken: set[int]
    ) -> np.ndarray:
        """A pause of about this length, warped to it; what it misses at either end is spread over it."""
        share = (np.arange(1, n + 1) / (n + 1))[:, None]
        pieces = self._pieces["between"]
        if not len(pieces):
            return before + share * (after - before)
        heads, tails = self._frames[pieces.start], self._frames[pieces.stop - 1]
        gap = ((heads - before) ** 2).sum(axis=1) + ((tails - after) ** 2).sum(axis=1) + _LEAST_GAP_MM2
        lengths = pieces.stop - pieces.start
        row = self._choose(pieces, gap * (1.0 + np.log(n / lengths) ** 2), emotion, taken)
        made = warp_matrix(int(lengths[row]), n) @ self._frames[pieces.start[row] : pieces.stop[row]]
        return made + (1.0 - share) * (before - made[0]) + share * (after - made[-1])

    def _onward(self, pose: np.ndarray, n: int, kind: str, emotion: np.ndarray, taken: set[int]) -> np.ndarray:
        """``n`` frames that lead away from ``pose``; those of an opening lead backwards in time.

        Settled stretches follow until there is enough; without any the face goes to rest, and only blinks.
        """
        backwards = kind == "opening"
        made = np.zeros((0, len(pose)))
        while len(made) < n:
            pieces = self._pieces[kind]
            pose = made[-1] if len(made) else pose
            wanted = n - len(made)
            if len(pieces):
                heads = self._frames[pieces.stop - 1 if backwards else pieces.start]
                short_s = (wanted - (pieces.stop - pieces.start)).clip(0) / self._rate_hz
                gap = ((heads - pose) ** 2).sum(axis=1) + _LEAST_GAP_MM2
                row = self._choose(pieces, gap * (1.0 + short_s / _SHORTFALL_S), emotion, taken)
                piece = np.array(self._frames[pieces.start[row] : pieces.stop[row]], float)
                piece = (piece[::-1] if backwards else piece)[:wanted]
            else:
                # no silence as long was captured: to rest, or, once there is something, stay, and blink
                still = made[-1:] if len(made) else self._rest[None]
                piece = still + self._blinks.within(wanted, seed=wanted)
            fading = np.exp(-np.arange(len(piece)) / (_EASE_S * self._rate_hz))[:, None]
            made = np.concatenate([made, piece + fading * (pose - piece[0])])
            kind = "settled"
        return made

    @staticmethod
    def _choose(pieces: _Pieces, cost: np.ndarray, emotion: np.ndarray, taken: set[int]) -> int:
        cost = cost + _OTHER_EMOTION_MM2 * (1.0 - emotion[pieces.emotion])
        used = np.isin(pieces.start, list(taken))
        row = int(np.where(used, np.inf, cost).argmin() if not used.all() else cost.argmin())
        taken.add(int(pieces.start[row]))
        return row
