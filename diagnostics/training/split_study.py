"""What a split does to a score: the same windows and the same classifier, split in several ways.

Only the last rows ask what matters, an unseen gearbox on an unseen sensor or at an unseen speed; random windows put
pieces of one record on both sides and are shown as what they are. Source: standard literature (grouped
cross-validation); choice of splits derived.

Indicators of single windows of a set, so that all kinds of splits can be tried on the same rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.record import record_values
from diagnostics.records.gear_train import gear_train
from diagnostics.records.record_classes import RecordClasses
from diagnostics.records.recording import LABEL_NAMES, Recording, recordings
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.evaluation import Predictions, bootstrap_weights, macro_auroc
from diagnostics.statistics.scores import Scores, area_interval, scores
from diagnostics.training.baselines import fitted_classifier, rms_features, state_index
from diagnostics.training.other_set import OTHER_SPECIMENS
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

REVOLUTIONS = 8
MOST_WINDOWS = 3
"""Windows of a record: enough to leak, few enough to be quick."""

FOLDS = 5
SPEED_BANDS = 3
RESAMPLES = 300
Fold = tuple[np.ndarray, np.ndarray]

STRENGTH = 0.3
"""C of all splits: weak enough that a classifier can remember gearboxes, which is what leaky splits reward."""


def window_matrix(dataset: Dataset, classes: RecordClasses, advance: Callable[[], None] | None = None) -> FeatureMatrix:
    """Return the indicators of windows that follow each other without overlap, with the labels of their records.

    `classes` are those of the set.

    Raises
    ------
    DatasetError
        If no record holds a whole window.
    """
    rows: list[dict[str, float]] = []
    labels: list[dict[str, Any]] = []
    for record in recordings(dataset):
        train = gear_train(record.labels)
        for window in windows_of(record):
            rows.append(
                record_values(
                    window.channels, window.tacho_s, window.fs_hz, train[0].teeth, None, record.quantities, train
                ).values
            )
            labels.append(dict(record.labels))
        if advance:
            advance()
    if not rows:
        raise DatasetError(
            f"{dataset.path}: no record holds {REVOLUTIONS} pinion revolutions, which the windows of --studies need. "
            "Use longer records (`duration_s`) or leave --studies out."
        )
    names = tuple(rows[0])
    values = np.array([[row[name] for name in names] for row in rows])
    columns = {name: np.array([label[name] for label in labels]) for name in LABEL_NAMES}
    return FeatureMatrix(values, names, {**columns, CLASS: classes.of(columns["state"])})


def windows_of(record: Recording) -> Iterator[Recording]:
    """Yield the windows of a record, each with its own time from zero."""
    pulses = record.tacho_s
    for window in range(min(MOST_WINDOWS, (pulses.size - 1) // REVOLUTIONS)):
        times = pulses[window * REVOLUTIONS : (window + 1) * REVOLUTIONS + 1]
        first, last = int(np.floor(times[0] * record.fs_hz)), int(np.ceil(times[-1] * record.fs_hz)) + 1
        channels = {name: signal[first:last] for name, signal in record.channels.items()}
        yield replace(record, channels=channels, tacho_s=times - first / record.fs_hz)


def by_channel(matrix: FeatureMatrix) -> FeatureMatrix:
    """Return one row per window and channel, features without the channel's name, and a label `channel`."""
    channels = tuple(dict.fromkeys(name.split("__")[1] for name in matrix.names))
    names = tuple(dict.fromkeys(name.split("__")[0] for name in matrix.names))
    place = {name: k for k, name in enumerate(matrix.names)}
    padded = np.column_stack([matrix.values, np.full(len(matrix.values), np.nan)])  # what a channel does not have
    values = np.concatenate([padded[:, [place.get(f"{name}__{c}", -1) for name in names]] for c in channels])
    labels = {name: np.tile(column, len(channels)) for name, column in matrix.labels.items()}
    return FeatureMatrix(values, names, {**labels, "channel": np.repeat(channels, matrix.values.shape[0])})


@dataclass(frozen=True, slots=True)
class SplitScore:
    """One way to split: what is held out, whether it leaks, scores by indicators and by RMS alone, and folds."""

    title: str
    leaky: bool
    indicators: Scores
    rms: Scores
    folds: int


def split_study(
    windows: FeatureMatrix,
    classes: tuple[str, ...],
    seed: int,
    other: FeatureMatrix | None = None,
    advance: Callable[[], None] | None = None,
) -> tuple[SplitScore, ...]:
    """Return the scores of all splits that the set allows.

    Parameters
    ----------
    windows : FeatureMatrix
        Indicators of windows, from `window_matrix`.
    classes : tuple of str
        States in order.
    seed : int
        Seeds folds and bootstrap.
    other : FeatureMatrix, optional
        Windows of another set: trained on all of the first, tested on all of this.
    advance : callable, optional
        Called after every row.
    """
    single = by_channel(windows)
    tasks = [(windows, *entry) for entry in _together(windows.labels, seed)]
    tasks += [(single, *entry) for entry in _single(single.labels, seed)]
    if other is not None:
        tasks.append(_other(windows, other))
    found = []
    for matrix, title, leaky, folds in tasks:
        if folds:
            found.append(_score(matrix, classes, title, leaky, folds, seed))
        if advance:
            advance()
    return tuple(found)


def rows_of_study(other: bool) -> int:
    """Return how often `split_study` calls `advance`."""
    return 10 if other else 9


