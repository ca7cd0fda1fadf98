"""Tables of a report: what the set holds, scores with intervals, every feature's separability.

Links from tables and figures of a page to the records behind them, further up on the same page.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
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
    rows = [
        [
            Cell(state),
            *(
                linked_cell(cell, state=state, split=name) if count else cell
                for name in splits
                for count in (int(((labels["state"] == state) & (labels["split"] == name)).sum()),)
                for cell in (Cell(str(count), value=float(count)),)
            ),
        ]
        for state in classes
    ]
    count = [np.unique(labels["specimen_id"][labels["split"] == name]).size for name in splits]
    rows.append([Cell("specimens (gearboxes)"), *(Cell(str(number)) for number in count)])
    return TableBlock(["State", *splits], rows, caption="Records by state and split, and gearboxes by split.")


def interval_cell(found: Interval, form: str = ".2f") -> Cell:
    """Return a value with its limits in small print; `form` is Python's, such as `+.2f` for differences."""
    if not math.isfinite(found.value):
        return Cell("undefined", value=math.nan)
    limits = "" if math.isnan(found.low) else f"{found.low:{form}} … {found.high:{form}}"
    return Cell(f"{found.value:{form}}", limits, found.value)
