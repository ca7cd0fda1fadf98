"""Every registered indicator against a closed form and against a second computation, through the columns users get."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import plain_indicators as plain
import pytest
from scipy.special import jv

from diagnostics.indicators.cepstrum import BAND_SHARE
from diagnostics.indicators.channel_signals import ChannelSignals
from diagnostics.indicators.history import history_indicators
from diagnostics.indicators.registry import indicator_columns, taken_of
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.shaft_signals import SignalShaft, record_shafts

TEETH, PER_TOOTH, FS_HZ = (18, 47), 128, 25_600.0
Z, PER_TURN = TEETH[0], TEETH[0] * PER_TOOTH
TURNS = TEETH[1]
ANGLE = 2 * np.pi * np.arange(PER_TURN) / PER_TURN
SETTINGS = IndicatorSettings()
PINION = SignalShaft("pinion", Z, 1, np.ones(6, dtype=bool), "")
TAKEN = taken_of(RECORDED.word)
"""Indicators of accelerations; those of angles: test_angle_indicators.py."""
NO_GEAR = SignalShaft("gear", TEETH[1], 0, np.zeros(6, dtype=bool), "", weighted=True)


def tone(order: int, amplitude: float = 1.0) -> np.ndarray:
    return amplitude * np.cos(order * ANGLE + 0.2)


def over_angle(steps: np.ndarray) -> ChannelSignals:
    """Return the signals of a record that is known at equal angles of the pinion already."""
    signals = ChannelSignals(np.ones(1), FS_HZ, None, (PINION, NO_GEAR), SETTINGS)
    signals.steps = steps
    return signals


def column(name: str, steps: np.ndarray) -> float:
    return over_angle(steps).values(TAKEN)[name]


# --- closed forms -----------------------------------------------------------------------------------------------------

MIXED = 1.5 + tone(1, 5.0) + tone(2, 4.0) + tone(Z, 3.0) + tone(6 * Z, 2.0) + tone(Z + 1, 0.6) + tone(7, 0.8)
"""Mean, shaft orders, two mesh lines (one beyond the fifth), a first sideband, and what alone is no regular part."""

MODULATION = 0.3
AM = 2.0 * (1 + MODULATION * np.cos(ANGLE + 0.4)) * np.cos(Z * ANGLE + 1)
PM = 2.0 * np.cos(Z * ANGLE + 0.2 * np.sin(ANGLE + 0.4))
BOTH = (1 + 0.3 * np.cos(ANGLE)) * np.cos(Z * ANGLE + 0.2 * np.sin(ANGLE))
COMMON = 0.15 * (jv(0, 0.2) + jv(2, 0.2))
TWO_TONES = tone(100, 0.7) + tone(37, 0.4)


def teager_of_two_tones(first: int, second: int) -> float:
    """Return mu_4/mu_2^2 of P cos((a - b) i) + Q cos((a + b) i), which is what two tones' energy varies by."""
    a, b = (2 * math.pi * order / PER_TURN for order in (first, second))
    p, q = 1 - math.cos(a + b), 1 - math.cos(a - b)
    return (0.375 * (p**4 + q**4) + 1.5 * p**2 * q**2) / (0.5 * (p**2 + q**2)) ** 2