def _together(labels: dict[str, np.ndarray], seed: int) -> list[tuple[str, bool, list[Fold]]]:
    specimens = labels["specimen_id"]
    # Complex numbers, so that a pair is one value; gearboxes of equal teeth are on one side whatever their module.
    pairs = labels["teeth_pinion"] + 1j * labels["teeth_gear"]
    every = np.arange(specimens.size)
    bands = speed_bands(labels["speed_hz"].astype(np.float64))
    return [
        ("random windows (leaky)", True, held_out(fold_of(every, seed))),
        ("records", True, held_out(fold_of(labels["record_id"], seed))),
        ("specimens", False, held_out(fold_of(specimens, seed))),
        ("gear pairs", False, held_out(fold_of(pairs, seed)) if np.unique(pairs).size > 1 else []),
        ("one speed band", True, held_out(bands)),
        ("one speed band of other specimens", False, crossed(bands, fold_of(specimens, seed))),
    ]


def _single(labels: dict[str, np.ndarray], seed: int) -> list[tuple[str, bool, list[Fold]]]:
    _, channel = np.unique(labels["channel"], return_inverse=True)
    fold = fold_of(labels["specimen_id"], seed)
    several = int(channel.max()) > 0
    return [
        ("single channel: specimens", False, held_out(fold)),
        ("single channel: one sensor", True, held_out(channel) if several else []),
        ("single channel: one sensor of other specimens", False, crossed(channel, fold) if several else []),
    ]


def _other(windows: FeatureMatrix, other: FeatureMatrix) -> tuple[FeatureMatrix, str, bool, list[Fold]]:
    columns = other.columns(windows.names)
    labels = {name: np.concatenate([windows.labels[name], columns.labels[name]]) for name in windows.labels}
    second = np.repeat([False, True], [windows.values.shape[0], other.values.shape[0]])
    labels["specimen_id"] = labels["specimen_id"] + OTHER_SPECIMENS * second
    joined = FeatureMatrix(np.concatenate([windows.values, columns.values]), windows.names, labels)
    return joined, "other set", False, [(~second, second)]


def speed_bands(speed_hz: np.ndarray) -> np.ndarray:
    """Return the speed band of every row, by thirds of the speeds; fewer where there are fewer speeds."""
    limits = np.unique(np.quantile(speed_hz, np.arange(1, SPEED_BANDS) / SPEED_BANDS))
    return np.unique(np.digitize(speed_hz, limits, right=True), return_inverse=True)[1]


def fold_of(group: np.ndarray, seed: int) -> np.ndarray:
    """Return the fold of every row; rows of a group share it."""
    members, index = np.unique(group, return_inverse=True)
    return (generator(seed, Purpose.FOLDS).permutation(members.size) % min(FOLDS, members.size))[index]


def held_out(part: np.ndarray) -> list[Fold]:
    """Return one fold per part: trained on the others, tested on it; none where there is a single part."""
    parts = np.unique(part)
    return [(part != one, part == one) for one in parts] if parts.size > 1 else []


def crossed(first: np.ndarray, second: np.ndarray) -> list[Fold]:
    """Return one fold per pair of parts: tested where both are met, trained where neither is."""
    folds = [
        ((first != one) & (second != two), (first == one) & (second == two))
        for one in np.unique(first)
        for two in np.unique(second)
    ]
    return [(train, test) for train, test in folds if train.any() and test.any()]


def _score(
    matrix: FeatureMatrix, classes: tuple[str, ...], title: str, leaky: bool, folds: Sequence[Fold], seed: int
) -> SplitScore:
    alone = matrix.columns([*rms_features(matrix.names)] or ["rms"])
    found = [fold_scores(*_out_of_fold(part, classes, folds), seed) for part in (matrix, alone)]
    return SplitScore(title, leaky, found[0], found[1], len(folds))


def fold_scores(found: Predictions, fold: np.ndarray, seed: int) -> Scores:
    """Judge out-of-fold predictions with the macro-AUROC averaged over folds, never ranked across them.

    A state that is rare in a fold is frequent in its training; ranked across folds, even a classifier that knows
    nothing but these frequencies would fall below chance.
    """
    weights = bootstrap_weights(found.specimen, seed, RESAMPLES)
    areas, sizes = [], []
    for one in np.unique(fold):
        mine = fold == one
        part = Predictions(found.classes, found.truth[mine], found.probability[mine], found.specimen[mine])
        areas.append(macro_auroc(part, weights[:, mine]))
        sizes.append(weights[:, mine].sum(axis=1))
    area, size = np.stack(areas), np.where(np.isfinite(areas), sizes, 0.0)
    with np.errstate(invalid="ignore"):
        mean = (np.nan_to_num(area) * size).sum(axis=0) / size.sum(axis=0)
    specimens = int(np.unique(found.specimen).size)
    return replace(scores(found, seed, RESAMPLES), macro_auroc=area_interval(mean, specimens))


def _out_of_fold(
    matrix: FeatureMatrix, classes: tuple[str, ...], folds: Sequence[Fold]
) -> tuple[Predictions, np.ndarray]:
    """Return the predictions of every row by the classifiers that were not trained on it, and its fold."""
    truth = state_index(matrix, classes)
    fold = np.zeros(truth.size, dtype=np.int64)
    probability = np.full((truth.size, len(classes)), np.nan)
    for number, (train, test) in enumerate(folds):
        if np.unique(truth[train]).size < 2:
            continue
        fold[test] = number
        model = fitted_classifier(matrix.rows(train), truth[train], classes, STRENGTH)
        probability[test] = model.probability(matrix.values[test])
    known = np.isfinite(probability[:, 0])
    found = Predictions(classes, truth[known], probability[known], matrix.labels["specimen_id"][known])
    return found, fold[known]
