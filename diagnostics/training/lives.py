"""Baselines of remaining life: what age, indicators and true areas tell of gearboxes that were not trained on.

Age: Weibull law of all lives, those of gearboxes that were taken out as at least as long, given that the gearbox still
runs. A network on averages: `life_network`. Everything else: gradient boosting of quantiles on the rows of failed
gearboxes. Source: standard literature. Inspections come as arrays, with their indicators and what is true of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.ranking_table import unusable_records, with_history
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.records.sample_bytes import BYTES
from diagnostics.statistics.life_scores import QUANTILES, unit_folds
from diagnostics.training.average_rows import AveragedRecords, averaged_records
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords

FOLDS = 5
WORST_TEETH = 3
CONSTANT, AGE, RMS, FIVE, FIVE_AGE = "constant", "age", "RMS", "five indicators", "five indicators, age"
HISTORY, DEBRIS = "five indicators with their history, age", "oil debris, age"
NETWORK = "sequence network on averages, age"
AREAS, OUTLOOK = "true areas of the three worst teeth, age", "the true state itself"
Predictor = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Rows to learn from and rows to predict, (n,) bool each; returns the latter's quantiles, (m, 3) in hours."""


@dataclass(frozen=True, slots=True)
class Inspections:
    """Inspections of a set of lives, with what may be known at each.

    Attributes
    ----------
    record_id, specimen : (n,) int
        `record_id` of an inspection's first record.
    split : (n,) str
    age_h, rul_h, observed_h : (n,) float64
        Age, remaining life (NaN where a gearbox was taken out), age at which its gearbox was last known to run.
    indicators : dict of str to (n, columns) float64
        The means over an inspection's records, by indicator: of every channel and gear.
    history : (n, columns) float64
        Likewise NA4 and NB4, which compare with the gearbox's own inspections so far.
    sample_bytes : (n, columns) float64
        Likewise what the samples look like as bytes.
    debris_mg : (n,) float64
        What a counter in the oil says.
    worst_shares : (n, 3) float64
        True areas of the worst teeth over that of a flank, 0 where none is pitted.
    outlook_h : (n, 3) float64
        Quantiles of the remaining life over continuations of the true state.
    averages : AveragedRecords, optional
        Averages of one turn of the first shaft, means over an inspection's records; None where records are too short.
    """

    record_id: np.ndarray
    specimen: np.ndarray
    split: np.ndarray
    age_h: np.ndarray
    rul_h: np.ndarray
    observed_h: np.ndarray
    indicators: dict[str, np.ndarray]
    history: np.ndarray
    sample_bytes: np.ndarray
    debris_mg: np.ndarray
    worst_shares: np.ndarray
    outlook_h: np.ndarray
    averages: AveragedRecords | None = None

    @property
    def median_life_h(self) -> float:
        """Median life of the gearboxes that failed."""
        _, first = np.unique(self.specimen, return_index=True)
        return float(np.nanmedian(self.age_h[first] + self.rul_h[first]))


@single_thread()
def baseline_predictions(found: Inspections, seed: int, *, network: bool) -> dict[str, np.ndarray]:
    """Return what each baseline predicts, (n, 3) in hours at `QUANTILES`, always by the other gearboxes.

    The network is left out where it is not wanted or there are no averages.
    """
    return {
        **{name: _by_folds(found, seed, predict) for name, predict in predictors(found, seed).items()},
        **(_by_network(found, found.averages, seed) if network and found.averages else {}),
        AREAS: tree_predictions(np.concatenate([found.worst_shares, found.age_h[:, None]], axis=1), found, seed),
        OUTLOOK: found.outlook_h,
    }


def predictors(found: Inspections, seed: int) -> dict[str, Predictor]:
    """Return the baselines that see what sensors tell, without the network."""
    age, five = found.age_h[:, None], _five(found)
    seen = {
        RMS: found.indicators["rms"],
        FIVE: five,
        FIVE_AGE: np.concatenate([five, age], axis=1),
        HISTORY: _with_history(found),
        DEBRIS: np.stack([found.debris_mg, found.age_h], axis=1),
    }
    return {
        CONSTANT: partial(_constant, found),
        AGE: partial(_by_age, found),
        **{name: partial(_trees, (values, found.rul_h), seed, QUANTILES) for name, values in seen.items()},
    }


def history_predictions(found: Inspections, seed: int) -> np.ndarray:
    """Return what `HISTORY` predicts alone, as of `baseline_predictions`."""
    return tree_predictions(_with_history(found), found, seed)


def _five(found: Inspections) -> np.ndarray:
    return np.concatenate(list(found.indicators.values()), axis=1)


def _with_history(found: Inspections) -> np.ndarray:
    five = _five(found)
    return np.concatenate([five, _changes(five, found.specimen), found.history, found.age_h[:, None]], axis=1)


@single_thread()
def tree_predictions(
    values: np.ndarray, found: Inspections, seed: int, quantiles: Sequence[float] = QUANTILES
) -> np.ndarray:
    """Return what trees predict that see some columns (n, k) alone, always by the other gearboxes.

    That is (n, quantiles) in hours.
    """
    return _by_folds(found, seed, partial(_trees, (values, found.rul_h), seed, quantiles))


