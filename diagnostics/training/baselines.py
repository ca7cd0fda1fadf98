"""Logistic regression on the indicators, the trivial one on RMS alone, and both with permuted labels.

Scaling, imputation and coefficients see training specimens only; the strength of regularisation is chosen on validation
specimens; test specimens are touched once. Source: standard literature.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.feature_table import FeatureMatrix
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.calibration import calibrated, fitted_temperature
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.training.splits import SpecimenSplit

STRENGTHS = (0.003, 0.03, 0.3, 3.0)
"""Candidates for C, the inverse strength of regularisation, strongest regularisation first."""

DEFAULT_STRENGTH = 0.3
"""C where no validation specimens exist."""

PERMUTATIONS = 20


@dataclass(frozen=True, slots=True)
class FeatureClassifier:
    """A fitted pipeline with the features it takes and the states it tells apart.

    Attributes
    ----------
    pipeline
        scikit-learn pipeline: medians for undefined values, standardisation, logistic regression.
    features, classes : tuple of str
        Columns it takes and states in the order of its probabilities.
    strength : float
        Chosen C; rounds of boosting.
    note : str
        What was not as it should be (no validation specimens), or empty.
    temperature : float
        Applied to the probabilities, see `diagnostics.statistics.calibration`; 1 leaves them.
    """

    pipeline: Any
    features: tuple[str, ...]
    classes: tuple[str, ...]
    strength: float
    note: str
    temperature: float = 1.0

    def predict(self, matrix: FeatureMatrix) -> Predictions:
        """Return the probabilities of records; states that training lacked get zero."""
        found = _predictions(self.pipeline, matrix.columns(self.features), self.classes)
        return calibrated(found, self.temperature)


def calibrated_classifier(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit, target: np.ndarray | None = None
) -> FeatureClassifier:
    """Return the classifier with the temperature that suits the validation specimens (1 where there are none)."""
    if not split.validation.any():
        return model
    found = model.predict(matrix.rows(split.validation))
    truth = found.truth if target is None else target[split.validation]
    return replace(model, temperature=fitted_temperature(replace(found, truth=truth)))


def _predictions(pipeline: Any, matrix: FeatureMatrix, classes: tuple[str, ...]) -> Predictions:
    probability = np.zeros((matrix.values.shape[0], len(classes)))
    probability[:, pipeline.classes_] = pipeline.predict_proba(matrix.values)
    return Predictions(classes, state_index(matrix, classes), probability, matrix.labels["specimen_id"])


def state_index(matrix: FeatureMatrix, classes: tuple[str, ...]) -> np.ndarray:
    """Return the position of every record's class in `classes`, (n,) int; healthy states are one class."""
    return np.array([classes.index(name) for name in matrix.labels[CLASS].tolist()], dtype=np.int64)


def logistic_pipeline(strength: float = DEFAULT_STRENGTH) -> Any:
    """Return an unfitted pipeline: medians for undefined values, standardisation, logistic regression."""
    from sklearn.impute import SimpleImputer
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    return make_pipeline(
        SimpleImputer(strategy="median", keep_empty_features=True),
        StandardScaler(),
        LogisticRegression(C=strength, max_iter=5000),
    )


def train_classifier(
    matrix: FeatureMatrix, split: SpecimenSplit, target: np.ndarray | None = None
) -> FeatureClassifier:
    """Fit on training specimens, choosing C by macro-AUROC on validation specimens (ties: stronger regularisation).

    Parameters
    ----------
    matrix : FeatureMatrix
        All records; every column is used.
    split : SpecimenSplit
        Whose specimens are which.
    target : (n,) int, optional
        Labels to learn, default the true states; the permutation control passes permuted ones.
    """
    truth = state_index(matrix, split.classes) if target is None else target
    train, validation = matrix.rows(split.train), matrix.rows(split.validation)
    if not split.validation.any():
        pipeline = logistic_pipeline().fit(train.values, truth[split.train])
        note = f"no validation specimens: C = {DEFAULT_STRENGTH} was not chosen but taken as it is"
        return FeatureClassifier(pipeline, matrix.names, split.classes, DEFAULT_STRENGTH, note)
    best: tuple[float, float, Any] | None = None
    ones = np.ones((1, int(split.validation.sum())))
    for strength in STRENGTHS:
        pipeline = logistic_pipeline(strength).fit(train.values, truth[split.train])
        found = _predictions(pipeline, validation, split.classes)
        judged = Predictions(found.classes, truth[split.validation], found.probability, found.specimen)
        area = float(np.nan_to_num(macro_auroc(judged, ones)[0], nan=0.5))
        if best is None or area > best[0] + 1e-12:
            best = (area, strength, pipeline)
    assert best is not None
    return FeatureClassifier(best[2], matrix.names, split.classes, best[1], "")


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
    advance: Callable[[], None] | None = None,
) -> np.ndarray:
    """Return macro-AUROC on the test specimens, (repeats,), of classifiers trained on permuted labels.

    They must scatter around 0.5; if they do not, the scoring itself is biased. They say nothing about leakage: test
    records among the training ones would give 0.5 as well. Against that, specimens are split (`specimen_split`).
    """
    truth, test = state_index(matrix, split.classes), matrix.rows(split.test)
    areas = np.empty(repeats)
    for repeat in range(repeats):
        model = train_classifier(matrix, split, permuted_target(truth, split, seed, repeat))
        areas[repeat] = macro_auroc(model.predict(test), np.ones((1, test.values.shape[0])))[0]
        if advance:
            advance()
    return areas
