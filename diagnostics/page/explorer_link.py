"""Links from tables and figures of a page to the records behind them, on the page to explore beside it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from urllib.parse import quote, urlencode

from diagnostics.page.html import Cell, inline, link

MOST_LINKS = 20
"""Below a figure; more would be longer than its caption."""


def explorer_link(explorer: str, **chosen: object) -> str:
    """Return where the page to explore shows records that fit, such as `explorer.html#state=severe`; nothing without.

    Parameters
    ----------
    explorer : str
        Name of the page beside this one, or nothing.
    chosen
        What its records have to be: `record`, `state`, `predicted`, `split`, `named` ...; `indicator` is shown of them.
    """
    if not explorer:
        return ""
    return f"{explorer}#{urlencode({name: str(value) for name, value in chosen.items()}, quote_via=quote)}"


def linked_cell(cell: Cell, explorer: str, **chosen: object) -> Cell:
    """Return a cell that leads to the records behind it; unchanged without a page to explore."""
    return replace(cell, link=explorer_link(explorer, **chosen)) if explorer else cell


def records_line(title: str, links: Mapping[str, str]) -> str:
    """Return a line below a figure that leads to records, by what each link is called; nothing without links."""
    shown = {name: target for name, target in links.items() if target}
    if not shown:
        return ""
    said = ", ".join(link(name, target) for name, target in list(shown.items())[:MOST_LINKS])
    return f'<p class="behind">{inline(title)}: {said}</p>'


def state_links(explorer: str, states: Iterable[str]) -> dict[str, str]:
    """Return where the records of every state are, by its name."""
    return {name: explorer_link(explorer, state=name) for name in states}


def indicator_links(explorer: str, titles: Mapping[str, str]) -> dict[str, str]:
    """Return where records are shown over each of these columns, by its title; titles come by column."""
    return {title: explorer_link(explorer, indicator=column) for column, title in titles.items()}
