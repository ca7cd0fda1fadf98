"""Each fit finds again what was put in, by another way than it was put in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagnostics.calibration.calibration import path_gains
from diagnostics.calibration.drivetrain import drivetrain
from diagnostics.calibration.healthy_blocks import HealthyBlock, healthy_blocks, jackknife
from diagnostics.calibration.noise_fit import noise_fit, smallest_step
from diagnostics.calibration.order_record import order_record
from diagnostics.calibration.own_lines import own_lines
from diagnostics.calibration.path_draws import housing_mass_kg, liftered, minimum_phase, path_level_db, path_level_doubt
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.records.gear_train import pair_train

FS_HZ, TEETH, SAMPLES = 25_600.0, (18, 47), 102_400
TIME_S = np.arange(SAMPLES) / FS_HZ
PAIR = drivetrain(pair_train(TEETH))


def block(signal: np.ndarray, speed_hz: float) -> HealthyBlock:
    return HealthyBlock("run", {"c": signal}, FS_HZ, np.arange(0.0, SAMPLES / FS_HZ, 1.0 / speed_hz))


def test_minimum_phase_gives_back_a_response_that_has_it() -> None:
    z = np.exp(1j * np.linspace(0.0, np.pi, 4097))
    zeros, poles = 0.9 * np.exp(0.5j), 0.95 * np.exp(1.2j)
    # of a filter in discrete time, whose zeros and poles lie within the unit circle
    response = np.abs(zeros) ** 2 - 2 * zeros.real * z + z**2
    response /= np.abs(poles) ** 2 - 2 * poles.real * z + z**2
    found = minimum_phase(20.0 * np.log10(np.abs(response)))
    assert np.abs(found - response).max() < 1e-6 * np.abs(response).max()


def test_a_path_between_dense_lines_follows_them_and_far_from_lines_the_floor() -> None:
    grid = np.linspace(0.0, 12_800.0, 1025)
    lines = np.arange(600.0, 4000.0, 30.0)
    truth = 10.0 * np.sin(grid / 1500.0)
    floor = np.full(4096, -40.0)
    found = path_level_db(lines, np.interp(lines, grid, truth), liftered(floor), grid, FS_HZ)
    inside = (grid > 800.0) & (grid < 3500.0)
    # the kernel of 0.12 octave averages a slope over a tenth of the frequency
    assert np.abs(found - truth)[inside].max() < 1.0
    assert np.ptp(found[grid > 9000.0]) < 1.0


def test_a_floor_is_found_beside_strong_lines_and_lines_with_their_energy() -> None:
    noise = np.random.default_rng(1).standard_normal(SAMPLES) * 0.1
    signal = noise + 3.0 * np.sin(2 * np.pi * 18 * 30.0 * TIME_S) + np.sin(2 * np.pi * 18 * 60.0 * TIME_S)
    record = order_record(signal, FS_HZ, block(signal, 30.0).pulses_s, PAIR)
    density = 0.1 * np.sqrt(2.0 / FS_HZ)
    middle = record.density[
        (np.arange(record.floor.size) * record.bin_hz > 200) & (np.arange(record.floor.size) * record.bin_hz < 11e3)
    ]
    # medians of 41 bins scatter by 11 % of the power
    assert np.median(middle) == pytest.approx(density, rel=0.03)
    assert record.line(18.0)[0] == pytest.approx(4.5, rel=0.01)
    assert record.line(36.0)[0] == pytest.approx(0.5, rel=0.01)


def test_noise_gives_back_its_density_depth_and_level() -> None:
    rng = np.random.default_rng(2)
    blocks, records = [], []
    for speed in (30.0, 31.0, 29.5):
        strength = 1.0 + 0.4 * np.cos(2 * np.pi * speed * TIME_S)
        signal = rng.standard_normal(SAMPLES) * np.sqrt(strength)
        blocks.append(block(signal, speed))
        records.append(order_record(signal, FS_HZ, blocks[-1].pulses_s, PAIR))
    fit = noise_fit(records, blocks, "c", TEETH)
    inside = (fit.frequency_hz > 100.0) & (fit.frequency_hz < 11_000.0)
    decibels = 20.0 * np.log10(fit.density[inside] / np.sqrt(2.0 / FS_HZ))
    assert abs(np.median(decibels)) < 0.3
    assert fit.driver_depth.value == pytest.approx(0.4, abs=0.05)
    # its kurtosis is that of the first line alone; the fit assumes three and leaves none for chance
    assert fit.driven_depth.value < 0.06
    assert fit.level_std.value < 0.15


def test_an_order_and_a_tone_are_told_apart_where_speeds_differ() -> None:
    rng = np.random.default_rng(3)
    records = []
    for speed in (30.0, 31.3, 32.9):
        signal = 0.05 * rng.standard_normal(SAMPLES)
        signal += np.sin(2 * np.pi * 4.35 * speed * TIME_S) + 0.5 * np.sin(2 * np.pi * 777.7 * TIME_S)
        records.append(order_record(signal, FS_HZ, block(signal, speed).pulses_s, PAIR))
    strong = [line for line in own_lines(records, PAIR) if line.amplitude > 0.1]
    assert [(round(line.order, 2), round(line.frequency_hz)) for line in strong] == [(4.35, 0), (0.0, 778)]
    assert [line.amplitude for line in strong] == pytest.approx([1.0, 0.5], rel=0.05)


def test_lines_of_the_teeth_are_left_to_the_simulation_and_low_orders_of_shafts_are_kept() -> None:
    rng, gear = np.random.default_rng(7), TEETH[0] / TEETH[1]
    kept, of_teeth = (1.0, 2.0 * gear, 31.45), (7.0, 18.0, 19.0, 31.0, 11.0 * gear, 60.0 * gear)
    records = []
    for speed in (30.0, 31.3, 32.9):
        signal = 0.05 * rng.standard_normal(SAMPLES)
        signal += sum(np.sin(2 * np.pi * order * speed * TIME_S) for order in (*kept, *of_teeth))
        records.append(order_record(signal, FS_HZ, block(signal, speed).pulses_s, PAIR))
    strong = sorted(line.order for line in own_lines(records, PAIR) if line.amplitude > 0.1)
    assert strong == pytest.approx(sorted(kept), abs=1e-3)


def test_noise_alone_gives_hardly_a_line() -> None:
    records = []
    for seed, speed in enumerate((30.0, 31.3, 32.9)):
        signal = np.random.default_rng(seed).standard_normal(SAMPLES)
        records.append(order_record(signal, FS_HZ, block(signal, speed).pulses_s, PAIR))
    # 50,000 bins x exp(-10) each: 2 in one recording, hardly one in two at the same place
    assert len(own_lines(records, PAIR)) <= 1


def test_the_step_of_a_converter_is_found_and_none_where_there_is_none() -> None:
    signal = np.random.default_rng(4).standard_normal(20_000)
    assert smallest_step(np.round(signal / 0.013) * 0.013) == pytest.approx(0.013, rel=1e-6)
    assert smallest_step(signal) == 0.0


def test_nine_of_ten_intervals_hold_the_mean_from_three_recordings_on() -> None:
    rng = np.random.default_rng(5)
    for count in (3, 6):
        inside = [one.low <= 0.0 <= one.high for one in (jackknife(rng.standard_normal(count)) for _ in range(2000))]
        # standard error of a share of 0.9 over 2000: 0.7 %
        assert np.mean(inside) == pytest.approx(0.9, abs=0.025)
    for count in (1, 2):
        assert not np.isfinite(jackknife(rng.standard_normal(count)).low)


def test_paths_keep_their_level_from_three_recordings_on_and_spread_below() -> None:
    """Half to twice the power, as the noise has it."""
    rng = np.random.default_rng(5)
    assert np.array_equal(path_gains(24, 3, rng), np.ones(24))
    power = path_gains(200, 2, rng) ** 2
    assert 0.5 <= power.min() < 0.55
    assert 1.85 < power.max() <= 2.0


def test_a_housing_weighs_what_is_given_or_what_boxes_round_the_gears_do() -> None:
    gears = {"module_mm": 6.0, "pinion": {"teeth": 18}, "gear": {"teeth": 47}}
    assert housing_mass_kg({"housing": {"kind": "rigid", "mass_kg": 20.0}, "gears": gears}) == 20.0
    assert housing_mass_kg({"housing": {"kind": "plates"}, "gears": gears}) == [64.0, 440.0]
    near = {**gears, "centre_distance_mm": 97.5}
    assert housing_mass_kg({"housing": {}, "gears": near}) == [8.0, 55.0]


def test_a_path_that_no_housing_of_that_mass_has_is_doubtful() -> None:
    grid = np.linspace(0.0, 12_800.0, 1025)
    rigid = np.full((3, 1025), 1.0 / 20.0 + 0j)
    assert path_level_doubt(20.0, grid, rigid) == ""
    assert path_level_doubt([10.0, 40.0], grid, 10.0 * rigid) == ""
    # mm/s² taken for m/s², and the reverse; 10 dB above a rigid body is usual
    assert "50 dB too high" in path_level_doubt(20.0, grid, 1e3 * rigid)
    assert "70 dB too low" in path_level_doubt(20.0, grid, 1e-3 * rigid)


def test_one_recording_stays_whole_and_what_it_cannot_tell_is_drawn_wide(tmp_path: Path) -> None:
    signal = np.sin(2 * np.pi * 18 * 30.0 * TIME_S) + 0.1 * np.random.default_rng(6).standard_normal(SAMPLES)
    signal += 0.3 * np.sin(2 * np.pi * 4.35 * 30.0 * TIME_S)
    np.savez(tmp_path / "run.npz", c=signal, pulse=np.where((TIME_S * 30.0) % 1.0 < 0.1, 5.0, 0.0))
    facts = RecordingFacts(FS_HZ, {}, unit="m/s2", tacho="pulse", tacho_pulses=1)
    found = healthy_blocks([(tmp_path / "run.npz", None)], ("c",), facts, TEETH, None)
    (one,) = found.blocks
    assert one.channels["c"].size == SAMPLES
    assert one.speed_hz == pytest.approx(30.0, rel=1e-3)
    record = order_record(one.channels["c"], FS_HZ, one.pulses_s, PAIR)
    noise = noise_fit([record], found.blocks, "c", TEETH)
    assert not np.isfinite(noise.level_db.low)
    # half to twice the power, and half to twice the amplitude of a line: stated, not fitted
    assert noise.spread_db == pytest.approx(10.0 * np.log10(2.0), abs=0.02)
    assert own_lines([record], PAIR)[0].spread == 2.0
