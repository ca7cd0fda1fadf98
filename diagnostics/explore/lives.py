"""What the page shows of a set of lives: age and remaining life of records, and each gearbox over its life."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from diagnostics.indicators.table import RecordTable
from diagnostics.page.style import png_bytes
from diagnostics.report.life_detection import CAPTION
from diagnostics.report.life_figure import life_figure
from diagnostics.report.life_rows import inspections_of
from diagnostics.report.unit_lives import unit_lives, watches
from diagnostics.training.life_baselines import HISTORY, OUTLOOK, history_predictions
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

SEED = 0
"""Of the folds that the predictions on the page come from; those of a report are its own."""
LIFE_COLUMNS = (("age_h", "Age [h]"), ("rul_h", "Remaining life [h]"))


def of_records(dataset: Dataset, record_ids: Sequence[int]) -> list[dict[str, float | None]]:
    """Return age and remaining life of records; None where a gearbox was taken out."""
    rows = sorted(dataset.life("inspections").to_pylist(), key=lambda row: row["record_id"])
    first = np.array([row["record_id"] for row in rows])  # of an inspection's records
    places = np.searchsorted(first, np.asarray(record_ids), side="right") - 1
    return [{name: rows[place][name] for name, _ in LIFE_COLUMNS} for place in places.tolist()]


def life_pictures(dataset: Dataset, table: RecordTable, chosen: Sequence[int]) -> dict[str, dict[str, Any]]:
    """Return figure and caption of gearboxes over their lives; none where too few failed to learn from."""
    try:
        found = inspections_of(dataset, table)
    except DatasetError:
        return {}
    predicted = {HISTORY: history_predictions(found, SEED), OUTLOOK: found.outlook_h}
    lives = unit_lives(dataset, found, watches(found), predicted, chosen)
    return {
        str(unit): {"png": base64.b64encode(png_bytes(life_figure(one))).decode("ascii"), "caption": CAPTION}
        for unit, one in lives.items()
    }
