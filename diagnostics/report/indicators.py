"""What a report shows of single indicators: their evaluation, sentences, tables, figures."""

from __future__ import annotations

import json
import math
import textwrap
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.indicators.classifier_table import write_table
from diagnostics.indicators.indicator import OF_CHANNEL
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.ranking_table import IndicatorTable
from diagnostics.indicators.registry import ALL, IndicatorColumn, column_title, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.page.blocks import Block, Cell, FigureBlock, FigureGrid, Paragraph, RecordLinks, TableBlock
from diagnostics.page.sentences import Sentences
from diagnostics.page.style import new_figure, state_ticks
from diagnostics.page.tables import cell, indicator_links, linked_cell, table
from diagnostics.page.wording import percent
from diagnostics.records.channel_quantities import ShownQuantity
from diagnostics.records.gear_train import GearNames
from diagnostics.records.state_classes import HEALTHY, damage_kinds, ordered_states
from diagnostics.records.usable_records import problem_lines
from diagnostics.statistics.detectable_size import detection_curve
from diagnostics.statistics.indicator_statistics import (
    SIZES,
    AssessmentSettings,
    IndicatorResult,
    JudgedRecords,
    assessment,
    judged_records,
    result_table,
    smallest_paired_p,
)
from diagnostics.training.realism import meaning_of_scores
from siggen.dataset.reading import Dataset
from siggen.file_writing import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CROWDED = 8
"""States beyond which their names are small."""
ROWS_SHOWN = 36
CURVE_COLOURS = ("#b01e3c", "#1f6f8b", "#e3a21a", "#6a1b6e", "#3c7d3e", "#5b6b7b")
MARKERS = "osD^vP"
LEGEND_SIGNS = 66


def known_column(column: str, gears: GearNames) -> IndicatorColumn | None:
    """Return what a column with its channel holds; None of the user's own."""
    return indicator_columns(IndicatorSettings(), gears).get(column.partition("__")[0])


def in_words(column: str, gears: GearNames) -> str:
    """Return what people call a column with its channel; the user's own indicators keep their names."""
    return column_title(column.partition("__")[0], gears)


def term_cell(column: str, gears: GearNames) -> Cell:
    """Return the cell that names a column: its title, which leads to the definition, its channel and its own name."""
    known = known_column(column, gears)
    channel = column.partition("__")[2]
    small = f"{channel}; {column.partition('__')[0]}" if channel else column
    return Cell(in_words(column, gears), small, link=f"#term-{known.entry.name}" if known else "")


def in_a_sentence(column: str, gears: GearNames) -> str:
    """Return a column as a sentence names it: its title in small letters where it is no acronym, and its channel."""
    title, channel = in_words(column, gears), column.partition("__")[2]
    if title[1:2].islower():
        title = title[:1].lower() + title[1:]
    return f"{title} at {channel}" if channel else title


def panel_title(column: str, gears: GearNames, width: int = 38) -> str:
    """Return title and channel of a column for a figure, in lines of at most so many signs."""
    title, channel = in_words(column, gears), column.partition("__")[2]
    return "\n".join(textwrap.wrap(f"{title} ({channel})" if channel else title, width))


def separation_rows(results: Sequence[IndicatorResult], states: tuple[str, ...]) -> dict[str, list[float]]:
    """Return the separations in both designs by indicator, median over channels, best first: `others` then `same`."""
    names = list(dict.fromkeys(result.indicator for result in results)) if states else []
    values = {name: _medians(results, name, states) for name in names}
    shown = sorted(names, key=lambda name: -_mean(values[name][: len(states)]))[:ROWS_SHOWN]
    return {name: values[name] for name in shown}


def _medians(results: Sequence[IndicatorResult], name: str, states: tuple[str, ...]) -> list[float]:
    """Return the median over channels of the separations, turned so that 1 is perfect."""
    rows = [result for result in results if result.indicator == name]
    medians = []
    for design in ("others", "same"):
        for state in states:
            turned = [0.5 + r.direction * (getattr(r, design)[state].separation.value - 0.5) for r in rows]
            defined = [value for value in turned if math.isfinite(value)]
            medians.append(float(np.median(defined)) if defined else math.nan)
    return medians


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if all(map(math.isfinite, values)) else -math.inf


