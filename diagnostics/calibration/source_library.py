"""SourceLibrary: what bearing forces healthy gearboxes of a configuration have at their mesh lines, by simulation."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

import siggen
from diagnostics.calibration.order_record import LINE_BINS, LineGroup, turns_of
from diagnostics.calibration.path_draws import number_limits
from diagnostics.calibration.rig import CalibratedRig
from siggen.errors import SolverFailure, UsageError

SPEED_MARGIN = 1.02
"""What the speed may vary by within a record."""
CARRIED_SHARE, SIDEBANDS = 0.39, 8
"""Of the sampling rate, and orders beside a mesh line: what a configuration asks its rate to carry."""


@dataclass(frozen=True, slots=True)
class SourceLibrary:
    """Energies of all directions of force at the groups of lines.

    Attributes
    ----------
    groups : tuple of LineGroup
    energy_n2 : (gearboxes, groups, forces, forces) float64
        w G w is the mean square of the force w F at the lines of a group, mean over its lines.
    """

    groups: tuple[LineGroup, ...]
    energy_n2: np.ndarray

    def level_db(self, direction: np.ndarray, gearboxes: np.ndarray) -> np.ndarray:
        """Return the mean over gearboxes (indices) of the level of w F at every group, (groups,) [dB re 1 N²]."""
        energy = np.einsum("i,ngij,j->ng", direction, self.energy_n2[gearboxes], direction)
        return np.asarray(10.0 * np.log10(np.maximum(energy, 1e-30)).mean(axis=0))


def force_columns(rig: CalibratedRig) -> list[str]:
    """Return what internals call the bearing forces of a rig."""
    return [f"bearing_force_{force}_n" for force in rig.forces_in_columns]


def source_library(
    rig: CalibratedRig,
    operating_point: dict[str, Any],
    fs_hz: float,
    groups: tuple[LineGroup, ...],
    gearboxes: int,
    advance: Callable[[], None],
) -> SourceLibrary:
    """Return the library: one healthy record of every gearbox, at the recordings' speed.

    Parameters
    ----------
    rig : Rig
    operating_point : dict
        As in a configuration: speed and torque.
    fs_hz : float
        Sampling rate of the recordings.
    groups : tuple of LineGroup
    gearboxes : int
        How many are drawn.
    advance : callable
        Told of every gearbox.

    Raises
    ------
    UsageError
        If no gearbox could be simulated.
    """
    config = siggen.load_config(library_configuration(rig, operating_point, fs_hz))
    found = []
    for number in range(gearboxes):
        with suppress(SolverFailure):
            found.append(_energies(siggen.run(siggen.draw(config, number)), force_columns(rig), fs_hz, groups))
        advance()
    if not found:
        raise UsageError(f"{rig.file}: none of {gearboxes} gearboxes could be simulated; see siggen plan {rig.file}")
    return SourceLibrary(groups, np.array(found))


def library_configuration(rig: CalibratedRig, operating_point: dict[str, Any], fs_hz: float) -> dict[str, Any]:
    """Return a configuration of healthy gearboxes whose bearing forces are kept, without background and paths."""
    place = rig.forces[0].split("/")[0]
    return {
        **at_recordings(rig, operating_point, fs_hz),
        "background": None,
        "sensors": {"bearing": {"place": place, "bits": None, "range_m_s2": 1e6}},
        "internals": {"quantities": force_columns(rig)},
    }


def at_recordings(rig: CalibratedRig, operating_point: dict[str, Any], fs_hz: float) -> dict[str, Any]:
    """Return a configuration of healthy gearboxes of a rig at the speed, torque and rate of recordings."""
    return {
        "extends": str(rig.file.resolve()) if rig.file.is_file() else str(rig.file),
        "name": "sources",
        **sampled_as(rig, operating_point, fs_hz),
        "repeats": 1,
        "states": {"healthy": {}},
        "operating_points": [operating_point],
    }


def sampled_as(rig: CalibratedRig, operating_point: dict[str, Any], fs_hz: float) -> dict[str, Any]:
    """Return the keys of a rig's configuration at another sampling rate: no more mesh harmonics than it carries."""
    speed_hz = SPEED_MARGIN * number_limits(operating_point["speed_hz"])[1]
    teeth = max(mesh.order for mesh in rig.drive.meshes)
    carried = int((CARRIED_SHARE * fs_hz / speed_hz - SIDEBANDS) / teeth)
    samples = round(rig.config["duration_s"] * fs_hz)
    return {
        "fs_hz": fs_hz,
        "duration_s": samples / fs_hz,
        "mesh_harmonics": max(1, min(carried, rig.config["mesh_harmonics"])),
    }


def _energies(record: siggen.Record, forces: list[str], fs_hz: float, groups: tuple[LineGroup, ...]) -> np.ndarray:
    """Return (groups, forces, forces) of one record."""
    from scipy import fft

    turns = [turns_of(record.truth[name], fs_hz, record.tacho_s) for name in forces]
    flat = np.stack([one.ravel() - one.mean() for one in turns])
    hann = np.hanning(flat.shape[1])
    spectra = fft.rfft(flat * hann, axis=1) * np.sqrt(2.0 / (flat.shape[1] * float(np.square(hann).sum())))
    return np.array([_group_energy(spectra, turns[0].shape[0], group) for group in groups])


def _group_energy(spectra: np.ndarray, revolutions: int, group: LineGroup) -> np.ndarray:
    total = np.zeros((len(spectra), len(spectra)))
    for order in group.orders:
        centre = round(order * revolutions)
        near = spectra[:, centre - LINE_BINS : centre + LINE_BINS + 1]
        total += (near @ near.conj().T).real
    return total / len(group.orders)
