"""One self-contained HTML page: headings, paragraphs, tables and figures, nothing fetched from anywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

_STYLE = """
:root { color-scheme: light; --ink: #242b33; --soft: #5c6672; --line: #e2e6ea; --accent: #0f6c7a; }
body { margin: 0 auto; max-width: 900px; padding: 32px 20px 64px; background: #fff; color: var(--ink);
       font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; }
h1 { font-size: 28px; margin: 0 0 4px; } h2 { font-size: 20px; margin: 44px 0 8px; }
p { max-width: 72ch; } .lead { color: var(--soft); margin-top: 0; }
.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 14px; margin: 12px 0; }
th, td { padding: 5px 12px 5px 0; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { color: var(--soft); font-weight: 600; vertical-align: bottom; white-space: normal; min-width: 4.2em; }
th:first-child, td:first-child { text-align: left; }
tr.standard td { color: var(--soft); font-style: italic; } tr.subject td { color: var(--accent); font-weight: 600; }
figure { margin: 16px 0; } figcaption, .note { color: var(--soft); font-size: 14px; max-width: 80ch; }
dt { font-weight: 600; margin-top: 8px; } dd { margin-left: 0; max-width: 80ch; }
"""


@dataclass(frozen=True)
class Row:
    """One line of a table; kind : ``result``, ``subject`` (what the report is about) or ``standard``."""

    cells: tuple[str, ...]
    kind: str = "result"


@dataclass(frozen=True)
class Figure:
    """A plot with its caption; ``name`` is what its file is called where figures are kept apart."""

    name: str
    svg: str
    caption: str


def heading(words: str) -> str:
    """Start a section."""
    return f"<h2>{escape(words)}</h2>"


def paragraph(words: str, kind: str = "") -> str:
    """Say something; kind : ``lead``, ``note`` or nothing."""
    return f'<p class="{kind}">{escape(words)}</p>' if kind else f"<p>{escape(words)}</p>"


def table(header: Sequence[str], rows: Sequence[Row]) -> str:
    """Lay out rows of text under a header."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join(
        f'<tr class="{row.kind}">{"".join(f"<td>{escape(cell)}</td>" for cell in row.cells)}</tr>' for row in rows
    )
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def figure(shown: Figure) -> str:
    """Show a plot with its caption."""
    return f"<figure>{shown.svg}<figcaption>{escape(shown.caption)}</figcaption></figure>"


def definitions(of: Sequence[tuple[str, str]]) -> str:
    """Explain words."""
    return f"<dl>{''.join(f'<dt>{escape(word)}</dt><dd>{escape(says)}</dd>' for word, says in of)}</dl>"


def page(title: str, parts: Sequence[str]) -> str:
    """Put the parts together under ``title``."""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style></head><body><h1>{escape(title)}</h1>"
        f"{''.join(parts)}</body></html>\n"
    )


def number(value: float | None, digits: int = 2) -> str:
    """Write a measured figure, or a dash for one that there is not."""
    return "–" if value is None else f"{value:.{digits}f}".replace("-", "\N{MINUS SIGN}")


def share(value: float | None) -> str:
    """Write a share as a percentage."""
    return "–" if value is None else f"{100 * value:.1f} %"
