"""Tables of the evaluation of indicators: ranking, what is undefined, definitions."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

from diagnostics.indicators.registry import ALL
from diagnostics.page.html import Cell, table
from diagnostics.page.tables import interval_cell, linked_cell
from diagnostics.records.gear_train import GearNames
from diagnostics.report.indicator_figures import known_column, term_cell
from diagnostics.statistics.indicator_result import IndicatorResult

ARROWS = {1: "rises", -1: "falls"}
BEHIND = " A number leads to the records behind it."
OF_HISTORY = ("na4", "nb4")
"""Indicators with a history are of several records: none stands in the list of records."""


def _behind(cell: Cell, column: str, **chosen: object) -> Cell:
    """Return a cell that leads to the records that it is about."""
    return cell if column.startswith(OF_HISTORY) else linked_cell(cell, indicator=column, **chosen)


def ranking_html(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> str:
    """Return all indicators, best between other specimens first, with the AUC of every state."""
    head = ["Indicator, channel", "Rank", "Score", *(f"AUC, {state}" for state in states), "With damage"]
    rows = [
        [
            term_cell(r.column, r.gears), Cell(str(rank), value=rank), interval_cell(r.score_others),
            *(
                _behind(interval_cell(r.others[state].separation), r.column, state=state)
                for state in states
            ),
            Cell(ARROWS[r.direction]),
        ]
        for rank, r in enumerate(found, start=1)
    ]  # fmt: skip
    caption = "Ranking between different specimens: AUC against healthy with 95 % limits. The score is their mean."
    return table(head, rows, caption=caption + BEHIND, sortable=True, tall=True)


def separation_html(rows: Mapping[str, Sequence[float]], states: tuple[str, ...], gears: GearNames) -> str:
    """Return the heat map: separation of every state in both designs, best first, empty without rows."""
    head = ["Indicator", *(f"{state}, {design}" for design in ("others", "same") for state in states)]
    cells = [
        [
            term_cell(name, gears),
            *(_behind(_separation(value), name, state=state) for value, state in zip(values, 2 * states, strict=True)),
        ]
        for name, values in rows.items()
    ]
    caption = (
        f"Separation of each state from healthy by the best {len(cells)} indicators, median over channels. 1 (dark) is "
        "perfect, 0.5 (white) is chance. Others: AUC between specimens. Same: share of pairs of one specimen that move "
        f"in the direction of the indicator.{BEHIND}"
    )
    return table(head, cells, caption=caption, sortable=True, tall=True) if cells else ""


def _separation(value: float) -> Cell:
    if not math.isfinite(value):
        return Cell("–", value=math.nan)
    return Cell(f"{value:.2f}", value=value, shade=2.0 * value - 1.0)


def best_html(best: Mapping[str, tuple[float, str]], gears: GearNames) -> str:
    """Return the best single indicator of every state."""
    rows = [
        [Cell(state), Cell(f"{value:.2f}", value=value), term_cell(column, gears)]
        for state, (value, column) in best.items()
    ]
    caption = "Best single indicator of each state, between different specimens. The best of many is optimistic."
    head = ["State", "AUC [-]", "Indicator and channel"]
    return table(head, rows, caption=caption, sortable=True, text=True) if rows else ""


def undefined_html(found: Sequence[IndicatorResult], left_out: Mapping[str, float]) -> str:
    """Return which indicators have no value in some records, how often, and when that is so.

    Parameters
    ----------
    found : sequence of IndicatorResult
        All results.
    left_out : mapping of str to float
        By channel, the share of records that were left out: there every indicator is undefined, for another reason.
    """
    rows = []
    for result in sorted(found, key=lambda r: (r.defined_share, r.column)):
        missing = 1.0 - result.defined_share - left_out.get(result.channel, 0.0)
        if missing > 1e-9:
            known = known_column(result.column, result.gears)
            reason = known.entry.undefined if known else "its function returned nan"
            rows.append(
                [term_cell(result.column, result.gears), Cell(f"{100.0 * missing:.1f}", value=missing), Cell(reason)]
            )
    head = ["Indicator and channel", "Undefined [%]", "When"]
    caption = "Indicators that are undefined in some of the records."
    return table(head, rows, caption=caption, sortable=True, tall=True, text=True) if rows else ""


def definition_html(held: Collection[str]) -> str:
    """Return the definitions of the indicators that are taken of these quantities."""
    head = [
        "Column starts with",
        "Indicator",
        "Taken from",
        "Value",
        "Unit",
        "On known signals",
        "Undefined when",
        "Source",
    ]
    rows = [
        [
            Cell(d.name, name=f"term-{d.name}", hint=f"{d.formula}; from {d.signal}"),
            *(Cell(t) for t in (d.title, d.signal, d.formula, d.unit, d.known, d.undefined, d.source)),
        ]
        for d in ALL
        if any(d.is_taken_of(quantity) for quantity in held)
    ]
    return table(head, rows, caption="Definitions of the indicators.", tall=True, text=True)
