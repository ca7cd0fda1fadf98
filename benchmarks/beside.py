"""`python -m benchmarks beside CHECKOUT`: what the loop of a preset costs here and in another checkout, in turn.

Each checkout reads its own file of the preset. The first and the last record of some gearboxes are made whole, in turn
here and there, and the CPU time of the loop is counted: cost = steps tried x cost of a step.
Steps that a record needs to choose its steps are in the sum and are told apart.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from benchmarks.shipped import ROOT

PROBE = Path(__file__).with_name("loop_probe.py")
GEARBOXES, ROUNDS = 4, 3
Cost = Mapping[str, float]


class Checkout:
    """A process that makes records with the sources of a checkout."""

    def __init__(self, folder: Path, preset: str) -> None:
        file = folder / "configs" / f"{preset}.yaml"
        if not file.is_file():
            raise SystemExit(f"beside: {file} is missing; give the root of a checkout that has it")
        path = os.pathsep.join([str(folder), *filter(None, [os.environ.get("PYTHONPATH")])])
        command = [sys.executable, "-P", str(PROBE), str(file)]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=folder,
            env={**os.environ, "PYTHONPATH": path},
        )  # fmt: skip

    def costs(self, gearbox: int) -> list[Cost]:
        """Return what the loop of the first and of the last record of a gearbox costs."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        print(gearbox, file=self._process.stdin, flush=True)
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit("beside: a checkout made no record; its error stands above")
        found: list[Cost] = json.loads(line)
        return found

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def main(arguments: Sequence[str]) -> int:
    """Measure and print; 1 if the median of the ratios is above the one that is allowed."""
    asked = _arguments(arguments)
    sides = {"here": Checkout(ROOT, asked.preset), "there": Checkout(asked.checkout.resolve(), asked.preset)}
    for side in sides.values():
        side.costs(0)  # compiles
    every: dict[tuple[str, int, int], list[Cost]] = {}
    for _ in range(asked.rounds):
        for gearbox in range(asked.gearboxes):
            for name, side in sides.items():
                for record, cost in enumerate(side.costs(gearbox)):
                    every.setdefault((name, gearbox, record), []).append(cost)
    for side in sides.values():
        side.close()
    ratios = []
    for gearbox in range(asked.gearboxes):
        for record in range(len({key[2] for key in every})):
            here, there = (_median(every[name, gearbox, record]) for name in sides)
            ratios.append(here["cpu_s"] / there["cpu_s"] * there["duration_s"] / here["duration_s"])
            print(f"gearbox {gearbox}, {('first', 'last')[record]} record: {ratios[-1]:.2f} times")
            print(f"  here   {_text(here)}\n  there  {_text(there)}")
    middle = median(ratios)
    print(f"here over there, median of {len(ratios)}: {middle:.2f} ({min(ratios):.2f} to {max(ratios):.2f})")
    return int(asked.most is not None and middle > asked.most)


def _median(costs: Sequence[Cost]) -> dict[str, float]:
    return {name: median(cost[name] for cost in costs) for name in costs[0]}


def _text(cost: Cost) -> str:
    """Return cost = steps x cost of a step, and what of it chooses the steps."""
    a_second = cost["duration_s"]
    whole, chosen = cost["cpu_s"] / a_second, (cost["cpu_s"] - cost["record_cpu_s"]) / a_second
    return (
        f"{1e3 * whole:6.1f} ms per s = {cost['tried'] / a_second / 1e3:6.1f} thousand steps tried x "
        f"{1e6 * cost['cpu_s'] / cost['tried']:.3f} us; {1e3 * chosen:.1f} ms choose the steps; "
        f"{1.0 / (cost['step_s'] * cost['fs_hz']):.3g} steps a sample, {cost['coordinates']:.0f} coordinates"
    )


def _arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks beside", description=__doc__)
    parser.add_argument("checkout", type=Path, help="root of the other checkout")
    parser.add_argument("--preset", default="quickstart", help="name of a file in configs/ (default: quickstart)")
    parser.add_argument("--gearboxes", type=int, default=GEARBOXES)
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="the median of so many counts")
    parser.add_argument("--most", type=float, help="fail if the median of the ratios is above")
    return parser.parse_args(arguments)
