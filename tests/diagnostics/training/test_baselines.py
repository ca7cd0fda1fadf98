"""The classifier on indicators finds what is there, and nothing where nothing is."""

from __future__ import annotations

import json
import math
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import classifier_table, feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import record_table
from diagnostics.records.usable_records import with_channels
from diagnostics.statistics.evaluation import scores
from diagnostics.statistics.indicator_statistics import separability
from diagnostics.training.classifiers import STRENGTHS, LogisticBaseline, trained
from diagnostics.training.feature_classifier import (
    DEFAULT_STRENGTH,
    FeatureClassifier,
    load_classifier,
    permutation_control,
    rms_features,
    save_classifier,
    untrusted_types,
)
from diagnostics.training.splits import SpecimenSplit, specimen_split
from siggen.errors import UsageError
from tests.diagnostics.conftest import CHANNELS, SPLITS_24, memory_dataset


@pytest.fixture(scope="module")
def matrix(features: pa.Table) -> FeatureMatrix:
    return feature_matrix(features)


@pytest.fixture(scope="module")
def split(matrix: FeatureMatrix) -> SpecimenSplit:
    return specimen_split(matrix.labels)


@pytest.fixture(scope="module")
def model(matrix: FeatureMatrix, split: SpecimenSplit) -> FeatureClassifier:
    return trained(LogisticBaseline(), matrix, split)


def test_plain_modulation_is_found_on_unseen_specimens(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    found = scores(model.predict(matrix.rows(split.test)), seed=0)
    assert found.specimens == 8
    assert found.macro_auroc.value > 0.9


def test_level_alone_does_not_show_it(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    # the level of these records is drawn without regard to the state; 24 test records scatter by about 0.1 around 0.5
    alone = matrix.columns(rms_features(matrix.names))
    assert alone.names == ("rms__bearing_vertical", "rms__bearing_horizontal")
    assert (
        scores(trained(LogisticBaseline(), alone, split).predict(alone.rows(split.test)), seed=0).macro_auroc.value
        < 0.8
    )


def test_permuted_labels_give_chance(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    # a run scatters by about 0.13 (24 correlated test records); the mean of ten by 0.04, three of which are allowed
    assert permutation_control(matrix, split, seed=1, repeats=10).mean() == pytest.approx(0.5, abs=0.12)


def test_without_any_effect_the_scores_are_chance() -> None:
    effectless = with_channels(memory_dataset(SPLITS_24, effect=0.0), CHANNELS[:1])
    matrix = feature_matrix(classifier_table(record_table(effectless)))
    split = specimen_split(matrix.labels)
    found = scores(trained(LogisticBaseline(), matrix, split).predict(matrix.rows(split.test)), seed=0).macro_auroc
    assert found.value == pytest.approx(0.5, abs=0.3)  # one run on 24 records: 0.5 +- 0.1, three of which are allowed
    strongest = separability(matrix, seed=0, resamples=50)[0]
    assert strongest.strength < 0.4  # the best of some 200 by chance, where a real effect reaches 0.5


def test_test_specimens_do_not_touch_the_fit(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    changed = matrix.values.copy()
    changed[split.test] = 1e6
    other = trained(LogisticBaseline(), replace(matrix, values=changed), split)
    np.testing.assert_array_equal(other.pipeline[-1].coef_, model.pipeline[-1].coef_)


def test_undefined_values_are_imputed_even_where_a_feature_is_never_defined(
    matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    holes = matrix.values.copy()
    holes[:, 3] = math.nan
    holes[::5, 7] = math.nan
    found = trained(LogisticBaseline(), replace(matrix, values=holes), split).predict(matrix.rows(split.test))
    np.testing.assert_allclose(found.probability.sum(axis=1), 1.0)


def test_strength_is_chosen_without_validation_specimens_too_and_never_by_test_specimens(
    matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    alone = replace(split, validation=np.zeros_like(split.validation))
    chosen = trained(LogisticBaseline(), matrix, alone)
    assert chosen.strength in STRENGTHS
    assert chosen.note == ""
    shuffled = matrix.values.copy()
    shuffled[split.test] = np.random.default_rng(0).permutation(shuffled[split.test])
    assert trained(LogisticBaseline(), replace(matrix, values=shuffled), alone).strength == chosen.strength


def test_too_few_specimens_take_the_default_strength_and_say_so(matrix: FeatureMatrix, split: SpecimenSplit) -> None:
    healthy = matrix.labels["state"] == "healthy"
    first, second = np.unique(matrix.labels["specimen_id"][split.train])[:2]
    own = matrix.labels["specimen_id"]
    train = ((own == first) & healthy) | ((own == second) & ~healthy)
    model = trained(LogisticBaseline(), matrix, replace(split, train=train, validation=np.zeros_like(train)))
    assert model.strength == DEFAULT_STRENGTH
    assert "too few training specimens" in model.note


def test_positive_columns_are_taken_as_logarithms_so_that_a_gain_is_a_summand(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit
) -> None:
    assert "rms__bearing_vertical" in model.logarithms
    assert not [name for name in model.logarithms if name.startswith("sideband_asymmetry")]
    # a column in another unit: the same logarithms but for a constant, which scaling takes off
    place = matrix.names.index("rms__bearing_vertical")
    other = matrix.values.copy()
    other[:, place] *= 1e3
    again = trained(LogisticBaseline(), replace(matrix, values=other), split).predict(replace(matrix, values=other))
    np.testing.assert_allclose(again.probability, model.predict(matrix).probability, atol=1e-6)


def test_classifier_survives_its_file(
    model: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit, tmp_path: Path
) -> None:
    path = save_classifier(model, IndicatorSettings(), "identity", tmp_path)
    assert untrusted_types(path) == ()
    again = load_classifier(tmp_path)
    test = matrix.rows(split.test)
    np.testing.assert_array_equal(again.predict(test).probability, model.predict(test).probability)
    assert json.loads((tmp_path / "feature_names.json").read_text())["features"] == list(matrix.names)


def test_a_file_with_unknown_types_is_not_loaded(model: FeatureClassifier, tmp_path: Path) -> None:
    import skops.io

    save_classifier(model, IndicatorSettings(), "identity", tmp_path)
    skops.io.dump(shutil.rmtree, tmp_path / "classifier.skops")
    with pytest.raises(UsageError, match="rmtree"):
        load_classifier(tmp_path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no readable classifier\.skops"):
        load_classifier(tmp_path)
