"""Tables of docs/start/from_a_file.md: `python docs/scripts/speed_machines.py [FIRST LAST] [--made-up]`.

How often `shaft_angle` gives the angle of a recording without a tacho, and whether it is right. 30 machines of
`siggen init`: 17 to 35 teeth, ratio 1 to 5, module 1 to 6 mm, 12 to 50 Hz, 30 to 100 % of the rated torque, two of
three with a second stage; each healthy and with its severe spall, two channels, 8 s. The speed drifts by 0.02 to 0.5 %;
in half of the recordings it steps by 0.4 % within 0.2 s besides. White noise of 0, 1 and 3 times the rms is added. The
range is -5 to +6 % of the speed; with the teeth of either gear wrong by one, and with a range that misses the speed, an
answer is an error. An angle is wrong that differs from the tacho by more than 0.1 tooth pitch anywhere.

`--made-up`: 72 recordings of one channel, 7 s, with two mesh lines of 27/71 teeth and side lines of the gear 0.1 to 1.5
times them. Some 30 minutes of CPU time; FIRST and LAST take a slice of the machines.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from chosen_states import chosen_states

import siggen
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle
from diagnostics.signal.shaft_angle import AGREEMENT, shaft_angle
from siggen.checks.notes import covering_classes
from siggen.config import inherited, parse_yaml
from siggen.errors import UsageError
from siggen.keys.merging import in_keys, merged
from siggen.rig.rig_answers import rig_of
from siggen.rig.rig_text import rig_text

MODULES_MM = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)
RATIOS = (1.0, 1.35, 1.6, 2.0, 2.5, 3.0, 3.55, 4.2, 5.0)
STATES = ("healthy", "severe")
NOISES = (0.0, 1.0, 3.0)
RANGE, MISSED = (0.95, 1.06), (1.06, 1.25)
DURATION_S, DRIFTS = 8.0, (2e-4, 5e-3)
STEP, STEP_S = 4e-3, 0.2
EDGE_PULSES = 2
"""At either end, where the angle rests on one side."""


@dataclass(frozen=True, slots=True)
class Known:
    """A recording whose angle is known: channels (n,), rate [Hz], teeth, times (k,) [s] and turns (k,)."""

    channels: Mapping[str, np.ndarray]
    fs_hz: float
    teeth: tuple[int, int]
    time_s: np.ndarray
    turns: np.ndarray

    @property
    def speed_hz(self) -> float:
        """Mean speed."""
        return float((self.turns[-1] - self.turns[0]) / (self.time_s[-1] - self.time_s[0]))


def machine(index: int) -> tuple[dict[str, Any], tuple[int, int]]:
    """Return the configuration of a machine, and its teeth."""
    rng = np.random.default_rng([77, index])
    pinion = int(rng.integers(17, 36))
    teeth = pinion, round(pinion * RATIOS[index % len(RATIOS)])
    speed_hz = round(float(np.exp(rng.uniform(np.log(12.0), np.log(50.0)))), 3)
    module = str(MODULES_MM[index % len(MODULES_MM)])
    rig, _ = rig_of({"teeth": f"{teeth[0]},{teeth[1]}", "module": module, "speed": str(speed_hz)})
    rig = replace(rig, accuracy_classes=covering_classes(rig))
    raw = inherited(parse_yaml(rig_text(rig, "rig"), "rig"))
    torque_nm, seed = rig.torque_nm[1] * float(rng.uniform(0.3, 1.0)), int(rng.integers(1 << 30))
    drift = float(np.exp(rng.uniform(*np.log(DRIFTS))) * rng.choice([-1.0, 1.0]))
    speed = {"start_ratio": 1.0 - 0.5 * drift, "end_ratio": 1.0 + 0.5 * drift}
    order = int(rng.integers(17, 29)) * teeth[0] / teeth[1]
    stage = {"order": order, "force_share": float(np.exp(rng.uniform(np.log(0.005), np.log(0.1))))}
    changes = {
        "specimens": 1, "repeats": 1, "duration_s": DURATION_S, "seed": seed,
        "operating_points": [{"speed_hz": speed_hz, "torque_nm": torque_nm}],
        "states": chosen_states(raw["states"], STATES),
        "variation": merged(in_keys(raw["variation"]), {"speed": speed}),
        "background": {**raw["background"], "second_stage": stage if index % 3 else None},
    }  # fmt: skip
    return {**raw, **changes}, teeth


def recordings(index: int) -> Iterator[Known]:
    """Yield the recordings of a machine; one of the two has a load step."""
    raw, teeth = machine(index)
    gearbox = siggen.draw(siggen.load_config(raw))
    for number, record in enumerate(siggen.runs(gearbox, gearbox.cases)):
        one = Known(record.channels, record.fs_hz, teeth, record.tacho_s, np.arange(float(record.tacho_s.size)))
        yield stepped(one, index) if (index + number) % 2 else one


def stepped(one: Known, index: int) -> Known:
    """Return a recording played faster from a moment on, by 0.4 %: its lines move as by a load step."""
    rng = np.random.default_rng([80, index])
    samples = next(iter(one.channels.values())).size
    time_s, at_s = np.arange(samples) / one.fs_hz, DURATION_S * rng.uniform(0.2, 0.8)
    rate = 1.0 + 0.5 * STEP * np.tanh((time_s - at_s) / (0.5 * STEP_S))
    place_s = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]))]) / one.fs_hz
    inside = place_s <= time_s[-1]
    grid = AngleGrid(place_s[inside], 1, samples, one.fs_hz / samples)
    channels = {name: resample_to_angle(signal, one.fs_hz, grid) for name, signal in one.channels.items()}
    kept = one.time_s <= place_s[inside][-1]
    return replace(one, channels=channels, time_s=np.interp(one.time_s[kept], place_s, time_s), turns=one.turns[kept])


def made_up() -> Iterator[Known]:
    """Yield 72 recordings of one channel: two mesh lines, four sidebands of the gear, drift or a load step, noise."""
    fs_hz, seconds, teeth = 12_800.0, 7.0, (27, 71)
    time_s = np.arange(round(fs_hz * seconds)) / fs_hz
    courses = ((0.0, 0.0, (1, 2)), (1e-3, STEP, (2, 3)), (3e-3, 0.0, (1, 3)), (-5e-3, STEP, (2, 5)))
    for case in itertools.product((0.1, 0.3, 0.5, 0.8, 1.0, 1.5), (0.5, 1.0, 2.0), range(4)):
        beside, noise, kind = case
        rng = np.random.default_rng([5, kind, round(10 * beside), round(10 * noise)])
        drift, step, harmonics = courses[kind]
        speed = 1.0 + drift * (time_s / seconds - 0.5) + 0.5 * step * np.tanh((time_s - 3.0) / (0.5 * STEP_S))
        turns = 24.0 * np.cumsum(speed) / fs_hz
        signal = noise * rng.standard_normal(time_s.size)
        for h in harmonics:
            orders = h * teeth[0] + teeth[0] / teeth[1] * np.arange(-2, 3)
            for k, order in enumerate(orders):
                level = 1.0 if k == 2 else beside * rng.uniform(0.3, 1.0)
                signal += level * np.cos(2.0 * np.pi * (order * turns + rng.uniform()))
        yield Known({"a": signal}, fs_hz, teeth, time_s[::256], turns[::256])


def outcome(one: Known, teeth: tuple[int, int], limits: tuple[float, float]) -> str:
    """Return `right`, `wrong`, `speed only` or `refused`."""
    speed_hz = one.speed_hz * one.teeth[0] / teeth[0]  # of wrong teeth the lines of the mesh stay within the range
    try:
        found = shaft_angle(one.channels, one.fs_hz, teeth, (limits[0] * speed_hz, limits[1] * speed_hz))
    except UsageError:
        return "refused"
    if not found.given:
        return "speed only"
    error = (np.interp(one.time_s, found.time_s, found.turns) - one.turns)[EDGE_PULSES:-EDGE_PULSES] * one.teeth[0]
    return "right" if float(np.ptp(error)) < 2.0 * AGREEMENT and _far(error) < AGREEMENT else "wrong"


def _far(error: np.ndarray) -> float:
    return float(np.abs(error - np.median(error)).max())


def noisy(one: Known, noise: float, index: int) -> Known:
    """Return a recording with white noise, in times its rms."""
    rng = np.random.default_rng([78, index])
    return replace(
        one, channels={n: s + noise * s.std() * rng.standard_normal(s.size) for n, s in one.channels.items()}
    )


def counted(first: int, last: int) -> dict[str, Counter[str]]:
    """Return the outcomes of machines by row of the table."""
    rows: dict[str, Counter[str]] = {}
    for index in range(first, last):
        print(f"machine {index} of {first} to {last - 1}", file=sys.stderr, flush=True)
        for one in recordings(index):
            for noise in NOISES:
                with_noise = noisy(one, noise, index)
                rows.setdefault(f"noise {noise:g}", Counter())[outcome(with_noise, one.teeth, RANGE)] += 1
                rows.setdefault(f"range missed, noise {noise:g}", Counter())[
                    outcome(with_noise, one.teeth, MISSED)
                ] += 1
            pinion, gear = one.teeth
            for name, teeth in (("pinion", (pinion + 1, gear)), ("gear", (pinion, gear + 1))):
                rows.setdefault(f"a tooth more on the {name}", Counter())[outcome(one, teeth, RANGE)] += 1
    return rows


def main() -> None:
    """Print a row per kind of recording."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", nargs="?", type=int, default=0)
    parser.add_argument("last", nargs="?", type=int, default=30)
    parser.add_argument("--made-up", action="store_true")
    asked = parser.parse_args()
    if asked.made_up:
        rows = {"one channel, two mesh lines": Counter(outcome(one, one.teeth, (0.92, 1.1)) for one in made_up())}
    else:
        rows = counted(asked.first, asked.last)
    print("| recordings | right | speed only | refused | wrong |\n|---|---:|---:|---:|---:|")
    for name, found in rows.items():
        print(f"| {name} | {found['right']} | {found['speed only']} | {found['refused']} | {found['wrong']} |")


if __name__ == "__main__":
    main()
