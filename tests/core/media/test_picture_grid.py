import numpy as np
import pytest

from core.media.lettering import fitting, text_width_px, write_text
from core.media.picture_grid import PictureRow, picture_grid

GROUND = (10, 20, 30)


def cell(value):
    return np.full((40, 60, 3), value, np.uint8)


def found_at(picture, value):
    """Rows and columns of the cell of one value, each as (first, one past last)."""
    rows, columns = np.nonzero((picture == value).all(axis=2))
    return (rows.min(), rows.max() + 1), (columns.min(), columns.max() + 1)


def test_cells_stand_whole_in_rows_and_columns():
    values = [[90, 100, 110], [120, 130, 140]]
    picture = picture_grid([PictureRow([cell(v) for v in row], "row", ["a", "b", "c"]) for row in values], "T", GROUND)
    places = {v: found_at(picture, v) for row in values for v in row}
    for v, (rows, columns) in places.items():
        assert rows[1] - rows[0] == 40 and columns[1] - columns[0] == 60
        np.testing.assert_array_equal(picture[slice(*rows), slice(*columns)], cell(v))
    for first, second in zip(*values):
        assert places[first][1] == places[second][1] and places[first][0][1] < places[second][0][0]
    assert places[90][1][1] < places[100][1][0] < places[110][1][0]


def test_without_words_there_is_ground_around_the_cells_alone():
    picture = picture_grid([PictureRow([cell(200)])], ground=GROUND)
    rows, columns = found_at(picture, 200)
    assert rows[0] == columns[0] == picture.shape[0] - rows[1] == picture.shape[1] - columns[1]


def test_a_caption_is_written_under_its_cell_and_stays_within_its_width():
    plain = picture_grid([PictureRow([cell(200), cell(210)], captions=["", ""])], ground=GROUND)
    written = picture_grid([PictureRow([cell(200), cell(210)], captions=["", "very long " * 9])], ground=GROUND)
    rows, columns = np.nonzero((plain != written).any(axis=2))
    below, (left, right) = found_at(plain, 210)
    assert rows.min() >= below[1] and columns.min() >= left - 1 and columns.max() <= right
    assert len(rows) > 50


@pytest.mark.parametrize("ground", [(0, 0, 0), (255, 255, 255)])
def test_words_can_be_read_on_any_ground(ground):
    picture = picture_grid([PictureRow([cell(128)], captions=["word"])], ground=ground)
    contrast = np.abs(picture[60:].astype(int) - ground[0]).max()
    assert contrast > 120


def test_cells_of_two_shapes_are_refused():
    with pytest.raises(ValueError, match="one shape"):
        picture_grid([PictureRow([cell(1), np.zeros((3, 3, 3), np.uint8)])])


def test_a_cut_text_fits_and_begins_as_it_did():
    text = "Dialog is an essential element"
    cut = fitting(text, 17, 100)
    assert text_width_px(cut, 17) <= 100 and cut.endswith("…") and text.startswith(cut[:-1].rstrip())
    assert fitting(text, 17, 1000) == text and fitting(text, 17, 0) == ""


def test_letters_are_as_wide_as_they_are_said_to_be():
    picture = np.zeros((40, 400, 3), np.uint8)
    write_text(picture, "smile", 50, 30, 20, (255, 255, 255))
    columns = np.flatnonzero(picture.any(axis=(0, 2)))
    assert columns.min() >= 49 and abs(columns.max() + 1 - 50 - text_width_px("smile", 20)) <= 3


def test_text_beyond_the_edge_is_cut_and_does_not_wrap():
    picture = np.zeros((60, 80, 3), np.uint8)
    write_text(picture, "a long line of words", 10, 20, 16, (255, 255, 255))
    assert not picture[28:].any()
