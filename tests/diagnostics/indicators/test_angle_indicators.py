"""Indicators that only angle signals have: speeds and transmission errors made in closed form, through the columns.

Speeds here turn with the record that they are sampled in, so that a modulated speed modulates its own time axis.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from diagnostics.indicators.record import record_values
from diagnostics.indicators.registry import check_quantity, columns, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import ANGULAR_SPEED, RECORDED, TRANSMISSION_ERROR
from siggen.errors import UsageError

FS_HZ, TEETH, SPEED_HZ = 25_600.0, (18, 47), 33.0
GEAR = TEETH[0] / TEETH[1]
MEAN = 2.0 * math.pi * SPEED_HZ
KNOWN = indicator_columns(IndicatorSettings())
HELD = {"encoder": ANGULAR_SPEED, "error": TRANSMISSION_ERROR}


@cache
def turning(duration_s: float = 1.5, drift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the pinion's turns at the samples, and the times of its whole turns; drift: speed-up per second, share."""
    time_s = np.arange(round(duration_s * FS_HZ)) / FS_HZ
    turns = SPEED_HZ * (time_s + drift / 2 * time_s**2)
    return turns, np.interp(np.arange(1, math.floor(turns[-1]) + 1), turns, time_s)


def values(signal: np.ndarray, quantity: str = ANGULAR_SPEED, pulses: np.ndarray | None = None) -> dict[str, float]:
    name = next(key for key, held in HELD.items() if held == quantity)
    found = record_values({name: signal}, turning()[1] if pulses is None else pulses, FS_HZ, TEETH, quantities=HELD)
    return {key.split("__")[0]: value for key, value in found.values.items()}


def modulated(turns: np.ndarray, lines: dict[float, float]) -> np.ndarray:
    return np.sum([a * np.cos(2.0 * math.pi * o * turns + o) for o, a in lines.items()], axis=0)


LINES = {1.0: 0.5, 2.0: 0.2, 3.0: 0.1, GEAR: 0.4, 2 * GEAR: 0.3, 3 * GEAR: 0.15, 18.0: 2.0, 17.0: 0.4}
"""Amplitude by pinion order: three orders of both shafts, a mesh line and its sideband."""


@pytest.mark.parametrize("quantity", [ANGULAR_SPEED, TRANSMISSION_ERROR])
def test_orders_of_both_shafts_are_read_within_one_percent_beside_a_mean_and_a_strong_mesh_line(quantity: str) -> None:
    found = values(MEAN + modulated(turning()[0], LINES), quantity)
    for order in (1, 2, 3):
        assert found[f"shaft_amplitude_pinion_k{order}"] == pytest.approx(LINES[order], rel=0.01)
        assert found[f"shaft_amplitude_gear_k{order}"] == pytest.approx(LINES[order * GEAR], rel=0.01)


def test_orders_are_read_while_the_speed_drifts() -> None:
    turns, pulses = turning(drift=0.05)
    time_s = np.arange(turns.size) / FS_HZ
    found = values(MEAN * (1.0 + 0.05 * time_s) + modulated(turns, {1.0: 0.5, GEAR: 0.4}), pulses=pulses)
    # a drift of 16 rad/s over the record leaks below 1 % of a line of 0.4 rad/s at bin 18 of its Hann spectrum
    assert found["shaft_amplitude_pinion_k1"] == pytest.approx(0.5, rel=0.01)
    assert found["shaft_amplitude_gear_k1"] == pytest.approx(0.4, rel=0.01)


def test_speed_ripple_is_the_modulation_over_root_two_and_leaves_the_mesh_and_the_drift_out() -> None:
    turns, pulses = turning(drift=0.05)
    mean = MEAN * (1.0 + 0.05 * np.arange(turns.size) / FS_HZ)
    ripple = {1.0: 0.012, 2 * GEAR: 0.005, 5.0: 0.003}
    found = values(mean + MEAN * modulated(turns, ripple | {18.0: 0.05}), pulses=pulses)["speed_ripple"]
    middle = mean[: round(pulses[-1] * FS_HZ)].mean() / MEAN
    assert found * middle == pytest.approx(math.sqrt(sum(m**2 for m in ripple.values()) / 2), rel=0.01)


