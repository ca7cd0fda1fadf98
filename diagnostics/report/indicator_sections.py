"""What a report says of indicators one by one: ranking, curves over severity and size, notes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.page import html
from diagnostics.page.tables import indicator_links, records_line
from diagnostics.page.wording import percent
from diagnostics.records.channel_quantities import ShownQuantity
from diagnostics.records.state_classes import damage_kinds, ordered_states
from diagnostics.report import indicator_figures, indicator_tables
from diagnostics.report.indicator_evaluation import Evaluated, findings, note_counts
from diagnostics.report.indicator_sentences import best_by_state
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_RANKED = 600
"""Columns in the ranking: all of two channels; six would make it 1.4 MB."""
OF_THE_FILE = (
    "Trends, smallest sizes found, effects, causes and p-values of every column are in evaluation.csv beside this page."
)
HOW_TO_READ = (
    'Indicators are judged in two designs. "Other specimens" compares healthy with damaged records of all gearboxes. '
    'There an AUC of 0.5 is chance, and Cliff\'s delta is 2 AUC − 1. "Same specimen" compares each damaged record with '
    "the healthy one of the same gearbox, operating point and repeat. It gives the share of pairs in which the "
    "indicator is higher after damage. A score is the mean over the states, turned so that 1 is perfect. The direction "
    "of turning comes from the same-specimen design. The 95 % limits come from resampled specimens. The p-values come "
    "from specimen means: Mann-Whitney for other specimens, Wilcoxon for the same specimen. Holm's method adjusts them "
    "over all indicators, channels and states. Mann-Whitney is conservative here, because healthy and damaged "
    "gearboxes are the same. NA4, NA4* and NB4 compare each record with the healthy and milder ones of its own "
    "specimen, in the true order of severity. They know more than indicators of single records, so the summary leaves "
    "them out."
)


def figures(evaluated: Evaluated, held: Mapping[str, ShownQuantity]) -> dict[str, tuple[Figure, str]]:
    """Return all figures by file name with their captions; those without data are left out."""
    names = evaluated.records.states
    if not names or not evaluated.shown:
        return {}
    matrix = evaluated.table.matrix
    intact = tuple(state for state in ordered_states(matrix.labels) if state not in names)
    drawn: dict[str, tuple[Figure | None, str]] = {
        "severity": (
            indicator_figures.severity_figure(matrix, evaluated.shown, names, intact, held),
            "Indicators over the severity of damage: median (red), 5 to 95 % of the records (blue), specimens (grey).",
        ),
        "detection": (
            indicator_figures.detection_figure(
                matrix, evaluated.records, evaluated.shown, evaluated.settings.false_alarms
            ),
            f"Share of alarms over the damaged area at {percent(evaluated.settings.false_alarms)} false alarms "
            "(dashed), between different specimens, with 95 % limits. Dotted: a50 and a90.",
        ),
    }
    return {name: (figure, caption) for name, (figure, caption) in drawn.items() if figure is not None}


def ranking_blocks(dataset: Dataset, evaluated: Evaluated) -> list[str]:
    """Return what is best, and all indicators in order."""
    found, names = evaluated.found, evaluated.records.states
    gears = evaluated.table.matrix.gears
    _, *told = findings(dataset, evaluated)
    separation = indicator_figures.separation_rows(found, names)
    return [
        *(html.paragraph(sentence) for sentence in told),
        indicator_tables.best_html(best_by_state(found, names), gears),
        indicator_tables.ranking_html(found[:MOST_RANKED], names),
        indicator_tables.separation_html(separation, names, gears),
        html.paragraph(HOW_TO_READ),
    ]


def detail_blocks(evaluated: Evaluated, pictures: Mapping[str, tuple[bytes, str]]) -> list[str]:
    """Return the figures of the best indicators, and what is undefined."""
    line = _behind(evaluated)
    shown = [name for name in ("severity", "detection") if name in pictures]
    return [
        html.figure_grid([html.figure_block(*pictures[name], line) for name in shown]),
        html.paragraph(OF_THE_FILE),
        indicator_tables.undefined_html(evaluated.found, _left_out(evaluated)),
    ]


def _behind(evaluated: Evaluated) -> str:
    """Return the line that leads from figures to their records."""
    titles = {result.column: indicator_figures.in_words(result.column, result.gears) for result in evaluated.shown}
    return records_line("All records by", indicator_links(titles))


def _left_out(evaluated: Evaluated) -> dict[str, float]:
    """Return by channel the share of records that could not be used there."""
    table = evaluated.table
    rows = len(table.notes)
    lost = {
        (p.record_id, channel) for p in table.problems for channel in ([p.channel] if p.channel else table.channels)
    }
    return {channel: sum(name == channel for _, name in lost) / rows for channel in table.channels}


def evaluation_notes(dataset: Dataset, evaluated: Evaluated) -> list[str]:
    """Return what was left out, the kinds of damage, and the settings."""
    table = evaluated.table
    first, *_, last = evaluated.table.matrix.gears[0].gears
    settings = ", ".join(f"{name} {value}" for name, value in asdict(table.settings).items() if value is not None)
    return [
        *(f"Left out: {problem}" for problem in table.problems),
        *note_counts(table),
        *kind_notes(dataset, evaluated.records.states),
        f"Revolutions averaged: {first} {_range(table.revolutions[:, 0])}, {last} {_range(table.revolutions[:, 1])}. "
        "Where noise matters, values from averages depend on the number of revolutions (see noise_share).",
        f"Settings: {settings}; bootstrap seed {evaluated.settings.seed}, "
        f"{evaluated.records.weights.shape[0] - 1} resamples.",
    ]


def kind_notes(dataset: Dataset, damaged: Sequence[str]) -> list[str]:
    """Return a note where damaged states are of several kinds: sizes, trends and histories run across ladders."""
    present = set(dataset.labels().column_names)
    table = dataset.labels(columns=[name for name in ("state", "fault", "through_face") if name in present])
    kinds = damage_kinds({name: np.asarray(table.column(name).to_pylist()) for name in table.column_names}, damaged)
    if len(kinds) < 2:
        return []
    listed = "; ".join(f"{kind}: {', '.join(members)}" for kind, members in kinds.items())
    return [
        f"The damaged states are of {len(kinds)} kinds ({listed}). Sizes, trends and NA4 are meaningful within one "
        "kind only. To judge the states of one kind, give --state NAME once for each."
    ]


def _range(values: np.ndarray) -> str:
    low, high = int(values.min()), int(values.max())
    return str(low) if low == high else f"{low} to {high}"
