"""What classifiers on indicators share: the fitted one with its columns, records as they take them, and its file.

Columns that are positive in every record to learn from are taken as logarithms: levels and ratios spread over decades,
and a gain becomes a summand. Medians, scaling and coefficients see records to learn from only. The file is one of
skops: loading lists the types inside and executes nothing unknown.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.state_classes import CLASS
from diagnostics.statistics.calibration import calibrated
from diagnostics.statistics.evaluation import UNKNOWN, Predictions, macro_auroc
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError
from siggen.file_writing import write_file

DEFAULT_STRENGTH = 0.01
"""C where it cannot be chosen."""

PERMUTATIONS = 20


@dataclass(frozen=True, slots=True)
class FeatureClassifier:
    """A fitted pipeline with the columns it takes and the states it tells apart.

    Attributes
    ----------
    pipeline
        scikit-learn pipeline or estimator, whose classes are places in `classes`.
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
        logs = np.array([name in taken for name in self.features], dtype=bool)
        return told(self.pipeline, with_logarithms(values, logs), np.arange(len(self.classes)))


def with_logarithms(values: np.ndarray, logs: np.ndarray) -> np.ndarray:
    """Return values (n, columns) with the marked columns as logarithms; what is not positive there is undefined."""
    positive = values > 0.0
    return np.where(logs, np.log(values, where=positive, out=np.full_like(values, np.nan)), values)


def told(model: Any, values: np.ndarray, classes: np.ndarray) -> np.ndarray:
    """Return the probabilities (n, classes) of records; classes, in ascending order, that training lacked get zero."""
    found = np.zeros((len(values), len(classes)))
    found[:, np.searchsorted(classes, model.classes_)] = model.predict_proba(values)
    return found


def state_index(matrix: FeatureMatrix, classes: tuple[str, ...]) -> np.ndarray:
    """Return the position of every record's class in `classes`, (n,) int; healthy states are one class.

    UNKNOWN where it is none of them, which only records of another set can be.
    """
    places = {name: place for place, name in enumerate(classes)}
    return np.array([places.get(name, UNKNOWN) for name in matrix.labels[CLASS].tolist()], dtype=np.int64)


class PreparedRecords:
    """Records as logistic regression takes them: medians and scaling fitted once, whatever labels and C follow."""

    def __init__(self, values: np.ndarray, *, take_logarithms: bool = True) -> None:
        from sklearn.impute import SimpleImputer
        from sklearn.preprocessing import StandardScaler

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a column undefined throughout has no least value
            self.logs = (np.nanmin(values, axis=0) > 0.0) & take_logarithms
        self.steps = SimpleImputer(strategy="median", keep_empty_features=True), StandardScaler()
        imputer, scaler = self.steps
        self.ready = scaler.fit_transform(imputer.fit_transform(with_logarithms(values, self.logs)))

    def of(self, values: np.ndarray) -> np.ndarray:
        """Return other records, (m, columns), prepared alike."""
        imputer, scaler = self.steps
        return np.asarray(scaler.transform(imputer.transform(with_logarithms(values, self.logs))))

    def fitted(self, truth: np.ndarray, strength: float) -> Any:
        """Return a logistic regression on these records, whose classes (n,) are given."""
        from sklearn.linear_model import LogisticRegression

        return LogisticRegression(C=strength, max_iter=5000).fit(self.ready, truth)


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
    truth, specimen = state_index(matrix, split.classes), matrix.groups[split.test]
    train = PreparedRecords(matrix.values[split.train])
    ready, areas = train.of(matrix.values[split.test]), np.empty(repeats)
    for repeat in range(repeats):
        model = train.fitted(permuted_target(truth, split, seed, repeat)[split.train], strength)
        probability = told(model, ready, np.arange(len(split.classes)))
        found = Predictions(split.classes, truth[split.test], probability, specimen)
        areas[repeat] = macro_auroc(found, np.ones((1, specimen.size)))[0]
        if advance:
            advance()
    return areas


CLASSIFIER_FILE, NAMES_FILE = "classifier.skops", "feature_names.json"
TRUSTED_TYPES = ("numpy.dtype",)
"""Types besides those that skops trusts by itself: the imputer remembers the type of its input."""


