"""Figures of a report: examples of records by state, spectra, scores."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.of_split import Training
from diagnostics.page.blocks import RecordLinks
from diagnostics.page.style import (
    PASSING,
    SLANTED,
    new_figure,
    sideband_places,
    state_colours,
    state_ticks,
)
from diagnostics.page.tables import records_link, state_links
from diagnostics.records.gear_train import GearMesh, meshes_of
from diagnostics.records.recording import Recording, one_recording
from diagnostics.records.state_classes import HEALTHY
from diagnostics.report.classifier_tables import permutation_figure, score_figure
from diagnostics.signal.spectrum import OrderSpectrum, order_spectrum, strongest_harmonic
from diagnostics.training.splits import TEST
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    return list(dict.fromkeys([int(_example_rows(dataset)[0]["specimen_id"]), *tested]))


DASHES = ("-", "--", "-.", ":")
"""Lines that lie on each other or are printed without colour are told apart by their dashes."""
LOSSES = {
    "mesh_stiffness_loss_as_simulated": "force over approach at rest and at the record's torque, as simulated",
    "mesh_stiffness_loss": "by potential energy, where a contact that loses its whole length carries nothing",
}
"""What the labels of a set say about the loss of mesh stiffness, the better one first."""


def loss_of_specimens(dataset: Dataset) -> tuple[dict[str, np.ndarray], str]:
    """Return state -> largest loss of each of its specimens, and what this loss is, from the labels of a set.

    The loss as simulated depends on the torque: of the records of a specimen and state the largest one counts.
    """
    named = set(dataset.labels().column_names)
    name = next(name for name in LOSSES if name in named)
    table = dataset.labels(columns=["state", "specimen_id", name])
    largest = table.group_by(["state", "specimen_id"], use_threads=False).aggregate([(name, "max")]).to_pydict()
    states, losses = np.array(largest["state"]), np.array(largest[f"{name}_max"])
    return {state: losses[states == state] for state in dict.fromkeys(largest["state"])}, LOSSES[name]


def stiffness_loss_figure(
    losses: Mapping[str, np.ndarray], classes: tuple[str, ...], colours: dict[str, str]
) -> Figure:
    """Return the largest relative loss of mesh stiffness, a dot per specimen, over the states."""
    figure, axes = new_figure(height_in=2.8 if len(classes) < SLANTED else 3.4)
    axis = axes[0, 0]
    for position, state in enumerate(classes):
        loss = 100.0 * losses[state]
        spread = 0.5 * (np.arange(loss.size) / max(loss.size - 1, 1) - 0.5)
        axis.plot(position + spread, loss, linestyle="none", marker="o", markersize=4, alpha=0.7, color=colours[state])
    state_ticks(axis, classes)
    axis.set_xlabel("State (one dot per specimen)")
    axis.set_ylabel("Largest stiffness loss [%]")
    axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]))
    return figure


@dataclass(slots=True)
class Drawing:
    """Figures with captions by file name, by section of the report; notes on what is missing; links to records."""

    damage: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    scores: dict[str, tuple[Figure, str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    behind: dict[str, RecordLinks] = field(default_factory=dict)

    def figures(self) -> dict[str, tuple[Figure, str]]:
        """Return all figures by file name."""
        return {**self.damage, **self.scores}


def draw(
    dataset: Dataset,
    matrix: FeatureMatrix,
    classes: tuple[str, ...],
    training: Training | None,
) -> Drawing:
    """Draw what the report shows of damage and scores; figures lead to records, whose signals the page draws itself."""
    healthy = {state for state in classes if (matrix.labels["fault"][matrix.labels["state"] == state] == HEALTHY).all()}
    colours = state_colours(classes, healthy)
    drawing = Drawing()
    _draw_damage(drawing, dataset, classes, colours)
    if training:
        _draw_scores(drawing, training)
    return drawing


def strongest(spectrum: OrderSpectrum, mesh: GearMesh) -> int:
    """Return the mesh harmonic with the largest line, of a planetary set where passing planets move it to."""
    teeth = mesh.teeth[0]
    if mesh.planets is None:
        return strongest_harmonic(spectrum, teeth)
    harmonics = range(1, int(spectrum.order[-1] / teeth) - 1)
    orders = np.array([h * teeth + sideband_places(mesh, h, 1)[PASSING][0] for h in harmonics])
    return 1 + int(np.argmax(spectrum.amplitude_m_s2[np.searchsorted(spectrum.order, orders)]))


def _draw_damage(drawing: Drawing, dataset: Dataset, classes: tuple[str, ...], colours: dict[str, str]) -> None:
    losses, meaning = loss_of_specimens(dataset)
    figure = stiffness_loss_figure(losses, classes, colours)
    caption = f"Largest relative loss of mesh stiffness against healthy, from the labels: {meaning}."
    drawing.damage["stiffness_loss"] = (figure, caption)
    drawing.behind["stiffness_loss"] = RecordLinks("Records", state_links(classes))


def _draw_scores(drawing: Drawing, training: Training) -> None:
    specimens = training.judged[0].scores.specimens
    caption = f"Scores on {specimens} test specimens, with 95 % intervals from resampled specimens. Dashed: chance."
    drawing.scores["scores"] = (score_figure(training), caption)
    named = {f"{said} named": records_link(split="test", named=said) for said in ("wrongly", "rightly")}
    drawing.behind["scores"] = RecordLinks("Test records", named)
    caption = "Permutation control: training with shuffled labels (dots) must give values around 0.5."
    if any(np.isfinite(judged.permuted_auroc).any() for judged in training.judged):
        drawing.scores["permuted"] = (permutation_figure(training), caption)
