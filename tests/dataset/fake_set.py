"""A small configuration and a stand-in for the physics: fast, pure, and fit for workers."""

from __future__ import annotations

import os
import shutil
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
import pyarrow as pa

from siggen.columns.record import Column, RecordFailure, SimulatedRecord
from siggen.gearbox.design import SetDesign, design_of
from siggen.gearbox.plan import PlannedRecord, planned_record
from siggen.sets import physics
from siggen.sets.generation import generate
from siggen.sets.run_journal import Events
from siggen.sets.set_run import Generation
from siggen.sets.verification import Verification, verify

STEP_M_S2 = 2.0**-6
"""Least power of two that covers 2 * 500 m/s^2 in 16 bits, as the converter of the configuration has it."""
STEPPED = {"integration_error": 2e-4, "integration_error_of": "samples"}


def fake_config(**changes: Any) -> SetDesign:
    """Two channels of 512 samples, three states, two operating points; 6 records per specimen."""
    pit = {"semi_axis_face_mm": 0.3, "semi_axis_profile_mm": 0.2, "depth_mm": 0.4}
    mapping = {
        "name": "fake",
        "seed": 7,
        "specimens": 5,
        "fs_hz": 5120.0,
        "duration_s": 0.1,
        "mesh_harmonics": 1,
        "splits": {"train": 12, "validation": 4, "test": 4},
        "gears": {
            "module_mm": 3.0,
            "face_width_mm": 20.0,
            "pinion": {"teeth": 18, "bore_radius_mm": 10.0},
            "gear": {"teeth": 47, "bore_radius_mm": 15.0},
        },
        "operating_points": [{"speed_hz": 30.0, "torque_nm": 60.0}, {"speed_hz": 20.0, "torque_nm": 40.0}],
        "states": {
            "healthy": {},
            "slight": {"damage": {"kind": "clustered", "count": 2, "spread_profile_mm": 0.1, **pit}},
            "moderate": {"damage": {"kind": "clustered", "count": 6, "spread_profile_mm": 0.2, **pit}},
        },
        "housing": {"kind": "rigid"},
        "sensors": {"bearing": {"axes": ["vertical", "horizontal"]}},
        **changes,
    }
    return design_of(mapping, "fake")


def fake_record(config: SetDesign, planned: PlannedRecord) -> SimulatedRecord:
    """Noise on the converter's grid, and labels that follow from the state."""
    rng = np.random.default_rng([config.seed, planned.record_id])
    state = config.config.states[planned.state_id]
    pits = 0 if state.damage is None else state.damage.count
    labels: dict[str, object] = {
        "state": state.name,
        "fault": state.fault,
        "severity": state.severity,
        "faulty_gear": "pinion" if pits else "none",
        "faulty_teeth_pinion": [planned.specimen_id % 18] if pits else [],
        "faulty_teeth_gear": [],
        "damage_count": pits,
        "damaged_area_mm2": 0.19 * pits,
        "damaged_area_share": 0.001 * pits,
        "damage_face_length_mm": 0.6 if pits else 0.0,
        "damage_profile_length_mm": 0.4 if pits else 0.0,
        "contact_length_loss_mm": 0.6 * pits,
        "mesh_stiffness_loss": 0.01 * pits,
        "contact_loss_share": 0.0,
        "through_face": False,
        "sink_depth_um": 0.0,
        "status": "ok",
        "teeth_pinion": 18,
        "teeth_gear": 47,
        "speed_hz": 30.0,
        "torque_nm": 60.0,
        "pinion_shaft_hz": 30.0,
        "gear_shaft_hz": 30.0 * 18 / 47,
        "mesh_hz": 540.0,
        "mesh_stiffness_loss_as_simulated": 0.008 * pits,
        **({} if config.config.dynamics.mesh.law == "linear" else {"oil_temperature_c": 50.0}),
        "start_angle_rad": float(rng.random()),
        **(STEPPED if config.config.dynamics.method == "exponential" else {}),
    }
    signals = {}
    for name in config.channels:
        t_s = np.arange(config.samples) / config.fs_hz
        accel = 20.0 * np.sin(2 * np.pi * 540.0 * t_s) + rng.normal(scale=0.5, size=config.samples)
        signals[name] = (np.round(accel / STEP_M_S2) * STEP_M_S2).astype(np.float32)
        labels |= {f"noise_floor_{name}_m_s2": 0.5, f"snr_{name}_db": 29.0, f"clipped_share_{name}": 0.0}
    return SimulatedRecord(planned, labels, signals, np.arange(3) / 30.0, fake_internals(config, planned))


