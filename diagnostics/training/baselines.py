"""Logistic regression on all indicators, the trivial one on RMS alone, and both with permuted labels.

Columns that are positive in every training record are taken as logarithms: levels and ratios spread over decades, and a
gain becomes a summand. Medians, scaling and coefficients see training specimens only. No column is left out; the
strength of the penalty is what few gearboxes can choose, by cross-validation over whole training and validation
specimens. Test specimens are touched once. Source: standard literature (ridge penalty, grouped cross-validation).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.calibration import calibrated, fitted_temperature
from diagnostics.statistics.evaluation import UNKNOWN, Predictions, macro_auroc
from diagnostics.training.splits import SpecimenSplit

STRENGTHS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
"""Candidates for C, the inverse strength of regularisation, strongest regularisation first."""

DEFAULT_STRENGTH = 0.01
"""C where it cannot be chosen."""

FOLDS = 4
PERMUTATIONS = 20


@dataclass(frozen=True, slots=True)
class FeatureClassifier:
    """A fitted pipeline with the columns it takes and the states it tells apart.

    Attributes
    ----------
    pipeline
        scikit-learn pipeline: medians for undefined values, standardisation, logistic regression.
    features, classes : tuple of str
        Columns it takes and states in the order of its probabilities.
    strength : float
        Chosen C; rounds of boosting.
    note : str
        What was not as it should be (C not chosen), or empty.
    temperature : float
        Applied to the probabilities, see `diagnostics.statistics.calibration`; 1 leaves them.
    logarithms : tuple of str
        Those of the columns whose logarithm the pipeline takes.
    """

    pipeline: Any
    features: tuple[str, ...]
    classes: tuple[str, ...]
    strength: float
    note: str
    temperature: float = 1.0
    logarithms: tuple[str, ...] = ()

    def predict(self, matrix: FeatureMatrix) -> Predictions:
        """Return the probabilities of records; states that training lacked get zero."""
        probability = self.probability(matrix.columns(self.features).values)
        found = Predictions(self.classes, state_index(matrix, self.classes), probability, matrix.labels["specimen_id"])
        return calibrated(found, self.temperature)

    def probability(self, values: np.ndarray) -> np.ndarray:
        """Return the uncalibrated probabilities (n, classes) of columns (n, features) in the order of `features`."""
        taken = set(self.logarithms)
        found = np.zeros((len(values), len(self.classes)))
        logs = np.array([name in taken for name in self.features], dtype=bool)
        found[:, self.pipeline.classes_] = self.pipeline.predict_proba(with_logarithms(values, logs))
        return found


def with_logarithms(values: np.ndarray, logs: np.ndarray) -> np.ndarray:
    """Return values (n, columns) with the marked columns as logarithms; what is not positive there is undefined."""
    positive = values > 0.0
    return np.where(logs, np.log(values, where=positive, out=np.full_like(values, np.nan)), values)


def calibrated_classifier(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit, target: np.ndarray | None = None
) -> FeatureClassifier:
    """Return the classifier with the temperature that suits the validation specimens (1 where there are none)."""
    if not split.validation.any():
        return model
    found = model.predict(matrix.rows(split.validation))
    truth = found.truth if target is None else target[split.validation]
    return replace(model, temperature=fitted_temperature(replace(found, truth=truth)))


def state_index(matrix: FeatureMatrix, classes: tuple[str, ...]) -> np.ndarray:
    """Return the position of every record's class in `classes`, (n,) int; healthy states are one class.

    UNKNOWN where it is none of them, which only records of another set can be.
    """
    places = {name: place for place, name in enumerate(classes)}
    return np.array([places.get(name, UNKNOWN) for name in matrix.labels[CLASS].tolist()], dtype=np.int64)


@dataclass(frozen=True, slots=True)
class PreparedRecords:
    """Records as logistic regression takes them, and how: fitted once, whatever labels and strengths follow.

    Attributes
    ----------
    steps : tuple
        Fitted: medians for undefined values, standardisation.
    logs : (columns,) bool
        Columns that are taken as logarithms.
    names : tuple of str
        Of the columns.
    ready : (n, columns) float64
        The records themselves.
    """

    steps: tuple[Any, Any]
    logs: np.ndarray
    names: tuple[str, ...]
    ready: np.ndarray

    def of(self, values: np.ndarray) -> np.ndarray:
        """Return other records, (m, columns), prepared alike."""
        imputer, scaler = self.steps
        return np.asarray(scaler.transform(imputer.transform(with_logarithms(values, self.logs))))

    def fitted(self, truth: np.ndarray, strength: float) -> Any:
        """Return a logistic regression on these records, whose classes (n,) int are given."""
        from sklearn.linear_model import LogisticRegression

        return LogisticRegression(C=strength, max_iter=5000).fit(self.ready, truth)


def prepared_records(matrix: FeatureMatrix, *, take_logarithms: bool = True) -> PreparedRecords:
    """Return records prepared for a fit; see `fitted_classifier`."""
    from sklearn.impute import SimpleImputer
    from sklearn.preprocessing import StandardScaler

    logs = _positive(matrix.values) if take_logarithms else np.zeros(len(matrix.names), dtype=bool)
    imputer, scaler = SimpleImputer(strategy="median", keep_empty_features=True), StandardScaler()
    ready = scaler.fit_transform(imputer.fit_transform(with_logarithms(matrix.values, logs)))
    return PreparedRecords((imputer, scaler), logs, matrix.names, ready)


def told(model: Any, ready: np.ndarray, classes: int) -> np.ndarray:
    """Return the probabilities (n, classes) of prepared records; classes that training lacked get zero."""
    found = np.zeros((len(ready), classes))
    found[:, model.classes_] = model.predict_proba(ready)
    return found


def fitted_classifier(
    matrix: FeatureMatrix,
    truth: np.ndarray,
    classes: tuple[str, ...],
    strength: float = DEFAULT_STRENGTH,
    *,
    note: str = "",
    take_logarithms: bool = True,
) -> FeatureClassifier:
    """Fit on all records of a matrix.

    Parameters
    ----------
    matrix : FeatureMatrix
        Training records; every column is used.
    truth : (n,) int
        Positions of their classes in `classes`.
    classes : tuple of str
        All classes.
    strength : float
        C.
    note : str
        What was not as it should be.
    take_logarithms : bool
        Whether columns that are positive in all records are taken as logarithms.
    """
    from sklearn.pipeline import make_pipeline

    own = prepared_records(matrix, take_logarithms=take_logarithms)
    pipeline = make_pipeline(*own.steps, own.fitted(truth, strength))
    taken = tuple(name for name, log in zip(matrix.names, own.logs.tolist(), strict=True) if log)
    return FeatureClassifier(pipeline, matrix.names, classes, strength, note, logarithms=taken)


def _positive(values: np.ndarray) -> np.ndarray:
    """Return which columns are positive wherever they are defined, and defined somewhere, (columns,) bool."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a column that is undefined throughout has no least value
        return np.asarray(np.nanmin(values, axis=0) > 0.0)


