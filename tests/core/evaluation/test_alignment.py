from pathlib import Path

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.alignment import (
    BoundaryErrors,
    measure_demo,
    measure_grid,
    phone_boundary_errors,
    read_word_times,
    word_boundary_errors,
)
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

GRID = Path(__file__).resolve().parents[3] / "../shared/data/grid-s1"
needs_data = pytest.mark.skipif(not GRID.is_dir(), reason="the shared test data is not beside the repository")


def phones(*labels):
    """A transcript of (phone, end_s), from 0 s."""
    edges = [0.0, *(end_s for _, end_s in labels)]
    return Transcript.covering(
        [PhonemeUtterance(name, a, b) for (name, _), a, b in zip(labels, edges, edges[1:])], [], edges[-1]
    )


def test_figures_of_five_errors_by_hand():
    figures = BoundaryErrors("word starts", np.array([0.01, -0.02, 0.03, -0.05, 0.2])).figures()
    assert figures == {
        "boundaries": "word starts",
        "n": 5,
        "median_ms": 30.0,
        "p90_ms": pytest.approx(50 + 0.6 * 150),
        "bias_ms": 10.0,
        "within_20ms": 0.4,
        "within_50ms": 0.8,
    }


def test_a_limit_is_inside_whatever_the_rounding_of_sums():
    errors = np.array([0.35 - 0.3, 0.3 - 0.35, 1.12 - 1.1])
    assert BoundaryErrors("", errors).figures()["within_50ms"] == 1.0
    assert BoundaryErrors("", errors).figures()["within_20ms"] == pytest.approx(1 / 3)


def test_no_boundary_has_no_figures():
    figures = BoundaryErrors("none", np.zeros(0)).figures()
    assert figures["n"] == 0 and figures["median_ms"] is None and figures["within_50ms"] is None


def test_words_are_compared_at_both_ends():
    truth = [WordUtterance("bin", 0.5, 0.75), WordUtterance("blue", 0.75, 1.0)]
    ours = Transcript((), (WordUtterance("bin", 0.25, 0.75), WordUtterance("blue", 1.0, 1.0)), 2.0)
    assert np.array_equal(word_boundary_errors(ours, truth), [[-0.25, 0.0], [0.25, 0.0]])
    with pytest.raises(ValueError, match="different words"):
        word_boundary_errors(ours, truth[:1])


def test_only_boundaries_that_both_have_are_compared():
    truth = phones(("pau", 0.5), ("b", 1.0), ("ih", 1.5), ("n", 2.0), ("pau", 2.5))
    assert phone_boundary_errors(truth, truth) == pytest.approx([0, 0, 0, 0])
    late = phones(("pau", 0.75), ("b", 1.0), ("ih", 1.25), ("n", 2.0), ("pau", 2.5))
    assert phone_boundary_errors(late, truth) == pytest.approx([0.25, 0, -0.25, 0])
    # another vowel: its two boundaries have no counterpart
    other = phones(("pau", 0.75), ("b", 1.0), ("eh", 1.25), ("n", 2.25), ("pau", 2.5))
    assert phone_boundary_errors(other, truth) == pytest.approx([0.25, 0.25])


def test_word_times_of_a_file(tmp_path):
    path = tmp_path / "clip.align"
    path.write_text("0 25000 sil\n25000 30000 bin\n30000 31000 sp\n31000 50000 blue\n50000 74500 sil\n")
    assert read_word_times(path) == [WordUtterance("bin", 1.0, 1.2), WordUtterance("blue", 1.24, 2.0)]


@pytest.mark.parametrize("line", ["1 2", "a b bin", "1.5 2 bin", "1 2 bin blue", "-1 2 bin"])
def test_a_line_that_is_no_word_time_is_named(tmp_path, line):
    path = tmp_path / "clip.align"
    path.write_text(f"0 25000 sil\n{line}\n")
    with pytest.raises(UserFacingError, match=r"clip\.align', line 2: '.*' is not 'start end word'"):
        read_word_times(path)


def test_a_folder_without_word_times_is_refused(tmp_path):
    with pytest.raises(UserFacingError, match="has no word times"):
        measure_grid(tmp_path, "tune")


@needs_data
@pytest.mark.prove
def test_grid_words_stand_where_the_corpus_says():
    rows = {row["boundaries"]: row for row in measure_grid(GRID, "tune")}
    starts, theirs = rows["word starts"], rows["word starts of the TextGrids"]
    assert starts["n"] == theirs["n"] == 240
    assert starts["median_ms"] <= 20
    assert starts["within_50ms"] >= 0.85
    assert starts["within_50ms"] > theirs["within_50ms"]
    assert rows["starts of first words"]["n"] + rows["starts of other words"]["n"] == starts["n"]


@pytest.mark.prove
def test_phones_stand_where_festival_put_them():
    whole, *emotions = measure_demo("tune")
    assert whole["compared"] > 0.9
    assert whole["median_ms"] <= 10
    assert whole["p90_ms"] <= 30
    assert sum(row["n"] for row in emotions) == whole["n"]