QUANTITIES = (
    Column("mesh_force_n", pa.float32(), "N", "force"),
    Column("pair_1_force_n", pa.float32(), "N", "of one"),
    Column("pair_1_film_ratio", pa.float32(), "", "of one"),
)


def quantities(config: SetDesign) -> tuple[Column, ...]:
    """Stand in for `siggen.sets.drawn.stored_quantities`."""
    return QUANTITIES


def fake_internals(config: SetDesign, planned: PlannedRecord) -> dict[str, np.ndarray] | None:
    """Return a force that tells the record; odd specimens have no second pair, others one with a film half the time."""
    if config.config.internals is None:
        return None
    force = np.linspace(0.0, 1.0, config.samples) + planned.record_id
    if planned.specimen_id % 2:
        return {"mesh_force_n": force}
    film = np.where(np.arange(config.samples) < config.samples // 2, 1.0 + force, np.nan)
    return {"mesh_force_n": force, "pair_1_force_n": -force, "pair_1_film_ratio": film}


def simulate(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Stand in for `siggen.sets.drawn.simulated`."""
    return [fake_record(config, planned_record(config, i)) for i in record_ids]


def simulate_with_thicker_films(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Change the last film of every record by 1 %."""
    results = simulate(config, record_ids)
    for result in results:
        if isinstance(result, SimulatedRecord) and "pair_1_film_ratio" in (result.internals or {}):
            result.internals["pair_1_film_ratio"][config.samples // 2 - 1] *= 1.01
    return results


def simulate_with_longer_contact(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Give every film one sample more."""
    results = simulate(config, record_ids)
    for result in results:
        if isinstance(result, SimulatedRecord) and "pair_1_film_ratio" in (result.internals or {}):
            result.internals["pair_1_film_ratio"][config.samples // 2] = 2.0
    return results


def simulate_slowly(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Give a test the time to kill something."""
    time.sleep(0.05 * len(record_ids))
    return simulate(config, record_ids)


def simulate_with_failures(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Fail at records 3 and 8, and give one signal a NaN (record 10)."""
    results: list[SimulatedRecord | RecordFailure] = []
    for result in simulate(config, record_ids):
        assert isinstance(result, SimulatedRecord)
        record_id = result.planned.record_id
        if record_id == 10:
            result.channels["bearing_vertical"][5] = np.nan
        is_failure = record_id in (3, 8)
        results.append(RecordFailure(record_id, "diverged", "motion left the backlash") if is_failure else result)
    return results


def simulate_none(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Fail at every record."""
    return [RecordFailure(i, "diverged", "always") for i in record_ids]


def simulate_with_a_bug(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Raise at record 8, as only a fault of the program does."""
    if 8 in record_ids:
        raise ZeroDivisionError("a bug")
    return simulate(config, record_ids)


def simulate_and_die_once(config: SetDesign, record_ids: Sequence[int]) -> list[SimulatedRecord | RecordFailure]:
    """Kill the worker at record 8, the first time only."""
    marker = Path(os.environ["SIGGEN_TEST_MARKER"])
    if 8 in record_ids and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return simulate(config, record_ids)


def damage_rows(config: SetDesign, record_ids: Sequence[int]) -> list[dict[str, object]]:
    """Stand in for `siggen.sets.drawn.damage_rows`: one ellipse per pit."""
    return [row for record_id in record_ids for row in _pits(config, record_id)]


def _pits(config: SetDesign, record_id: int) -> list[dict[str, object]]:
    planned = planned_record(config, record_id)
    damage = config.config.states[planned.state_id].damage
    ellipse = {
        "gear": "pinion",
        "tooth": planned.specimen_id % 18,
        "kind": "pit",
        "shape": "ellipse",
        "height_mm": 1.9,
        "semi_axis_face_mm": 0.3,
        "semi_axis_profile_mm": 0.2,
        "face_width_mm": 20.0,
        "pitch_height_mm": 2.5,
        "tip_height_mm": 5.5,
        "depth_mm": 0.4,
        "depth_law": "flat",
        "polygon_face_mm": [],
        "polygon_height_mm": [],
    }
    count = 0 if damage is None else damage.count
    return [{**ellipse, "record_id": record_id, "face_mm": 8.0 + pit} for pit in range(count)]


@contextmanager
def fake_physics(simulation: Any = simulate) -> Iterator[None]:
    """Put the stand-in where `generate` and `verify` look for the physics; workers receive its functions by name."""
    stand_in = physics.Physics(simulation, damage_rows, quantities)
    with patch.object(physics, "physics", lambda: stand_in):
        yield


def write_fake_set(
    path: Path | str,
    config: SetDesign | None = None,
    *,
    workers: int = 0,
    part: tuple[int, int] | None = None,
    simulation: Any = simulate,
    executor: Executor | str | None = None,
    events: Events | None = None,
    allowed_loss: float = 1.0,
) -> Generation:
    """Generate a set with the stand-in, in this process unless workers are asked for; one gearbox per shard."""
    with fake_physics(simulation):
        told = {"events": events, "allowed_loss": allowed_loss}
        return generate(config or fake_config(), path, workers, part=part, executor=executor, **told)  # type: ignore[arg-type]


@cache
def _made_once() -> TemporaryDirectory[str]:
    folder = TemporaryDirectory()
    write_fake_set(Path(folder.name) / "set")
    return folder


def copy_fake_set(path: Path) -> None:
    """Lay the set of `fake_config()` into a folder, for tests to which its making is nothing."""
    shutil.copytree(Path(_made_once().name) / "set", path, dirs_exist_ok=True)


def verify_fake_set(path: Path, sample: int, *, workers: int = 0, simulation: Any = simulate) -> Verification:
    """Verify a set with records of the stand-in, simulated in this process unless workers are asked for."""
    with fake_physics(simulation):
        return verify(path, sample, workers=workers)


FAKE_FILES = sorted(
    ["README.md", "config.yaml", "damage.parquet", "labels.parquet", "manifest.json"]
    + [
        f"data/{shard}.parquet"
        for shard in ("train-00000", "train-00001", "train-00002", "validation-00000", "test-00000")
    ]
)
"""All files of the set of `fake_config()`."""


def file_bytes(path: Path) -> dict[str, bytes]:
    """Return every file of a set."""
    files = sorted(p for p in path.rglob("*") if p.is_file())
    return {p.relative_to(path).as_posix(): p.read_bytes() for p in files}


if __name__ == "__main__":
    # python -m tests.dataset.fake_set FOLDER WORKERS [EXECUTOR]: a process of its own that a test can kill
    from siggen.errors import SiggenError

    by_name: Any = import_module("tests.dataset.fake_set")  # workers of Ray do not know this module as __main__

    try:
        chosen = sys.argv[3] if len(sys.argv) > 3 else None
        slowly = by_name.simulate_slowly
        by_name.write_fake_set(Path(sys.argv[1]), workers=int(sys.argv[2]), simulation=slowly, executor=chosen)
    except SiggenError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(error.exit_code)
