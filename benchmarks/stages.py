"""Gearboxes of two stages: what the time loop costs beside that of the first stage alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks.row import Row, cost_row
from benchmarks.shipped import PAPER_B
from benchmarks.timing import Candidate, medians
from siggen.checks.loading import load_config
from siggen.config import Config, read_yaml
from siggen.dynamics.time.equations import no_inputs
from siggen.planning.specimen import draw_operating_point, draw_specimen
from siggen.record.specimen_state import specimen_state
from siggen.specimen.motion import specimen_motion

SLOW = {
    "name": "slow",
    "gears": {
        "module_mm": 3.0,
        "face_width_mm": 30.0,
        "pinion": {"teeth": 17, "bore_radius_mm": 15.0},
        "gear": {"teeth": 52, "bore_radius_mm": 25.0},
    },
}
CASES = {"friction off": ("dynamics.friction.model=off", "dynamics.mesh.damping=constant"), "mixed friction": ()}
STEPS = 2
GOAL = 2.5


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the cost of the loop with the same steps, and of tables and all."""
    duration_s, rounds = (0.5, 5) if quick else (1.0, 11)
    for name, overrides in CASES.items():
        loops = {kind: _loop(_config(found, overrides), duration_s) for kind, found in (("one", []), ("two", [SLOW]))}
        for loop in loops.values():
            loop(0)  # compiles
        cost = medians({kind: Candidate(loop) for kind, loop in loops.items()}, rounds)
        ratio = cost["two"] / cost["one"]
        what = f"time loop of two stages, 14 coordinates, {STEPS} steps per sample, {name}, per {duration_s:g} s"
        row = cost_row(what, cost["two"], "one stage, 8 coordinates", cost["one"])
        yield Row(row.what, row.measured, row.alternative, row.ratio, f"<= {GOAL:g} times", ratio <= GOAL)


def _config(stages: list[dict[str, Any]], overrides: tuple[str, ...]) -> Config:
    """Return the gearbox of paper_b on bearings in the ground, with further stages."""
    raw: dict[str, Any] = {**read_yaml(PAPER_B), "stages": stages, "housing": {}}
    raw["sensors"] = [{"name": "top", "place": "pinion_bearing", "axes": ["vertical"]}]
    return load_config(raw, ["dynamics.model=8dof", "dynamics.shafts=null", *overrides])


def _loop(config: Config, duration_s: float) -> Callable[[int], object]:
    """Return what steps a healthy state through time once."""
    specimen, point = draw_specimen(config, 0), draw_operating_point(config, 0, 0)
    step_s = 1.0 / (config.fs_hz * STEPS)
    motion = specimen_motion(specimen.dynamics, specimen_state(config, specimen, 0).mesh, point, step_s)
    steps = round(duration_s / step_s)
    pitches = np.arange(steps + 1, dtype=np.float64) * (motion.teeth * point.speed_hz * step_s)
    trajectory = np.empty((steps + 1, 2 * len(motion.structure.coordinates)))
    trajectory[0] = motion.start(pitches[0])
    return lambda _: motion.advance(pitches, no_inputs(pitches), trajectory)
