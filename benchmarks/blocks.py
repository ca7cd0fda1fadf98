"""Records in blocks beside the same records at once: CPU time of a short record, and the error of what is no noise."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

import numpy as np

from benchmarks.row import Row, cost_row
from benchmarks.shipped import ROOT, shipped
from siggen.columns.record import Record
from siggen.config import Config
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import simulate_specimen
from siggen.specimen.instrument import specimen_instrument

WAYS = ("blocks", "record")
ENDS = 100
"""Last samples that are left out: at once, delays see the beginning of a record behind its end."""
LARGEST_ERROR = 1e-3
"""The tolerance of the integration; filters must not add as much."""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield CPU times in turn, and errors against one transform over the whole record."""
    ways = {way: shipped(ROOT / "configs" / "quickstart.yaml", "specimens=1", f"filters={way}") for way in WAYS}
    rounds = 5 if quick else 15
    made = _in_turn({way: _recorder(config) for way, config in ways.items()}, rounds)
    yield cost_row("a record of quickstart in blocks, tables and gearbox included, CPU", made[0], "at once", made[1])
    built = _in_turn({way: _builder(config) for way, config in ways.items()}, rounds)
    yield cost_row("responses of its gearbox in blocks, CPU", built[0], "at once", built[1])
    for name in ("quickstart", "industrial"):
        error = _error(name)
        yield Row(
            f"{name}: largest error of a channel in blocks, 3 s, noise left out, but for the last {ENDS} samples",
            f"{error:.1e}",
            goal=f"<= {LARGEST_ERROR:.0e}",
            met=error <= LARGEST_ERROR,
        )


def _recorder(config: Config) -> Callable[[], Any]:
    return lambda: simulate_specimen(config, [0])


def _builder(config: Config) -> Callable[[], Any]:
    specimen = draw_specimen(config, 0)
    return lambda: specimen_instrument(config, specimen)


def _in_turn(calls: dict[str, Callable[[], Any]], rounds: int) -> list[float]:
    """Return the median CPU time of each call; the first round, which loads compiled code, does not count."""
    spent: dict[str, list[float]] = {way: [] for way in calls}
    for _ in range(rounds + 1):
        for way, call in calls.items():
            begin = time.process_time()
            call()
            spent[way].append(time.process_time() - begin)
    return [median(values[1:]) for values in spent.values()]


def _error(name: str) -> float:
    """Return the relative rms difference of the worst channel of the first record."""
    config = shipped(ROOT / "configs" / f"{name}.yaml", "specimens=1", "duration_s=3")
    blocks, whole = (_signals(_without_noise(config, way)) for way in WAYS)
    return max(float((blocks[n] - whole[n])[:-ENDS].std() / whole[n].std()) for n in whole)


def _without_noise(config: Config, filters: str) -> Config:
    """Return a configuration whose channels hold what is no noise, not converted."""
    found = config.canonical()
    without = dict.fromkeys(("pink_noise", "noise_spectrum", "tones", "inverter", "mains", "bits"))
    quiet = {**without, "noise": {"floor_m_s2": 0.0}, "range_m_s2": 1e6}
    sensors = [{**sensor, **quiet} for sensor in found["sensors"]]
    background = {**found["background"], "rubbing": None, "floor": None}
    return Config.model_validate({**found, "sensors": sensors, "background": background, "filters": filters})


def _signals(config: Config) -> dict[str, np.ndarray]:
    made = simulate_specimen(config, [0])[0]
    if not isinstance(made, Record):
        raise RuntimeError(f"record 0 of {config.name}: {made.reason}")
    return {name: values.astype(np.float64) for name, values in made.channels.items()}