def _by_folds(found: Inspections, seed: int, predict: Predictor) -> np.ndarray:
    folds = unit_folds(found.specimen, generator(seed, Purpose.FOLDS), FOLDS)
    rows = np.concatenate([np.flatnonzero(fold) for fold in folds])
    return np.concatenate([predict(~fold, fold) for fold in folds])[np.argsort(rows)]


def _changes(values: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return each value over that of the gearbox's first inspection, and over that of the one before (n, 2 columns)."""
    start = np.diff(specimen, prepend=-1) != 0  # inspections stand in the order of gearbox and age
    first = values[np.maximum.accumulate(np.where(start, np.arange(start.size), 0))]
    before = np.where(start[:, None], values, np.roll(values, 1, axis=0))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.concatenate([values / first, values / before], axis=1)


def _constant(found: Inspections, train: np.ndarray, test: np.ndarray) -> np.ndarray:
    """Return the quantiles of the training inspections for all others."""
    return np.tile(np.nanquantile(found.rul_h[train], QUANTILES), (int(test.sum()), 1))


def _by_age(found: Inspections, train: np.ndarray, test: np.ndarray) -> np.ndarray:
    return remaining_of_age(found.age_h[test], *_law_of_age(found, train))


def _by_network(found: Inspections, averages: AveragedRecords, seed: int) -> dict[str, np.ndarray]:
    """Return what the network predicts, under its name."""
    from diagnostics.training.average_rows import average_rows
    from diagnostics.training.life_network import LifeSequences, network_quantiles

    rows = average_rows(averages)

    def predict(train: np.ndarray, test: np.ndarray) -> np.ndarray:
        of_age_h = remaining_of_age(found.age_h, *_law_of_age(found, train))
        known = LifeSequences(rows, found.specimen, found.age_h, found.rul_h, of_age_h)
        return network_quantiles(known, seed, train, test)

    return {NETWORK: _by_folds(found, seed, predict)}


def _law_of_age(found: Inspections, train: np.ndarray) -> tuple[float, float]:
    """Return slope and scale of the Weibull law of the training gearboxes."""
    _, first = np.unique(found.specimen[train], return_index=True)
    life_h = (found.age_h + found.rul_h)[train][first]
    failed = np.isfinite(life_h)
    return weibull_lives(life_h[failed], found.observed_h[train][first][~failed])


def weibull_lives(failed_h: np.ndarray, taken_out_h: np.ndarray) -> tuple[float, float]:
    """Return slope and scale of the likeliest Weibull law of lives, of which some are only known to be longer."""
    from scipy.stats import CensoredData, weibull_min

    slope, _, scale_h = weibull_min.fit(CensoredData(failed_h, right=taken_out_h), floc=0.0)
    return float(slope), float(scale_h)


def remaining_of_age(age_h: np.ndarray, slope: float, scale_h: float) -> np.ndarray:
    """Return the quantiles of the remaining life, (n, 3), of gearboxes that run at an age; from a Weibull law."""
    used = (age_h[:, None] / scale_h) ** slope
    return np.asarray(scale_h * (used - np.log1p(-np.asarray(QUANTILES))) ** (1.0 / slope) - age_h[:, None])


def _trees(
    known: tuple[np.ndarray, np.ndarray], seed: int, quantiles: Sequence[float], train: np.ndarray, test: np.ndarray
) -> np.ndarray:
    values, rul_h = known
    rows = train & np.isfinite(rul_h)
    defined = np.isfinite(values[rows]).any(axis=0)
    fitted = [_model(q, seed).fit(values[rows][:, defined], rul_h[rows]) for q in quantiles]
    # three fits know nothing of each other: sorted, none crosses another
    return np.sort(np.stack([model.predict(values[test][:, defined]) for model in fitted], axis=1), axis=1)


def _model(quantile: float, seed: int) -> Any:
    from sklearn.ensemble import HistGradientBoostingRegressor

    # small trees: some hundred inspections of some dozen gearboxes carry no deeper ones
    return HistGradientBoostingRegressor(
        loss="quantile",
        quantile=quantile,
        max_iter=60,
        max_leaf_nodes=6,
        min_samples_leaf=10,
        early_stopping=False,
        random_state=seed,
    )


INDICATORS = ("rms", "kurtosis", "fm4", "m6a", "energy_ratio")
OWN_HISTORY, SAMPLES = "history", "samples"
OUTLOOK_COLUMNS = ("rul_q10_h", "rul_q50_h", "rul_q90_h")
FEWEST_FAILED = 4


def inspections(dataset: Dataset, stage: Stage) -> Inspections:
    """Return the inspections of a set that have a record; order and errors as of `inspections_of`."""
    _check_failed(dataset)
    with stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = record_table(dataset, advance=advance)
    return inspections_of(dataset, table)


def _check_failed(dataset: Dataset) -> None:
    if "life/units.parquet" not in dataset.inventory.files:
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
        history=np.stack([means[key][OWN_HISTORY] for key in keys]),
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
    return {**five, OWN_HISTORY: np.stack(with_own, axis=1), SAMPLES: table.values(samples)}


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
