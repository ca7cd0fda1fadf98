"""One self-contained page: inline style and script, figures inside, nothing loaded from elsewhere."""

from __future__ import annotations

import base64
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from diagnostics.page.sort_script import SORT_SCRIPT
from diagnostics.page.style_sheet import style_sheet

PRINTED_ROWS = 20
"""Rows of a tall table that are printed; more would be pages of numbers that nobody reads on paper."""

SHORT_ROWS = 12
"""Up to so many rows a table stays on one sheet."""

WIDE = 9
"""Columns beyond which paper needs small print."""

WIDER = 14
"""Columns beyond which it also needs limits on lines of their own."""

PLAIN_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")
NUMBERED = (("Figure", "<figcaption>"), ("Table", '<p class="caption">'))


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table: what is shown, what is smaller behind it, and what it is sorted by (None: its text)."""

    text: str
    small: str = ""
    value: float | None = None


def page(title: str, parts: Sequence[str]) -> str:
    """Return the whole page, its figures and tables numbered."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)}</title><style>{style_sheet(PRINTED_ROWS)}</style></head>\n<body><main>\n"
        + numbered("\n".join(parts))
        + f"\n</main><script>{SORT_SCRIPT}</script></body></html>\n"
    )


def numbered(body: str) -> str:
    """Return the body with a number before every caption, so that text elsewhere can cite figures and tables."""
    for word, opening in NUMBERED:
        first, *rest = body.split(opening)
        body = first + "".join(f"{opening}<b>{word} {number}.</b> {part}" for number, part in enumerate(rest, start=1))
    return body


def heading(text: str, level: int = 2) -> str:
    """Return a heading."""
    return f"<h{level}>{inline(text)}</h{level}>"


def paragraph(text: str, style: str = "") -> str:
    """Return a paragraph, of a class of its own if one is named."""
    return f'<p class="{style}">{inline(text)}</p>' if style else f"<p>{inline(text)}</p>"


def summary(sentences: Sequence[str]) -> list[str]:
    """Return the sentences of a summary, the first of them, which says what all others mean, set off."""
    first, *others = sentences
    return [paragraph(first, "first"), *(paragraph(sentence) for sentence in others)]


def notes(texts: Sequence[str]) -> list[str]:
    """Return notes as paragraphs, each a sentence whatever part of the program wrote it."""
    return [
        paragraph(f"{text[:1].upper()}{text[1:]}{'' if text.endswith(('.', '?')) else '.'}", "note") for text in texts
    ]


def inline(text: str) -> str:
    """Return text for the page: `code` between backticks, long names broken between their parts."""
    found = re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))
    return re.sub(r"(?<=\w)_(?=[^\W_])", "_<wbr>", found)


def figure_block(png: bytes, caption: str) -> str:
    """Return a figure with its caption, the picture inside the page and its size known before it is drawn."""
    source = base64.b64encode(png).decode("ascii")
    width, height = (int.from_bytes(png[start : start + 4], "big") for start in (16, 20))  # of the header of a PNG
    return (
        f'<figure><img alt="{escape(caption, quote=True)}" width="{width}" height="{height}" '
        f'src="data:image/png;base64,{source}"><figcaption>{inline(caption)}</figcaption></figure>'
    )


def figure_grid(blocks: Sequence[str]) -> str:
    """Return figures side by side where there is room; nothing for none."""
    return f'<div class="figures">{"".join(blocks)}</div>' if blocks else ""


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[Cell]],
    *,
    caption: str = "",
    sortable: bool = False,
    tall: bool = False,
    text: bool = False,
) -> str:
    """Return a table that scrolls inside itself, sorted by a click on a head if asked for; text wraps in its cells.

    Parameters
    ----------
    head : sequence of str
        Titles of the columns; all empty for a table without a head.
    rows : sequence of sequence of Cell
        The first cell names its row.
    caption : str
        Above the table, numbered by the page.
    sortable, tall, text : bool
        Whether heads sort, whether more than a screen of rows scrolls (and is cut on paper), whether cells wrap.
    """
    long = tall and len(rows) > PRINTED_ROWS and not text
    short = len(rows) <= SHORT_ROWS
    flags = {
        "sortable": sortable,
        "text": text,
        "wide": len(head) > WIDE and not text,
        "wider": len(head) > WIDER and not text,
    }
    box = " ".join(["scroll", *(["tall"] if tall else []), *(["cut"] if long else []), *(["short"] if short else [])])
    titles = "".join(f'<th scope="col">{inline(title)}</th>' for title in head)
    body = "".join(f"<tr>{''.join(_cell(cell, place) for place, cell in enumerate(row))}</tr>" for row in rows)
    return (
        (f'<p class="caption">{inline(caption)}</p>' if caption else "")
        + f'<div class="{box}" tabindex="0" role="region" aria-label="{escape(caption or "table", quote=True)}">'
        + f'<table class="{" ".join(name for name, wanted in flags.items() if wanted)}">'
        + (f"<thead><tr>{titles}</tr></thead>" if any(head) else "")
        + f"<tbody>{body}</tbody></table></div>"
        + (_printed_note(len(rows)) if long else "")
    )


def _printed_note(rows: int) -> str:
    return (
        f'<p class="printed">On paper: the first {PRINTED_ROWS} of {rows} rows in the order that was chosen; all are '
        "on the screen and in the files beside this page.</p>"
    )


def _cell(cell: Cell, place: int) -> str:
    tag, scope = ("td", "") if place else ("th", ' scope="row"')
    small = f" <small>{inline(minus(cell.small))}</small>" if cell.small else ""
    return f"<{tag}{scope}{_sorted_by(cell)}>{inline(minus(cell.text))}{small}</{tag}>"


def _sorted_by(cell: Cell) -> str:
    """Return the attribute that a table is sorted by, where what is shown is no number itself."""
    if cell.value is None or (math.isfinite(cell.value) and PLAIN_NUMBER.fullmatch(cell.text)):
        return ""
    return f' data-value="{cell.value:.6g}"' if math.isfinite(cell.value) else ' data-value=""'


def minus(text: str) -> str:
    """Return text with a true minus sign before numbers, and none before a zero."""
    plain = re.sub(r"(?<![\w.])[-+](0(?:\.0+)?)(?![\d.])", r"\1", text)
    return re.sub(r"(?<![\w.,)])-(?=\d)", "\N{MINUS SIGN}", plain)
