"""A small set in memory with the interface of `siggen.open`: modulated mesh tones whose depth follows the state."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import wraps
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from siggen.columns.damage import DAMAGE_COLUMNS
from siggen.dataset.inventory import ListedShard
from tests.diagnostics.column_roles import ListedRoles
from tests.shared import shared

if TYPE_CHECKING:
    from diagnostics.indicators.table import RecordTable
    from diagnostics.judging.of_split import Training

STATES = ("healthy", "slight", "severe")
DEPTH = {"healthy": 0.0, "slight": 0.15, "severe": 0.5}
AREA_MM2 = {"healthy": 0.0, "slight": 1.0, "severe": 8.0}
TEETH = (18, 47)
FS_HZ = 12_800.0
ROWS = 7
"""Records of a shard: no divisor of the 36 of the training split, so that the last group is smaller."""

CHANNELS = ("bearing_vertical", "bearing_horizontal")


def shaft_record(
    rng: np.random.Generator, depth: float, duration_s: float = 1.0, speed_hz: float = 30.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return a signal with a once-per-revolution dip of the given depth, and its pulse times; level and phase vary."""
    time_s = np.arange(round(FS_HZ * duration_s)) / FS_HZ
    turns = speed_hz * time_s + rng.uniform() + 0.003 * np.sin(2 * np.pi * 0.8 * time_s)
    dip = 1.0 - depth * np.exp(-0.5 * (((turns % 1.0) - 0.5) / 0.02) ** 2)
    mesh = sum(np.cos(2 * np.pi * (h * TEETH[0] * turns + rng.uniform())) / h for h in (1, 2, 3))
    signal = rng.uniform(5.0, 15.0) * dip * mesh + 0.3 * rng.standard_normal(time_s.size)
    pulses = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1)
    return signal.astype(np.float32), np.interp(pulses, turns, time_s)


