"""Evaluation of a set whose modulation follows the damage, and of one without any effect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.ranking_table import IndicatorTable, ranking_table
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.statistics.assessment import AssessmentSettings, assessment, result_table
from diagnostics.statistics.indicator_result import IndicatorResult

SETTINGS = AssessmentSettings(resamples=60)


@pytest.fixture(scope="module")
def table(dataset: Any, measured: RecordTable) -> IndicatorTable:
    return ranking_table(measured, dataset)


@pytest.fixture(scope="module")
def found(table: IndicatorTable) -> list[IndicatorResult]:
    return assessment(table, SETTINGS)


def named(found: list[IndicatorResult], indicator: str, channel: str = "bearing_vertical") -> IndicatorResult:
    return next(r for r in found if (r.indicator, r.channel) == (indicator, channel))


def test_every_indicator_and_channel_is_ranked_once(found: list[IndicatorResult], table: IndicatorTable) -> None:
    assert sorted(r.column for r in found) == sorted(table.matrix.names)
    scores = [r.score_others.value for r in found if np.isfinite(r.score_others.value)]
    assert scores == sorted(scores, reverse=True)


def test_once_per_revolution_dip_is_seen_by_pinion_indicators_in_both_designs(found: list[IndicatorResult]) -> None:
    best = named(found, "sideband_power_pinion_h5_k1")
    assert best.direction == 1
    assert best.others["severe"].separation.value == 1.0
    assert best.same["slight"].separation.value == 1.0
    assert best.spearman_area.value > 0.9
    assert best.monotonicity.value == 1.0
    assert best.others["severe"].holm < 0.05
    # area 1 of the slight state is the smallest there is, and already found
    assert best.detectable["others_area_mm2_a90"].value == best.smallest_size["others_area_mm2"] == 1.0


def test_gear_indicators_of_a_pinion_fault_are_weaker(found: list[IndicatorResult]) -> None:
    pinion, gear = (named(found, f"sideband_power_{shaft}_h5_k1").score_others.value for shaft in ("pinion", "gear"))
    assert pinion > gear


def test_level_is_random_between_specimens(found: list[IndicatorResult]) -> None:
    level = named(found, "mesh_amplitude_h1")
    assert abs(level.others["slight"].separation.value - 0.5) < 0.25  # AUC of 24 against 24 scatters by 0.083


def test_without_an_effect_nothing_survives_the_correction(effectless: Any, measured_effectless: RecordTable) -> None:
    found = assessment(ranking_table(measured_effectless, effectless), SETTINGS)
    # NA4* of a history depends on M by construction; it compares with one record, the rest must show nothing
    fresh = [r for r in found if not r.indicator.startswith(("na4", "nb4"))]
    assert min(result.holm for r in fresh for result in r.others.values() if np.isfinite(result.holm)) > 0.05
    assert min(result.holm for r in fresh for result in r.same.values() if np.isfinite(result.holm)) > 0.05
    scores = np.array([r.score_others.value for r in fresh])
    assert np.nanmax(np.abs(scores - 0.5)) < 0.25


def test_direction_of_a_falling_indicator_is_turned(table: IndicatorTable) -> None:
    name = "sideband_power_pinion_h5_k1__bearing_vertical"
    values = table.matrix.values[:, [table.matrix.names.index(name)]]
    both = np.concatenate([values, -values], axis=1)
    matrix = FeatureMatrix(both, (name, "fallen__bearing_vertical"), table.matrix.labels)
    rising, falling = sorted(assessment(replace(table, matrix=matrix), SETTINGS), key=lambda r: -r.direction)
    assert falling.direction == -1
    assert falling.score_others.value == pytest.approx(rising.score_others.value)
    assert falling.detectable["others_area_mm2_a90"] == rising.detectable["others_area_mm2_a90"]


def test_what_moves_a_healthy_indicator_is_found(table: IndicatorTable) -> None:
    rng = np.random.default_rng(1)
    labels = dict(table.matrix.labels)
    labels["speed_hz"] = rng.uniform(20, 35, labels["state"].size)
    labels["torque_nm"] = rng.uniform(30, 80, labels["state"].size)
    labels["snr_bearing_vertical_db"] = rng.uniform(0, 30, labels["state"].size)
    values = np.stack([labels["speed_hz"] ** 2, 100.0 + labels["speed_hz"] ** 2, rng.standard_normal(72)], axis=1)
    names = ("a__bearing_vertical", "a__bearing_horizontal", "b__bearing_vertical")
    found = assessment(replace(table, matrix=FeatureMatrix(values, names, labels)), SETTINGS)
    moved = named(found, "a")
    assert moved.sensitivity["speed"] > 0.9
    assert moved.sensitivity["load"] < 0.35  # 24 records: adjusted share scatters by sqrt(2 * 2)/24 = 0.08
    assert moved.sensitivity["noise"] < 0.35
    assert np.isnan(named(found, "a", "bearing_horizontal").sensitivity["noise"])  # the set does not tell it
    assert moved.sensitivity["sensor"] < 0.2  # 100 is small against 400 ... 1225


def test_healthy_repeats_give_a_threshold_on_the_same_specimen(make_dataset: Callable[..., Any]) -> None:
    few = make_dataset(("test",) * 8)
    small = ranking_table(record_table(few), few)
    labels = {name: np.concatenate([values, values]) for name, values in small.matrix.labels.items()}
    labels["repeat"] = np.repeat([0, 1], 24)
    rng = np.random.default_rng(2)
    values = 10.0 * labels["specimen_id"] + labels["damaged_area_mm2"] + 0.1 * rng.standard_normal(48)
    matrix = FeatureMatrix(values[:, None], ("a__bearing_vertical",), labels)
    found = assessment(replace(small, matrix=matrix), SETTINGS)[0]
    assert found.detectable["same_area_mm2_a90"].value == 1.0
    assert found.detectable["others_area_mm2_a90"].value == np.inf  # specimens differ by ten times the largest effect


def test_table_has_a_row_for_each(found: list[IndicatorResult]) -> None:
    table = result_table(found)
    assert table.num_rows == len(found)
    assert table.column("rank").to_pylist() == list(range(1, len(found) + 1))
    assert {"others_holm_severe", "spearman_area_low", "explained_by_sensor", "others_area_mm2_a90"} <= set(
        table.column_names
    )
    assert all(isinstance(r.numbers()["direction"], int) for r in found)
