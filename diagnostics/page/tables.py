"""Tables of a report: what the set holds, scores with intervals, every feature's separability.

Links from tables and figures of a page to the records behind them, further up on the same page.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from urllib.parse import quote, urlencode

import numpy as np

from diagnostics.page.blocks import Cell, TableBlock
from diagnostics.statistics.evaluation import Interval


def records_link(**chosen: object) -> str:
    """Return where this page shows records that fit, such as `#state=severe`.

    Parameters
    ----------
    chosen
        What its records have to be: `record`, `state`, `predicted`, `split`, `named` ...; `indicator` is shown of them.
    """
    return f"#{urlencode({name: str(value) for name, value in chosen.items()}, quote_via=quote)}"


def linked_cell(cell: Cell, **chosen: object) -> Cell:
    """Return a cell that leads to the records behind it."""
    return replace(cell, link=records_link(**chosen))


def state_links(states: Iterable[str]) -> dict[str, str]:
    """Return where the records of every state are, by its name."""
    return {name: records_link(state=name) for name in states}


def indicator_links(titles: Mapping[str, str]) -> dict[str, str]:
    """Return where records are shown over each of these columns, by its title; titles come by column."""
    return {title: records_link(indicator=column) for column, title in titles.items()}


def set_table(labels: dict[str, np.ndarray], classes: tuple[str, ...]) -> TableBlock:
    """Return records by state and split, and specimens by split; counts lead to their records."""
    splits = [name for name in ("train", "validation", "test") if (labels["split"] == name).any()]

    def counted_records(state: str, split: str) -> Cell:
        count = int(((labels["state"] == state) & (labels["split"] == split)).sum())
        return linked_cell(cell(count), state=state, split=split) if count else cell(count)

    rows: list[list[object]] = [[state, *(counted_records(state, split) for split in splits)] for state in classes]
    gearboxes = [str(np.unique(labels["specimen_id"][labels["split"] == name]).size) for name in splits]
    rows.append(["specimens (gearboxes)", *gearboxes])
    return table(["State", *splits], rows, "Records by state and split, and gearboxes by split.")


def cell(value: object, form: str = ".2f") -> Cell:
    """Return a value as a cell: an interval with its limits in small print, a dash for what is not known.

    `form` is Python's for numbers that are not whole, such as `+.2f` for differences. Cells stay as they are.
    """
    if isinstance(value, Cell):
        return value
    if isinstance(value, Interval):
        known = math.isfinite(value.low)
        limits = f"{value.low:{form}} … {value.high:{form}}" if known else ""
        return Cell(f"{value.value:{form}}", limits, value.value) if math.isfinite(value.value) else UNDEFINED
    if isinstance(value, (int, np.integer)):
        return Cell(str(value), value=float(value))
    if isinstance(value, (float, np.floating)):
        return Cell(f"{value:{form}}" if math.isfinite(value) else "–", value=float(value))
    return UNKNOWN if value is None else Cell(str(value))


UNDEFINED, UNKNOWN = Cell("undefined", value=math.nan), Cell("–", value=math.nan)


def table(
    head: Sequence[str], rows: Iterable[Sequence[object]], caption: str, form: str = ".2f", **shown: bool
) -> TableBlock:
    """Return a table of values, see `cell`; `shown` are further fields of a block, such as `sortable=True`."""
    return TableBlock(head, [[cell(value, form) for value in row] for row in rows], caption, **shown)
