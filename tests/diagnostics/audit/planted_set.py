"""Small sets with mesh lines, error sidebands per specimen, noise and pulses of damage; every leak can be planted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.audit.measured_set import MeasuredSet, measured_set
from tests.diagnostics.column_roles import ListedRoles
from tests.shared import shared

STATES = ("healthy", "slight", "severe")
TEETH = (18, 47)
FS_HZ = 12_800.0
DURATION_S = 1.0
CHANNELS = ("lid_x", "lid_y", "bearing_x")


@dataclass
class PlantedSet(ListedRoles):
    """Rows in memory behind the interface of `siggen.open`."""

    table: pa.Table
    path: Path = Path("planted")
    config: dict[str, Any] = field(default_factory=dict)
    manifest: dict[str, Any] = field(default_factory=lambda: {"identity": "0" * 64})
    is_simulated: bool = True
    fs_hz: float = FS_HZ
    duration_s: float = DURATION_S
    splits: tuple[str, ...] = ("all",)

    @property
    def channels(self) -> tuple[SimpleNamespace, ...]:
        return tuple(
            SimpleNamespace(name=name, column=f"accel_{name}_m_s2", quantity="acceleration", shown_unit="m/s²")
            for name in CHANNELS
        )

    def row_groups(self) -> tuple[tuple[int, ...], ...]:
        return ((self.table.num_rows,),)

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        return self.table if columns is None else self.table.select(list(columns))

    def records(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        yield from self.labels(None, columns).combine_chunks().to_batches(max_chunksize=batch_rows)


@dataclass(frozen=True)
class Plant:
    """What to plant; the defaults are a set without leaks."""

    specimens: int = 12
    points: int = 2
    repeats: int = 1
    error_depth: float = 0.15
    one_error_draw: bool = False
    shared_noise: bool = False
    copied_channel_noise: bool = False
    severe_pulse: float = 0.0
    slight_gain: float = 1.0
    padded_state: str = ""
    one_tooth: bool = False
    one_start: bool = False
    seed: int = 3


def planted(plant: Plant) -> PlantedSet:
    """Return the set."""
    rng = np.random.default_rng(plant.seed)
    noise_once = rng.standard_normal((len(CHANNELS), round(FS_HZ * DURATION_S)))
    common = np.random.default_rng(99)
    rows = []
    for specimen in range(plant.specimens):
        errors = _errors(np.random.default_rng(99) if plant.one_error_draw else rng, plant.error_depth)
        # every channel has its own path: gain and phase per mesh harmonic, drawn per specimen
        paths = 10 ** rng.normal(0, 0.15, (len(CHANNELS), 5)) * np.exp(0j)
        tooth = 4 if plant.one_tooth else int(rng.integers(TEETH[0]))
        points = [(rng.uniform(25, 32), rng.uniform(40, 60)) for _ in range(plant.points)]
        for state_id, state in enumerate(STATES):
            for point_id, (speed_hz, torque_nm) in enumerate(points):
                for repeat in range(plant.repeats):
                    start = (tooth / TEETH[0] + 0.25) % 1.0 + 2 if plant.one_start else rng.uniform(0, 47)
                    noise = noise_once if plant.shared_noise else rng.standard_normal(noise_once.shape)
                    if plant.copied_channel_noise:
                        noise = np.repeat(noise[:1], len(CHANNELS), axis=0)
                    pulse = plant.severe_pulse if state == "severe" else 0.0
                    signals, tacho_s = _signals(errors, paths, speed_hz, start, tooth, pulse, noise, rng)
                    if state == "slight":
                        signals = signals * plant.slight_gain
                    if state == plant.padded_state:
                        signals[:, -1000:] = 0.0
                    rows.append(
                        _row(len(rows), specimen, state_id, point_id, repeat, speed_hz, torque_nm, start, tooth, common)
                        | {f"accel_{n}_m_s2": s.astype(np.float32) for n, s in zip(CHANNELS, signals, strict=True)}
                        | {"tacho_s": tacho_s}
                    )
    return PlantedSet(_table(rows))


def _errors(rng: np.random.Generator, depth: float) -> np.ndarray:
    """Return complex sidebands (5 harmonics, 13 offsets) relative to the mesh line; zero at the line itself."""
    size = depth * np.exp(-0.15 * np.abs(np.arange(-6, 7))) * rng.uniform(0.6, 1.4, (5, 13))
    sidebands = size * np.exp(2j * np.pi * rng.random((5, 13)))
    sidebands[:, 6] = 0.0
    return sidebands


def _signals(
    errors: np.ndarray, paths: np.ndarray, speed_hz: float, start: float, tooth: int, pulse: float, noise: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    time_s = np.arange(noise.shape[1]) / FS_HZ
    wander = 1e-4 * speed_hz / (2 * np.pi) * np.sin(2 * np.pi * time_s + rng.uniform(0, 6.28))
    turns = start + speed_hz * time_s + wander
    once = np.exp(2j * np.pi * turns)
    sixth = np.ones(turns.size, dtype=np.complex128) / once**6
    offsets = np.empty((13, turns.size), dtype=np.complex128)
    for k in range(13):
        offsets[k] = sixth
        sixth = sixth * once
    parts = 1.0 + errors @ offsets
    mesh = once ** TEETH[0]
    for h in range(5):
        parts[h:] *= mesh
    bump = np.exp(-0.5 * (((turns - tooth / TEETH[0] + 0.5) % 1.0 - 0.5) / 0.01) ** 2)
    signals = np.real(paths @ parts) + pulse * bump * np.sin(2 * np.pi * 60 * turns) + noise
    pulses = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1)
    return signals, np.interp(pulses, turns, time_s)


def _row(
    record: int, specimen: int, state_id: int, point_id: int, repeat: int, speed_hz: float, torque_nm: float,
    start: float, tooth: int, rng: np.random.Generator,
) -> dict[str, Any]:  # fmt: skip
    state, damaged = STATES[state_id], state_id > 0
    return {
        "record_id": record, "specimen_id": specimen, "state_id": state_id, "state": state,
        "operating_point_id": point_id, "repeat": repeat, "split": "train" if specimen % 2 else "test",
        "fault": "pitting" if damaged else "healthy", "severity": state,
        "faulty_teeth_pinion": [tooth] if damaged else [],
        "damaged_area_mm2": 2.0 * state_id, "damaged_area_share": 0.02 * state_id,
        "damage_profile_length_mm": 0.5 * state_id, "mesh_stiffness_loss": 0.01 * state_id, "status": "ok",
        "teeth_pinion": TEETH[0], "teeth_gear": TEETH[1], "speed_hz": speed_hz, "torque_nm": torque_nm,
        "start_angle_rad": 2 * np.pi * start,
        "noise_floor_lid_x_m_s2": float(rng.uniform(0.9, 1.1)), "path_gain_lid_x": 1.0 + 0.01 * specimen,
        "pitch_error_um": 3.0 + specimen, "snr_lid_x_db": 10.0 + 5 * state_id,
    }  # fmt: skip


def _table(rows: list[dict[str, Any]]) -> pa.Table:
    schema = pa.Table.from_pylist(rows[-1:]).schema
    for name in CHANNELS:
        column = f"accel_{name}_m_s2"
        kind = pa.list_(pa.float32(), round(FS_HZ * DURATION_S))
        schema = schema.set(schema.get_field_index(column), pa.field(column, kind))
    return pa.Table.from_pylist(rows, schema=schema)


def measured(plant: Plant, factory: pytest.TempPathFactory) -> MeasuredSet:
    """Return the measured set, which files share."""
    return shared(factory, f"measured {plant}", lambda: measured_set(planted(plant)))
