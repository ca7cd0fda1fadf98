"""Indicators as people call them, with their definitions on hover and in a glossary that a screen reader reads."""

from __future__ import annotations

from functools import cache
from html import escape

from diagnostics.indicators.indicator import base_name
from diagnostics.indicators.indicator_titles import indicator_titles
from diagnostics.indicators.registry import ALL, BY_NAME
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.page.html import Cell, inline


@cache
def _titles() -> dict[str, str]:
    return indicator_titles(IndicatorSettings())


def column_title(column: str) -> str:
    """Return what people call a column; the user's own indicators keep their names."""
    name = column.partition("__")[0]
    return _titles().get(name, name).rsplit(" [", 1)[0]


def definition(column: str) -> str:
    """Return how the value of a column is taken; nothing for the user's own indicators."""
    known = BY_NAME.get(base_name(column))
    return f"{known.formula}; from {known.signal}" if known else ""


def term_cell(column: str) -> Cell:
    """Return the cell that names a column: its title with the definition, its channel and its own name behind it."""
    known = BY_NAME.get(base_name(column))
    channel = column.partition("__")[2]
    small = f"{channel}, {column.partition('__')[0]}" if channel else column
    return Cell(column_title(column), small, link=f"#term-{known.name}" if known else "", hint=definition(column))


def in_a_sentence(column: str) -> str:
    """Return a column as a sentence names it: its title in small letters where it is no acronym, and its channel."""
    title, channel = column_title(column), column.partition("__")[2]
    if title[1:2].islower():
        title = title[:1].lower() + title[1:]
    return f"{title} at {channel}" if channel else title


def glossary_html() -> str:
    """Return the definitions of all indicators, each where its links lead."""
    entries = "".join(
        f'<dt id="term-{escape(known.name, quote=True)}">{inline(known.title)} <code>{inline(known.name)}</code></dt>'
        f"<dd>{inline(known.formula)}, from {inline(known.signal)}"
        f"{f', in {inline(known.unit)}' if known.unit else ''}. Undefined when {inline(known.undefined)}. "
        f"Source: {inline(known.source)}.</dd>"
        for known in ALL
    )
    return f"<dl>{entries}</dl>"
