"""The evaluation of indicators: how each separates damage, in numbers, tables and files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.indicators.classifier_table import write_table
from diagnostics.indicators.ranking_table import IndicatorTable
from diagnostics.report.indicator_figures import known_column
from diagnostics.report.indicator_sentences import indicator_findings
from diagnostics.statistics.assessment import AssessmentSettings, assessment, result_table
from diagnostics.statistics.indicator_result import IndicatorResult
from diagnostics.statistics.judged_records import JudgedRecords, judged_records
from diagnostics.training.realism import meaning_of_scores
from siggen.dataset.reading import Dataset
from siggen.file_writing import write_file

CURVES_SHOWN = 6
NUMBERS = "indicators.json"


@dataclass(frozen=True, slots=True)
class Evaluated:
    """Everything the page is made of."""

    table: IndicatorTable
    settings: AssessmentSettings
    records: JudgedRecords
    found: list[IndicatorResult]

    @property
    def shown(self) -> list[IndicatorResult]:
        """The best channel of each of the best indicators of different definition."""
        chosen: dict[str, IndicatorResult] = {}
        for result in self.found:
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
        found = assessment(table, chosen, advance)
    records = judged_records(table.matrix.labels, chosen.seed, chosen.resamples)
    return Evaluated(table, chosen, records, found)


def findings(dataset: Dataset, found: Evaluated) -> list[str]:
    """Say what the scores mean, which indicators are best, and what survives."""
    states = found.records.states
    meaning = meaning_of_scores(dataset.config, scored=bool(states))
    return [meaning, *indicator_findings(found.found, states, _specimens(found.table))]


def write_evaluation(dataset: Dataset, found: Evaluated, folder: Path, *, values: bool = False) -> Path:
    """Write `evaluation.parquet` and `.csv` (all results, best first) and `indicators.json`; return the CSV's path.

    With `values` also `indicators.parquet`: labels and all indicators of every record, those with a history too.
    """
    if values:
        write_table(found.table.arrow(), folder / "indicators.parquet")
    results = result_table(found.found)
    write_table(results, folder / "evaluation.parquet")
    write_table(results, folder / "evaluation.csv")
    numbers = report_numbers(dataset, found, findings(dataset, found))
    write_file(folder / NUMBERS, json.dumps(numbers, indent=1, allow_nan=False) + "\n")
    return folder / "evaluation.csv"


def _specimens(table: IndicatorTable) -> int:
    return int(np.unique(table.matrix.labels["specimen_id"]).size)


def report_numbers(dataset: Dataset, found: Evaluated, sentences: Sequence[str]) -> dict[str, Any]:
    """Return the content of `indicators.json`; undefined and unreached numbers are null."""
    table = found.table
    return {
        "set": dataset.path.name,
        "identity": dataset.manifest["identity"],
        "records": int(table.matrix.values.shape[0]),
        "specimens": _specimens(table),
        "states": list(found.records.states),
        "summary": list(sentences),
        "indicator_settings": asdict(table.settings),
        "assessment_settings": asdict(found.settings),
        "left_out": [str(problem) for problem in table.problems],
        "notes": note_counts(table),
    }


def note_counts(table: IndicatorTable) -> list[str]:
    """Return how often each reason for undefined values occurs."""
    reasons, counts = np.unique([note for note in table.notes if note], return_counts=True)
    return [f"{count} of {len(table.notes)} records: {reason}" for reason, count in zip(reasons, counts, strict=True)]