def severity_figure(
    matrix: FeatureMatrix,
    shown: Sequence[IndicatorResult],
    states: tuple[str, ...],
    healthy: tuple[str, ...],
    channels: Mapping[str, ShownQuantity],
) -> Figure:
    """Return each indicator over the states: median and 5 to 95 % of the records, and every specimen as a thin line.

    `channels` says what channels hold; the unit of each indicator stands at its axis.
    """
    rows = (len(shown) + 1) // 2
    figure, axes = new_figure(rows, 2, height_in=0.8 + 1.6 * rows, sharex=True)
    ladder = (*healthy, *states)
    for axis, result in zip(axes.ravel(), shown, strict=False):
        values = matrix.values[:, matrix.names.index(result.column)]
        _draw_ladders(axis, matrix.labels, values, ladder)
        position = [k for k, state in enumerate(ladder) if np.isfinite(values[matrix.labels["state"] == state]).any()]
        limits = [np.nanquantile(values[matrix.labels["state"] == ladder[k]], [0.05, 0.5, 0.95]) for k in position]
        low, middle, high = np.array(limits).T
        axis.fill_between(position, low, high, color="#1f6f8b", alpha=0.18, linewidth=0)
        axis.plot(position, middle, color="#b01e3c", linewidth=1.8, marker="o", markersize=4)
        if np.nanmin(values) > 0 and np.nanmax(values) > 30 * np.nanmin(values):
            axis.set_yscale("log")
        axis.set_title(panel_title(result.column, result.gears), loc="left", fontsize=7)
        axis.set_ylabel(f"[{_unit(result, channels)}]", fontsize=7)
        state_ticks(axis, ladder, fontsize=8 if len(ladder) <= CROWDED else 7)
    for axis in axes.ravel()[len(shown) :]:
        axis.set_visible(False)
    return figure


def _unit(result: IndicatorResult, channels: Mapping[str, ShownQuantity]) -> str:
    """Return the unit of an indicator: that of its channel for levels and amplitudes, - for ratios."""
    known = known_column(result.column, result.gears)
    if known is None or not known.entry.unit:
        return "-"
    return channels[result.channel].unit if known.entry.unit == OF_CHANNEL else known.entry.unit


def _draw_ladders(axis: Any, labels: dict[str, np.ndarray], values: np.ndarray, ladder: tuple[str, ...]) -> None:
    """Draw the mean of every specimen over the states."""
    for specimen in np.unique(labels["specimen_id"])[:60]:
        of_specimen = labels["specimen_id"] == specimen
        means = []
        for state in ladder:
            chosen = values[of_specimen & (labels["state"] == state)]
            defined = chosen[np.isfinite(chosen)]
            means.append(float(defined.mean()) if defined.size else np.nan)
        axis.plot(range(len(ladder)), means, color="#8a97a3", linewidth=0.5, alpha=0.7)


