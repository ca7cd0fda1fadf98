"""What baselines see: the records to learn from and those of all test parts, alone or beside a reference.

Everything comes from the one table of each set. What depends on a set, such as levels of convolutions, depends on the
records to learn from alone: a test record is judged by itself, whatever stands beside it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from diagnostics.audit.averaged_lines import Bank, band_bank, kurtogram_maximum, line_array, residual_lines
from diagnostics.audit.signal_attackers import convolution_features, level_waves, over_channels
from diagnostics.base.progress import Stage
from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.benchmark import LEARN, Benchmark
from diagnostics.training.average_rows import AveragedRecords, padded_lines
from diagnostics.training.referenced import log_values
from siggen.dataset.reading import Dataset

CHUNK = 400
"""Records whose bands are taken at once."""


@dataclass(frozen=True, slots=True)
class PartRecords:
    """Records of one set: indicators with labels, averaged lines, row of each one's reference or -1, label of teeth."""

    matrix: FeatureMatrix
    waveforms: list[list[np.ndarray]]
    reference: np.ndarray
    channels: tuple[str, ...]
    teeth: str


@dataclass(frozen=True, slots=True)
class SeenRecords:
    """Records to learn from, then those of the test parts.

    Attributes
    ----------
    matrix : FeatureMatrix
        Indicators; beside a reference the differences of their logarithms.
    learn : int
        How many records are to learn from.
    damaged : (learn,) bool
    kurtogram : (records,) float64
        Largest kurtosis of the envelope over all bands.
    bands : (records, columns) float64
    convolutions : (records, columns) float64
    averages : AveragedRecords
    referenced : bool
    """

    matrix: FeatureMatrix
    learn: int
    damaged: np.ndarray
    kurtogram: np.ndarray
    bands: np.ndarray
    convolutions: np.ndarray
    averages: AveragedRecords
    referenced: bool

    @property
    def gearbox(self) -> np.ndarray:
        """(learn,) int: gearboxes of the records to learn from."""
        return np.asarray(self.matrix.groups[: self.learn])

    def tests(self) -> np.ndarray:
        """Return the numbers of the test records."""
        return np.asarray(self.matrix.labels["record_id"][self.learn :])


def benchmark_records(benchmark: Benchmark, workers: int, stage: Stage) -> tuple[PartRecords, ...]:
    """Return the records of all sets, those to learn from first; indicators from some processes."""
    sets = [(LEARN, benchmark.learn()), *((name, benchmark.part(name)) for name in benchmark.parts)]
    return tuple(_part(name, dataset, workers, stage) for name, dataset in sets)


def _part(name: str, dataset: Dataset, workers: int, stage: Stage) -> PartRecords:
    with stage(f"indicators, {name}", dataset.inventory.rows) as advance:
        table = record_table(dataset, workers=workers, advance=advance)
    if name == LEARN:
        check_table(table, dataset)  # test records are answered whatever they are
    matrix = feature_matrix(classifier_table(table))
    return PartRecords(matrix, table.complex_rows("waveform"), _references(matrix), table.channels, table.teeth[0])


def _references(matrix: FeatureMatrix) -> np.ndarray:
    """Return the row of the first healthy record of each one's gearbox and operating point; -1 for itself."""
    labels = matrix.labels
    first: dict[tuple[int, int], int] = {}
    places = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    for row in np.flatnonzero((labels["fault"] == HEALTHY) & (labels["state"] != SHAM)).tolist():
        first.setdefault(places[row], row)
    found = np.array([first.get(place, -1) for place in places], dtype=np.int64)
    return np.where(found == np.arange(found.size), -1, found)


def seen_records(parts: tuple[PartRecords, ...], *, referenced: bool) -> SeenRecords:
    """Return what baselines see; records without a reference are left out if asked for.

    Parameters
    ----------
    parts : tuple of PartRecords
        As of `benchmark_records`.
    referenced : bool
        Whether every record stands beside a healthy one of its gearbox.
    """
    kept = [_kept(part, place, referenced) for place, part in enumerate(parts)]
    learn = int(kept[0].sum())
    labels = {
        name: np.concatenate([part.matrix.labels[name][rows] for part, rows in zip(parts, kept, strict=True)])
        for name in parts[0].matrix.labels
    }
    values = [_values(part, referenced)[rows] for part, rows in zip(parts, kept, strict=True)]
    matrix = replace(parts[0].matrix, values=np.concatenate(values), labels=labels)
    lines, beside = _lines(parts, kept, referenced)
    teeth = labels[parts[0].teeth]
    residual = residual_lines(lines, teeth)
    known = None if beside is None else residual_lines(beside, teeth)
    difference = residual if known is None else residual - known
    averages = AveragedRecords(
        padded_lines([list(row) for row in lines.astype(np.complex64)]),
        teeth,
        parts[0].channels,
        None if beside is None else padded_lines([list(row) for row in beside.astype(np.complex64)]),
    )
    highest, bands = _in_chunks(difference, known)
    return SeenRecords(
        matrix=matrix,
        learn=learn,
        damaged=np.asarray(labels["fault"][:learn] != HEALTHY),
        kurtogram=highest,
        bands=bands,
        convolutions=convolution_features(level_waves(difference, known), learn),
        averages=averages,
        referenced=referenced,
    )


def _kept(part: PartRecords, place: int, referenced: bool) -> np.ndarray:
    """Return the records to learn from, or to be asked about: of test parts those of the split test."""
    asked = np.ones(part.reference.size, dtype=bool) if place == 0 else part.matrix.labels["split"] == "test"
    return np.asarray(asked & (part.reference >= 0) if referenced else asked)


def _values(part: PartRecords, referenced: bool) -> np.ndarray:
    values = part.matrix.values
    if not referenced:
        return values
    logarithms = log_values(values)
    return np.asarray(logarithms - logarithms[part.reference])


def _lines(
    parts: tuple[PartRecords, ...], kept: list[np.ndarray], referenced: bool
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return averaged lines of all records and of their references, with the orders that those to learn from have."""
    every = [line_array(part.waveforms) for part in parts]
    orders = every[0].shape[-1]
    same = [_cut(one, orders) for one in every]
    lines = np.concatenate([one[rows] for one, rows in zip(same, kept, strict=True)])
    if not referenced:
        return lines, None
    beside = [one[part.reference[rows]] for one, part, rows in zip(same, parts, kept, strict=True)]
    return lines, np.concatenate(beside)


def _cut(lines: np.ndarray, orders: int) -> np.ndarray:
    missing = max(orders - lines.shape[-1], 0)
    return np.pad(lines[..., :orders], ((0, 0), (0, 0), (0, missing)))


def _in_chunks(difference: np.ndarray, known: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the kurtogram and the columns of all bands, a few hundred records at once: each asks for megabytes."""
    highest, bands = [], []
    for start in range(0, len(difference), CHUNK):
        rows = slice(start, start + CHUNK)
        highest.append(np.nanmean(kurtogram_maximum(difference[rows]), axis=1))
        bank: Bank = band_bank(difference[rows], None if known is None else known[rows])
        bands.append(over_channels(bank)[0])
    return np.concatenate(highest), np.concatenate(bands)


def only(seen: SeenRecords, columns: tuple[str, ...]) -> FeatureMatrix:
    """Return the indicators whose names begin with some words, of every channel."""
    names = [name for name in seen.matrix.names if name.partition("__")[0] in columns]
    return replace(seen.matrix.columns(names))