def train_classifier(
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    target: np.ndarray | None = None,
    *,
    strengths: Sequence[float] = STRENGTHS,
    take_logarithms: bool = True,
) -> FeatureClassifier:
    """Fit on training specimens with the C that does best on training and validation specimens left out in turn.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records; every column is used.
    split : SpecimenSplit
        Whose specimens are which.
    target : (n,) int, optional
        Labels to learn, default the true states; the permutation control passes permuted ones.
    strengths : sequence of float
        Candidates for C; a single one is taken as it is.
    take_logarithms : bool
        As of `fitted_classifier`.
    """
    truth = state_index(matrix, split.classes) if target is None else target
    strength, note = strengths[0], ""
    if len(strengths) > 1:
        strength, note = _chosen_strength(matrix, split, truth, strengths, take_logarithms)
    train = matrix.rows(split.train)
    return fitted_classifier(
        train, truth[split.train], split.classes, strength, note=note, take_logarithms=take_logarithms
    )


def _chosen_strength(
    matrix: FeatureMatrix, split: SpecimenSplit, truth: np.ndarray, strengths: Sequence[float], take_logarithms: bool
) -> tuple[float, str]:
    """Return the C of largest macro-AUROC on specimens left out (ties: stronger penalty), or why none was chosen."""
    used = split.train | split.validation
    seen, own = matrix.rows(used), truth[used]
    _, place = np.unique(seen.labels["specimen_id"], return_inverse=True)
    fold, ones = place % FOLDS, np.ones((1, own.size))
    if any(np.unique(own[fold != k]).size < 2 for k in np.unique(fold)):
        note = f"too few training specimens to choose by: C = {DEFAULT_STRENGTH} was taken as it is"
        return DEFAULT_STRENGTH, note
    held_out = np.zeros((len(strengths), own.size, len(split.classes)))
    for k in np.unique(fold):
        rest = prepared_records(seen.rows(fold != k), take_logarithms=take_logarithms)
        ready = rest.of(seen.values[fold == k])
        for number, strength in enumerate(strengths):
            model = rest.fitted(own[fold != k], strength)
            held_out[number, fold == k] = told(model, ready, len(split.classes))
    areas = []
    for probability in held_out:
        found = Predictions(split.classes, own, probability, seen.labels["specimen_id"])
        areas.append(float(np.nan_to_num(macro_auroc(found, ones)[0], nan=0.5)))
    best = max(range(len(areas)), key=lambda k: (round(areas[k], 12), -k))
    return strengths[best], ""


def rms_features(names: Sequence[str]) -> tuple[str, ...]:
    """Return the raw RMS of every channel among the feature names."""
    return tuple(name for name in names if name.startswith("rms__"))


def permuted_target(truth: np.ndarray, split: SpecimenSplit, seed: int, repeat: int) -> np.ndarray:
    """Return labels shuffled across all training records and, apart from them, across all validation records."""
    rng = generator(seed, Purpose.PERMUTATION, repeat)
    shuffled = truth.copy()
    for mask in (split.train, split.validation):
        shuffled[mask] = rng.permutation(truth[mask])
    return shuffled


def permutation_control(
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    seed: int,
    repeats: int = PERMUTATIONS,
    strength: float = DEFAULT_STRENGTH,
    advance: Callable[[], None] | None = None,
) -> np.ndarray:
    """Return macro-AUROC on the test specimens, (repeats,), of classifiers trained on permuted labels.

    They must scatter around 0.5; if they do not, the scoring itself is biased. They say nothing about leakage: test
    records among the training ones would give 0.5 as well. Against that, specimens are split (`specimen_split`). All
    take the C that was chosen with the true labels.
    """
    truth, test = state_index(matrix, split.classes), matrix.rows(split.test)
    train = prepared_records(matrix.rows(split.train))
    ready, areas = train.of(test.values), np.empty(repeats)
    for repeat in range(repeats):
        model = train.fitted(permuted_target(truth, split, seed, repeat)[split.train], strength)
        probability = told(model, ready, len(split.classes))
        found = Predictions(split.classes, truth[split.test], probability, test.labels["specimen_id"])
        areas[repeat] = macro_auroc(found, np.ones((1, test.values.shape[0])))[0]
        if advance:
            advance()
    return areas