def detection_figure(
    matrix: FeatureMatrix, records: JudgedRecords, shown: Sequence[IndicatorResult], false_alarms: float
) -> Figure | None:
    """Return the share of alarms over the damaged area, between other specimens, with intervals; None without data."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    figure, axes = new_figure(height_in=3.4)
    axis, drawn = axes[0, 0], 0
    healthy = matrix.labels["fault"] == HEALTHY
    for colour, marker, result in zip(CURVE_COLOURS, MARKERS, shown, strict=False):
        values = result.direction * matrix.values[:, matrix.names.index(result.column)]
        kept = np.isfinite(values)
        area = matrix.labels[SIZES["area_mm2"]]
        curve = detection_curve(values[kept], healthy[kept], area[kept], records.weights[:, kept], false_alarms)
        if curve is None:
            continue
        drawn += 1
        low, high = np.quantile(curve.share[1:], [0.025, 0.975], axis=0)
        axis.fill_between(curve.size, low, high, color=colour, alpha=0.12, linewidth=0)
        axis.plot(
            curve.size,
            curve.share[0],
            color=colour,
            marker=marker,
            markersize=4,
            label=panel_title(result.column, result.gears, LEGEND_SIGNS),
        )
    if not drawn:
        return None
    for level in (0.5, 0.9):
        axis.axhline(level, color="#8a97a3", linestyle=":", linewidth=0.9)
    axis.axhline(false_alarms, color="#8a97a3", linestyle="--", linewidth=0.9)
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_ylim(0.0, 1.03)
    axis.set_xlabel("Damaged area [mm²]")
    axis.set_ylabel("Share of alarms [-]")
    figure.legend(loc="outside lower center", ncols=1, fontsize=8)
    return figure


SIGNIFICANT = 0.05
FEWEST_SPECIMENS = 3
"""Of which a summary speaks: fewer give no test, and an interval of two points."""

WITH_HISTORY = ("na4_", "nb4_")


def indicator_findings(results: Sequence[IndicatorResult], states: tuple[str, ...], specimens: int) -> list[str]:
    """Return four findings: best in each design, hardest and easiest state, what survives, the smallest size found."""
    if not states:
        return [FINDINGS.no_damage()]
    if specimens < FEWEST_SPECIMENS:
        return [FINDINGS.few(specimens, FEWEST_SPECIMENS)]
    told = (_best(results, states), _by_state(results, states), _survivors(results, specimens), _smallest(results))
    return [text for text in told if text]


def hardest_sentence(evaluated: Evaluated) -> str:
    """Say which state single indicators find worst, of one state how well it is found; nothing without a state."""
    results, states = evaluated.results, evaluated.records.states
    if not states or _specimens(evaluated.table) < FEWEST_SPECIMENS:
        return ""
    return _by_state(results, states) or _best(results, states)


def single_records(results: Sequence[IndicatorResult]) -> list[IndicatorResult]:
    """Return the indicators that know nothing but their own record."""
    return [result for result in results if not result.indicator.startswith(WITH_HISTORY)]


def _best(results: Sequence[IndicatorResult], states: tuple[str, ...]) -> str:
    single = [result for result in single_records(results) if math.isfinite(result.score_others.value)]
    paired = [result for result in single if math.isfinite(result.score_same.value)]
    other = max(single, key=lambda result: result.score_others.value, default=None)
    return FINDINGS.best(other, max(paired, key=lambda result: result.score_same.value, default=None), states)


def best_by_state(results: Sequence[IndicatorResult], states: tuple[str, ...]) -> dict[str, tuple[float, str]]:
    """Return by state the best AUC between other specimens, turned by direction, and whose it is."""
    best = {}
    for state in states:
        turned = [
            (0.5 + r.direction * (r.others[state].separation.value - 0.5), r.column)
            for r in single_records(results)
            if math.isfinite(r.others[state].separation.value)
        ]
        if turned:
            best[state] = max(turned)
    return best


def _by_state(results: Sequence[IndicatorResult], states: tuple[str, ...]) -> str:
    """Name the hardest and the easiest of several states."""
    best = best_by_state(results, states)
    if len(best) < 2:
        return ""  # the sentence before has said it
    hardest, easiest = (chosen(best, key=lambda state: best[state][0]) for chosen in (min, max))
    return FINDINGS.by_state((hardest, *best[hardest]), (easiest, *best[easiest]), results[0].gears)


def _survivors(judged: Sequence[IndicatorResult], specimens: int) -> str:
    others, same = ([r for entry in judged for r in getattr(entry, design).values()] for design in ("others", "same"))
    tested = [sum(math.isfinite(r.p_value) for r in results) for results in (others, same)]
    return FINDINGS.survivors(
        tested,
        kept=[sum(r.holm < SIGNIFICANT for r in results) for results in (others, same)],
        mild=sum(r.false_discovery < SIGNIFICANT for r in same),
        level=SIGNIFICANT,
        specimens=specimens,
        least_p=smallest_paired_p(specimens),
        needed=math.ceil(1.0 + math.log2(max(tested[1], 1) / SIGNIFICANT)),
    )


def _smallest(results: Sequence[IndicatorResult]) -> str:
    name = "others_area_mm2_a90"
    judged = [r for r in single_records(results) if name in r.detectable and not math.isnan(r.detectable[name].value)]
    reached = [r for r in judged if math.isfinite(r.detectable[name].value)]
    best = min(reached, key=lambda r: (r.detectable[name].value, -r.score_others.value), default=None)
    size, least = (best.detectable[name], best.smallest_size["others_area_mm2"]) if best else (None, None)
    return FINDINGS.smallest(judged, best, size, least)


def size_text(size: float) -> str:
    """Return a size, or the sign for one that is not reached."""
    return f"{size:.3g}" if math.isfinite(size) else "∞"


FINDINGS = Sentences(
    Path(__file__).with_name("templates") / "findings.txt", in_a_sentence=in_a_sentence, size_text=size_text
)


ARROWS = {1: "rises", -1: "falls"}
BEHIND = " A number leads to the records behind it."
OF_HISTORY = ("na4", "nb4")
"""Indicators with a history are of several records: none stands in the list of records."""


def _behind(cell: Cell, column: str, **chosen: object) -> Cell:
    """Return a cell that leads to the records that it is about."""
    return cell if column.startswith(OF_HISTORY) else linked_cell(cell, indicator=column, **chosen)


def ranks_table(results: Sequence[IndicatorResult], states: tuple[str, ...]) -> TableBlock:
    """Return the best indicators between other specimens in their order, with the AUC of every state."""
    head = ["Indicator, channel", "Rank", "Score", *(f"AUC, {state}" for state in states), "With damage"]
    rows = [
        (
            *(term_cell(r.column, r.gears), rank, r.score_others),
            *(_behind(cell(r.others[state].separation), r.column, state=state) for state in states),
            ARROWS[r.direction],
        )
        for rank, r in enumerate(results, start=1)
        if rank <= MOST_RANKED or known_column(r.column, r.gears) is None
    ]
    shown = f"The best {len(rows)} of {len(results)}" if len(results) > len(rows) else "Ranking"
    caption = (
        f"{shown} between different specimens: AUC against healthy with 95 % limits. The score is their mean, of an "
        "indicator that falls with damage 1 less it."
    )
    return table(head, rows, caption + BEHIND, sortable=True, tall=True)


def separation_table(rows: Mapping[str, Sequence[float]], states: tuple[str, ...], gears: GearNames) -> TableBlock:
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
    return TableBlock(head, cells, caption=caption, sortable=True, tall=True)


def _separation(value: float) -> Cell:
    return replace(cell(value), shade=2.0 * value - 1.0)


def best_table(best: Mapping[str, tuple[float, str]], gears: GearNames) -> TableBlock:
    """Return the best single indicator of every state."""
    rows = [(state, value, term_cell(column, gears)) for state, (value, column) in best.items()]
    caption = "Best single indicator of each state, between different specimens. The best of many is optimistic."
    return table(["State", "AUC [-]", "Indicator and channel"], rows, caption, sortable=True, text=True)


def undefined_table(results: Sequence[IndicatorResult], left_out: Mapping[str, float]) -> TableBlock:
    """Return which indicators have no value in some records, how often, and when that is so.

    Parameters
    ----------
    results : sequence of IndicatorResult
        All results.
    left_out : mapping of str to float
        By channel, the share of records that were left out: there every indicator is undefined, for another reason.
    """
    rows = []
    for result in sorted(results, key=lambda r: (r.defined_share, r.column)):
        missing = 1.0 - result.defined_share - left_out.get(result.channel, 0.0)
        if missing > 1e-9:
            known = known_column(result.column, result.gears)
            reason = known.entry.undefined if known else "its function returned nan"
            rows.append((term_cell(result.column, result.gears), 100.0 * missing, reason))
    head = ["Indicator and channel", "Undefined [%]", "When"]
    caption = "Indicators that are undefined in some of the records."
    return table(head, rows, caption, ".1f", sortable=True, tall=True, text=True)


def term_table(held: Collection[str]) -> TableBlock:
    """Return the definitions of the indicators that are taken of these quantities."""
    head = ["Column starts with", "Indicator", "Taken from", "Value", "Unit", "On known signals"]
    rows = [
        (
            Cell(d.name, name=f"term-{d.name}", hint=f"{d.formula}; from {d.signal}"),
            *(d.title, d.signal, d.formula, d.unit, d.known, d.undefined, d.source),
        )
        for d in ALL
        if any(d.is_taken_of(quantity) for quantity in held)
    ]
    return table([*head, "Undefined when", "Source"], rows, "Definitions of the indicators.", tall=True, text=True)


CURVES_SHOWN = 6
NUMBERS = "indicators.json"


@dataclass(frozen=True, slots=True)
class Evaluated:
    """Everything the page is made of."""

    table: IndicatorTable
    settings: AssessmentSettings
    records: JudgedRecords
    results: list[IndicatorResult]

    @property
    def shown(self) -> list[IndicatorResult]:
        """The best channel of each of the best indicators of different definition."""
        chosen: dict[str, IndicatorResult] = {}
        for result in self.results:
            known = known_column(result.column, result.gears)
            chosen.setdefault(known.entry.name if known else result.indicator, result)
        return list(chosen.values())[:CURVES_SHOWN]


def evaluated(
    table: IndicatorTable, settings: AssessmentSettings | None = None, stage: Stage = silent_stage
) -> Evaluated:
    """Return what a table of indicators tells of damage.

    Parameters
    ----------
    table : IndicatorTable
        All indicators of the set.
    settings : AssessmentSettings, optional
        Default: `AssessmentSettings()`.
    stage : Stage
        Told of every step.
    """
    chosen = settings or AssessmentSettings()
    with stage("evaluation", len(table.matrix.names)) as advance:
        results = assessment(table, chosen, advance)
    records = judged_records(table.matrix.labels, chosen.seed, chosen.resamples)
    return Evaluated(table, chosen, records, results)


def findings(dataset: Dataset, evaluated: Evaluated) -> list[str]:
    """Say what the scores mean, where the user's own indicators stand, which are best, and what survives."""
    states = evaluated.records.states
    meaning = meaning_of_scores(dataset.config, scored=bool(states))
    return [meaning, *own_ranks(evaluated), *indicator_findings(evaluated.results, states, _specimens(evaluated.table))]


