"""CPU time of the time loop: parallel gears and tilting shafts."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

from benchmarks.contact.record_case import RecordCase, record_case
from siggen.specimen.integration import TimeGrid, time_grid

LOOP_S, ROUNDS = 0.25, 5
STATE = "through_100"
LAWS = {
    "parallel": ("dynamics.shafts=null",),
    "tilting": (),
}


def loop_times() -> Iterator[tuple[str, dict[str, float]]]:
    """Yield integrator, and CPU seconds per second of signal by law; laws are run in turn, medians."""
    cases = {law: record_case(STATE, 0, *overrides) for law, overrides in LAWS.items()}
    for integrator, steps in (("exponential", None), ("runge_kutta", 2)):
        spent: dict[str, list[float]] = {law: [] for law in cases}
        for turn in range(ROUNDS + 1):
            for law, case in cases.items():
                found = _loop_s(case, integrator, steps)
                if turn:  # the first turn compiles
                    spent[law].append(found)
        yield integrator, {law: float(np.median(found)) for law, found in spent.items()}


def _loop_s(case: RecordCase, integrator: str, steps: int | None) -> float:
    """Return the CPU time of the loop per second of signal."""
    mesh = case.state.mesh
    grid = TimeGrid(steps or 1, 1)
    if steps is None:
        grid = time_grid(case.config, case.specimen, mesh.structure, mesh.tables, case.point)
    motion = case.motion(integrator, grid.per_sample, stride=grid.stride)
    _, pitches, inputs = case.course(motion, grid.per_sample, 0.0, LOOP_S)
    states = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    begin = time.process_time()
    motion.advance(pitches, inputs, states)
    return (time.process_time() - begin) / LOOP_S
