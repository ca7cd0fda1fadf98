"""The baselines as scikit-learn takes them: the same classifier as that of a training, on gearboxes of any kind."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sklearn.base import clone
from sklearn.model_selection import GroupKFold

import diagnostics
from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.training.classifiers import LogisticBaseline, trained
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError


@pytest.fixture(scope="module")
def table(features: Any) -> FeatureMatrix:
    matrix = feature_matrix(features)
    return matrix.columns(matrix.names[::12])  # as good for this, and quicker


def test_the_logistic_baseline_is_the_classifier_of_a_training(table: FeatureMatrix) -> None:
    train, test = table.split("train"), table.split("test")
    every, nobody = np.ones(len(train.values), dtype=bool), np.zeros(len(train.values), dtype=bool)
    classes = tuple(sorted(table.classes))
    known = trained(LogisticBaseline(), train, SpecimenSplit(every, nobody, nobody, classes))
    model = diagnostics.LogisticBaseline().fit(train.values, train.labels["class"], groups=train.groups)
    assert tuple(model.classes_) == classes
    assert model.strength_ == known.strength
    # the columns lie otherwise in memory, so that sums differ in their last bits, and the solver's last step with them
    assert np.allclose(model.predict_proba(test.values), known.probability(test.values), rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("name", ["LogisticBaseline", "BoostingBaseline"])
def test_a_baseline_goes_through_cross_validation_over_gearboxes(table: FeatureMatrix, name: str) -> None:
    model = clone(getattr(diagnostics, name)())
    fitted = model.fit(table.values, table.labels["class"], table.groups)
    assert fitted.score(table.values, table.labels["class"]) > 0.9
    for train, test in GroupKFold(2).split(table.values, groups=table.groups):
        own = clone(model).fit(table.values[train], table.labels["class"][train], table.groups[train])
        # the modulation is plain to see: three classes, of which chance names a third
        assert own.score(table.values[test], table.labels["class"][test]) > 0.6
    with pytest.raises(UsageError, match="received 3 rows, 2 classes, 3 groups"):
        model.fit(np.zeros((3, 2)), [0, 1], [0, 1, 2])
