"""Transfer paths of one specimen as curves over frequency, with the mesh harmonics they will meet."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.makers import RING_TURNING
from siggen.errors import UsageError
from siggen.gearbox.specimen import Specimen
from siggen.record.housing import SpecimenHousing, specimen_housing
from siggen.record.instrument import ChannelInstrument, settle_s, specimen_instrument
from siggen.sensing.filters import frequencies
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FILE_NUMBERS = 150_000
"""Of one sensor in a table that shall be read again: two sensors fit into the configuration of a set."""
MODES_PER_MEMORY = 0.8
"""Frequency step times the time over which modes settle: half that time, e^-7 of the energy is left (as is allowed)."""


@dataclass(frozen=True, slots=True)
class PathCurves:
    """Channels with a path over frequencies (k,), modes of the housing, by operating point mesh frequencies [Hz]."""

    specimen_id: int
    frequency_hz: FloatArray
    channels: tuple[ChannelInstrument, ...]
    housing: SpecimenHousing | None
    mesh_hz: tuple[tuple[float, ...], ...]
    mesh_harmonics: int
    memory_s: float = 0.0

    @property
    def table(self) -> pa.Table:
        """One row per frequency, two columns per channel and bearing force."""
        step = self._step
        columns = {"frequency_hz": self.frequency_hz[::step]}
        for channel in self.channels:
            for name, curve in zip(channel.forces, _rows(channel), strict=True):
                stem = f"{channel.name}_from_{'_'.join(name.split('/'))}"
                unit = "m_s2_per_nm" if name == RING_TURNING else "m_s2_per_n"
                columns |= {f"{stem}_real_{unit}": curve.real[::step], f"{stem}_imag_{unit}": curve.imag[::step]}
        return pa.table(columns)

    @property
    def _step(self) -> int:
        """Rows that are left out between two: as few as make a file that can be read again, as many as modes allow."""
        of_sensors = Counter(channel.drawn.sensor for channel in self.channels)
        widest = max(len(channel.forces) * of_sensors[channel.drawn.sensor] for channel in self.channels)
        numbers = self.frequency_hz.size * (1 + 2 * widest)
        wide = MODES_PER_MEMORY / max(self.memory_s, 1e-9) / (self.frequency_hz[1] - self.frequency_hz[0])
        return max(min(-(-numbers // FILE_NUMBERS), int(wide)), 1)

    def peak(self, channel: ChannelInstrument) -> tuple[float, float]:
        """Return the largest accelerance [m/s²/N] from any bearing force, and its frequency [Hz]."""
        forces = [name != RING_TURNING for name in channel.forces]  # the ring's moment is none
        largest = np.abs(_rows(channel)[forces]).max(axis=0)
        place = int(largest.argmax())
        return float(largest[place]), float(self.frequency_hz[place])


def path_curves(specimen: Specimen, mesh_harmonics: int) -> PathCurves:
    """Return the transfer paths of one specimen, with so many lines of each mesh.

    Raises
    ------
    UsageError
        If no sensor has a path.
    """
    instrument = specimen_instrument(specimen)
    channels = tuple(channel for channel in instrument.channels if channel.accelerance is not None)
    if not channels:
        raise UsageError(
            "no sensor stands on a housing that gives way or has a measured path: dynamics.model: casing has one"
        )
    housing = specimen_housing(specimen)
    turns = zip(specimen.meshes, specimen.shaft_turns, strict=False)
    meshing = tuple(float(turn * mesh.pair.pinion.teeth) for mesh, turn in turns)
    if specimen.planets is not None:
        meshing = (specimen.planets.teeth.pitches_per_turn,)
    return PathCurves(
        specimen_id=specimen.specimen_id,
        frequency_hz=frequencies(instrument.length, specimen.sampling.fs_hz),
        channels=channels,
        housing=housing if any(c.path_modes for c in channels) else None,
        mesh_hz=tuple(tuple(point.speed_hz * teeth for teeth in meshing) for point in specimen.points),
        mesh_harmonics=mesh_harmonics,
        memory_s=settle_s(specimen),
    )


def _rows(channel: ChannelInstrument) -> NDArray[np.complex128]:
    assert channel.accelerance is not None
    return channel.accelerance


# The picture of `siggen inspect path`: accelerance of every channel over frequency, mesh harmonics marked.

LOWEST_HZ = 50.0
POINT_COLOURS = ("C3", "C5", "tab:purple", "tab:brown", "tab:olive")


def path_figure(found: PathCurves) -> Figure:
    """Return the figure: one panel per channel, one curve per bearing force."""
    from matplotlib.figure import Figure

    count = len(found.channels)
    figure = Figure(figsize=(9.0, 2.0 * count + 1.2), layout="constrained")
    panels = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    shown = found.frequency_hz >= LOWEST_HZ
    for panel, channel in zip(panels, found.channels, strict=True):
        for name, row in zip(channel.forces, channel.accelerance, strict=True):  # type: ignore[arg-type]
            if name == RING_TURNING:  # per N m
                continue
            label = ", ".join(name.split("/"))
            panel.loglog(found.frequency_hz[shown], np.abs(row[shown]), lw=0.9, label=label)
        panel.set_title(channel.name, loc="left", fontsize="medium")
        panel.grid(alpha=0.3)
        _mark_mesh(panel, found)
    peak = max(found.peak(channel)[0] for channel in found.channels)
    panels[0].set_ylim(1e-5 * peak, 2.0 * peak)
    panels[0].set_xlim(LOWEST_HZ, found.frequency_hz[-1])
    panels[0].legend(ncols=4, fontsize="small", loc="lower right")
    panels[-1].set_xlabel("frequency [Hz]; dotted: mesh harmonics of each operating point")
    figure.supylabel("accelerance [m/s² per N]")
    return figure


def _mark_mesh(panel: Axes, found: PathCurves) -> None:
    for colour, meshes in zip(POINT_COLOURS, found.mesh_hz, strict=False):
        for mesh_hz, harmonic in product(meshes, range(1, found.mesh_harmonics + 1)):
            panel.axvline(harmonic * mesh_hz, color=colour, lw=0.6, ls=":", zorder=0)


def save_path_figure(found: PathCurves, path: Path) -> None:
    """Draw the paths into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: path_figure(found), path)
