"""Healthy recordings plus what simulated damage changes: damaged less healthy, of one gearbox at one course of speed.

Both simulations are one state each of the same gearbox: start angle, speed and every draw but the damage are the same.
Noise and own lines are off, so that nothing but the damage is left. Angle by angle the difference is laid under the
recording's own course; where the recording is longer, it begins again after whole turns. The path of the gearbox stays
in frequency, which is exact where the speed is that of the simulation. Source: derived.

Rows of a set of recordings with injected damage: ids, labels, origin, signals.

A set of healthy recordings and of the same with injected damage, with the origin of every row.

Where a generated set has a gearbox (`specimen_id`) it has a recording: all rows of one are on one side of the split.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

import siggen
from diagnostics.base.seeding import Purpose, generator
from diagnostics.calibration.healthy_blocks import HealthyBlock, HealthyBlocks
from diagnostics.calibration.path_draws import number_limits
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle
from siggen.errors import SolverFailure, UsageError
from siggen.keys.column import Role

TRAIN, VALIDATION, TEST = "train", "validation", "test"
RECORDED, INJECTED = "recorded", "injected"
NO_GEARBOX = -1
OF_DAMAGE = ("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm", "mesh_stiffness_loss")
"""Labels of the simulated damage; 0 for a recording as it is."""

ORIGIN = pa.schema(
    [
        pa.field(name, kind, metadata={"role": Role.KEY if name == "recording" else Role.CONSEQUENCE})
        for name, kind in {
            "recording": pa.string(),
            "origin": pa.string(),
            "simulated_gearbox": pa.int64(),
            "path_number": pa.int64(),
            "identity": pa.string(),
            "difference_db": pa.float64(),
            "difference_torque_nm": pa.float64(),
        }.items()
    ]
)
"""What was added to a recording; it differs between states because they are made so."""
TEXT = """# Recordings with injected damage

Rows with `origin` recorded are your healthy recordings. Rows with `origin` injected are the same recordings plus the
simulated difference between a damaged and a healthy gearbox, at the recording's own course of speed. `recording` names
the file; `simulated_gearbox`, `path_number`, `identity`, `difference_torque_nm` and `difference_db` (energy of the
difference over that of the recording) say what was added; -1 stands for nothing.

`specimen_id` is the number of the recording, so all rows of a recording are on one side of the split: the last fifth,
one at least, is the test. Recordings are cut to the length of the shortest. `torque_nm` is the middle of the
configuration's range in all rows: a recording does not say it. `siggen-diagnostics report` reads this
folder; it needs two recordings for training and one for the test.

