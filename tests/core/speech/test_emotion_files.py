import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.errors import UserFacingError
from core.speech.emotion import EMOTIONS, EmotionModifier
from core.speech.emotion_files import read_emotions, write_emotions


def test_spans_comments_and_default_intensity(tmp_path):
    path = tmp_path / "e.txt"
    path.write_bytes(b"\xef\xbb\xbf# mood\r\n0 1.5 anger\r\n\r\n1.5\t2 JOY 0.25 # fades\r\n")
    assert read_emotions(path) == [EmotionModifier(0, 1.5, "anger", 1.0), EmotionModifier(1.5, 2, "happiness", 0.25)]


spans = st.builds(
    lambda start, length, emotion, intensity: EmotionModifier(start, start + length, emotion, intensity),
    st.floats(0, 600),
    st.floats(0.01, 60),
    st.sampled_from(EMOTIONS),
    st.floats(0, 1),
)


@given(st.lists(spans, min_size=1, max_size=10))
@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_is_written_is_read_back(tmp_path, modifiers):
    write_emotions(modifiers, tmp_path / "e.txt")
    assert read_emotions(tmp_path / "e.txt") == modifiers


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("# nothing\n", "holds no emotion"),
        ("0 1 anger\n0 1\n", "line 2: 2 columns"),
        ("0 1 anger 1 1\n", "line 1: 5 columns"),
        ("0 x anger\n", "line 1: 'x' is not a time"),
        ("0 nan anger\n", "line 1: 'nan' is not a time"),
        ("-1 1 anger\n", "line 1: '-1' is not a time"),
        ("1 1 anger\n", "line 1: the span ends at 1 s, but starts at 1 s"),
        ("0 1 hunger\n", "line 1: 'hunger' is not an emotion"),
        ("0 1 anger 1.01\n", "line 1: the intensity '1.01'"),
        ("0 1 anger nan\n", "line 1: the intensity 'nan'"),
    ],
)
def test_bad_lines_are_named(tmp_path, content, says):
    path = tmp_path / "e.txt"
    path.write_text(content)
    with pytest.raises(UserFacingError) as caught:
        read_emotions(path)
    assert says in caught.value.message
    assert "e.txt" in caught.value.message


def test_a_missing_file_is_said(tmp_path):
    with pytest.raises(UserFacingError, match="no emotion specification"):
        read_emotions(tmp_path / "none.txt")
