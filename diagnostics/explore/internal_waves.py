"""Transmission error, mesh force and mesh stiffness of records, where a set stores what no sensor sees."""

from __future__ import annotations

from typing import Any

import numpy as np

from diagnostics.explore.detail import Detail
from diagnostics.explore.record_views import packed_wave
from siggen.dataset.reading import Dataset

SHOWN = {
    "transmission_error_m": ("Transmission error", "µm", 1e6),
    "mesh_force_n": ("Mesh force", "N", 1.0),
    "mesh_stiffness_n_per_m": ("Mesh stiffness", "N/µm", 1e-6),
}
"""Title, shown unit and factor of the quantities that the page draws, of those that a set may store."""


def shown_internals(dataset: Dataset) -> list[dict[str, str]]:
    """Return name, title and shown unit of the stored quantities that the page draws; none for a set without them."""
    stored = {column.name for column in getattr(dataset, "internal_columns", ())}
    return [{"name": name, "title": title, "unit": unit} for name, (title, unit, _) in SHOWN.items() if name in stored]


def internal_waves(
    dataset: Dataset, ids: np.ndarray, detail: Detail, fine: list[tuple[int, int]]
) -> list[dict[str, Any]]:
    """Return the packed quantities of every record by name; empty for records that the set stores none of.

    Parameters
    ----------
    dataset : siggen Dataset
    ids : (n,) int64
        Records of the page.
    detail : Detail
        How many points.
    fine : list of (int, int)
        Stretch of every record that is kept whole, as of its signals.
    """
    found: list[dict[str, Any]] = [{} for _ in ids]
    names = [quantity["name"] for quantity in shown_internals(dataset)]
    place = {int(record): row for row, record in enumerate(ids)}
    if not names:
        return found
    for batch in dataset.internals(columns=["record_id", *names], batch_rows=16):
        for line, record in enumerate(batch.column("record_id").to_pylist()):
            row = place.get(record)
            if row is not None:
                series = {name: SHOWN[name][2] * np.asarray(batch.column(name)[line].values) for name in names}
                found[row] = {name: packed_wave(values, detail, fine[row]) for name, values in series.items()}
    return found
