"""What indicators of a record of 10 s cost: from the raw record as a sum, from given averages, and a set's.

And what its angle costs without a tacho.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from benchmarks.row import Row, cost_row, duration_text
from benchmarks.timing import Candidate, medians
from diagnostics.base.kept_memory import keep_memory
from diagnostics.indicators.channel_signals import ChannelSignals
from diagnostics.indicators.line_levels import record_levels
from diagnostics.indicators.record import channel_conditions, record_result
from diagnostics.indicators.registry import ALL
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.workers import CHUNK_RECORDS, mapped
from diagnostics.records.gear_train import PAIR, pair_train
from diagnostics.records.recording import Recording
from diagnostics.records.usable_records import clipped_channels, record_problems, refused_parts
from diagnostics.signal.noise_sketch import noise_sketch
from diagnostics.signal.order_domain import AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.shaft_angle import shaft_angle
from diagnostics.signal.shaft_signals import SignalShaft, record_shafts
from diagnostics.signal.spectrum import order_lines
from diagnostics.signal.synchronous_average import synchronous_average

FS_HZ = 51_200.0
DURATION_S = 10.0
SPEED_HZ = 30.0
TEETH = (18, 47)
GOAL_RAW_S = 80e-3
GOAL_AVERAGE_S = 20e-3
GOAL_SET_S = 50.0
GOAL_ANGLE_S, ANGLE_CHANNELS, ANGLE_LIMITS_HZ = 1.0, 4, (26.0, 34.0)
SET_RECORDS = 1000
WORKERS = 2


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of one record and channel and of its parts, and the wall time of a set by two workers."""
    keep_memory()  # as commands and workers do
    record = modulated_record()
    cost = medians(_candidates(record), rounds=5 if quick else 25)
    whole, average = cost.pop("raw"), cost.pop("average")
    cost["columns and the rest"] = whole - sum(cost.values())
    parts = ", ".join(f"{name} {1e3 * part:.1f}" for name, part in cost.items())
    goal_ms = f"<= {GOAL_RAW_S * 1e3:.0f} ms"
    yield Row(
        "raw record of 10 s, one channel, CPU",
        duration_text(whole),
        f"of it in ms: {parts}",
        goal=goal_ms,
        met=whole <= GOAL_RAW_S,
    )
    yield cost_row("from given averages of both shafts, CPU", average, "raw record", whole, GOAL_AVERAGE_S)
    yield _angle_row(record, rounds=2 if quick else 10)
    yield _set_row(record, 100 if quick else SET_RECORDS)


def modulated_record() -> Recording:
    """Return five mesh harmonics, modulated by both shafts, with noise and a little speed variation, and pulses."""
    time_s = np.arange(round(FS_HZ * DURATION_S)) / FS_HZ
    turns = SPEED_HZ * time_s + 0.02 * np.sin(2 * np.pi * 0.3 * time_s)
    depth = 1.0 + 0.1 * np.cos(2 * np.pi * turns) + 0.05 * np.cos(2 * np.pi * turns * TEETH[0] / TEETH[1])
    mesh = sum(np.cos(2 * np.pi * h * TEETH[0] * turns + h) / h for h in range(1, 6))
    # a fixed generator: every run measures the same record
    signal = depth * mesh + 0.3 * np.random.default_rng(0).standard_normal(time_s.size)
    pulses = np.interp(np.arange(1, int(turns[-1])), turns, time_s)
    labels = {"record_id": 0, "speed_hz": SPEED_HZ, "torque_nm": 50.0}
    return Recording(labels, {"casing": signal.astype(np.float32)}, pulses, FS_HZ, pair_train(TEETH))


def _angle_row(record: Recording, rounds: int) -> Row:
    signal, rng = record.channels["casing"], np.random.default_rng(1)
    channels = {str(k): signal + rng.standard_normal(signal.size) for k in range(ANGLE_CHANNELS)}
    found = shaft_angle(channels, FS_HZ, TEETH, ANGLE_LIMITS_HZ)
    candidate = Candidate(lambda _: shaft_angle(channels, FS_HZ, TEETH, ANGLE_LIMITS_HZ))
    cost = medians({"angle": candidate}, rounds)["angle"]
    return Row(
        f"angle without a tacho, 10 s of {ANGLE_CHANNELS} channels, CPU",
        duration_text(cost),
        f"outcome: {found.outcome}",
        goal=f"<= {GOAL_ANGLE_S:g} s",
        met=cost <= GOAL_ANGLE_S and found.given,
    )


