"""Faces trained on a real talker move their lips as he does, on sentences that they have not heard."""

from __future__ import annotations

import pytest

from core.evaluation.split import hold_out
from core.iface.lip_scores import captured_scores
from core.iface.model_file import MODERN, PAPER
from core.iface.training import train_face
from core.motion.build import build_database
from core.motion.readers.corpus_folder import read_corpus


@pytest.mark.prove
def test_lips_of_unheard_grid_sentences_are_followed(shared_data, tmp_path):
    database = build_database(hold_out(read_corpus(shared_data("grid-s1"))), tmp_path / "grid.h5")
    recordings = database.held_out_recordings("test")
    found = {v: captured_scores(train_face(database, v).face, database, recordings) for v in (PAPER, MODERN)}
    assert found[PAPER].lip_gap_r >= 0.80 and found[MODERN].lip_gap_r >= 0.86
    assert found[MODERN].lip_error_mm < found[PAPER].lip_error_mm < 1.6  # a still face: 2.2
