"""Report of the evaluation of indicators: one page, one JSON file, tables of all values and all results."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.base.progress import Stage, silent_stage
from diagnostics.indicators.classifier_table import write_table
from diagnostics.indicators.indicator import base_name
from diagnostics.indicators.ranking_table import IndicatorTable
from diagnostics.page import html
from diagnostics.page.provenance import provenance
from diagnostics.page.style import png_bytes, styled
from diagnostics.page.tables import indicator_links, records_line, set_table
from diagnostics.page.wording import joined, percent
from diagnostics.records.channel_quantities import ShownQuantity, channel_quantities
from diagnostics.records.named_set import words_of
from diagnostics.records.state_classes import HEALTHY, damage_kinds, ordered_states
from diagnostics.report import indicator_figures, indicator_tables
from diagnostics.report.indicator_figures import column_title
from diagnostics.report.indicator_sentences import best_by_state, indicator_findings
from diagnostics.report.report import clipping_notes
from diagnostics.statistics.assessment import AssessmentSettings, assessment, result_table
from diagnostics.statistics.detectable_size import NoiseCurve, noise_curve
from diagnostics.statistics.indicator_result import IndicatorResult
from diagnostics.statistics.judged_records import JudgedRecords, judged_records
from diagnostics.training.realism import meaning_of_scores
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVES_SHOWN = 6
PAGE, NUMBERS = "indicators.html", "indicators.json"
MOST_DETAILED = 150
"""Columns in the tables below the ranking: with all of 422 the page of a small set would have 1.3 MB."""
MOST_RANKED = 600
"""Columns in the ranking: all of two channels; six would make it 1.4 MB."""
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


@dataclass(frozen=True, slots=True)
class Evaluated:
    """Everything the page is made of."""

    table: IndicatorTable
    settings: AssessmentSettings
    records: JudgedRecords
    found: list[IndicatorResult]
    noise: dict[str, dict[str, NoiseCurve]]

    @property
    def shown(self) -> list[IndicatorResult]:
        """The best channel of each of the best indicators of different definition."""
        chosen: dict[str, IndicatorResult] = {}
        for result in self.found:
            chosen.setdefault(base_name(result.indicator), result)
        return list(chosen.values())[:CURVES_SHOWN]


def write_indicator_report(
    dataset: Dataset,
    table: IndicatorTable,
    folder: Path,
    settings: AssessmentSettings | None = None,
    stage: Stage = silent_stage,
    *,
    explorer: str = "",
) -> Path:
    """Evaluate a table of indicators and write everything; return the page's path.

    Parameters
    ----------
    dataset : siggen Dataset
        The set that the table was made of.
    table : IndicatorTable
        All indicators of the set.
    folder : Path
        Created where missing. Gets `indicators.html`, `indicators.json`, `indicators.parquet` (all values),
        `evaluation.parquet` and `.csv` (all results, in the order of the ranking) and `figures/`.
    settings : AssessmentSettings, optional
        Default: `AssessmentSettings()`.
    stage : Stage
        Told of every step.
    explorer : str
        Name of the page to explore beside it, to which tables and figures then lead.

    Raises
    ------
    UsageError
        If matplotlib is missing.
    """
    require_packages("the report of indicators", "matplotlib")
    chosen = settings or AssessmentSettings()
    folder.mkdir(parents=True, exist_ok=True)
    words = words_of(dataset)
    write_table(words.table(table.arrow()), folder / "indicators.parquet")
    with stage("evaluation", len(table.matrix.names)) as advance:
        found = assessment(table, chosen, advance)
    evaluated = Evaluated(table, chosen, judged_records(table.matrix.labels, chosen.seed, chosen.resamples), found, {})
    evaluated = Evaluated(table, chosen, evaluated.records, found, _noise_curves(evaluated))
    results = words.table(result_table(found))
    write_table(results, folder / "evaluation.parquet")
    write_table(results, folder / "evaluation.csv")
    states_found = evaluated.records.states
    sentences = [
        meaning_of_scores(dataset.config, scored=bool(states_found)),
        *indicator_findings(found, states_found, _specimens(table)),
    ]
    numbers = report_numbers(dataset, evaluated, sentences)
    (folder / NUMBERS).write_text(words(json.dumps(numbers, indent=1, allow_nan=False)) + "\n", encoding="utf-8")
    with stage("figures", 1) as advance, styled():
        drawn_figures = figures(evaluated, channel_quantities(dataset))
        pictures = {name: (png_bytes(words.figure(drawn)), text) for name, (drawn, text) in drawn_figures.items()}
        advance()
    (folder / "figures").mkdir(exist_ok=True)
    for name, (png, _) in pictures.items():
        (folder / "figures" / f"{name}.png").write_bytes(png)
    return _write_page(dataset, folder, evaluated, sentences, pictures, explorer)


def _specimens(table: IndicatorTable) -> int:
    return int(np.unique(table.matrix.labels["specimen_id"]).size)


def _noise_curves(evaluated: Evaluated) -> dict[str, dict[str, NoiseCurve]]:
    """Return AUC over signal-to-noise ratio of the indicators shown, by column and state."""
    labels, curves = evaluated.table.matrix.labels, {}
    for result in evaluated.shown:
        if f"snr_{result.channel}_db" not in labels:
            continue
        values = result.direction * evaluated.table.matrix.values[:, evaluated.table.matrix.names.index(result.column)]
        found = {}
        for state in evaluated.records.states:
            chosen = np.isfinite(values) & ((labels["fault"] == HEALTHY) | (labels["state"] == state))
            found[state] = noise_curve(
                values[chosen],
                (labels["state"] == state)[chosen],
                labels[f"snr_{result.channel}_db"][chosen],
                labels["specimen_id"][chosen],
                evaluated.records.weights[:, chosen],
            )
        curves[result.column] = found
    return curves


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
        "noise": (
            indicator_figures.noise_figure(evaluated.noise, names),
            f"Separation of {joined(indicator_figures.shown_states(names))} over the signal-to-noise ratio, with 95 % "
            "limits. Each group has the same number of records.",
        ),
    }
    return {name: (figure, caption) for name, (figure, caption) in drawn.items() if figure is not None}


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
        "left_out": [str(problem) for problem in table.problems],
        "notes": _note_counts(table),
        "results": [result.numbers() for result in evaluated.found],
        "noise_curves": {
            column: {state: {"snr_db": c.snr_db, "auc": [a.numbers() for a in c.auc]} for state, c in found.items()}
            for column, found in evaluated.noise.items()
        },
    }


def _note_counts(table: IndicatorTable) -> list[str]:
    reasons, counts = np.unique([note for note in table.notes if note], return_counts=True)
    return [f"{count} of {len(table.notes)} records: {reason}" for reason, count in zip(reasons, counts, strict=True)]


def _write_page(
    dataset: Dataset,
    folder: Path,
    evaluated: Evaluated,
    sentences: Sequence[str],
    pictures: dict[str, tuple[bytes, str]],
    explorer: str,
) -> Path:
    found, names, table = evaluated.found, evaluated.records.states, evaluated.table
    behind = _behind(evaluated, explorer)

    def grid(*wanted: str) -> str:
        shown = [name for name in wanted if name in pictures]
        return html.figure_grid([html.figure_block(*pictures[name], behind.get(name, "")) for name in shown])

    title = f"Indicators of {dataset.path.name}"
    first = found[:MOST_DETAILED]
    undefined = indicator_tables.undefined_html(found, _left_out(table))
    sections = [
        html.heading("Records"),
        set_table(table.matrix.labels, ordered_states(table.matrix.labels), explorer),
        html.heading("Ranking"),
        html.paragraph(HOW_TO_READ),
        indicator_tables.best_html(best_by_state(found, names)),
        indicator_tables.ranking_html(found[:MOST_RANKED], names, explorer),
        *([html.paragraph(_detail_text(len(found)))] if len(found) > MOST_DETAILED else []),
        indicator_tables.separation_html(indicator_figures.separation_rows(found, names), names, explorer),
        *(indicator_tables.same_specimen_html(first, names), indicator_tables.p_value_html(first, names)),
        html.heading("Trend with severity, and the smallest damage found"),
        html.paragraph(_size_text(evaluated)),
        indicator_tables.trend_html(first, names),
        grid("severity", "noise", "detection"),
        html.heading("What changes indicators in healthy records"),
        html.paragraph(
            "The table gives the adjusted share of rank variance that each cause explains alone. Speed, load and "
            "signal-to-noise ratio are fitted as a parabola, sensor and specimen as groups. Causes may share variance."
        ),
        indicator_tables.sensitivity_html(first, explorer),
        *([html.heading("Undefined values"), undefined] if undefined else []),
        html.heading("Definitions"),
        indicator_tables.definition_html({channel.quantity for channel in dataset.channels}),
        html.heading("Notes"),
        *html.notes(_notes(dataset, evaluated)),
    ]
    parts = [html.heading(title, 1), *html.summary(sentences), html.contents(sections), *sections]
    path = folder / PAGE
    path.write_text(words_of(dataset)(html.page(title, parts)), encoding="utf-8")
    return path


def _behind(evaluated: Evaluated, explorer: str) -> dict[str, str]:
    """Return by figure the line that leads to its records."""
    titles = {result.column: column_title(result.column) for result in evaluated.shown}
    line = records_line("All records by", indicator_links(explorer, titles))
    return dict.fromkeys(("severity", "detection", "noise"), line)


def _left_out(table: IndicatorTable) -> dict[str, float]:
    """Return by channel the share of records that could not be used there."""
    rows = len(table.notes)
    lost = {
        (p.record_id, channel) for p in table.problems for channel in ([p.channel] if p.channel else table.channels)
    }
    return {channel: sum(name == channel for _, name in lost) / rows for channel in table.channels}


def _detail_text(count: int) -> str:
    ranked = f"all {count}" if count <= MOST_RANKED else f"the first {MOST_RANKED} of {count}"
    return (
        f"The ranking has {ranked} columns. The tables below it have the first {MOST_DETAILED} of the ranking, so "
        "that the page opens quickly. The file evaluation.csv beside this page has every number of every column."
    )


def _size_text(evaluated: Evaluated) -> str:
    repeated = evaluated.records.pairs.null_rows.size > 0
    same = (
        "On the same specimen, changes are taken against its first healthy record. Its other healthy records set the "
        "threshold."
        if repeated
        else "On the same specimen no threshold can be set: the set has no repeated healthy records (repeats > 1)."
    )
    return (
        f"a50 and a90 are the sizes at which 50 % and 90 % of the damaged records give an alarm. The rate of false "
        f"alarms among healthy records is {percent(evaluated.settings.false_alarms)}. The sign ≤ means: found already "
        f"at the smallest damage of the set. {same} Monotonicity is the mean sign of the steps from each severity to "
        "the next. An indicator need not be monotone: pitting over many teeth lowers FM4 again."
    )


def _notes(dataset: Dataset, evaluated: Evaluated) -> list[str]:
    table = evaluated.table
    angle = table.settings.speed_range_hz
    settings = ", ".join(f"{name} {value}" for name, value in asdict(table.settings).items() if value is not None)
    return [
        *(f"Left out: {problem}" for problem in table.problems),
        *_note_counts(table),
        *kind_notes(dataset, evaluated.records.states),
        *clipping_notes(dataset),
        f"Revolutions averaged: pinion {_range(table.revolutions[:, 0])}, gear {_range(table.revolutions[:, 1])}. "
        "Where noise matters, values from averages depend on the number of revolutions (see noise_share).",
        f"Settings: {settings}; bootstrap seed {evaluated.settings.seed}, "
        f"{evaluated.records.weights.shape[0] - 1} resamples.",
        f"Shaft angles come from {f'mesh lines within {angle[0]:g} to {angle[1]:g} Hz' if angle else 'the pulses'}.",
        provenance(dataset, evaluated.settings.seed),
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
