"""Verdicts of `check` where load or speed differs: `check_conditions.py FOLDER --machines 10 [--over speed]`.

A machine is that of `hidden_machine.py`, recorded twice healthy under each of ten conditions, once with a spall through
the face and once with a broken tooth. References reach over the conditions; the other healthy recordings and the
damaged ones are judged. Angles come from the mesh lines, within a range of -5 to +6 % of the speed; recordings without
an angle are not compared. What is in FOLDER is not made again.

* load: 0 to 100 % behind an induction motor, whose speed falls by 0.5 % from no load to full; unknown, given, and read
  from slip;
* speed: 15 to 40 Hz at one torque.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, HEALTHY, STATES, TEETH, features, machine
from scipy.stats import t as student

import siggen
from diagnostics.machine.comparable import comparable, slip_loads
from diagnostics.machine.machine import Machine
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.records.gear_train import pair_train
from diagnostics.signal.shaft_angle import shaft_angle
from diagnostics.statistics.change_score import FEWEST, change_score
from siggen.errors import UsageError

DURATION_S, RANGE = 4.0, (0.95, 1.06)
FULL_NM, NO_LOAD_HZ, SLIP = 45.0, 35.0, 0.005
LOADS = (0.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 100.0)
SPEEDS_HZ, LOAD_OF_SPEEDS = (15.0, 17.0, 19.0, 21.5, 24.0, 26.5, 29.5, 33.0, 36.5, 40.0), 75.0
LEAST_LOAD = 9.0
"""Below a tenth of the load gears rattle: no references are taken there [%]."""
BROKEN = {"severity": "severe", "damage": {"kind": "chip", "gear": "pinion", "height_mm": 6.0}}
DAMAGED = ("through", "broken")
DRAWS = 8
LOAD, SPEED = "load", "speed"
WAYS = {LOAD: ("unknown", "given", "slip"), SPEED: ("known",)}
COUNTS = {LOAD: (4, 5, 7), SPEED: (5, 7, 10)}


def interval(values: np.ndarray) -> str:
    """Return the mean with its 90 % interval (Student's t over machines)."""
    if values.size < 2:
        return f"{values.mean():.2f}"
    reach = student.ppf(0.95, values.size - 1) * values.std(ddof=1) / np.sqrt(values.size)
    return f"{values.mean():.2f} [{values.mean() - reach:.2f}, {values.mean() + reach:.2f}]"


def points(over: str) -> list[dict[str, float]]:
    """Return the operating points of a study."""
    if over == SPEED:
        return [{"speed_hz": speed, "torque_nm": FULL_NM * LOAD_OF_SPEEDS / 100.0} for speed in SPEEDS_HZ]
    return [
        {"speed_hz": NO_LOAD_HZ * (1.0 - SLIP * load / 100.0), "torque_nm": FULL_NM * load / 100.0} for load in LOADS
    ]


def recorded(number: int, folder: Path, over: str) -> dict[str, np.ndarray]:
    """Return features, states, loads [%] and speeds [Hz] of all records of a machine."""
    kept = folder / f"{over}s_{number}.npz"
    if not kept.exists():
        raw, conditions = machine(number, folder), points(over)
        states = {HEALTHY: {}, "again": {}, "through": STATES["through"], "broken": BROKEN}
        changes = {"operating_points": conditions, "states": states, "specimens": 1, "duration_s": DURATION_S}
        config = siggen.load_config({**raw, **changes})
        gearbox = siggen.draw(config)
        records = list(siggen.runs(gearbox, gearbox.cases))
        angles = [pulses(one) for one in records]
        rows = [features(one.channels, own) if own.size else None for one, own in zip(records, angles, strict=True)]
        unknown = np.full(next(row for row in rows if row is not None).size, np.nan)
        np.savez(
            kept,
            rows=np.array([unknown if row is None else row for row in rows]),
            state=np.array([one.state for one in records]),
            load=np.array([100.0 * one.torque_nm / FULL_NM for one in records]),
            speed=np.array([one.speed_hz for one in records]),
        )
    return dict(np.load(kept))


def pulses(record: siggen.Record) -> np.ndarray:
    """Return the pulse times [s] of the pinion by the mesh lines, (0,) where they give no angle."""
    low, high = (factor * record.speed_hz for factor in RANGE)
    try:
        found = shaft_angle(record.channels, FS_HZ, TEETH, (low, high))
    except UsageError:
        return np.empty(0)
    return found.pulses_s if found.given else np.empty(0)


def references(condition: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return rows of the healthy recordings: one of the two lowest, one of the two highest, others between."""
    levels = np.unique(condition)
    first = int(rng.choice(np.flatnonzero(condition <= levels[1])))
    last = int(rng.choice(np.flatnonzero(condition >= levels[-2])))
    others = np.setdiff1d(np.arange(condition.size), [first, last])
    return np.append(rng.choice(others, count - 2, replace=False), [first, last])


def as_machine(held: dict[str, np.ndarray], rows: np.ndarray, way: str) -> Machine:
    """Return the machine that these references give."""
    speed, load = held["speed"][rows], held["load"][rows]
    if way == "slip":
        load = slip_loads(speed, speed.max(), speed.min())
    elif way != "given":
        load = np.full(rows.size, np.nan)
    names = tuple(str(k) for k in range(held["rows"].shape[1]))
    facts = RecordingFacts(fs_hz=FS_HZ, unit="m/s2")
    called = tuple(str(row) for row in rows)
    return Machine(
        pair_train((18, 47)), CHANNELS, facts, None, FS_HZ, 1.5, 0.05, names, held["rows"][rows], called,
        speed, load, way == "slip",
    )  # fmt: skip


def rates(held: dict[str, np.ndarray], count: int, way: str) -> list[float]:
    """Return the shares [%] of healthy, spalled and broken recordings called changed, and of those not compared."""
    rng = np.random.default_rng(0)
    healthy = np.flatnonzero(np.isin(held["state"], (HEALTHY, "again")))
    verdicts: dict[str, list[float]] = {"healthy": [], **{name: [] for name in DAMAGED}, "other": []}
    condition = held["speed" if way == "known" else "load"]
    angled = np.isfinite(held["rows"]).any(axis=1)
    healthy = healthy[(held["load"][healthy] > LEAST_LOAD) & angled[healthy]]
    for _ in range(DRAWS):
        chosen = healthy[references(condition[healthy], count, rng)]
        known = as_machine(held, chosen, way)
        for row in np.setdiff1d(np.arange(len(held["rows"])), chosen):
            load = float(held["load"][row]) if way in ("given", "slip") else None
            beside = comparable(known, float(held["speed"][row]), load) if angled[row] else None
            if beside is not None and np.count_nonzero(beside.used) < FEWEST:
                beside = None
            state = str(held["state"][row])
            verdicts["other"].append(float(beside is None))
            if beside is not None:
                found = change_score(known.values[beside.used], held["rows"][row], 0.05, beside.conditions)
                verdicts[state if state in DAMAGED else "healthy"].append(float(found.changed))
    return [100.0 * float(np.mean(column)) for column in verdicts.values()]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=10)
    parser.add_argument("--over", choices=(LOAD, SPEED), default=LOAD)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    held = []
    for number in range(1, arguments.machines + 1):  # the one of number 0 served to choose the rule
        own = arguments.folder / f"machine_{number}"
        own.mkdir(exist_ok=True)
        held.append(recorded(number, own, arguments.over))
    print(f"| references | {arguments.over} | false alarms, % | through, % | broken, % | not compared, % |")
    print("|---|---|---|---|---|---|")
    for count in COUNTS[arguments.over]:
        for way in WAYS[arguments.over]:
            found = np.array([rates(one, count, way) for one in held])
            shown = " | ".join(interval(column) for column in found.T)
            print(f"| {count} | {way} | {shown} |", flush=True)


if __name__ == "__main__":
    main()
