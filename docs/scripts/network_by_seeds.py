"""The 1-D network on all gearboxes of a set, three folds and five seeds, beside logistic regression on indicators.

    python docs/scripts/network_by_seeds.py runs/quickstart

Prints the AUC of any damage against healthy, mean over folds: of each seed, their mean and spread, and of logistic
regression. Of the gearboxes outside of a fold, every fourth chooses the epoch or, with the others, the penalty.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

import diagnostics
import siggen
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import record_table
from diagnostics.statistics.evaluation import weighted_auc
from diagnostics.training.average_rows import averaged_records
from diagnostics.training.classifiers import LogisticBaseline, trained
from diagnostics.training.cnn import network_probability, train_network
from diagnostics.training.feature_classifier import state_index
from diagnostics.training.splits import SpecimenSplit, specimen_split

FOLDS, SEEDS = 3, 5


def splits(matrix: FeatureMatrix) -> Iterator[SpecimenSplit]:
    """Yield the split of each fold; gearboxes are dealt by one fixed permutation."""
    dealt = np.random.default_rng(0).permutation(np.unique(matrix.groups))
    for fold in range(FOLDS):
        rest = np.setdiff1d(dealt, dealt[fold::FOLDS], assume_unique=True)
        part = [np.isin(matrix.groups, some) for some in (np.delete(rest, np.s_[::4]), rest[::4], dealt[fold::FOLDS])]
        yield replace(specimen_split(matrix.labels), train=part[0], validation=part[1], test=part[2])


def detection(probability: np.ndarray, truth: np.ndarray, split: SpecimenSplit, matrix: FeatureMatrix) -> float:
    """Return the AUC of 1 - p(healthy) among test records of different gearboxes."""
    healthy, test = split.classes.index(str(split.healthy)), split.test
    weights = np.ones((1, int(test.sum())))
    return float(weighted_auc(1 - probability[:, healthy], truth[test] != healthy, weights, matrix.groups[test])[0])


def main(folder: str) -> None:
    """Print the scores."""
    dataset = siggen.open(folder)
    matrix = diagnostics.table(dataset)
    averages = averaged_records(record_table(dataset))
    linear, network = [], []
    for split in splits(matrix):
        truth, test = state_index(matrix, split.classes), np.flatnonzero(split.test)
        model = trained(LogisticBaseline(), matrix, split)
        linear.append(detection(model.probability(matrix.values[test]), truth, split, matrix))
        for seed in range(SEEDS):
            found = train_network(averages, truth, split, seed)
            probability = network_probability(found.network, averages.chosen(test))
            network.append(detection(probability, truth, split, matrix))
            print(f"fold {len(linear)}, seed {seed}: {network[-1]:.3f}, epoch {found.best_epoch} of {found.epochs}")
    means = np.array(network).reshape(FOLDS, SEEDS).mean(axis=0)
    print(f"1-D network: {means.mean():.3f}, standard deviation over seeds {means.std(ddof=1):.3f}")
    print(f"logistic regression: {np.mean(linear):.3f}, folds {', '.join(f'{area:.3f}' for area in linear)}")


if __name__ == "__main__":
    main(sys.argv[1])
