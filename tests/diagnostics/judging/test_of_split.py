"""The damaged area that probabilities expect rests on the mean areas of the classes."""

from __future__ import annotations

import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.of_split import mean_areas
from diagnostics.training.splits import SpecimenSplit, specimen_split


@pytest.fixture(scope="module")
def matrix(features: pa.Table) -> FeatureMatrix:
    return feature_matrix(features)


@pytest.fixture(scope="module")
def split(matrix: FeatureMatrix) -> SpecimenSplit:
    return specimen_split(matrix.labels)


def test_mean_areas_are_those_of_the_classes(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    assert mean_areas(matrix, split).tolist() == [0.0, 1.0, 8.0]