def test_two_orders_one_apart_are_told_apart_and_none_is_found_where_none_is() -> None:
    found = values(MEAN + modulated(turning()[0], {1.0: 1.0, 3.0: 1.0}))
    assert found["shaft_amplitude_pinion_k1"] == pytest.approx(1.0, rel=0.01)
    assert found["shaft_amplitude_pinion_k3"] == pytest.approx(1.0, rel=0.01)
    assert found["shaft_amplitude_pinion_k2"] < 1e-3


def test_white_noise_has_the_amplitude_and_the_ripple_of_its_closed_form() -> None:
    rng, sigma, count = np.random.default_rng(1), 0.8, 60
    rows = [values(MEAN + sigma * rng.standard_normal(turning()[0].size)) for _ in range(count)]
    held = (turning()[1][-1] - turning()[1][0]) * FS_HZ
    amplitudes = [row[f"shaft_amplitude_pinion_k{k}"] ** 2 for row in rows for k in (1, 2, 3)]
    # squares of amplitudes are exponential: the rms over 180 of them errs by 0.5/sqrt(180), four standard errors
    expected = sigma * math.sqrt(6.0 / held)
    assert math.sqrt(np.mean(amplitudes)) == pytest.approx(expected, rel=4 * 0.5 / math.sqrt(3 * count))
    band = SPEED_HZ * (0.5 * TEETH[0] - 0.5 * GEAR) / (FS_HZ / 2)
    ripple = math.sqrt(np.mean([row["speed_ripple"] ** 2 for row in rows]))
    # some 430 bins in a band, 60 records: 0.5/sqrt(430 * 60 / 2) is 0.4 %; the band begins on a whole bin: 0.2 %
    assert ripple == pytest.approx(sigma * math.sqrt(band) / MEAN, rel=0.02)


def test_level_about_the_mean_leaves_the_mean_speed_out() -> None:
    found = values(MEAN + modulated(turning()[0], {5.0: 0.6}))
    assert found["rms"] == pytest.approx(MEAN, rel=1e-4)
    assert found["rms_without_mean"] == pytest.approx(0.6 / math.sqrt(2), rel=0.01)  # no whole number of periods


def test_lines_that_a_record_does_not_resolve_are_undefined_and_so_is_ripple_of_few_turns() -> None:
    # 0.3 s: nine turns of the pinion, three of the gear; gear order 3 lies 0.15 pinion orders from pinion order 1
    turns, pulses = turning(0.3)
    found = values(MEAN + modulated(turns, LINES), pulses=pulses)
    assert math.isnan(found["shaft_amplitude_pinion_k1"])
    assert math.isnan(found["shaft_amplitude_gear_k3"])
    assert math.isnan(found["speed_ripple"])
    assert found["shaft_amplitude_pinion_k3"] == pytest.approx(LINES[3.0], rel=0.1)


def test_accelerations_keep_their_columns_and_every_quantity_has_its_own() -> None:
    own = {held: set(columns(IndicatorSettings(), held)) for held in (RECORDED.word, *HELD.values(), "torque")}
    lines = {f"shaft_amplitude_{shaft}_k{k}" for shaft in ("pinion", "gear") for k in (1, 2, 3)}
    common = own[RECORDED.word] - {"crest_factor"}
    assert own["torque"] == common
    assert own[TRANSMISSION_ERROR] == common | lines | {"rms_without_mean"}
    assert own[ANGULAR_SPEED] == common | lines | {"rms_without_mean", "speed_ripple"}


def test_an_indicator_of_another_quantity_is_refused_with_channel_quantity_and_what_to_take() -> None:
    held = {**HELD, "lid": RECORDED.word}
    with pytest.raises(UsageError, match=r"received channel 'encoder', which holds angular speed.*acceleration.*lid"):
        check_quantity("crest_factor__encoder", KNOWN, held)
    with pytest.raises(UsageError, match=r"received channel 'lid', which holds acceleration.*encoder, error"):
        check_quantity("shaft_amplitude_gear_k2__lid", KNOWN, held)
    for column in ("crest_factor__lid", "speed_ripple__encoder", "rms__error", "peak__lid", "record_id"):
        check_quantity(column, KNOWN, held)
