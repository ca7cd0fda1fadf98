"""Shares inside the ranges, and the spread between sensors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from planted_set import Plant, measured

from diagnostics.audit.envelope import QUANTITIES, realism
from diagnostics.audit.measured_set import MeasuredSet


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> MeasuredSet:
    return measured(Plant(specimens=3), tmp_path_factory)


def test_the_ranges_hold_their_limits_and_undefined_is_outside() -> None:
    kurtosis = next(quantity for quantity in QUANTITIES if quantity.name == "kurtosis")
    values = np.array([1.9, 2.0, 3.2, 3.3, 4.0, 6.5, 6.6, np.nan])
    assert kurtosis.inside(values).tolist() == [False, True, True, False, True, True, False, False]


def test_thirteen_quantities_count_healthy_channel_records_only(found: MeasuredSet) -> None:
    fm4 = np.where(found.healthy[:, None], 3.0, 99.0) * np.ones((1, 3))
    fm4[0, 0], fm4[0, 1] = np.nan, 9.0
    result = realism(replace(found, values={**found.values, "fm4_pinion": fm4}))
    assert result is not None
    assert len(result.shares) == 13
    assert result.channel_records == 3 * 2 * 3
    share = next(share for share in result.shares if share.quantity.name == "fm4")
    assert share.inside == pytest.approx(16 / 18)
    assert share.undefined == pytest.approx(1 / 18)
    assert share.quantiles[1] == 3.0


def test_speeds_of_benches_and_of_variable_machines_are_in_range_and_those_between_are_not(found: MeasuredSet) -> None:
    shares = {}
    for percent in (0.02, 0.1, 1.0):
        variation = np.full(found.checksums.shape, percent)
        judged = realism(replace(found, values={**found.values, "speed_variation_percent": variation}))
        assert judged is not None
        shares[percent] = judged.shares[-1].inside
    assert shares == {0.02: 1.0, 0.1: 0.0, 1.0: 1.0}


def test_spread_between_sensors_is_the_standard_deviation_over_channels(found: MeasuredSet) -> None:
    values = np.tile([-20.0, -17.0, -14.0], (found.checksums.shape[0], 1))
    result = realism(replace(found, values={**found.values, "sideband1_db": values}))
    assert result is not None
    assert result.spreads[0].name == "sideband1_db"
    assert result.spreads[0].spread_db == pytest.approx(3.0)


def test_what_stands_beside_the_mesh_lines_is_judged_apart_from_the_thirteen(found: MeasuredSet) -> None:
    inside = {"shaft_1x_db": -30.0, "noise_kurtosis_4_8khz": 2.9, "floor_slope_db": np.nan}
    columns = {name: np.full(found.checksums.shape, value) for name, value in inside.items()}
    result = realism(replace(found, values={**found.values, **columns}))
    assert result is not None
    shares = {share.quantity.name: share.inside for share in result.background}
    assert shares["shaft_1x_db"] == 1.0
    assert shares["noise_kurtosis_4_8khz"] == 0.0
    assert "floor_slope_db" not in shares
    assert "shaft_1x_db" not in {share.quantity.name for share in result.shares}
    assert result.background_inside == pytest.approx(np.mean(list(shares.values())))


def test_a_set_without_healthy_records_has_nothing_to_compare(found: MeasuredSet) -> None:
    assert realism(replace(found, labels={**found.labels, "fault": np.full(found.healthy.size, "pitting")})) is None


def test_ranges_of_accelerometers_judge_no_other_quantity(found: MeasuredSet) -> None:
    values = np.tile([-20.0, -17.0, 60.0], (found.checksums.shape[0], 1))
    mixed = replace(found, values={**found.values, "sideband1_db": values}, other_quantities={"bearing_x": "torque"})
    result = realism(mixed)
    assert result is not None
    assert result.channel_records == 3 * 2 * 2
    assert next(share for share in result.shares if share.quantity.name == "sideband1_db").inside == 1.0
    assert result.spreads == ()
    none = dict.fromkeys(found.channels, "torque")
    assert realism(replace(found, other_quantities=none)) is None