def _candidates(record: Recording) -> dict[str, Candidate]:
    settings = IndicatorSettings()
    signal = record.channels["casing"].astype(np.float64)
    tooth = settings.samples_per_tooth
    grid = angle_grid(record.tacho_s, TEETH[0] * tooth)
    steps = resample_to_angle(signal, FS_HZ, grid)
    shafts = record_shafts(grid, TEETH, tooth, settings.sidebands, PAIR[0].gears)
    # an average is a record of one revolution: what it costs to average is then nothing
    averages = [synchronous_average(steps, shaft.teeth, tooth).signal for shaft in shafts]
    single = [replace(shaft, revolutions=1) for shaft in shafts]
    turns = steps.reshape(grid.revolutions, -1)
    lines = order_lines(turns, float(record.tacho_s[-1] - record.tacho_s[0]))
    of_record = tuple(entry for entry in ALL if not entry.fields and not entry.quantities)
    functions: dict[str, Callable[[], object]] = {
        "raw": lambda: record_result(record, settings),
        "average": lambda: [_shaft_values(a, s, settings) for a, s in zip(averages, single, strict=True)],
        "checks and stored samples": lambda: _checks(record, settings),
        "times of the angle steps": lambda: angle_grid(record.tacho_s, TEETH[0] * tooth),
        "resampling to angle": lambda: resample_to_angle(signal, FS_HZ, grid),
        "level and spectral kurtosis": lambda: ChannelSignals(signal, FS_HZ, grid, shafts, settings).values(of_record),
        "averages of both shafts": lambda: [_shaft_values(steps, s, settings) for s in shafts],
        "log spectrum": lambda: _over_angle(steps, grid, shafts, settings).log_spectrum,
        "levels of lines and noise": lambda: record_levels(turns, lines, TEETH, FS_HZ),
        "noise sketch": lambda: noise_sketch(signal, FS_HZ, steps, TEETH, grid),
    }
    return {name: Candidate(lambda _, call=call: call()) for name, call in functions.items()}  # type: ignore[misc]


def _checks(record: Recording, settings: IndicatorSettings) -> None:
    record_problems(record, settings.frame_samples, needs_tacho=True)
    refused_parts(record)
    clipped_channels(record)
    for signal in record.channels.values():
        channel_conditions(signal)


def _over_angle(
    steps: np.ndarray, grid: AngleGrid | None, shafts: tuple[SignalShaft, SignalShaft], settings: IndicatorSettings
) -> ChannelSignals:
    """Return a channel of which the record over angle is known."""
    signals = ChannelSignals(np.ones(1), FS_HZ, grid, shafts, settings)
    signals.steps = steps
    return signals


def _shaft_values(steps: np.ndarray, shaft: SignalShaft, settings: IndicatorSettings) -> tuple[dict[str, float], ...]:
    """Return values and moments of one shaft from a record over angle."""
    other = SignalShaft("gear" if shaft.name == "pinion" else "pinion", shaft.teeth, 0, shaft.resolved, "")
    signals = _over_angle(steps, None, (shaft, other), settings)
    own = tuple(entry for entry in ALL if "shaft" in entry.fields)
    return signals.values(own), signals.moments()


def _set_row(record: Recording, count: int) -> Row:
    """Return the wall time of so many records by two workers, their start and the way of the records there included."""
    # copies: the same object eight times would cross to the worker once
    done = count // CHUNK_RECORDS * CHUNK_RECORDS
    records = (replace(record, channels={n: s.copy() for n, s in record.channels.items()}) for _ in range(done))
    begin = time.perf_counter()
    for _ in mapped(records, record_result, WORKERS):
        pass
    wall = time.perf_counter() - begin
    what = f"{done} such records, {WORKERS} workers, wall"
    if done < SET_RECORDS:  # mostly the start of the workers: says nothing about the goal
        return Row(what, duration_text(wall))
    return Row(what, duration_text(wall), goal=f"<= {GOAL_SET_S:g} s", met=wall <= GOAL_SET_S)
