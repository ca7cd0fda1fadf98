"""Tables of the evaluation of indicators: ranking, trend and size, causes, what is undefined, definitions."""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnostics.assessment.indicator_result import IndicatorResult
from diagnostics.evaluation import Interval
from diagnostics.indicators.definition import base_name
from diagnostics.indicators.definitions import BY_NAME, DEFINITIONS
from diagnostics.report.html import Cell, table
from diagnostics.report.indicator_figures import CAUSES
from diagnostics.report.tables import interval_cell

ARROWS = {1: "rises", -1: "falls"}


def ranking_html(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> str:
    """Return all indicators, best between other specimens first, with the separation of every state in both designs."""
    head = [
        "Indicator, channel", "Rank", "Score, other specimens", *(f"AUC {state}" for state in states),
        "Score, same specimen", *(f"Share of pairs above, {state}" for state in states), "With damage",
        *(f"Holm p {state}" for state in states), *(f"Holm p, paired {state}" for state in states),
    ]  # fmt: skip
    rows = [
        [
            Cell(r.indicator, r.channel), Cell(str(rank), value=rank),
            interval_cell(r.score_others), *(interval_cell(r.others[state].separation) for state in states),
            interval_cell(r.score_same), *(interval_cell(r.same[state].separation) for state in states),
            Cell(ARROWS[r.direction]), *(p_cell(r.others[state].holm) for state in states),
            *(p_cell(r.same[state].holm) for state in states),
        ]
        for rank, r in enumerate(found, start=1)
    ]  # fmt: skip
    return table(head, rows, sortable=True, tall=True)


def trend_html(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> str:
    """Return trend with severity, effect sizes and the smallest sizes found."""
    sizes = {name: None for r in found for name in r.detectable}
    head = [
        "Indicator, channel", "Spearman, area", "Spearman, stiffness loss", "Monotonicity",
        *(size_title(name) for name in sizes),
        *(f"Cohen's d {state}" for state in states), *(f"paired d {state}" for state in states),
    ]  # fmt: skip
    rows = [
        [
            Cell(r.indicator, r.channel), interval_cell(r.spearman_area, sign=True),
            interval_cell(r.spearman_stiffness, sign=True), interval_cell(r.monotonicity, sign=True),
            *(size_cell(r, name) for name in sizes),
            *(interval_cell(r.others[state].effect, sign=True) for state in states),
            *(interval_cell(r.same[state].effect, sign=True) for state in states),
        ]
        for r in found
    ]  # fmt: skip
    return table(head, rows, sortable=True, tall=True)


def size_title(name: str) -> str:
    """Return the head of a column of sizes: `others_area_mm2_a90` is the area found with 90 %, other specimens."""
    design, kind, unit, share = name.split("_")
    size = {"area": "area", "profile": "profile length"}[kind]
    return f"{share}, {size} [{unit.replace('mm2', 'mm²')}], {'other' if design == 'others' else 'same'} specimen"


def size_cell(result: IndicatorResult, name: str) -> Cell:
    """Return a smallest size: with an upper-bound sign where the smallest damage is found, or that none is."""
    found = result.detectable[name]
    smallest = result.smallest_size[name.rsplit("_", 1)[0]]
    if math.isnan(found.value):
        return Cell("undefined", value=math.nan)
    if math.isinf(found.value):
        return Cell("not reached", f"from {size_text(found.low)}" if math.isfinite(found.low) else "", 1e9)
    bound = "≤ " if found.value <= smallest * (1.0 + 1e-9) else ""
    return Cell(f"{bound}{found.value:.3g}", size_limits(found), found.value)


def size_limits(found: Interval) -> str:
    """Return the limits of a size."""
    return f"{size_text(found.low)} … {size_text(found.high)}"


def size_text(size: float) -> str:
    """Return a size, or the sign for one that is not reached."""
    return f"{size:.3g}" if math.isfinite(size) else "∞"


def p_cell(p_value: float) -> Cell:
    """Return an adjusted p-value."""
    if math.isnan(p_value):
        return Cell("–", value=math.nan)
    return Cell("< 0.001" if p_value < 0.001 else f"{p_value:.3f}", value=p_value)


def sensitivity_html(found: Sequence[IndicatorResult]) -> str:
    """Return what explains each indicator in healthy records."""
    rows = [
        [Cell(r.indicator, r.channel), *(_share(r.sensitivity.get(cause, math.nan)) for cause in CAUSES)] for r in found
    ]
    return table(["Indicator, channel", *(cause.capitalize() for cause in CAUSES)], rows, sortable=True, tall=True)


def _share(value: float) -> Cell:
    return Cell(f"{value:.2f}" if math.isfinite(value) else "–", value=value)


def undefined_html(found: Sequence[IndicatorResult]) -> str:
    """Return which indicators have no value in some records, how often, and when that is so."""
    rows = []
    for result in sorted(found, key=lambda r: (r.defined_share, r.column)):
        if result.defined_share < 1.0:
            known = BY_NAME.get(base_name(result.indicator))
            reason = known.undefined if known else "its function returned nan"
            missing = 1.0 - result.defined_share
            rows.append([Cell(result.column), Cell(f"{missing:.1%}", value=missing), Cell(reason)])
    head = ["Indicator and channel", "Undefined", "When"]
    return table(head, rows, sortable=True, tall=True, text=True) if rows else ""


def definition_html() -> str:
    """Return the definitions of all indicators."""
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
        [Cell(t) for t in (d.name, d.title, d.signal, d.formula, d.unit, d.known, d.undefined, d.source)]
        for d in DEFINITIONS
    ]
    return table(head, rows, tall=True, text=True)
