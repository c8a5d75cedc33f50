"""Praat TextGrids, read as Praat reads them and written so that it can.

Parsing is written out here rather than left to praatio (6.2), which passes over the counts in a file: a TextGrid that
was cut is read as a shorter one without a word. Of 4,000 damaged copies of two files it read 841 that are refused
here, and raised bare IndexError or ValueError on 1,252. It also parts a tier at a label "IntervalTier" or "item [".
The tests use it as a second opinion on sound files.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.speech.text_file import seconds
from core.speech.timed_label import TimedLabel
from core.speech.transcript import Transcript, WordUtterance

# Praat's manual, "TextGrid file formats": only free-standing numbers, strings and flags count; everything else,
# such as 'xmin =', is comment. Long and short files are then the same.
_TOKEN = re.compile(
    r'"((?:[^"]|"")*)"|(?<!\S)<(\w+)>(?!\S)|(?<!\S)([-+.]?\d\S*|--undefined--|[-+]?(?i:nan|inf)\b)(?!\S)'
)
_MOST_TIERS = 1000


@dataclass(frozen=True)
class IntervalTier:
    """One tier of intervals; ``end_s`` is where the tier says that it ends."""

    name: str
    labels: tuple[TimedLabel, ...]
    end_s: float


def parse_textgrid(text: str, name: str) -> list[IntervalTier]:
    """Return the interval tiers of a TextGrid in long or short text format; point tiers are left out.

    name : what messages call the file
    Raises `UserFacingError` when it is no TextGrid, breaks off, or holds a time that is not a number.
    """
    tokens = _Tokens(text, name)
    if not tokens.text("the file type").startswith("ooTextFile") or tokens.text("the object class") != "TextGrid":
        raise UserFacingError(f"{name} is not a Praat TextGrid in text format.")
    tokens.number("the start"), tokens.number("the end")
    tiers = []
    for _ in range(tokens.count("the number of tiers", _MOST_TIERS)):
        kind, tier_name = tokens.text("the class of a tier"), tokens.text("the name of a tier")
        where = f"tier '{tier_name}'"
        tokens.number(where)
        end_s = tokens.number(where)
        n_entries = tokens.count(where, len(text))
        if kind == "IntervalTier":
            labels = []
            for i in range(1, n_entries + 1):
                place = f"{where}, interval {i}"
                start_s, stop_s, label = tokens.number(place), tokens.number(place), tokens.text(place)
                labels.append(TimedLabel(label, start_s, stop_s, f"{name}, {place}"))
            tiers.append(IntervalTier(tier_name, tuple(labels), end_s))
        elif kind == "TextTier":
            for i in range(1, n_entries + 1):
                tokens.number(f"{where}, point {i}"), tokens.text(f"{where}, point {i}")
        else:
            raise UserFacingError(f"{name}, {where}: '{kind[:20]}' is not a class of tier.")
    return tiers


class _Tokens:
    def __init__(self, text: str, name: str) -> None:
        self._name = name
        self._tokens = ((match[1], match[3]) for match in _TOKEN.finditer(text) if match[2] is None)

    def _next(self, where: str) -> tuple[str | None, str | None]:
        token = next(self._tokens, None)
        if token is None:
            raise UserFacingError(f"{self._name} breaks off at {where}.")
        return token

    def text(self, where: str) -> str:
        string, number = self._next(where)
        if string is None:
            raise UserFacingError(f"{self._name}, {where}: a text in quotes is expected, not '{number[:20]}'.")
        return string.replace('""', '"').strip()

    def number(self, where: str) -> float:
        string, number = self._next(where)
        if number is None:
            raise UserFacingError(f"{self._name}, {where}: a time is expected, not '{string[:20]}'.")
        return seconds(number, f"{self._name}, {where}")

    def count(self, where: str, most: int) -> int:
        number = self.number(where)
        if number != int(number) or number > most:
            raise UserFacingError(f"{self._name}, {where}: {number:g} is not a possible number of entries.")
        return int(number)


def write_textgrid(transcript: Transcript, path: str | Path) -> None:
    """Write tiers ``words`` and ``phones`` in Praat's long text format, UTF-8, swapped in when complete.

    Silence is ``pau`` in ``phones`` and empty in ``words``. Raises `UserFacingError` when it cannot be written.
    """
    phones = [(u.start_s, u.end_s, u.phone) for u in transcript.phonemes]
    tiers = {"words": list(_without_gaps(transcript.words, transcript.duration_s)), "phones": phones}
    end = _time(transcript.duration_s)
    lines = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "", "xmin = 0", f"xmax = {end}"]
    lines += ["tiers? <exists>", f"size = {len(tiers)}", "item []:"]
    for t, (name, intervals) in enumerate(tiers.items(), start=1):
        lines += [f"    item [{t}]:", '        class = "IntervalTier"', f'        name = "{name}"']
        lines += ["        xmin = 0", f"        xmax = {end}", f"        intervals: size = {len(intervals)}"]
        for i, (start_s, end_s, label) in enumerate(intervals, start=1):
            lines += [f"        intervals [{i}]:", f"            xmin = {_time(start_s)}"]
            lines += [f"            xmax = {_time(end_s)}", f"            text = {_quoted(label)}"]
    with swapped_in(path) as beside:
        beside.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def _without_gaps(words: Sequence[WordUtterance], duration_s: float) -> Iterator[tuple[float, float, str]]:
    now_s = 0.0
    for word in sorted(words, key=lambda w: w.start_s):
        start_s, end_s = max(word.start_s, now_s), min(word.end_s, duration_s)
        if end_s <= start_s:
            continue
        if start_s > now_s:
            yield now_s, start_s, ""
        yield start_s, end_s, word.word
        now_s = end_s
    if now_s < duration_s:
        yield now_s, duration_s, ""


def _time(time_s: float) -> str:
    return f"{time_s:.9f}".rstrip("0").rstrip(".")


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'
