"""Larger databases than there are captures for: a database repeated with fresh variation, to measure growth."""

from __future__ import annotations

import numpy as np

from core.motion.node import NodeTable, NodeTableBuilder
from core.speech.phoneme import PAU, PHONEMES


def replicated(
    frames: np.ndarray, nodes: NodeTable, n_nodes: int, rate_hz: float, seed: int = 2008
) -> tuple[np.ndarray, NodeTable]:
    """Return frames and nodes of a database with exactly ``n_nodes`` nodes made by repeating this one's sentences.

    The first round is the database itself. In later rounds a sentence is stretched by up to 15 %, its motion scaled by
    up to 10 %, moved by a slow drift of a tenth of each coefficient's deviation, and its phones keep their order: joins
    between copies are as imperfect as between two takes of one sentence. Silence between nodes is not repeated.
    """
    rng = np.random.default_rng(seed)
    deviation = frames.std(axis=0)
    builder = NodeTableBuilder()
    pieces: list[np.ndarray] = []
    made = first = take = 0
    while made < n_nodes:
        for s, name in enumerate(nodes.sentence_names):
            rows = np.flatnonzero(nodes.sentence == s)[: n_nodes - made]
            if len(rows) == 0:
                continue
            phones, lengths, motion = _sentence(frames, nodes, rows)
            if take:
                lengths, motion = varied(rng, lengths, motion, deviation, rate_hz)
            stops = lengths.cumsum()
            masked = np.zeros(len(motion), bool)
            builder.add_sentence(
                f"{name}-{take}", int(nodes.emotion[rows[0]]), phones, stops - lengths, stops, masked, first
            )
            pieces.append(motion.astype(np.float32))
            first += len(motion)
            made += len(rows)
        take += 1
    return np.concatenate(pieces), builder.table()


def _sentence(frames: np.ndarray, nodes: NodeTable, rows: np.ndarray) -> tuple[list[int], np.ndarray, np.ndarray]:
    """Phones, lengths and frames of consecutive nodes; a broken chain becomes an empty silence."""
    phones, lengths, motion = [], [], []
    for row in rows:
        if phones and nodes.pre[row] < 0:
            phones.append(PHONEMES.index(PAU))
            lengths.append(0)
        phones.append(int(nodes.phoneme[row]))
        lengths.append(int(nodes.n_frames[row]))
        motion.append(frames[nodes.start[row] : nodes.stop[row]])
    return phones, np.array(lengths), np.concatenate(motion)


def varied(
    rng: np.random.Generator, lengths: np.ndarray, motion: np.ndarray, deviation: np.ndarray, rate_hz: float
) -> tuple[np.ndarray, np.ndarray]:
    """Say a sentence once more: stretched by up to 15 %, scaled by up to 10 %, with a slow drift.

    lengths : int, shape (n_phones,), frames of each; motion : shape (n_frames, n_dims)
    deviation : shape (n_dims,); a tenth of it is the size of the drift
    returns : the new lengths, and frames as many as their sum
    """
    stretch = rng.uniform(0.85, 1.15)
    longer = np.where(lengths > 0, np.maximum(np.rint(lengths * stretch), 1), 0).astype(int)
    n_frames = int(longer.sum())
    place = np.linspace(0, len(motion) - 1, n_frames)
    low = np.minimum(place.astype(int), max(len(motion) - 2, 0))
    share = (place - low)[:, None]
    warped = motion[low] * (1 - share) + motion[np.minimum(low + 1, len(motion) - 1)] * share
    seconds = np.arange(n_frames)[:, None] / rate_hz
    phase, speed_hz = rng.uniform(0, 2 * np.pi, len(deviation)), rng.uniform(0.2, 1.0, len(deviation))
    drift = 0.1 * deviation * np.sin(2 * np.pi * speed_hz * seconds + phase)
    return longer, warped * rng.uniform(0.9, 1.1) + drift
