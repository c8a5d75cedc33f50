"""Recordings that a database keeps beside its motion nodes, untouched, to be measured against.

They lie in the group ``held_out`` of the file: ``positions``, raw as captured, and ``sentences``; their sound lies with
the sound of the other sentences.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from core.motion.captured_sentence import CapturedSentence
from core.motion.database_checks import (
    Unsound,
    check_captured,
    check_rate,
    check_sentences,
    plain_json,
    stored,
    stored_text,
)
from core.motion.marker_set import MarkerSet
from core.motion.recording import Recording

GROUP = "held_out"


def write_held_out(file, recordings: Sequence[Recording], marker_names: Sequence[str]) -> None:
    """Write the markers ``marker_names`` of ``recordings``, which have the same, into an open HDF5 file."""
    if not recordings:
        return
    columns = [recordings[0].marker_names.index(name) for name in marker_names]
    file.create_dataset(f"{GROUP}/rates_hz", data=np.array([r.rate_hz for r in recordings], np.float64))
    positions = [np.asarray(r.positions, np.float32)[:, columns] for r in recordings]
    file.create_dataset(f"{GROUP}/positions", data=np.concatenate(positions))
    stops = np.cumsum([len(p) for p in positions]).tolist()
    sentences = [
        CapturedSentence(r.sentence, r.emotion, r.text, start, stop, r.transcript)
        for r, start, stop in zip(recordings, [0, *stops], stops)
    ]
    file.create_dataset(f"{GROUP}/sentences", data=json.dumps([s.as_entry() for s in sentences]))


def read_held_out(file, names: Sequence[str], markers: MarkerSet) -> list[Recording]:
    """Read the recordings ``names`` from an open HDF5 file.

    They are without the path of a sound file: their sound is `MotionDatabase.audio_bytes`. Raises `Unsound`, or what
    h5py raises, for a file that was damaged or made up.
    """
    positions = stored(file, f"{GROUP}/positions", np.float32)
    rates_hz = stored(file, f"{GROUP}/rates_hz", np.float64)
    check_captured(positions, len(markers))
    sentences = [CapturedSentence.from_entry(entry) for entry in plain_json(stored_text(file, f"{GROUP}/sentences"))]
    check_sentences((s.name for s in sentences), ((s.start_frame, s.stop_frame) for s in sentences), len(positions))
    if rates_hz.shape != (len(sentences),):
        raise Unsound("its held-out sentences have no rates")
    for rate_hz in rates_hz:
        check_rate(rate_hz)
    row = {s.name: i for i, s in enumerate(sentences)}
    if not row.keys() >= set(names):
        raise Unsound("a sentence that was held out is not there")
    found = [(sentences[row[name]], float(rates_hz[row[name]])) for name in names]
    return [
        Recording(s.name, s.emotion, positions[s.start_frame : s.stop_frame], markers.names, rate_hz, s.transcript,
                  s.text)
        for s, rate_hz in found
    ]  # fmt: skip
