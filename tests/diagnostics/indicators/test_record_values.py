"""Indicators of whole records: names, known modulations, and what is left undefined."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnostics.indicators.average import fm4
from diagnostics.indicators.record import RecordValues, record_values
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import PAIR
from diagnostics.signal.order_domain import angle_grid
from diagnostics.signal.shaft_signals import record_shafts

FS_HZ, TEETH = 25_600.0, (18, 47)


def record(
    duration_s: float, pinion: float = 0.0, gear: float = 0.0, speed_hz: float = 30.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return a mesh tone of amplitude 2 modulated by both shafts, and its pulses."""
    time_s = np.arange(round(FS_HZ * duration_s)) / FS_HZ
    turns = speed_hz * time_s + 0.4
    modulation = 1 + pinion * np.cos(2 * np.pi * turns) + gear * np.cos(2 * np.pi * turns * TEETH[0] / TEETH[1] + 0.7)
    pulses = (np.arange(1, np.floor(turns[-1]) + 1) - 0.4) / speed_hz
    return 2.0 * modulation * np.cos(2 * np.pi * TEETH[0] * turns), pulses


def features_of(duration_s: float = 2.0, **depths: float) -> RecordValues:
    signal, pulses = record(duration_s, **depths)
    return record_values({"a": signal}, pulses, FS_HZ, TEETH)


def test_modulations_of_both_shafts_are_read_back_from_one_record() -> None:
    found = features_of(pinion=0.2, gear=0.1).values
    # over 59 pinion revolutions the plain average keeps up to 1/(pi * 59 * 0.38) = 1.4 % of a gear sideband (5e-2 of
    # the mesh line): 7e-4; the Hann average of the gear leaks far less
    assert found["sideband_pinion_h1_upper1__a"] == pytest.approx(0.1, abs=7e-4)
    assert found["sideband_pinion_h1_lower1__a"] == pytest.approx(0.1, abs=7e-4)
    assert found["sideband_gear_h1_upper1__a"] == pytest.approx(0.05, abs=1e-4)
    assert found["sideband_gear_h1_lower1__a"] == pytest.approx(0.05, abs=1e-4)
    assert found["mesh_amplitude_h1__a"] == pytest.approx(2.0, rel=1e-3)


def test_the_other_shafts_sidebands_do_not_show_in_the_gears() -> None:
    found = features_of(pinion=0.3).values
    # Hann sidelobes two and more bins away, at 22 gear revolutions: below 1e-3 of the 0.15 sideband
    assert max(found[f"sideband_gear_h1_{side}{k}__a"] for side in ("upper", "lower") for k in range(1, 7)) < 1.5e-4


def test_name_carries_definition_and_channel() -> None:
    signal, pulses = record(1.0)
    names = record_values({"a": signal, "b_c": signal}, pulses, FS_HZ, TEETH).values
    assert "sideband_ratio_pinion_h1_k3__a" in names
    assert "sideband_ratio_gear_h5_k3__b_c" in names
    assert len(names) == 2 * len({name.split("__")[0] for name in names})


def test_averaged_revolutions_are_stated() -> None:
    found = features_of(2.0)
    # 60 revolutions hold 59 whole ones between pulses, as the start is not a pulse; 59 * 18 / 47 = 22.6
    assert (*found.revolutions, found.notes) == (59, 22, "")


def test_short_record_leaves_unresolved_gear_sidebands_undefined_and_says_so() -> None:
    found = features_of(0.5, gear=0.1)  # 5 gear revolutions: sidebands 3 (needs 6) and 5 (needs 9) touch the pinion's
    undefined = {name for name, value in found.values.items() if math.isnan(value)}
    assert {name for name in undefined if "_h1_" in name} == {
        *(f"sideband_gear_h1_{side}{k}__a" for side in ("lower", "upper") for k in (3, 5)),
        "sideband_ratio_gear_h1_k3__a",
    }
    assert found.notes == "gear sidebands not resolved by 5 gear revolutions: 3 (needs 5), 5 (needs 9)"
    assert found.values["sideband_gear_h1_upper1__a"] == pytest.approx(0.05, abs=1e-3)


@pytest.mark.parametrize("pulses", [0, 1])
def test_without_an_angle_only_the_raw_indicators_are_defined(pulses: int) -> None:
    signal, times = record(1.0)
    found = record_values({"a": signal}, times[:pulses], FS_HZ, TEETH)
    assert {name for name, value in found.values.items() if not math.isnan(value)} == {
        "rms__a", "kurtosis__a", "crest_factor__a", "spectral_kurtosis_maximum__a",
    }  # fmt: skip
    assert found.values.keys() == features_of(1.0).values.keys()
    assert "no whole turn of the first shaft" in found.notes


def test_fm4_of_a_perfect_record_is_undefined_when_the_angle_is_exact() -> None:
    # a tone that the angle steps hit exactly, so that nothing but rounding remains
    settings = IndicatorSettings(samples_per_tooth=16)
    time_s = np.arange(18 * 16 * 20) / (18 * 16)
    signal = np.cos(2 * np.pi * 18 * time_s)
    from diagnostics.signal.shaft_signals import separated_average
    from diagnostics.signal.synchronous_average import synchronous_average

    average = synchronous_average(signal, 18, settings.samples_per_tooth).signal
    assert math.isnan(fm4(separated_average(average, 18).difference, average))


@pytest.mark.parametrize(("turns", "resolved"), [(6, True), (5, False)])
def test_sideband_is_resolved_from_exactly_the_revolutions_it_needs(turns: int, resolved: bool) -> None:
    # 18/47 teeth: two gear revolutions, 5.2 of the pinion, resolve the gear's first sideband, one order off the line
    grid = angle_grid(np.arange(turns + 1) / 30.0, 18 * 128)
    _, gear = record_shafts(grid, (18, 47), 128, 1, PAIR[0].gears)
    assert gear.revolutions == (2 if resolved else 1)
    assert gear.resolved.tolist() == [resolved]
