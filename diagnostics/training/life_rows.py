"""Inspections of a set of gearboxes that run to failure, with their indicators and what is true of them, as arrays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.indicators.ranking_table import unusable_records, with_history
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.records.sample_bytes import BYTES
from diagnostics.training.average_rows import AveragedRecords, averaged_records
from diagnostics.training.life_baselines import WORST_TEETH, Inspections
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

INDICATORS = ("rms", "kurtosis", "fm4", "m6a", "energy_ratio")
HISTORY, SAMPLES = "history", "samples"
OUTLOOK_COLUMNS = ("rul_q10_h", "rul_q50_h", "rul_q90_h")
FEWEST_FAILED = 4


def inspections(dataset: Dataset, stage: Stage) -> Inspections:
    """Return the inspections of a set that have a record; order and errors as of `inspections_of`."""
    _check_failed(dataset)
    with stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = record_table(dataset, advance=advance)
    return inspections_of(dataset, table)


def _check_failed(dataset: Dataset) -> None:
    if not any(name.startswith("life/units/") for name in dataset.inventory.files):
        raise DatasetError(
            f"{dataset.path}: does not tell when its gearboxes fail, as a test part of a benchmark; allowed: the part "
            "to learn from, or any other set of lives"
        )
    events = dataset.life("units").column("event").to_pylist()
    if (failed := events.count("failed")) < FEWEST_FAILED:
        raise DatasetError(
            f"{dataset.path}: received {failed} failed of {len(events)} gearboxes; allowed: at least {FEWEST_FAILED} "
            "failed. Generate more (specimens), or look at them for longer (life.most, life.interval_h)."
        )


def inspections_of(dataset: Dataset, table: RecordTable) -> Inspections:
    """Return the inspections of a set of which its table has a record, in the order of gearbox and age.

    Raises
    ------
    DatasetError
        If fewer than four gearboxes failed: nothing could be judged on gearboxes that were not trained on. If the set
        does not tell.
    """
    _check_failed(dataset)
    found, keys = blind_inspections(dataset, table), _in_order(dataset, table)
    units = {row["specimen_id"]: row for row in dataset.life("units").to_pylist()}
    rows, outlook = _by_inspection(dataset, "inspections"), _by_inspection(dataset, "outlook")
    shares = _worst_shares(dataset.life("teeth"))
    return replace(
        found,
        rul_h=np.array([rows[key]["rul_h"] for key in keys], dtype=np.float64),
        observed_h=np.array([units[specimen]["observed_h"] for specimen, _ in keys]),
        worst_shares=np.array([shares.get(key, [0.0] * WORST_TEETH) for key in keys]),
        outlook_h=np.array([[outlook[key][name] for name in OUTLOOK_COLUMNS] for key in keys]),
        averages=_averages(table, keys),
    )


def blind_inspections(dataset: Dataset, table: RecordTable) -> Inspections:
    """Return the inspections as `inspections_of`, without truth (NaN) and averages: a test part need have no more."""
    means, keys = _means(table), _in_order(dataset, table)
    debris_mg = {key: row["debris_mg"] for key, row in _by_inspection(dataset, "debris").items()}
    rows, unknown = _by_inspection(dataset, "inspections"), np.full(len(keys), np.nan)
    return Inspections(
        record_id=np.array([rows[key]["record_id"] for key in keys]),
        specimen=np.array([specimen for specimen, _ in keys]),
        split=np.array([rows[key]["split"] for key in keys]),
        age_h=np.array([rows[key]["age_h"] for key in keys]),
        rul_h=unknown,
        observed_h=unknown,
        indicators={name: np.stack([means[key][name] for key in keys]) for name in INDICATORS},
        history=np.stack([means[key][HISTORY] for key in keys]),
        sample_bytes=np.stack([means[key][SAMPLES] for key in keys]),
        debris_mg=np.array([debris_mg[key] for key in keys]),
        worst_shares=np.tile(unknown[:, None], WORST_TEETH),
        outlook_h=np.tile(unknown[:, None], len(OUTLOOK_COLUMNS)),
    )


Key = tuple[int, int]


def _in_order(dataset: Dataset, table: RecordTable) -> list[Key]:
    """Return gearbox and number of every inspection of which there is a record."""
    labels = table.labels()
    known = set(zip(labels["specimen_id"].tolist(), labels["state_id"].tolist(), strict=True))
    return sorted(known & _by_inspection(dataset, "inspections").keys())


def _by_inspection(dataset: Dataset, name: str) -> dict[Key, dict[str, object]]:
    """Return the rows of a table of `life/` with one for each inspection."""
    return {(row["specimen_id"], row["inspection"]): row for row in dataset.life(name).to_pylist()}


def _means(table: RecordTable) -> dict[Key, dict[str, np.ndarray]]:
    """Return the mean of each column over the records of an inspection, by indicator; NaN where undefined."""
    labels = table.labels()
    keys = np.stack([labels["specimen_id"], labels["state_id"]], axis=1)
    unique, index = np.unique(keys, axis=0, return_inverse=True)
    found: dict[Key, dict[str, np.ndarray]] = {(int(a), int(b)): {} for a, b in unique}
    counts = np.bincount(index.reshape(-1))
    for name, values in _columns(table).items():
        sums = np.zeros((counts.size, values.shape[1]))
        np.add.at(sums, index.reshape(-1), values)
        for key, row in zip(found, sums / counts[:, None], strict=True):
            found[key][name] = row
    return found


def _columns(table: RecordTable) -> dict[str, np.ndarray]:
    """Return by indicator the columns of every record (records, columns), and those with a history, and of bytes."""
    rows, labels = np.arange(table.rows), _in_time(table.labels())
    unusable = unusable_records(table, rows)
    with_own = [
        values
        for channel in table.channels
        for name, values in with_history(table, labels, rows, channel, unusable[channel]).items()
        if table.columns[name.partition("__")[0]].entry.name in ("na4", "nb4")  # na4_star asks what is healthy
    ]
    own = [(name, table.columns[name.partition("__")[0]].entry.name) for name in table.names() if name not in table.own]
    five = {name: table.values([column for column, entry in own if entry == name]) for name in INDICATORS}
    samples = [f"{name}.{channel}" for channel in table.channels for name in ("samples", *BYTES)]
    return {**five, HISTORY: np.stack(with_own, axis=1), SAMPLES: table.values(samples)}


def _in_time(labels: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return labels by whose order a history is that of inspections, whatever the damage."""
    return {**labels, "damaged_area_mm2": np.zeros(len(labels["state_id"]))}


def _averages(table: RecordTable, keys: list[Key]) -> AveragedRecords | None:
    """Return the averages of inspections, each of its records at the first operating point; None of short records."""
    try:
        every = averaged_records(table)
    except DatasetError:
        return None
    labels = table.labels()
    rows: dict[Key, list[int]] = {key: [] for key in keys}
    for row in np.flatnonzero(labels["operating_point_id"] == 0).tolist():
        rows[int(labels["specimen_id"][row]), int(labels["state_id"][row])].append(row)
    if not all(rows.values()):
        return None
    lines = np.stack([every.lines[own].mean(axis=0) for own in rows.values()])
    return AveragedRecords(lines, every.teeth[[own[0] for own in rows.values()]], every.channels)


def _worst_shares(table: pa.Table) -> dict[Key, list[float]]:
    """Return the largest shares of a flank of each inspection with a pitted tooth, the largest first."""
    shares: dict[Key, list[float]] = {}
    for row in table.to_pylist():
        shares.setdefault((row["specimen_id"], row["inspection"]), []).append(row["area_share"])
    return {key: (sorted(own, reverse=True) + [0.0] * WORST_TEETH)[:WORST_TEETH] for key, own in shares.items()}
