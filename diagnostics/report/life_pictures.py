"""What the page shows of a set of lives: age and remaining life of records, and each gearbox over its life."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence

import numpy as np

from diagnostics.explore.set_page import Lives
from diagnostics.indicators.table import RecordTable
from diagnostics.page.style import png_bytes, styled
from diagnostics.report.life_detection import CAPTION
from diagnostics.report.life_figure import life_figure
from diagnostics.report.unit_lives import unit_lives, watches
from diagnostics.training.life_baselines import HISTORY, OUTLOOK, history_predictions
from diagnostics.training.life_rows import inspections_of
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

SEED = 0
"""Of the folds that the predictions on the page come from; those of a report are its own."""
LIFE_COLUMNS = (("age_h", "Age [h]"), ("rul_h", "Remaining life [h]"))


def lives_of(dataset: Dataset, table: RecordTable) -> Lives:
    """Return age and remaining life of all records, and what draws a gearbox over its life."""
    ages = of_records(dataset, dataset.labels(columns=["record_id"]).column("record_id").to_pylist())
    labels = {name: np.array([row[name] for row in ages], dtype=object) for name, _ in LIFE_COLUMNS}
    return Lives(labels, LIFE_COLUMNS, figure_of(dataset, table))


def of_records(dataset: Dataset, record_ids: Sequence[int]) -> list[dict[str, float | None]]:
    """Return age and remaining life of records; None where a gearbox was taken out, or a benchmark does not tell."""
    rows = sorted(dataset.life("inspections").to_pylist(), key=lambda row: row["record_id"])
    first = np.array([row["record_id"] for row in rows])  # of an inspection's records
    places = np.searchsorted(first, np.asarray(record_ids), side="right") - 1
    return [{name: rows[place].get(name) for name, _ in LIFE_COLUMNS} for place in places.tolist()]


def figure_of(dataset: Dataset, table: RecordTable) -> Callable[[int], dict[str, str]] | None:
    """Return what draws a gearbox over its life, with its caption; None where too few failed to learn from."""
    try:
        found = inspections_of(dataset, table)
    except DatasetError:
        return None
    predicted = {HISTORY: history_predictions(found, SEED), OUTLOOK: found.outlook_h}
    seen = watches(found)

    def figure(gearbox: int) -> dict[str, str]:
        (life,) = unit_lives(dataset, found, seen, predicted, [gearbox]).values()
        with styled():
            return {"png": base64.b64encode(png_bytes(life_figure(life))).decode("ascii"), "caption": CAPTION}

    return figure
