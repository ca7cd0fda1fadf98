"""The records that stand for their states in the report: one specimen, one operating point, one channel."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.records.gear_train import GearMesh, meshes_of
from diagnostics.records.recording import Recording, one_recording
from diagnostics.records.state_classes import HEALTHY
from diagnostics.signal.spectrum import OrderSpectrum, order_spectrum
from diagnostics.training.splits import TEST
from siggen.dataset.reading import Dataset


@dataclass(frozen=True, slots=True)
class Example:
    """One state of the chosen specimen."""

    record_id: int
    state: str
    fault: str
    signal: np.ndarray
    tacho_s: np.ndarray
    spectrum: OrderSpectrum | None


@dataclass(frozen=True, slots=True)
class ExampleSet:
    """Examples of all states of one specimen, and what they have in common."""

    examples: tuple[Example, ...]
    specimen_id: int
    channel: str
    quantity: str
    unit: str
    speed_hz: float
    torque_nm: float
    teeth: tuple[int, int]
    fs_hz: float
    train: tuple[GearMesh, ...]
    mesh: GearMesh

    @property
    def turns_hz(self) -> float:
        """How often the driver turns, of a planetary set against its carrier."""
        planets = self.mesh.planets
        return self.speed_hz * (1.0 if planets is None else float(planets.sun_turns))

    @property
    def healthy(self) -> Example | None:
        """The first healthy example."""
        return next((example for example in self.examples if example.fault == HEALTHY), None)


def example_set(dataset: Dataset, channel: int = 0) -> ExampleSet:
    """Return the states of the specimen that has most of them, at its first operating point.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    channel : int
        Position of the channel.
    """
    chosen = _example_rows(dataset)
    found = dataset.channels[channel]
    records = [one_recording(dataset, row["record_id"]) for row in sorted(chosen, key=lambda row: row["state_id"])]
    first, train = records[0].labels, meshes_of(records[0].train)
    return ExampleSet(
        examples=tuple(_example(record, found.name) for record in records),
        specimen_id=int(first["specimen_id"]),
        channel=found.name,
        quantity=found.quantity,
        unit=found.shown_unit,
        speed_hz=float(first["speed_hz"]),
        torque_nm=float(first["torque_nm"]),
        teeth=train[0].teeth,
        fs_hz=dataset.fs_hz,
        train=train,
        mesh=train[0],
    )


def around_mesh(examples: ExampleSet, mesh: GearMesh) -> ExampleSet:
    """Return examples with the teeth, the speed and the orders of a mesh's own driver."""
    turns = float(mesh.turns)
    shown = [
        example
        if example.spectrum is None
        else replace(
            example,
            spectrum=replace(
                example.spectrum,
                order=example.spectrum.order / turns,
                revolutions=max(1, int(example.spectrum.revolutions * turns)),
            ),
        )
        for example in examples.examples
    ]
    return replace(examples, examples=tuple(shown), speed_hz=examples.speed_hz * turns, teeth=mesh.teeth, mesh=mesh)


def _example(record: Recording, channel: str) -> Example:
    signal, tacho_s, teeth = record.channels[channel], record.tacho_s, record.teeth[0]
    spectrum = order_spectrum(signal, tacho_s, record.fs_hz, teeth) if len(tacho_s) > 1 else None
    labels = record.labels
    return Example(int(labels["record_id"]), labels["state"], labels["fault"], signal, tacho_s, spectrum)


def _example_rows(dataset: Dataset) -> list[dict[str, Any]]:
    columns = ["record_id", "specimen_id", "state", "state_id", "operating_point_id", "repeat", "fault"]
    groups: dict[tuple[int, int], list[dict[str, Any]]] = {}
    for row in dataset.labels(columns=columns).to_pylist():
        if row["repeat"] == 0:
            groups.setdefault((row["operating_point_id"], row["specimen_id"]), []).append(row)
    _, chosen = max(groups.items(), key=lambda item: (len(item[1]), -item[0][0], -item[0][1]))
    return chosen


def reported_gearboxes(dataset: Dataset) -> list[int]:
    """Return the gearboxes to which a report leads: those of its figures, then those of the test split."""
    table = dataset.labels(columns=["specimen_id", "split"]).to_pylist()
    tested = sorted({int(row["specimen_id"]) for row in table if row["split"] == TEST})
    # the stiffness curves are of gearbox 0
    return list(dict.fromkeys([int(_example_rows(dataset)[0]["specimen_id"]), 0, *tested]))