CLOSED_ON_AVERAGES = {
    "mesh_amplitude_h1": (MIXED, 3.0),
    "average_rms_pinion": (MIXED, math.sqrt(1.5**2 + (25 + 16 + 9 + 4 + 0.36 + 0.64) / 2)),
    "average_kurtosis_pinion": (9.0 + tone(7), 1.5),
    "average_crest_factor_pinion": (3 * np.cos(Z * ANGLE), math.sqrt(2)),
    "residual_rms_pinion": (MIXED, math.sqrt((0.36 + 0.64) / 2)),
    "difference_rms_pinion": (MIXED, 0.8 / math.sqrt(2)),
    "fm0_pinion_h5": (np.cos(Z * ANGLE) + 0.5 * np.cos(3 * Z * ANGLE), 2.0),
    "fm4_pinion": (MIXED, 1.5),
    "m6a_pinion": (MIXED, 2.5),
    "m8a_pinion": (MIXED, 4.375),
    "energy_ratio_pinion": (MIXED, 0.8 / math.sqrt(25 + 16 + 9 + 4 + 0.36)),
    "energy_operator_teager_pinion": (
        MIXED - tone(Z + 1, 0.6) - tone(7, 0.8) + TWO_TONES,
        teager_of_two_tones(100, 37),
    ),
    "energy_operator_lebold_pinion": (MIXED - tone(7, 0.8), 1.5),
    "sideband_index_pinion_h1": (AM, MODULATION),
    "sideband_level_factor_pinion_h1": (9.0 + AM, math.sqrt(2) * MODULATION / math.sqrt(1 + MODULATION**2 / 2)),
    "sideband_pinion_h1_upper1": (AM, MODULATION / 2),
    "sideband_ratio_pinion_h1_k3": (AM + tone(Z + 3, 0.5) + tone(Z - 4, 9.0), MODULATION + 0.25),
    "sideband_power_pinion_h5_k1": (AM + tone(5 * Z, 1.0) + tone(6 * Z), MODULATION**2 / 2 * 4 / 5),
    "sideband_asymmetry_pinion_h1": (BOTH, 20 * math.log10((COMMON + jv(1, 0.2)) / (COMMON - jv(1, 0.2)))),
    "amplitude_modulation_pinion_h1": (AM + tone(2 * Z) + tone(40), MODULATION),
    "phase_modulation_pinion_h1": (PM + tone(2 * Z) + tone(40), 0.2),
    "band_kurtosis_pinion_o75_150": (MIXED + tone(100, 0.3), 1.5),
    # two lines beat once per revolution: energy 1 + cos(angle), its mean over the best of the pitches of 128 steps
    "band_localised_energy_pinion_o75_150": (
        MIXED + tone(100, 0.3) + tone(101, 0.3),
        1 + np.cos(ANGLE[np.arange(PER_TOOTH) - PER_TOOTH // 2]).mean(),
    ),
}
"""Column: one revolution of the pinion, and its value."""


@pytest.mark.parametrize("name", CLOSED_ON_AVERAGES)
def test_closed_form_of_an_average(name: str) -> None:
    average, expected = CLOSED_ON_AVERAGES[name]
    # 1e-9: rounding, and J_7(0.2) = 2e-11 of the phase modulation beyond the sixth sideband
    assert column(name, average) == pytest.approx(expected, rel=1e-9)


def test_closed_form_of_the_mesh_amplitudes_of_every_harmonic() -> None:
    average = sum(tone(h * Z, 0.1 * h) for h in range(1, 6))
    for h in range(1, 6):
        assert column(f"mesh_amplitude_h{h}", average) == pytest.approx(0.1 * h)


def test_closed_form_of_the_noise_share() -> None:
    # revolutions s + c and s - c in turn: variance c^2 M/(M - 1) between them, over M, by that of s
    steps = np.concatenate([tone(Z, 2.0) + sign * tone(7, 0.5) for sign in (1, -1) * 4])
    assert column("noise_share_pinion", steps) == pytest.approx(0.5**2 / 2 / 7 / (2.0**2 / 2))


def raw(name: str, signal: np.ndarray) -> float:
    shafts = record_shafts(None, TEETH, PER_TOOTH, 6, PAIR[0].gears)
    return ChannelSignals(signal, FS_HZ, None, shafts, SETTINGS).values(TAKEN)[name]


SINE = 1.7 * np.cos(2 * np.pi * np.arange(25_600) / 64)
CLOSED_ON_RECORDS = {
    "rms": (3.0 + SINE, math.sqrt(9 + 1.7**2 / 2)),
    "kurtosis": (3.0 + SINE, 1.5),
    "crest_factor": (3.0 + SINE, 4.7 / math.sqrt(9 + 1.7**2 / 2)),
}


@pytest.mark.parametrize("name", CLOSED_ON_RECORDS)
def test_closed_form_of_a_record(name: str) -> None:
    signal, expected = CLOSED_ON_RECORDS[name]
    assert raw(name, signal) == pytest.approx(expected, rel=1e-12)


def test_closed_form_of_the_spectral_kurtosis() -> None:
    # one spike every half frame, three times as high in a tenth of 2,000 frames: <s^4>/<s^2>^2 - 2 in every band; two
    # of the frames see a change of height. A spike off the middle of a half frame leaves no band empty.
    height = np.repeat([1.0, 3.0, 1.0], [900, 200, 901])
    spike = (np.arange(256) == 64).astype(float)
    expected = (0.9 + 0.1 * 81) / (0.9 + 0.1 * 9) ** 2 - 2
    assert raw("spectral_kurtosis_maximum", np.outer(height, spike).ravel()) == pytest.approx(expected, abs=0.02)


def whole_record(signal: np.ndarray, pulses: np.ndarray) -> ChannelSignals:
    grid = angle_grid(pulses, PER_TURN)
    return ChannelSignals(signal, FS_HZ, grid, record_shafts(grid, TEETH, PER_TOOTH, 6, PAIR[0].gears), SETTINGS)


def test_closed_form_of_the_cepstral_peaks() -> None:
    # an echo of share a after one revolution gives a/2 there; noise in a bin: see test_modulation.py
    noise = np.random.default_rng(2).standard_normal(61_440)
    for share, name, delay in ((0.4, "pinion", 1280), (0.6, "gear", round(1280 * 47 / 18))):
        echo = noise.copy()
        echo[delay:] += share * noise[:-delay]
        found = whole_record(echo, np.arange(0.01, 2.39, 0.05)).values(TAKEN)  # 1,280 samples per pinion revolution
        other = "gear" if name == "pinion" else "pinion"
        assert found[f"cepstral_peak_{name}"] == pytest.approx(share / 2, abs=0.04)
        assert abs(found[f"cepstral_peak_{other}"]) < 0.03


SCALES = (1.0, 2.0, 3.0)
CLOSED_OF_HISTORIES = {
    "na4": [2.25 * s**4 / np.mean(np.square(SCALES[: i + 1])) ** 2 for i, s in enumerate(SCALES)],
    "na4_star": [2.25 * s**4 for s in SCALES],
    "nb4": [1.5 * s**4 / np.mean(np.square(SCALES[: i + 1])) ** 2 for i, s in enumerate(SCALES)],
}


def columns_of(rows: list[dict[str, float]]) -> dict[str, np.ndarray]:
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def labels(order: list[int]) -> dict[str, np.ndarray]:
    """Return the labels of a healthy record and two damaged ones of one specimen, in the given order of rows."""
    same = {name: np.zeros(len(order)) for name in ("specimen_id", "operating_point_id", "repeat")}
    area, fault = np.array([0.0, 0.5, 2.0])[order], np.array(["healthy", "pitting", "pitting"])[order]
    return {**same, "state_id": np.array([4, 2, 1])[order], "damaged_area_mm2": area, "fault": fault}


@pytest.mark.parametrize("order", [[0, 1, 2], [2, 0, 1], [1, 2, 0]])
@pytest.mark.parametrize("name", CLOSED_OF_HISTORIES)
def test_closed_form_of_a_history_in_any_order_of_rows(name: str, order: list[int]) -> None:
    # sidebands grow with s: residual 0.2 s cos(angle) cos(2 z angle), kurtosis 1.5 * 1.5; envelope 2 + 0.2 s cos(angle)
    averages = [tone(2 * Z, 2.0) + tone(2 * Z, 0.1 * SCALES[i]) * 2 * np.cos(ANGLE) for i in order]
    moments = columns_of([over_angle(average).moments() for average in averages])
    found = history_indicators(labels(order), moments)[f"{name}_pinion"]
    np.testing.assert_allclose(found, np.array(CLOSED_OF_HISTORIES[name])[order], rtol=1e-9)


def test_a_history_is_one_specimen_at_one_operating_point_in_one_repeat() -> None:
    owners = [(s, p, r, i) for i in (2, 0, 1) for s in (0, 1) for p in (0, 1) for r in (0, 1)]
    level = {(s, p, r): 1.0 + 4 * s + 2 * p + r for s in (0, 1) for p in (0, 1) for r in (0, 1)}
    moments = []
    for s, p, r, i in owners:
        average = tone(2 * Z, 2.0) + tone(2 * Z, 0.02 * level[s, p, r] * SCALES[i]) * 2 * np.cos(ANGLE)
        moments.append(over_angle(average).moments())
    names = ("specimen_id", "operating_point_id", "repeat")
    own = {name: np.array([owner[place] for owner in owners]) for place, name in enumerate(names)}
    found = history_indicators({**labels([owner[3] for owner in owners]), **own}, columns_of(moments))
    for name, expected in CLOSED_OF_HISTORIES.items():
        wanted = [expected[owner[3]] for owner in owners]
        np.testing.assert_allclose(found[f"{name}_pinion"], wanted, rtol=1e-9, err_msg=name)


# --- a second computation ---------------------------------------------------------------------------------------------


def lines_of(seed: int) -> list[tuple[float, float, float]]:
    """Return (pinion orders, amplitude, phase): mesh lines, sidebands of both shafts, and lines of neither."""
    rng = np.random.default_rng(seed)
    gear = Z / TEETH[1]
    orders = [*np.arange(1.0, 5.0), *gear * np.arange(1, 4), 46.0, 47.0, *rng.uniform(3.0, 110.0, 12)]
    found = [(o, rng.uniform(0.02, 0.1)) for o in orders]
    for h in range(1, 7):
        mesh = rng.uniform(0.5, 2.0)
        beside = [h * Z + s * k * unit for k in range(1, 8) for s in (-1, 1) for unit in (1.0, gear)]
        found += [(float(h * Z), mesh), *((o, mesh * rng.uniform(0.01, 0.08)) for o in beside)]
    return [(o, a, rng.uniform(0, 2 * np.pi)) for o, a in found]


def written_out(lines: list[tuple[float, float, float]], turns: np.ndarray) -> np.ndarray:
    return np.sum([a * np.cos(2 * np.pi * o * turns + p) for o, a, p in lines], axis=0)


START, CHANGE = 30.0, 0.75
"""Speed [Hz] and its change per second: 4 % over the record."""


@cache
def record_and_truth(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a record that speeds up, its pulses, and the same signal at its true equal angles."""
    lines = lines_of(seed)
    time_s = np.arange(round(1.61 * FS_HZ)) / FS_HZ
    record = 0.3 + written_out(lines, START * time_s + CHANGE / 2 * time_s**2)
    pulses = (np.sqrt(START**2 + 2 * CHANGE * np.arange(1, TURNS + 2)) - START) / CHANGE
    return record, pulses, 0.3 + written_out(lines, 1 + np.arange(TURNS * PER_TURN) / PER_TURN)


def second_computation(seed: int) -> dict[str, float]:
    record, pulses, steps = record_and_truth(seed)
    values = plain.raw_indicators(record)
    for name, teeth in zip(("pinion", "gear"), TEETH, strict=True):
        values |= plain.shaft_indicators(steps, name, teeth, PER_TOOTH)
    grid = angle_grid(pulses, PER_TURN)  # between its lines this record holds only the error of its resampling
    resampled = resample_to_angle(record, FS_HZ, grid)
    highest = int(BAND_SHARE * 0.5 * FS_HZ / grid.slowest_hz)
    return values | plain.cepstral_peaks(resampled, TURNS, TEETH, highest)


def test_every_column_by_a_second_computation() -> None:
    record, pulses, _ = record_and_truth(3)
    found, expected = whole_record(record, pulses).values(TAKEN), second_computation(3)
    found = {name: value for name, value in found.items() if not name.startswith("band_")}  # empty of lines here
    assert set(found) == set(expected)
    for name, value in expected.items():
        # resampling errs by 3e-5 of the amplitude at most; eighth moments and energies multiply that by up to ten
        assert found[name] == pytest.approx(value, rel=3e-4), name


def test_every_band_by_a_second_computation() -> None:
    rng = np.random.default_rng(4)
    # of a gear that turns 2.6 times slower, half the sampling rate is its order 1000: lines in all bands of both
    orders = np.concatenate([np.arange(4, 300, 1.37), Z / TEETH[1] * np.arange(4, 560, 2)])
    lines = [(o, rng.uniform(0.1, 1.0), rng.uniform(0.0, 6.3)) for o in orders]
    time_s = np.arange(round(1.61 * FS_HZ)) / FS_HZ
    record = written_out(lines, START * time_s)
    found = whole_record(record, np.arange(1, TURNS + 2) / START).values(TAKEN)
    steps = written_out(lines, 1 + np.arange(TURNS * PER_TURN) / PER_TURN)
    expected = {}
    for name, teeth in zip(("pinion", "gear"), TEETH, strict=True):
        carried = FS_HZ / 2 / START * teeth / Z
        expected |= plain.band_indicators(plain.plain_average(steps, teeth * PER_TOOTH), name, teeth, carried)
    assert set(expected) == {name for name in found if name.startswith("band_")}
    for name, value in expected.items():
        # up to 0.4 of the rate resampling errs by 1e-3 of the amplitude, fourth moments by four times that
        assert found[name] == pytest.approx(value, rel=4e-3, nan_ok=True), name
    assert [name for name, value in expected.items() if math.isnan(value)] == [
        f"band_{kind}_pinion_o300_600" for kind in ("kurtosis", "localised_energy")
    ]


def test_every_history_by_a_second_computation() -> None:
    order = [2, 0, 1]
    moments = columns_of([whole_record(*record_and_truth(i)[:2]).moments() for i in order])
    found = history_indicators(labels(order), moments)
    for shaft, teeth in zip(("pinion", "gear"), TEETH, strict=True):
        averages = [plain.plain_average(record_and_truth(i)[2], teeth * PER_TOOTH) for i in range(3)]
        residuals = [plain.without_fit(average, teeth, 0) for average in averages]
        harmonic = plain.dominant(averages[0], teeth)
        envelopes = [plain.envelope(average, teeth, harmonic) for average in averages]
        for row, i in enumerate(order):
            expected = {
                "na4": plain.plain_na4(residuals[i], residuals[: i + 1]),
                "na4_star": plain.plain_na4(residuals[i], residuals[:1]),
                "nb4": plain.plain_na4(envelopes[i], envelopes[: i + 1]),
            }
            for name, value in expected.items():
                assert found[f"{name}_{shaft}"][row] == pytest.approx(value, rel=3e-4), (name, shaft, i)


# --- nothing left out -------------------------------------------------------------------------------------------------

SEPARATE = {"spectral_kurtosis_maximum", "cepstral_peak", "noise_share"}
"""Closed forms that have a test of their own above."""


def test_every_definition_has_a_closed_form_and_a_second_computation() -> None:
    tables = (CLOSED_ON_AVERAGES, CLOSED_ON_RECORDS, CLOSED_OF_HISTORIES)
    known = {entry.name for entry in TAKEN}
    of_column = {name: one.entry.name for name, one in indicator_columns(SETTINGS).items()}
    assert {of_column.get(name, name) for table in tables for name in table} | SEPARATE == known
    record, pulses, _ = record_and_truth(3)
    by_column = {of_column[name] for name in whole_record(record, pulses).values(TAKEN)}
    assert by_column | set(CLOSED_OF_HISTORIES) == known