def own_ranks(evaluated: Evaluated) -> list[str]:
    """Return a sentence for each of the user's own indicators: where its best channel stands among all columns.

    None without a damaged state, which gives no order.
    """
    best: dict[str, tuple[int, IndicatorResult]] = {}
    for rank, result in enumerate(evaluated.results if evaluated.records.states else (), start=1):
        if known_column(result.column, result.gears) is None:
            best.setdefault(result.indicator, (rank, result))
    return [FINDINGS.own_rank(rank, result, len(evaluated.results)) for rank, result in best.values()]


def write_evaluation(dataset: Dataset, evaluated: Evaluated, folder: Path, *, values: bool = False) -> Path:
    """Write `evaluation.parquet` and `.csv` (all results, best first) and `indicators.json`; return the CSV's path.

    With `values` also `indicators.parquet`: labels and all indicators of every record, those with a history too.
    """
    if values:
        write_table(evaluated.table.arrow(), folder / "indicators.parquet")
    results = result_table(evaluated.results)
    write_table(results, folder / "evaluation.parquet")
    write_table(results, folder / "evaluation.csv")
    numbers = report_numbers(dataset, evaluated, findings(dataset, evaluated))
    write_file(folder / NUMBERS, json.dumps(numbers, indent=1, allow_nan=False) + "\n")
    return folder / "evaluation.csv"


