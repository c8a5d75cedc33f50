"""The page shows what it is given, and nothing of it becomes markup."""

from __future__ import annotations

from html.parser import HTMLParser

from app.report import page as html
from app.report.page import Row, number, share


class Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.seen, self.words = [], [], []

    def handle_starttag(self, tag, attributes):
        self.seen.append(tag)
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def read(text):
    reader = Reader()
    reader.feed(text)
    assert reader.open == []
    return reader


def test_a_page_is_whole_and_fetches_nothing():
    evil = '<img src="http://x/y.png"> & co'
    parts = [
        html.heading(evil), html.paragraph(evil), html.paragraph(evil, "note"),
        html.table([evil, "b"], [Row((evil, "1")), Row(("c", "2"), "subject")]), html.definitions([(evil, evil)]),
        html.figure(html.Figure("f", "<svg></svg>", evil)),
    ]  # fmt: skip
    text = html.page(evil, parts)
    reader = read(text)
    assert reader.words.count(evil) == 10
    assert "img" not in reader.seen and "script" not in reader.seen and "link" not in reader.seen
    assert reader.seen.count("td") == 4 and reader.seen.count("th") == 2


def test_figures_are_written_plainly():
    assert (number(1.006), number(-0.5, 1), number(None), share(0.912), share(None)) == (
        "1.01", "\N{MINUS SIGN}0.5", "–", "91.2 %", "–",
    )  # fmt: skip