@dataclass
class MemoryDataset(ListedRoles):
    """Rows in memory behind the interface of a set on disk."""

    table: pa.Table
    path: Path = Path("memory_set")
    config: dict[str, Any] = field(default_factory=lambda: {"name": "memory"})
    manifest: dict[str, Any] = field(default_factory=lambda: {"identity": "0" * 64, "name": "memory"})
    fs_hz: float = FS_HZ
    duration_s: float = 1.0

    @property
    def channels(self) -> tuple[SimpleNamespace, ...]:
        return tuple(
            SimpleNamespace(
                name=name, sensor="bearing", place="pinion_bearing", axis=name.split("_")[1], unit="m/s^2",
                column=f"accel_{name}_m_s2", quantity="acceleration", shown_unit="m/s²",
            )
            for name in CHANNELS
        )  # fmt: skip

    @property
    def splits(self) -> tuple[str, ...]:
        present = set(self.table.column("split").to_pylist())
        return tuple(name for name in ("train", "validation", "test") if name in present)

    def _split(self, split: str | None) -> pa.Table:
        if split is None:
            return pa.concat_tables([self._split(name) for name in self.splits])
        return self.table.filter(pc.equal(self.table.column("split"), split))

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        table = self._split(split)
        return table if columns is None else table.select(list(columns))

    def damage(self, split: str | None = None) -> pa.Table:
        rows = self.labels(split, ["record_id", "specimen_id", "fault"]).to_pylist()
        damaged = [row for row in rows if row["fault"] != "healthy"]
        gears = ["gear" if row["specimen_id"] % 2 else "pinion" for row in damaged]
        teeth = [row["specimen_id"] % TEETH[0] for row in damaged]
        ellipse = {"face_mm": 10.0, "height_mm": 3.0, "semi_axis_face_mm": 1.0, "semi_axis_profile_mm": 0.5}
        flank = {"face_width_mm": 20.0, "pitch_height_mm": 2.5, "tip_height_mm": 5.0}
        same = {
            "kind": "spall",
            "shape": "ellipse",
            "depth_law": "flat",
            "depth_mm": 0.2,
            "polygon_face_mm": [],
            "polygon_height_mm": [],
            **ellipse,
            **flank,
        }
        rows = [
            {"record_id": row["record_id"], "gear": gear, "tooth": tooth, **same}
            for row, gear, tooth in zip(damaged, gears, teeth, strict=True)
        ]
        return pa.Table.from_pylist(rows, pa.schema([(column.name, column.type) for column in DAMAGE_COLUMNS]))

    def records(
        self, split: str | None = None, columns: Sequence[str] | None = None, batch_rows: int | None = None
    ) -> Iterator[pa.RecordBatch]:
        yield from self.labels(split, columns).combine_chunks().to_batches(max_chunksize=batch_rows)

    def shards(self, split: str) -> tuple[ListedShard, ...]:
        rows = self.labels(split, ["record_id"]).num_rows
        return tuple(
            ListedShard(shard=f"{split}-{k:05d}", rows=min(ROWS, rows - k * ROWS)) for k in range(-(-rows // ROWS))
        )

    def row_groups(self) -> tuple[tuple[int, ...], ...]:
        return ((self.table.num_rows,),)

    def shard_rows(self, shard: ListedShard, columns: Sequence[str] | None = None) -> pa.RecordBatch:
        number = int(shard.shard.rpartition("-")[2])
        part = self.labels(shard.split, columns).slice(number * ROWS, shard.rows)
        return part.combine_chunks().to_batches()[0]

    def record(self, record_id: int) -> dict[str, Any]:
        row = self.table.filter(pc.equal(self.table.column("record_id"), record_id)).to_pylist()[0]
        signals = {channel.column: np.asarray(row[channel.column], dtype=np.float32) for channel in self.channels}
        return {**row, **signals, "tacho_s": np.asarray(row["tacho_s"])}


def memory_dataset(
    specimens: Sequence[str], *, effect: float = 1.0, seed: int = 5, duration_s: float = 1.0
) -> MemoryDataset:
    """Return a set with one specimen per entry, which names its split; `effect` scales the depth of modulation."""
    rng = np.random.default_rng(seed)
    rows = []
    for specimen, split in enumerate(specimens):
        for state_id, state in enumerate(STATES):
            found = [shaft_record(rng, effect * DEPTH[state], duration_s) for _ in CHANNELS]
            # one shaft, two sensors: the second signal is the first one through another gain and noise
            first, pulses = found[0]
            second = (0.7 * first + 0.3 * rng.standard_normal(first.size)).astype(np.float32)
            rows.append(_row(len(rows), specimen, state_id, state, split, (first, second), pulses))
    samples = round(FS_HZ * duration_s)
    schema = pa.Table.from_pylist(rows[:1]).schema
    for name in CHANNELS:
        position = schema.get_field_index(f"accel_{name}_m_s2")
        schema = schema.set(position, pa.field(f"accel_{name}_m_s2", pa.list_(pa.float32(), samples)))
    return MemoryDataset(pa.Table.from_pylist(rows, schema=schema), duration_s=duration_s)


def _row(
    record: int,
    specimen: int,
    state_id: int,
    state: str,
    split: str,
    signals: tuple[np.ndarray, ...],
    pulses: np.ndarray,
) -> dict[str, Any]:
    return {
        "record_id": record, "specimen_id": specimen, "state_id": state_id, "state": state,
        "operating_point_id": 0, "repeat": 0, "split": split,
        "fault": "healthy" if state == "healthy" else "pitting", "severity": state,
        "damaged_area_mm2": AREA_MM2[state], "damaged_area_share": AREA_MM2[state] / 100.0,
        "mesh_stiffness_loss": AREA_MM2[state] / 40.0,
        **{f"clipped_share_{name}": 0.0 for name in CHANNELS},
        "teeth_pinion": TEETH[0], "teeth_gear": TEETH[1], "speed_hz": 30.0, "torque_nm": 60.0,
        "mesh_hz": 540.0, "pinion_shaft_hz": 30.0,
        **{f"accel_{name}_m_s2": signal for name, signal in zip(CHANNELS, signals, strict=True)},
        "tacho_s": pulses,
    }  # fmt: skip


SPLITS_24 = ("train",) * 12 + ("validation",) * 4 + ("test",) * 8


@pytest.fixture(scope="session")
def dataset() -> MemoryDataset:
    """24 specimens, three states, a modulation that is plain to see."""
    return memory_dataset(SPLITS_24)


@pytest.fixture(scope="session")
def measured(dataset: MemoryDataset, tmp_path_factory: pytest.TempPathFactory) -> RecordTable:
    """The one pass over the separable set, which many tests begin with."""
    from diagnostics.indicators.table import record_table

    return shared(tmp_path_factory, "measured", lambda: record_table(dataset))


@pytest.fixture(scope="session")
def features(measured: RecordTable) -> pa.Table:
    """The feature table of the separable set."""
    from diagnostics.indicators.classifier_table import classifier_table

    return classifier_table(measured)


@pytest.fixture(scope="session")
def training(dataset: MemoryDataset, features: pa.Table, tmp_path_factory: pytest.TempPathFactory) -> Training:
    """What training without networks makes of the separable set."""
    from diagnostics.judging.of_split import NetworkOptions, train_models

    options = NetworkOptions(cnn=False)
    return shared(tmp_path_factory, "training", lambda: train_models(dataset, features, 0, network=options))


@pytest.fixture(scope="session")
def models_folder(
    training: Training, features: pa.Table, dataset: MemoryDataset, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The folder of these models; tests that change a file copy it."""
    from diagnostics.prediction.saved_models import save_models

    folder = tmp_path_factory.mktemp("models")
    save_models(training, features, dataset, folder)
    return folder


@pytest.fixture(scope="session")
def make_dataset() -> Callable[..., MemoryDataset]:
    """Return the function that makes such sets."""
    return memory_dataset


@pytest.fixture(autouse=True, scope="session")
def light_classifiers() -> Iterator[None]:
    """Ten trees and two strengths of the penalty, which tell these sets apart as well: all take half of a report."""
    from diagnostics.training import classifiers, lives

    choose = classifiers._chosen_strength

    def of_two(values: Any, truth: Any, gearbox: Any, strengths: Sequence[float], **given: Any) -> Any:
        return choose(values, truth, gearbox, strengths[2::2] or strengths, **given)

    model, of_life = classifiers._model, lives._model
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(classifiers, "_chosen_strength", of_two)
        patch.setattr(classifiers, "_model", lambda trees, seed: model(min(trees, 10), seed))
        patch.setattr(lives, "_model", lambda q, seed: of_life(q, seed).set_params(max_iter=10))
        yield


@pytest.fixture(autouse=True, scope="session")
def each_record_measured_once() -> Iterator[None]:
    """Take what the one pass made of the same record with the same settings before: many tests copy one small set."""
    from diagnostics.indicators import table

    measure: Callable[..., Any] = table._record_result
    kept: dict[bytes, bytes] = {}

    @wraps(measure)
    def measured(*given: Any) -> Any:
        key = hashlib.blake2b(pickle.dumps(given)).digest()
        if key not in kept:
            kept[key] = pickle.dumps(measure(*given))
        return pickle.loads(kept[key])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(table, "_record_result", measured)
        yield
