"""The solution on show is what a search from nothing finds, after whatever edits."""

from __future__ import annotations

import random

import numpy as np
import pytest

from core.document.document import Document
from core.document.edits import SetSpeech
from core.document.live_search import LiveSearch
from core.errors import UserFacingError
from core.motion.database import open_database
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.engine import SearchEngine
from core.synthesis.options import PAPER
from tests.core.document.random_edits import made_speech, random_edit
from tests.core.document.random_walk import RandomWalk


@pytest.fixture(scope="module")
def database(database_path):
    return open_database(database_path)


def cold(database, document):
    """Search every node in every slot, with nothing left from before."""
    engine = SearchEngine(database, NumpyKernels(), document.weights, options=PAPER)
    request = engine.request(document.speech_input())
    return find_path(request, engine.costs, engine.prepared_kernels())


def follow(database, seed: int, n_edits: int, every: int) -> int:
    """Edit, undo and redo at random; return how often the request could not be satisfied, by either search."""
    chance, document = random.Random(seed), Document(face=None)
    document.apply(SetSpeech.on(document, made_speech(seed)))
    document.take_database(database, {})
    # the paper's setting makes the motion of one path, which is quick; the path is what this is about
    live = LiveSearch(SearchEngine(database, NumpyKernels(), options=PAPER))
    infeasible, walk = 0, RandomWalk(document, chance)
    for i in range(n_edits):
        if not walk.undo_or_redo() and walk.edit() is None:
            continue
        try:
            shown = live.answer(document.speech_input(), document.weights).path
        except UserFacingError:
            infeasible += 1
            with pytest.raises(UserFacingError):
                cold(database, document)
            continue
        if chance.random() < 0.2:
            priced = live.price()
            assert priced.path is shown
            assert (priced.prices[range(len(shown.nodes)), shown.nodes] == 0.0).all()
        if i % every == 0:
            found = cold(database, document)
            assert shown.nodes.tolist() == found.nodes.tolist()
            assert shown.cost == found.cost
    return infeasible


def test_edits_are_answered_as_from_nothing(database):
    follow(database, seed=1, n_edits=60, every=1)


@pytest.mark.prove
@pytest.mark.parametrize("seed", range(3))
def test_2000_edits_are_answered_as_from_nothing(database, seed):
    assert follow(database, seed, n_edits=2000, every=1) < 1000


def test_the_motion_is_the_engines_own(database):
    chance, document = random.Random(3), Document(face=None)
    document.apply(SetSpeech.on(document, made_speech(3)))
    document.take_database(database, {})
    live = LiveSearch(SearchEngine(database, NumpyKernels()))
    for _ in range(6):
        edit = random_edit(document, chance)
        if edit is not None:
            document.apply(edit)
        try:
            shown = live.answer(document.speech_input(), document.weights)
        except UserFacingError:
            continue
        alone = SearchEngine(database, NumpyKernels(), document.weights).synthesise(document.speech_input())
        assert np.array_equal(shown.motion.positions, alone.motion.positions)


def test_a_price_is_what_forcing_a_node_costs(database):
    document = Document(face=None)
    document.apply(SetSpeech.on(document, made_speech(5)))
    document.take_database(database, {})
    live = LiveSearch(SearchEngine(database, NumpyKernels(), options=PAPER))
    path = live.answer(document.speech_input()).path
    priced = live.price()
    for slot, node in ((0, 3), (4, 50), (8, 90)):
        document.pins = {slot: database.nodes.name(node)}
        forced = cold(database, document)
        assert priced.prices[slot, node] == pytest.approx(forced.cost - path.cost, rel=1e-9, abs=1e-9 * forced.cost)
    document.pins = {}
    assert sum(sum(row.values()) for row in priced.breakdown) == pytest.approx(path.cost, rel=1e-6)