def _specimens(table: IndicatorTable) -> int:
    return int(np.unique(table.matrix.labels["specimen_id"]).size)


def report_numbers(dataset: Dataset, evaluated: Evaluated, sentences: Sequence[str]) -> dict[str, Any]:
    """Return the content of `indicators.json`; undefined and unreached numbers are null."""
    table = evaluated.table
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": int(table.matrix.values.shape[0]),
        "specimens": _specimens(table),
        "states": list(evaluated.records.states),
        "summary": list(sentences),
        "indicator_settings": asdict(table.settings),
        "assessment_settings": asdict(evaluated.settings),
        "left_out": problem_lines(table.problems),
        "notes": note_counts(table),
    }


def note_counts(table: IndicatorTable) -> list[str]:
    """Return how often each reason for undefined values occurs."""
    reasons, counts = np.unique([note for note in table.notes if note], return_counts=True)
    return [f"{count} of {len(table.notes)} records: {reason}" for reason, count in zip(reasons, counts, strict=True)]


MOST_RANKED = 100
"""Columns in the ranking; what is worse separates nothing, and stands in evaluation.csv."""


def figures(evaluated: Evaluated, held: Mapping[str, ShownQuantity]) -> dict[str, tuple[Figure, str]]:
    """Return all figures by file name with their captions; those without data are left out."""
    names = evaluated.records.states
    if not names or not evaluated.shown:
        return {}
    matrix = evaluated.table.matrix
    intact = tuple(state for state in ordered_states(matrix.labels) if state not in names)
    drawn: dict[str, tuple[Figure | None, str]] = {
        "severity": (
            severity_figure(matrix, evaluated.shown, names, intact, held),
            "Indicators over the severity of damage: median (red), 5 to 95 % of the records (blue), specimens (grey).",
        ),
        "detection": (
            detection_figure(matrix, evaluated.records, evaluated.shown, evaluated.settings.false_alarms),
            f"Share of alarms over the damaged area at {percent(evaluated.settings.false_alarms)} false alarms "
            "(dashed), between different specimens, with 95 % limits. Dotted: a50 and a90.",
        ),
    }
    return {name: (figure, caption) for name, (figure, caption) in drawn.items() if figure is not None}


