"""Figures of what the damage does to the mesh: stiffness curves of one specimen, and the loss over all specimens."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.page.style import SLANTED, new_figure, state_ticks
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DASHES = ("-", "--", "-.", ":")
"""Lines that lie on each other or are printed without colour are told apart by their dashes."""
LOSSES = {
    "mesh_stiffness_loss_as_simulated": "force over approach at rest and at the record's torque, as simulated",
    "mesh_stiffness_loss": "by potential energy, where a contact that loses its whole length carries nothing",
}
"""What the labels of a set say about the loss of mesh stiffness, the better one first."""


def stiffness_figure(curves: Mapping[str, tuple[np.ndarray, np.ndarray]], colours: dict[str, str]) -> Figure:
    """Return mesh stiffness over the pinion's angle, all states in one frame.

    Parameters
    ----------
    curves : mapping of state to (angle_deg (k,), stiffness_n_per_m (k,))
        What `siggen.mesh_stiffness_curves` returns.
    colours : dict of str
        Colour by state.
    """
    figure, axes = new_figure(height_in=3.4)
    axis = axes[0, 0]
    for place, (state, (angle_deg, stiffness_n_per_m)) in enumerate(curves.items()):
        style = {"color": colours.get(state), "linestyle": DASHES[place % len(DASHES)], "linewidth": 1.2}
        axis.plot(angle_deg, 1e-6 * np.asarray(stiffness_n_per_m), label=state, **style)
    axis.set_xlabel("Pinion angle [°]")
    axis.set_ylabel("Mesh stiffness [N/µm]")
    axis.margins(x=0.01)
    figure.legend(loc="outside upper center", ncols=min(len(curves), 3), fontsize=9)
    return figure


def loss_of_specimens(dataset: Dataset) -> tuple[dict[str, np.ndarray], str]:
    """Return state -> largest loss of each of its specimens, and what this loss is, from the labels of a set.

    Sets of schema version 1 have the loss by potential energy alone. The loss as simulated depends on the torque: of
    the records of a specimen and state the largest one counts.
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