**Your recordings are in this folder. `siggen publish` refuses it.** Whether a detector gains by such rows is open:
docs/understand/calibration.md compares them with shuffled phases and with no damage at all.
"""

LONGEST_S = 10.0
SPARE_TURNS = 2


def splits_of(recordings: int) -> tuple[str, ...]:
    """Return the split of each recording: the last fifth is tested, the fifth before validates; two train at least."""
    test = max(1, recordings // 5) if recordings > 1 else 0
    validation = recordings // 5
    return (TRAIN,) * (recordings - test - validation) + (VALIDATION,) * validation + (TEST,) * test


def injected_rows(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, seed: int, advance: Callable[[], None]
) -> Iterator[dict[str, Any]]:
    """Yield the rows of all recordings, each as it is and then with every damage of its own simulated gearboxes.

    Parameters
    ----------
    blocks : HealthyBlocks
    mine : Path
        The calibrated configuration.
    gearboxes : int
        Different ones for each recording.
    seed : int
    advance : callable
        Told of every gearbox.
    """
    record_id = 0
    for number, (block, split) in enumerate(zip(blocks.blocks, splits_of(len(blocks.blocks)), strict=True)):
        own = {"specimen_id": number, "split": split, "operating_point_id": 0, "speed_hz": block.speed_hz}
        yield {"record_id": record_id, **own, **_recorded(block)}
        record_id += 1
        for k in range(gearboxes):
            gearbox = number * gearboxes + k
            start = int(generator(seed, Purpose.PATHS, 0, 1 + gearbox).integers(SPARE_TURNS))
            for difference in simulated_differences(mine, block, gearbox):
                yield {"record_id": record_id, **own, **_injected(block, difference, start, gearbox, k)}
                record_id += 1
            advance()


def _recorded(block: HealthyBlock) -> dict[str, Any]:
    return {
        **_row(block, RECORDED, block.channels),
        "state": "healthy",
        "fault": "healthy",
        "severity": "healthy",
        "faulty_gear": "none",
        "repeat": 0,
        **dict.fromkeys(OF_DAMAGE, 0.0),
        "simulated_gearbox": NO_GEARBOX,
        "path_number": NO_GEARBOX,
        "identity": "",
        "difference_db": -np.inf,
        "difference_torque_nm": np.nan,
    }


def _injected(block: HealthyBlock, difference: DamageEffect, start: int, gearbox: int, repeat: int) -> dict[str, Any]:
    added = sum(float(np.mean(signal**2)) for signal in difference.channels.values())
    own = sum(float(np.var(signal)) for signal in block.channels.values())
    numbers = [value for name, value in difference.labels.items() if name.startswith("path_number_")]
    return {
        **_row(block, INJECTED, injected(block, difference, start)),
        **{name: difference.labels[name] for name in ("state", "fault", "severity", "faulty_gear", *OF_DAMAGE)},
        "repeat": repeat,
        "simulated_gearbox": gearbox,
        "path_number": int(numbers[0]) if numbers else NO_GEARBOX,
        "identity": difference.identity,
        "difference_db": 10.0 * float(np.log10(max(added, 1e-30) / own)),
        "difference_torque_nm": float(difference.labels["torque_nm"]),
    }


def _row(block: HealthyBlock, origin: str, channels: Mapping[str, np.ndarray]) -> dict[str, Any]:
    signals = tuple(channels.values())
    return {"recording": block.name, "origin": origin, "signals": signals, "tacho_s": block.pulses_s}


def write_injected(
    blocks: HealthyBlocks, mine: Path, gearboxes: int, folder: Path, seed: int, advance: Callable[[], None]
) -> Path:
    """Write the set into a new folder; return the folder.

    Parameters
    ----------
    blocks : HealthyBlocks
    mine : Path
        The calibrated configuration.
    gearboxes : int
        Different ones for each recording.
    folder : Path
    seed : int
    advance : callable
        Told of every gearbox.

    Raises
    ------
    UsageError
        If no damage could be simulated.
    """
    config = siggen.load_config(mine)
    rows = list(injected_rows(blocks, mine, gearboxes, seed, advance))
    if all(row["origin"] == RECORDED for row in rows):
        raise UsageError(f"{mine}: no damage could be simulated; see siggen plan {mine}")
    _complete(rows, config)
    facts = {"kind": "injected", "configuration": mine.name, "recordings": [block.name for block in blocks.blocks]}
    return siggen.write_recorded_set(config, folder, rows, ORIGIN, facts, TEXT)


def _complete(rows: Sequence[dict[str, Any]], config: Any) -> None:
    """Add what rows of one set have in common: numbers of the states, teeth, the torque that is assumed."""
    torque = config.canonical()["operating_points"][0]["torque_nm"]
    torque_nm = 0.5 * sum(number_limits(torque))
    states = dict.fromkeys(["healthy", *(row["state"] for row in rows)])
    numbers = {state: number for number, state in enumerate(states)}
    gearbox = siggen.draw(config)
    counts = {gear.name: gear.teeth for gear in gearbox.drivetrain.gears}
    teeth = {column.name: counts[column.of] for column in gearbox.columns if column.quantity == "teeth"}
    for row in rows:
        row["state_id"], row["torque_nm"] = numbers[row["state"]], float(torque_nm)
        row.update(teeth)


@dataclass(frozen=True, slots=True)
class DamageEffect:
    """What one damage does to one gearbox.

    Attributes
    ----------
    channels : mapping of str to (n,) float64
        Damaged less healthy acceleration [m/s²], by the recordings' channels.
    fs_hz : float
    pulses_s : (k,) float64
        Turns of the pinion in the simulation.
    labels : mapping
        Of the damaged record.
    identity : str
        Of the configuration of the damaged record.
    """

    channels: Mapping[str, np.ndarray]
    fs_hz: float
    pulses_s: np.ndarray
    labels: Mapping[str, Any]
    identity: str


def damage_states(mine: Path) -> dict[str, dict[str, Any]]:
    """Return the damaged states of a calibrated configuration by name, as it gives them."""
    states = siggen.load_config(mine).canonical()["states"]
    return {name: state for name, state in states.items() if state.get("damage")}


def simulated_differences(mine: Path, block: HealthyBlock, gearbox: int) -> Iterator[DamageEffect]:
    """Yield the difference of every damaged state of a gearbox, at the speed of a recording."""
    wanted = min((block.pulses_s.size - 1 + SPARE_TURNS) / block.speed_hz, LONGEST_S)
    duration = np.ceil(wanted * block.fs_hz) / block.fs_hz
    changes = _quiet(mine, block, duration, gearbox)
    try:
        healthy = siggen.run(siggen.draw(siggen.load_config({**changes, "states": {"healthy": {}}}), gearbox))
    except SolverFailure:
        return
    for name, state in damage_states(mine).items():
        alone = {**state, "grows": None} if "grows" in state else state
        config = siggen.load_config({**changes, "states": {name: alone}})
        try:
            damaged = siggen.run(siggen.draw(config, gearbox), config.state_names[0])
        except SolverFailure:
            continue
        pairs = zip(block.channels, healthy.channels.values(), damaged.channels.values(), strict=True)
        found = {name: b - a for name, a, b in pairs}
        yield DamageEffect(found, config.fs_hz, damaged.tacho_s, damaged.labels, config.identity)


def _quiet(mine: Path, block: HealthyBlock, duration_s: float, gearbox: int) -> dict[str, Any]:
    """Return a configuration at the recording's speed, without noise, converter and variation of the speed."""
    config = siggen.load_config(mine).canonical()
    off = {"noise_spectrum": None, "lines": None, "bits": None, "range_m_s2": 1e6}
    _refuse_other_kinds(mine, config["sensors"], off)
    return {
        **config,
        "name": "difference",
        "specimens": gearbox + 1,
        "repeats": 1,
        "duration_s": float(duration_s),
        "variation": {},
        "sensors": {name: {**sensor, **off} for name, sensor in config["sensors"].items()},
        "operating_points": [{**config["operating_points"][0], "speed_hz": block.speed_hz}],
    }


