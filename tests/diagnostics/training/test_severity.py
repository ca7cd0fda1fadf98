"""The damaged area as a number: regressions beat the constant where damage shows, and equal it elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.table import RecordTable
from diagnostics.training.boosting import DEFAULT_TREES
from diagnostics.training.severity import area_predictions, area_scores, boosted_areas, mean_areas
from diagnostics.training.splits import SpecimenSplit, specimen_split


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """As training does: threads of small trees mostly wait for each other."""
    import sklearn.ensemble  # noqa: F401 - only libraries that are loaded can be limited
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        yield


@pytest.fixture(scope="module")
def matrix(features: pa.Table) -> FeatureMatrix:
    return feature_matrix(features)


@pytest.fixture(scope="module")
def split(matrix: FeatureMatrix) -> SpecimenSplit:
    return specimen_split(matrix.labels)


def errors_mm2(matrix: FeatureMatrix, split: SpecimenSplit) -> dict[str, float]:
    """Mean absolute errors on the test specimens."""
    test = matrix.rows(split.test)
    median = np.median(matrix.labels["damaged_area_mm2"][split.train])
    predicted = {
        "ridge": area_predictions(matrix, split),
        "boosting": boosted_areas(matrix, split, seed=0),
        "median": np.full(int(split.test.sum()), median),
    }
    return {name: area_scores(name, area, test, 0, 20).error_mm2.value for name, area in predicted.items()}


def test_regressions_find_areas_that_show(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    found = errors_mm2(matrix, split)
    assert found["median"] == pytest.approx((1 + 0 + 7) / 3)  # areas of 0, 1 and 8 mm^2, of which 1 is the median
    assert found["ridge"] < found["median"]
    assert found["boosting"] < 0.5 * found["median"]


def test_areas_that_do_not_show_are_no_better_than_the_median(measured_effectless: RecordTable) -> None:
    matrix = feature_matrix(classifier_table(measured_effectless))
    # the median has the least absolute error of all constants; 24 records let a regression scatter by about a tenth
    found = errors_mm2(matrix, specimen_split(matrix.labels))
    assert found["boosting"] > 0.85 * found["median"]


def test_test_specimens_do_not_touch_the_fit_and_areas_are_never_negative(
    matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    before = boosted_areas(matrix, split, seed=0)
    labels = dict(matrix.labels)
    labels["damaged_area_mm2"] = np.where(split.test, 1e6, labels["damaged_area_mm2"])
    np.testing.assert_array_equal(boosted_areas(replace(matrix, labels=labels), split, seed=0), before)
    assert (before >= 0.0).all()


def test_without_validation_specimens_the_number_of_trees_is_fixed(
    matrix: FeatureMatrix, split: SpecimenSplit, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = replace(split, validation=np.zeros_like(split.validation))
    found = boosted_areas(matrix, alone, seed=0)
    monkeypatch.setattr("diagnostics.training.severity.MOST_TREES", DEFAULT_TREES)
    np.testing.assert_array_equal(boosted_areas(matrix, alone, seed=0), found)


def test_mean_areas_are_those_of_the_classes(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    assert mean_areas(matrix, split).tolist() == [0.0, 1.0, 8.0]
