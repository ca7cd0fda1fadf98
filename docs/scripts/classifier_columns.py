"""The shipped logistic regression against one on six columns: macro-AUROC, paired over gearboxes.

    python docs/scripts/classifier_columns.py data/quickstart data/bench24

The six columns are the energy operators of Teager and Lebold and the cepstral peak of the pinion in every channel. Both
classifiers choose their C in the same way, on gearboxes that are not judged. Two ways to judge: on the test gearboxes
of the set's own split, and on all gearboxes, each by classifiers that were trained without it (six folds, of the rest
every fourth gearbox validates). Intervals: 90 %, paired, from resampled gearboxes.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import siggen
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.classifier_table import check_table, classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.statistics.evaluation import Predictions, bootstrap_weights, macro_auroc
from diagnostics.training.baselines import train_classifier
from diagnostics.training.splits import SpecimenSplit, specimen_split

SIX = ("energy_operator_teager_pinion", "energy_operator_lebold_pinion", "cepstral_peak_pinion")
STRENGTHS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
FOLDS, RESAMPLES, SEED = 6, 2000, 0


def predictions(matrix: FeatureMatrix, split: SpecimenSplit) -> dict[str, Predictions]:
    """Return the uncalibrated predictions of the test records by classifier."""
    six = matrix.columns([name for name in matrix.names if name.split("__")[0] in SIX])
    models = {
        "shipped": (matrix, train_classifier(matrix, split)),
        "six columns": (six, train_classifier(six, split, strengths=STRENGTHS, take_logarithms=False)),
        "six columns, logarithms": (six, train_classifier(six, split, strengths=STRENGTHS)),
    }
    return {name: model.predict(own.rows(split.test)) for name, (own, model) in models.items()}


def rotated(matrix: FeatureMatrix, split: SpecimenSplit) -> dict[str, Predictions]:
    """Return predictions of all records, each by a classifier that was trained without its gearbox."""
    _, place = np.unique(matrix.labels["specimen_id"], return_inverse=True)
    found: dict[str, list[Predictions]] = {}
    for fold in range(FOLDS):
        test = place % FOLDS == fold
        validation = ~test & (place // FOLDS % 4 == fold % 4)
        own = replace(split, train=~test & ~validation, validation=validation, test=test)
        for name, part in predictions(matrix, own).items():
            found.setdefault(name, []).append(part)
    return {name: joined(parts) for name, parts in found.items()}


def joined(parts: list[Predictions]) -> Predictions:
    """Return predictions of several folds as one."""
    return Predictions(
        parts[0].classes,
        np.concatenate([part.truth for part in parts]),
        np.concatenate([part.probability for part in parts]),
        np.concatenate([part.specimen for part in parts]),
    )


def rows(found: dict[str, Predictions]) -> list[str]:
    """Return value by classifier and the paired differences of the shipped one."""
    weights = bootstrap_weights(found["shipped"].specimen, SEED, RESAMPLES)
    areas = {name: macro_auroc(own, weights) for name, own in found.items()}
    lines = []
    for name, area in areas.items():
        difference = areas["shipped"] - area
        low, high = np.nanquantile(difference[1:], [0.05, 0.95])
        told = "" if name == "shipped" else f"{difference[0]:+.3f} ({low:+.3f} to {high:+.3f})"
        lines.append(f"| {name} | {area[0]:.3f} | {told} |")
    return lines


@single_thread
def main() -> None:
    """Print a table per set."""
    for folder in sys.argv[1:]:
        dataset = siggen.open(Path(folder))
        table = record_table(dataset)
        matrix = feature_matrix(classifier_table(table, check_table(table, dataset)))
        split = specimen_split(matrix.labels)
        for title, found in (("test gearboxes", predictions(matrix, split)), ("all gearboxes", rotated(matrix, split))):
            count = np.unique(found["shipped"].specimen).size
            print(f"\n{dataset.path.name}: {count} {title}, {len(matrix.names)} columns\n")
            print("| logistic regression on | macro-AUROC | shipped minus this, 90 % |\n|---|---|---|")
            print("\n".join(rows(found)))


if __name__ == "__main__":
    main()
