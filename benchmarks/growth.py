"""How the cost of a record of quickstart grows: with pits on a tooth, meshes, sensors, and modes of the housing.

CPU time per second of signal, its plan and tables shared out as in `presets`; two records, healthy and damaged.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from benchmarks.presets import costs
from benchmarks.row import Row, duration_text
from benchmarks.shipped import ROOT, shipped
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable

CONFIGS = ROOT / "configs"
PITS, SENSORS, MODES = (12, 120, 1200), (1, 2, 4, 8), (10, 40, 160)
SENSOR = {"place": "lid", "axes": ["vertical"], "model": "laboratory", "mount": "stud"}
THIRD = (
    'machine.shafts.slow={"span_mm": 140, "bearing": {"stiffness_n_per_m": 2.0e+8, "damping_n_s_per_m": 2500}}',
    'machine.shafts.last={"bearing": {"stiffness_n_per_m": 2.0e+8, "damping_n_s_per_m": 4000}}',
    'machine.gears.last_pinion={"shaft": "slow", "teeth": 19, "bore_radius_mm": 25.0}',
    'machine.gears.last_gear={"shaft": "last", "teeth": 50, "bore_radius_mm": 35.0}',
    'machine.meshes.last={"driver": "last_pinion", "driven": "last_gear", "module_mm": 6.0, "face_width_mm": 45.0}',
)


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row for everything that grows: what records cost, the last over the first."""
    yield _row("pits on a tooth", "quickstart", PITS, [[_pitted(count)] for count in PITS], quick)
    two, three = _found("two_stage", [[], THIRD], quick)
    (one,) = _found("quickstart", [["duration_s=3"]], quick)  # as long as those of two_stage
    yield _told("meshes", (1, 2, 3), [one, two, three])
    yield _row("sensors", "quickstart", SENSORS, [[_sensed(count)] for count in SENSORS], quick)
    with tempfile.TemporaryDirectory() as folder:
        yield _row("modes of the housing", "quickstart", MODES, [_shaking(folder, count) for count in MODES], quick)


def _row(what: str, preset: str, counts: Sequence[int], overrides: Sequence[Sequence[str]], quick: bool) -> Row:
    return _told(what, counts, _found(preset, overrides, quick))


def _found(preset: str, overrides: Sequence[Sequence[str]], quick: bool) -> list[float]:
    """Return the costs of a record with each of the overrides [s per s of signal]."""
    found = []
    for own in overrides:
        config = shipped(CONFIGS / f"{preset}.yaml", *own)
        costs(shipped(CONFIGS / f"{preset}.yaml", "duration_s=0.05", *own), 0)  # compiles
        found.append(float(np.mean([sum(costs(config, k).values()) for k in range(1, 2 if quick else 4)])))
    return found


def _told(what: str, counts: Sequence[int], found: Sequence[float]) -> Row:
    numbers = ", ".join(f"{count:,}" for count in counts)
    measured = ", ".join(map(duration_text, found))
    return Row(
        f"a record with {numbers} {what}, CPU per s of signal", measured, "last over first", found[-1] / found[0]
    )


def _pitted(count: int) -> str:
    damage = {
        "kind": "clustered", "gear": "pinion", "teeth": 1, "count": count, "centre_height_mm": "pitch",
        "spread_profile_mm": 0.5, "semi_axis_face_mm": 0.08, "semi_axis_profile_mm": 0.06, "depth_mm": 0.05,
    }  # fmt: skip
    return f"states={json.dumps({'others': None, 'healthy': {}, 'pitted': {'damage': damage}})}"


def _sensed(count: int) -> str:
    return f"sensors={json.dumps({'others': None, **{f'lid_{k}': SENSOR for k in range(count)}})}"


def _shaking(folder: str, count: int) -> list[str]:
    """Return the overrides of a housing with so many modes from 200 Hz to 10 kHz."""
    wave = 2.4 * np.arange(count)
    seats = [f"{gear}_bearing/{axis}" for gear in ("pinion", "gear") for axis in ("horizontal", "vertical")]
    sensors = [f"{name}/{axis}" for name in ("lid", "side") for axis in ("horizontal", "vertical", "axial")]
    shapes = {place: 0.2 * np.cos(wave + k) for k, place in enumerate((*seats, *DRIVE, *sensors))}
    base = {name: 2.0 * np.cos(wave + k) / (1.0 + np.arange(count)) for k, name in enumerate(BASE)}
    file = Path(folder) / f"modes_{count}.csv"
    file.write_text(ModeTable(np.linspace(200.0, 1e4, count), np.full(count, 0.03), shapes, base).text)
    return [f'housing={{"kind": "modal", "modes": "{file}"}}']