def _refuse_other_kinds(mine: Path, sensors: Mapping[str, Mapping[str, Any]], off: Mapping[str, Any]) -> None:
    for name, sensor in sensors.items():
        if lacking := [key for key in off if key not in sensor]:
            raise UsageError(
                f"{mine}: sensor {name}: received kind {sensor.get('kind')}, which has no "
                f"{', '.join(lacking)}; allowed: accelerometers, whose noise is taken off before damage is injected. "
                "Leave this sensor and its recordings out"
            )


def injected(block: HealthyBlock, difference: DamageEffect, start_turn: int) -> dict[str, np.ndarray]:
    """Return the recording's channels with the difference at its own course of angle.

    Parameters
    ----------
    block : Block
    difference : Difference
    start_turn : int
        Turn of the simulation that lies under the first pulse of the recording.
    """
    grid = _times(block, difference, start_turn)
    return {
        name: signal + resample_to_angle(difference.channels[name], difference.fs_hz, grid)
        for name, signal in block.channels.items()
    }


def _times(block: HealthyBlock, difference: DamageEffect, start_turn: int) -> AngleGrid:
    """Return where in the simulation every sample of the recording lies, by the angle of the pinion."""
    time_s = np.arange(next(iter(block.channels.values())).size) / block.fs_hz
    turn = _continued(time_s, block.pulses_s)
    whole = difference.pulses_s.size - 1
    inside = np.mod(turn + start_turn, whole)
    return AngleGrid(np.interp(inside, np.arange(whole + 1), difference.pulses_s), 1, 1, np.inf)


def _continued(time_s: np.ndarray, pulses_s: np.ndarray) -> np.ndarray:
    """Return turns since the first pulse at times (n,); before the first and after the last at the speed there."""
    turns = np.arange(pulses_s.size, dtype=np.float64)
    found = np.interp(time_s, pulses_s, turns)
    first, last = pulses_s[1] - pulses_s[0], pulses_s[-1] - pulses_s[-2]
    found = np.where(time_s < pulses_s[0], (time_s - pulses_s[0]) / first, found)
    return np.asarray(np.where(time_s > pulses_s[-1], turns[-1] + (time_s - pulses_s[-1]) / last, found))