def ranking_blocks(dataset: Dataset, evaluated: Evaluated) -> list[Block]:
    """Return what is best, and all indicators in order."""
    results, names = evaluated.results, evaluated.records.states
    gears = evaluated.table.matrix.gears
    _, *told = findings(dataset, evaluated)
    separation = separation_rows(results, names)
    return [
        *(Paragraph(sentence) for sentence in told),
        best_table(best_by_state(results, names), gears),
        ranks_table(results, names),
        separation_table(separation, names, gears),
        Paragraph(FINDINGS.how_to_read()),
    ]


def detail_blocks(evaluated: Evaluated, pictures: Mapping[str, tuple[bytes, str]]) -> list[Block]:
    """Return the figures of the best indicators, and what is undefined."""
    line = _records_behind(evaluated)
    shown = [name for name in ("severity", "detection") if name in pictures]
    return [
        FigureGrid([FigureBlock(*pictures[name], line) for name in shown]),
        Paragraph(FINDINGS.of_the_file()),
        undefined_table(evaluated.results, _left_out(evaluated)),
    ]


def _records_behind(evaluated: Evaluated) -> RecordLinks:
    """Return the line that leads from figures to their records."""
    titles = {result.column: in_words(result.column, result.gears) for result in evaluated.shown}
    return RecordLinks("All records by", indicator_links(titles))


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
    turns = [f"{gear} {_range(table.revolutions[:, k])}" for k, gear in enumerate((first, last))]
    resamples = evaluated.records.weights.shape[0] - 1
    return [
        *(f"Left out: {problem}" for problem in problem_lines(table.problems)),
        *note_counts(table),
        *kind_notes(dataset, evaluated.records.states),
        FINDINGS.averaged(*turns),
        FINDINGS.settings(asdict(table.settings), evaluated.settings.seed, resamples),
    ]


def kind_notes(dataset: Dataset, damaged: Sequence[str]) -> list[str]:
    """Return a note where damaged states are of several kinds: sizes, trends and histories run across ladders."""
    present = set(dataset.labels().column_names)
    table = dataset.labels(columns=[name for name in ("state", "fault", "through_face") if name in present])
    kinds = damage_kinds({name: np.asarray(table.column(name).to_pylist()) for name in table.column_names}, damaged)
    return [FINDINGS.several_kinds(kinds)] if len(kinds) > 1 else []


def _range(values: np.ndarray) -> str:
    low, high = int(values.min()), int(values.max())
    return str(low) if low == high else f"{low} to {high}"
