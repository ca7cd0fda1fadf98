"""A second stage is found by the comb of its teeth, and not where errors of the teeth alone make lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnostics.calibration.drivetrain import TrainOrders, drivetrain
from diagnostics.calibration.order_record import OrderRecord, line_groups, order_record
from diagnostics.calibration.second_stage import second_stage, stage_lines, wave_lines
from diagnostics.calibration.shaft_multiples import machine_multiples
from diagnostics.records.gear_train import pair_train

FS_HZ, SAMPLES = 12_800.0, 25_600
HIGHEST_ORDER = 170.0
TIME_S = np.arange(SAMPLES) / FS_HZ
SPEEDS_HZ = (30.0, 31.3, 32.9)
Comb = tuple[str, int, float]


def pair(teeth: tuple[int, int]) -> TrainOrders:
    return drivetrain(pair_train(teeth))


def records(
    seed: int, teeth: tuple[int, int], comb: Comb | None, resonant_order: float = 0.0
) -> dict[str, list[OrderRecord]]:
    """Return two channels of three recordings: mesh lines, errors at all orders of both shafts, noise, a comb or none.

    A comb has its shaft, teeth and the amplitude of its first line; its h-th has that over h. A resonance of 2 % of
    damping lifts what passes it, but not the noise.
    """
    rng = np.random.default_rng(seed)
    found = {}
    for channel in ("one", "two"):
        shafts = []
        for shaft, step, own in (("pinion", 1.0, teeth[0]), ("gear", teeth[0] / teeth[1], teeth[1])):
            number = np.arange(1, int(HIGHEST_ORDER / step) + 1)
            beside = np.abs(number - np.round(number / own) * own)
            size = np.where(beside == 0, 1.0, 0.1 / (1.0 + beside)) * np.hypot(*rng.standard_normal((2, number.size)))
            phasors = size * np.exp(2j * np.pi * rng.random(number.size))
            if comb is not None and comb[0] == shaft:
                lines = slice(comb[1] - 1, None, comb[1])
                phasors[lines] += (
                    comb[2] * comb[1] / number[lines] * np.exp(2j * np.pi * rng.random(number[lines].size))
                )
            ratio = number * step / resonant_order if resonant_order else np.zeros(number.size)
            shafts.append((step, phasors / (1.0 - ratio**2 + 0.04j * ratio)))
        found[channel] = [_record(speed, shafts, teeth, rng) for speed in SPEEDS_HZ]
    return found


def _record(
    speed_hz: float, shafts: list[tuple[float, np.ndarray]], teeth: tuple[int, int], rng: np.random.Generator
) -> OrderRecord:
    signal = 0.01 * rng.standard_normal(SAMPLES)
    for step, phasors in shafts:
        turn, total = np.exp(2j * np.pi * step * speed_hz * TIME_S), np.zeros(SAMPLES, dtype=complex)
        for phasor in phasors[::-1]:
            total = (total + phasor) * turn
        signal += total.real
    return order_record(signal, FS_HZ, np.arange(0.0, SAMPLES / FS_HZ, 1.0 / speed_hz), pair(teeth))


@pytest.mark.parametrize(
    ("teeth", "comb"),
    [((18, 47), ("gear", 21, 0.5)), ((18, 47), ("pinion", 25, 0.5)), ((20, 40), ("gear", 23, 0.5))],
    ids=["on the gear's shaft", "on the pinion's shaft", "errors of the pinion at every second order of the gear"],
)
def test_shaft_teeth_and_levels_of_a_stage_are_found_again(teeth: tuple[int, int], comb: Comb) -> None:
    multiples = machine_multiples(records(1, teeth, comb), pair(teeth))
    found = second_stage(multiples, pair(teeth))
    assert found is not None
    assert (found.shaft, found.teeth) == comb[:2]
    for channel in ("one", "two"):
        lines = {one.name: one for one in stage_lines(found, multiples[found.shaft][channel])}
        for h in (1, 2):
            # errors of the teeth at that order, of unknown phase, change a line by a tenth or two
            assert lines[f"line {h}"].line.amplitude == pytest.approx(comb[2] / h, rel=0.25)
            level = lines[f"line {h}"].level_db
            assert level.low < level.value < level.high


@pytest.mark.parametrize("teeth", [(18, 47), pytest.param((20, 40), marks=pytest.mark.slow)])
def test_errors_of_the_teeth_pass_for_no_stage(teeth: tuple[int, int]) -> None:
    for seed in range(10, 16):
        assert (
            second_stage(
                machine_multiples(records(seed, teeth, None), pair(teeth)),
                pair(teeth),
            )
            is None
        )


def test_a_stage_whose_three_lines_one_channel_shows_is_found() -> None:
    teeth, step = (18, 47), 18 / 47
    # 29, 23 and 20 dB over the errors of the teeth; its other lines and the other channel show nothing
    comb = np.zeros(3 * 25)
    comb[24::25] = 1.0, 0.5, 0.35
    channels, rng = records(7, teeth, None), np.random.default_rng(8)
    lines = [_record(speed, [(step, comb)], teeth, rng) for speed in SPEEDS_HZ]
    channels["one"] = [replace(one, power=one.power + w.power) for one, w in zip(channels["one"], lines, strict=True)]
    found = second_stage(machine_multiples(channels, pair(teeth)), pair(teeth))
    assert found is not None
    assert (found.shaft, found.teeth) == ("gear", 25)


@pytest.mark.parametrize(
    "resonant_order", [12.1, *(pytest.param(order, marks=pytest.mark.slow) for order in (13.0, 31.4))]
)
def test_a_resonance_of_the_housing_is_no_stage(resonant_order: float) -> None:
    for seed in range(20, 24):
        channels = records(seed, (18, 47), None, resonant_order)
        assert second_stage(machine_multiples(channels, pair((18, 47))), pair((18, 47))) is None


def test_a_stage_among_the_errors_is_not_named() -> None:
    # a line of 0.02 is one of the errors' own
    multiples = machine_multiples(records(1, (18, 47), ("gear", 21, 0.02)), pair((18, 47)))
    assert second_stage(multiples, pair((18, 47))) is None


def test_a_drive_near_a_multiple_of_a_shaft_is_no_stage_of_that_shaft() -> None:
    rng = np.random.default_rng(3)
    # half a bin beside the multiple, its harmonics further
    drive = [(25.02, 0.5 / np.arange(1.0, 6.0))]
    channels = {name: [_record(speed, drive, (18, 47), rng) for speed in SPEEDS_HZ] for name in ("one", "two")}
    assert second_stage(machine_multiples(channels, pair((18, 47))), pair((18, 47))) is None


def test_a_wave_on_the_flanks_is_a_line_of_its_own_with_what_it_adds_to_the_errors() -> None:
    teeth, step = (18, 47), 18 / 47
    # one wave of 29 periods round the gear: no comb, so no stage
    channels = records(4, teeth, None)
    number = np.zeros(29)
    number[-1] = 0.8
    rng = np.random.default_rng(5)
    for name, plain in channels.items():
        waves = [_record(speed, [(step, number)], teeth, rng) for speed in SPEEDS_HZ]
        channels[name] = [replace(one, power=one.power + wave.power) for one, wave in zip(plain, waves, strict=True)]
    multiples = machine_multiples(channels, pair(teeth))
    assert second_stage(multiples, pair(teeth)) is None
    (found,) = [line for line in wave_lines(multiples, pair(teeth), "one", ()) if line.amplitude > 0.4]
    assert found.order == pytest.approx(29 * step)
    assert found.amplitude == pytest.approx(0.8, rel=0.05)
    assert all(line.order != found.order for line in wave_lines(multiples, pair(teeth), "one", (found.order,)))


def test_sidebands_at_lines_of_a_stage_are_no_measure_of_the_path() -> None:
    step = 18 / 47
    foreign = 18.0 + 2 * step
    groups = {group.name: group for group in line_groups(pair((18, 47)), 100.0, (foreign,))}
    assert foreign not in groups["gear sidebands of mesh 1"].orders
    assert len(groups["gear sidebands of mesh 1"].orders) == 7
    assert len(groups["gear sidebands of mesh 2"].orders) == 8
