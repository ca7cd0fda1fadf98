"""Where to filter: multiply-adds per sample of filtering outputs, states, or the coordinates that outputs move with."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from statistics import median

import numpy as np

from benchmarks.row import Row
from benchmarks.shipped import ROOT, shipped
from siggen.arrays import FloatArray
from siggen.dynamics.time.decimation import Decimator, second_difference_taps, value_taps
from siggen.planning.plan import planned_record
from siggen.planning.specimen import draw_operating_point, draw_specimen
from siggen.record.specimen_state import specimen_state
from siggen.sensing.inputs import FORCE
from siggen.sensors.sensor import needs
from siggen.specimen.instrument import specimen_instrument
from siggen.specimen.integration import rule_grid

PRESETS = ("quickstart", "bench", "industrial", "paper_b", "linear_pits")
BLOCK = 2048
"""Samples that are filtered at once, as in a record."""


@dataclass(frozen=True, slots=True)
class Outputs:
    """Rows of accelerations (motions, n) and of bearing forces (forces, 2n) of a preset, and steps per sample."""

    accelerations: FloatArray
    forces: FloatArray
    steps: int

    @property
    def coordinates(self) -> int:
        """Coordinates of the model; it has twice as many states, and as many modes."""
        return int(self.accelerations.shape[1])

    @property
    def taps(self) -> int:
        """Of either filter."""
        return int(value_taps(self.steps).size)

    @property
    def per_output(self) -> int:
        """Multiply-adds per sample where outputs are filtered: projection at every step, then a filter for each."""
        rows = len(self.accelerations) + len(self.forces)
        return self._entries * self.steps + rows * self.taps

    @property
    def per_mode(self) -> int:
        """The same where modes are filtered and projected per sample, the change to modal coordinates left out.

        Accelerations come from the second difference of n displacements, forces from 2n displacements and speeds.
        """
        filtered = self.coordinates * (1 + 2 * bool(len(self.forces)))
        rows = len(self.accelerations) + 2 * len(self.forces)
        return filtered * self.taps + rows * self.coordinates

    @property
    def per_used(self) -> int:
        """The same where coordinates are filtered for accelerations, where those are fewer; forces as outputs."""
        used = np.count_nonzero(self.accelerations.any(axis=0))
        if used >= len(self.accelerations):
            return self.per_output
        forces = np.count_nonzero(self.forces) * self.steps + len(self.forces) * self.taps
        return int(used * self.taps + np.count_nonzero(self.accelerations) + forces)

    @property
    def _entries(self) -> int:
        return int(np.count_nonzero(self.accelerations) + np.count_nonzero(self.forces))


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield counts for every preset, and CPU times where filtering coordinates needs fewer multiply-adds."""
    for name in PRESETS:
        found = _outputs(name)
        yield Row(
            f"{name}: {len(found.accelerations)} accelerations, {len(found.forces)} forces, {found.coordinates} modes, "
            f"{found.taps} taps: multiply-adds per sample, outputs filtered",
            f"{found.per_output}",
            f"modes: {found.per_mode}; coordinates that outputs use: {found.per_used}",
            found.per_mode / found.per_output,
        )
        if found.per_used < found.per_output:
            yield _measured(name, found, 50 if quick else 300)


def _outputs(name: str) -> Outputs:
    config = shipped(ROOT / "configs" / f"{name}.yaml")
    specimen, planned = draw_specimen(config, 0), planned_record(config, 0)
    state = specimen_state(config, specimen, planned.state_id)
    built = state.mesh.structure
    seen = {motion for channel in specimen_instrument(config, specimen).channels for motion in channel.motions}
    point = draw_operating_point(config, 0, planned.operating_point_id)
    steps, _ = rule_grid(config, specimen.dynamics, state.mesh, point)
    forces = [np.concatenate(pair) for pair in built.bearing_forces.values()] if needs(config.sensors, FORCE) else []
    return Outputs(
        np.array([row for motion, row in built.motions.items() if motion in seen]).reshape(-1, len(built.coordinates)),
        np.array(forces).reshape(len(forces), 2 * len(built.coordinates)),
        steps,
    )


def _measured(name: str, found: Outputs, rounds: int) -> Row:
    """Return CPU times of accelerations alone, both ways in turn on the same states, and how far they differ."""
    states = np.random.default_rng(0).standard_normal((BLOCK * found.steps, 2 * found.coordinates))
    taps, rows = second_difference_taps(found.steps), found.accelerations
    columns = np.flatnonzero(rows.any(axis=0))
    still = np.zeros((max(len(rows), columns.size), found.coordinates))
    outputs = Decimator(np.concatenate([rows, still[: len(rows)]], axis=1), taps, found.steps)
    unit = np.eye(2 * found.coordinates)[columns]
    coordinates, mix = Decimator(unit, taps, found.steps), np.ascontiguousarray(rows[:, columns])
    ways: tuple[Callable[[], FloatArray], ...] = (
        lambda: outputs.take(states),
        lambda: mix @ coordinates.take(states),
    )
    spent: tuple[list[float], ...] = ([], [])
    for _ in range(rounds):
        made = []
        for way, times in zip(ways, spent, strict=True):
            begin = time.process_time()
            made.append(way())
            times.append(time.process_time() - begin)
    error = float(np.abs(made[0] - made[1]).max() / np.abs(made[0]).max())
    of_outputs, of_coordinates = (1e6 * median(times) for times in spent)
    return Row(
        f"{name}: its {len(rows)} accelerations, {BLOCK} samples filtered, CPU",
        f"{of_outputs:.0f} us",
        f"{columns.size} coordinates filtered: {of_coordinates:.0f} us, differs by {error:.0e}",
        of_coordinates / of_outputs,
    )
