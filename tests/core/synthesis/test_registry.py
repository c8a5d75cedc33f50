"""Every engine has one name, and answers the same question."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import pytest

from core.errors import UserFacingError
from core.search.compute import NumpyKernels
from core.search.weights import SearchWeights
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.engine import SpeechInput
from core.synthesis.registry import DEFAULT_ENGINE, ENGINES, engine_kind, make_engine, make_engines, weights_of
from tests.core.evaluation.conftest import mouth_corpus, mouth_database  # noqa: F401


@pytest.fixture
def speech():
    phones = ("pau", "m", "aa", "k", "pau")
    spoken = tuple(PhonemeUtterance(p, 0.2 * i, 0.2 * i + 0.2) for i, p in enumerate(phones))
    return SpeechInput(Transcript(spoken, (), 1.0))


@pytest.mark.parametrize("name", [name for name, kind in ENGINES.items() if not kind.listens])
def test_an_engine_animates_all_of_the_speech_and_a_search_alone_has_a_path(mouth_database, speech, name):
    answer = make_engine(name, mouth_database, NumpyKernels()).synthesise(speech)
    n_frames = len(answer.motion.positions)
    assert n_frames == pytest.approx(answer.motion.rate_hz * speech.transcript.duration_s, abs=1)
    assert (getattr(answer, "path", None) is not None) == engine_kind(name).searches
    assert isinstance(answer.warnings, tuple)


def test_engines_that_live_side_by_side_compute_on_kernels_of_their_own(mouth_database):
    engines = make_engines(["search", "search-single"], mouth_database, NumpyKernels)
    assert engines["search"].kernels is not engines["search-single"].kernels
    assert engines["search"].options.n_paths > engines["search-single"].options.n_paths == 1


def test_only_the_search_as_printed_leaves_out_what_goes_beyond_the_paper(mouth_database):
    beyond = SearchWeights(pnt=3.0, context_before=1.0, duration=2.0)
    assert weights_of("search-paper", mouth_database, beyond) == beyond.as_printed != beyond
    assert weights_of("search-paper", mouth_database) == mouth_database.paper_weights
    assert weights_of("search-single", mouth_database, beyond) is beyond
    assert weights_of(DEFAULT_ENGINE, mouth_database) == mouth_database.weights
    assert make_engine("search-paper", mouth_database, NumpyKernels(), beyond).weights == beyond.as_printed


def test_what_is_offered_begins_with_no_rival_and_an_unknown_engine_is_told(mouth_database):
    assert ENGINES[DEFAULT_ENGINE].is_offered and not ENGINES["random"].is_offered
    with pytest.raises(UserFacingError, match="no engine 'magic'"):
        make_engine("magic", mouth_database, NumpyKernels())