def save_classifier(
    model: FeatureClassifier, settings: IndicatorSettings, identity: str, folder: Path, prefix: str = ""
) -> Path:
    """Write `classifier.skops` and `feature_names.json` (features, states, settings, identity); return the former.

    A prefix before both names keeps variants of a classifier apart.
    """
    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    write_file(path, _skops_io().dumps(model.pipeline))
    facts = {
        "features": model.features,
        "classes": model.classes,
        "strength": model.strength,
        "note": model.note,
        "temperature": model.temperature,
        "logarithms": model.logarithms,
        "settings": asdict(settings),
        "identity": identity,
    }
    write_file(folder / f"{prefix}{NAMES_FILE}", json.dumps(facts, indent=1) + "\n")
    return path


def untrusted_types(path: Path) -> tuple[str, ...]:
    """Return the types in a skops file that neither skops nor `TRUSTED_TYPES` names; nothing is executed."""
    return tuple(name for name in _skops_io().get_untrusted_types(file=path) if name not in TRUSTED_TYPES)


def load_classifier(folder: Path, prefix: str = "") -> FeatureClassifier:
    """Read a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If the file is missing, damaged, or holds types that are not trusted, which are listed; it is then not loaded.
        If the names beside it are of another schema, or hold values that cannot be.
    """
    path = folder / f"{prefix}{CLASSIFIER_FILE}"
    try:
        found = untrusted_types(path)
        facts = _facts(folder, prefix)
        if found:
            raise UsageError(f"{path}: holds types that are not trusted: {', '.join(found)}; it is not loaded")
        pipeline = _skops_io().load(path, trusted=list(TRUSTED_TYPES))
    except UsageError:
        raise
    except Exception as error:  # whatever a damaged archive makes its reader raise
        raise UsageError(f"{folder}: no readable {path.name} with {prefix}{NAMES_FILE} ({error})") from error
    return _classifier(folder / f"{prefix}{NAMES_FILE}", pipeline, facts)


def _skops_io() -> ModuleType:
    """Return skops.io, imported when it is needed."""
    from diagnostics.training.skops_io import skops_io

    return skops_io


def _classifier(path: Path, pipeline: Any, facts: dict[str, Any]) -> FeatureClassifier:
    """Return the classifier of a pipeline and what the names beside it say, if that can be."""
    try:
        found = FeatureClassifier(
            pipeline=pipeline,
            features=tuple(facts["features"]),
            classes=tuple(facts["classes"]),
            strength=float(facts["strength"]),
            note=str(facts["note"]),
            temperature=float(facts.get("temperature", 1.0)),
            logarithms=tuple(facts.get("logarithms", ())),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(f"{path}: received another schema ({error!r}); train again with this version") from error
    if wrong := _impossible(found):
        raise UsageError(f"{path}: received {wrong}; the folder is damaged or was edited: train again")
    return found


def _impossible(found: FeatureClassifier) -> str:
    """Return which value of a classifier cannot be, with what is allowed; empty if all can."""
    if not (math.isfinite(found.temperature) and found.temperature > 0.0):
        return f"temperature {found.temperature}; allowed: finite and above 0"
    if not math.isfinite(found.strength):
        return f"strength {found.strength}; allowed: finite"
    for what, names in (("features", found.features), ("classes", found.classes)):
        if len(set(names)) < len(names) or not all(isinstance(name, str) for name in names):
            return f"{what} that are no names or come twice; allowed: every name once"
    if unknown := set(found.logarithms) - set(found.features):
        return f"logarithms of {min(unknown)}, which is no feature; allowed: its features"
    return ""


def classifier_identity(folder: Path, prefix: str = "") -> str:
    """Return the identity of the set that a classifier written by `save_classifier` was trained on; empty if untold."""
    return str(_facts(folder, prefix).get("identity", ""))


def load_settings(folder: Path) -> IndicatorSettings:
    """Read the settings of the features of a classifier written by `save_classifier`.

    Raises
    ------
    UsageError
        If they are missing or of another version.
    """
    try:
        return IndicatorSettings(**_facts(folder, "")["settings"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{folder / NAMES_FILE}: no readable settings of features ({error})") from error


def _facts(folder: Path, prefix: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / f"{prefix}{NAMES_FILE}").read_text(encoding="utf-8"))
    return found
