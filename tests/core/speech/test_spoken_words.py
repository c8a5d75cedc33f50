import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.speech.number_words import number_words
from core.speech.spoken_words import spoken_words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Hello, world!", "Hello world"),
        ("“I don’t know,” she said—really…", "I don't know she said really"),
        ("'Tis the dogs' bone; it's 'hello'", "'Tis the dogs' bone it's hello"),
        ("twenty-one e-mail - yes", "twenty-one e-mail yes"),
        ("[laughs] (sighs) well <i>no</i> {beat}", "well no"),
        ("B2B mp3 4x4", "B two B mp three four x four"),
        ("AT&T, R&D", "AT and T R and D"),
        ("U.S.A. vs. Mr. Smith", "U S A vs Mr Smith"),
        ("and/or a_b", "and or a b"),
        ("10am, 5kg", "ten am five kilograms"),
        ("-5 @ 3rd, 20°", "minus five at third twenty degrees"),
        ("1.2.3", "one two three"),
        ("ＡＢＣ ½", "ABC one half"),
        ("1/2, 3 1/2 and 1½, 24/7", "one half three and a half and one and a half twenty four seven"),
        ("$5M, £20k or $2 million", "five million dollars twenty thousand pounds or two million dollars"),
        ("Prof. X, approx. 3 km (e.g. Jan. 1st)", "professor X approximately three kilometers e g january first"),
        ("100km/h. The last rep. 7 min.", "one hundred kilometers per hour The last rep seven minutes"),
        ("Call 555-0123!", "Call five five five zero one two three"),
        ("bob@example.com #blessed", "bob at example dot com hashtag blessed"),
        ("I paid $3.50 for 21 apples in 1984 at 10:30.", "I paid three dollars and fifty cents for twenty one apples "
         "in nineteen eighty four at ten thirty"),
        ("Zürich 日本", "Zürich 日本"),
        ("... — !? \t\n 😀 ' - ''", ""),
    ],
)  # fmt: skip
def test_written_and_spoken(text, words):
    assert spoken_words(text) == words.split()


@given(st.text(max_size=60))
def test_any_text_gives_words_with_letters_and_no_digits_or_spaces(text):
    for word in spoken_words(text):
        assert any(c.isalpha() for c in word)
        assert not any(c.isdecimal() or c.isspace() for c in word)


@pytest.mark.parametrize(
    ("token", "words"),
    [
        ("0", "zero"),
        ("13", "thirteen"),
        ("40", "forty"),
        ("101", "one hundred and one"),
        ("1,234", "one thousand two hundred and thirty four"),
        ("1000001", "one million one"),
        ("1984", "nineteen eighty four"),
        ("1905", "nineteen oh five"),
        ("1900", "nineteen hundred"),
        ("2000", "two thousand"),
        ("2005", "two thousand and five"),
        ("2024", "twenty twenty four"),
        ("007", "zero zero seven"),
        ("3.14", "three point one four"),
        (".5", "point five"),
        ("1st", "first"),
        ("22nd", "twenty second"),
        ("13th", "thirteenth"),
        ("20th", "twentieth"),
        ("90s", "nineties"),
        ("50%", "fifty percent"),
        ("$1", "one dollar"),
        ("£2.01", "two pounds and one penny"),
        ("£2.5", "two pounds and fifty pence"),
        ("9:05", "nine oh five"),
        ("9:00", "nine o'clock"),
        ("12345678901234567890", "one two three four five six seven eight nine zero " * 2),
    ],
)
def test_numbers_are_read_aloud(token, words):
    assert number_words(token) == words.split()


@pytest.mark.parametrize("token", ["", "abc", "1,23", "1.2.3", "$", "%", "1st1", "25:00:00", "-3"])
def test_what_is_no_number(token):
    assert number_words(token) is None


@given(st.integers(0, 10**15 - 1))
def test_a_cardinal_says_its_number(number):
    """Read the words back by another road: sum what each word is worth."""
    ones = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen"
    worth = {word: i for i, word in enumerate(f"{ones} seventeen eighteen nineteen".split())}
    tens = "zero ten twenty thirty forty fifty sixty seventy eighty ninety"
    worth |= {word: 10 * i for i, word in enumerate(tens.split()) if i > 1}
    scales = {"thousand": 10**3, "million": 10**6, "billion": 10**9, "trillion": 10**12}
    total = group = 0
    for word in number_words(f"{number:,}"):
        if word == "hundred":
            group *= 100
        elif word in scales:
            total, group = total + group * scales[word], 0
        elif word != "and":
            group += worth[word]
    assert total + group == number
