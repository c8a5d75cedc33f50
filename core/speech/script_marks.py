"""What scripts and subtitles write that nobody says: speaker tags, stage directions, time lines."""

from __future__ import annotations

import re

# a line of subtitles with its number above it, and what opens a WebVTT file
_SUBTITLE_TIMES = re.compile(r"^(?:\d+[ \t]*\n)?[ \t]*\d+(?::\d+)+[.,]\d+[ \t]*-->.*$", re.MULTILINE)
_WEBVTT = re.compile(r"\A\s*WEBVTT\b.*$", re.MULTILINE)
_SCENE = re.compile(r"^[ \t]*(?:INT|EXT|INT\./EXT|I/E)\.[ \t].*$", re.MULTILINE)
_MARKUP = re.compile(r"<[^>]*>")
_BRACKETS = re.compile(r"\[[^\]]*\]|\{[^}]*\}")
# "JOHN:", "MARY ANN (V.O.):", "Speaker 1:"
_CAPITALS = r"[^\W\d_a-z](?:[^\W_a-z]|[.'’-])*"
_TAG = re.compile(
    rf"^[ \t]*(?:{_CAPITALS}(?:[ \t]{_CAPITALS}){{0,2}}|(?i:speaker|voice|narrator|interviewer)(?:[ \t]*\w{{1,2}})?)"
    r"[ \t]*(?:\([^)\n]*\)[ \t]*)?:(?=\s)",
    re.MULTILINE,
)
# "Anna:" may also be said; it is a tag when every line of several begins so
_NAME = re.compile(r"^[ \t]*[^\W\d_a-z][\w.'’-]*(?:[ \t][^\W\d_a-z][\w.'’-]*)?:(?=\s)")
# Round brackets and asterisks may hold spoken words, so they are directions only when they hold one of these.
_DIRECTION = re.compile(
    r"(?:laugh|chuckl|giggl|sigh|gasp|cough|sob|cry|crying|sniff|groan|moan|grunt|whisper|shout|yell|scream|mumbl|mutter"
    r"|pause|beat|silence|inhal|exhal|breath|clear(?:s|ing) (?:his|her|their)? ?throat|sings?\b|singing|hum(?:s|ming)\b"
    r"|music|applause|inaudible|crosstalk|cont(?:'|’)?d|continu|v\.?o\.?$|o\.?s\.?$|o\.?c\.?$|off[- ]?screen)",
    re.IGNORECASE,
)
_ASIDE = re.compile(r"\(([^()\n]{1,40})\)|\*([^*\n]{1,40})\*|~([^~\n]{1,40})~")
_MOST_WORDS_OF_ASIDE = 4


def without_script_marks(text: str) -> tuple[str, list[str]]:
    """Return what is left to be said, and the marks left out that might have been meant to be, each once.

    Left out are square, curly and angle brackets, the numbers and times of subtitles, scene headings ("INT. ..."),
    speaker tags in capitals before a colon ("Anna:" only when all of several lines begin so), and short asides in
    round brackets or asterisks that name a sound or a manner ("(sighs)", "*gasp*").
    """
    left_out: list[str] = []

    def leave_out(match: re.Match[str]) -> str:
        left_out.append(" ".join(match[0].split()))
        return " "

    text = text.replace("\r\n", "\n")
    for pattern in (_WEBVTT, _SUBTITLE_TIMES, _MARKUP):
        text = pattern.sub(" ", text)
    for pattern in (_BRACKETS, _SCENE, _TAG):
        text = pattern.sub(leave_out, text)
    text = _ASIDE.sub(lambda match: leave_out(match) if _is_direction(match) else match[0], text)
    lines = [line for line in text.split("\n") if line.strip()]
    if len(lines) > 1 and all(map(_NAME.match, lines)):
        text = "\n".join(_NAME.sub(leave_out, line) for line in lines)
    return text, list(dict.fromkeys(left_out))


def _is_direction(match: re.Match[str]) -> bool:
    words = next(filter(None, match.groups())).split()
    return len(words) <= _MOST_WORDS_OF_ASIDE and any(_DIRECTION.match(word) for word in (*words, " ".join(words)))
