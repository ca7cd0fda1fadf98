"""SourceLibrary: what bearing forces healthy gearboxes of a configuration have at their mesh lines, by simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.calibration.order_record import LINE_BINS, LineGroup, turns_of
from siggen.errors import UsageError

PLACES = tuple((place, axis) for place in ("pinion_bearing", "gear_bearing") for axis in ("vertical", "horizontal"))
FORCES = tuple(f"bearing_force_{place}_{axis}_n" for place, axis in PLACES)


@dataclass(frozen=True, slots=True)
class SourceLibrary:
    """Energies of all directions of force at the groups of lines.

    Attributes
    ----------
    groups : tuple of LineGroup
    energy_n2 : (gearboxes, groups, 4, 4) float64
        w G w is the mean square of the force w F at the lines of a group, mean over its lines.
    """

    groups: tuple[LineGroup, ...]
    energy_n2: np.ndarray

    def level_db(self, direction: np.ndarray, gearboxes: np.ndarray) -> np.ndarray:
        """Return the mean over gearboxes (indices) of the level of w F at every group, (groups,) [dB re 1 N²]."""
        energy = np.einsum("i,ngij,j->ng", direction, self.energy_n2[gearboxes], direction)
        return np.asarray(10.0 * np.log10(np.maximum(energy, 1e-30)).mean(axis=0))


def source_library(
    rig: Path,
    operating_point: dict[str, Any],
    fs_hz: float,
    groups: tuple[LineGroup, ...],
    gearboxes: int,
    advance: Callable[[], None],
) -> SourceLibrary:
    """Return the library: one healthy record of every gearbox, at the recordings' speed.

    Parameters
    ----------
    rig : Path
        Configuration of the machine.
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
        If the model has no bearings, or no gearbox could be simulated.
    """
    config = siggen.load_config(library_configuration(rig, operating_point, fs_hz))
    found = []
    for number in range(gearboxes):
        record = siggen.simulate(config, [number])[0]
        advance()
        if hasattr(record, "channels"):
            found.append(_energies(record, fs_hz, groups))
    if not found:
        raise UsageError(f"{rig}: none of {gearboxes} gearboxes could be simulated; see siggen plan {rig}")
    return SourceLibrary(groups, np.array(found))


def library_configuration(rig: Path, operating_point: dict[str, Any], fs_hz: float) -> dict[str, Any]:
    """Return a configuration of healthy gearboxes whose bearing forces are kept, without background and paths."""
    return {
        **at_recordings(rig, operating_point, fs_hz),
        "background": None,
        "sensors": [{"name": "bearing", "place": "pinion_bearing", "bits": None, "range_m_s2": 1e6}],
        "internals": {"quantities": list(FORCES)},
    }


def at_recordings(rig: Path, operating_point: dict[str, Any], fs_hz: float) -> dict[str, Any]:
    """Return a configuration of healthy gearboxes of a rig at the speed, torque and rate of recordings."""
    return {
        "extends": str(rig.resolve()) if rig.is_file() else str(rig),
        "name": "sources",
        "fs_hz": fs_hz,
        "repeats": 1,
        "states": [{"name": "healthy"}],
        "operating_points": [operating_point],
    }


def _energies(record: Any, fs_hz: float, groups: tuple[LineGroup, ...]) -> np.ndarray:
    """Return (groups, 4, 4) of one record."""
    from scipy import fft

    pulses = np.asarray(record.tacho_s)
    turns = [turns_of(record.internals[name].astype(np.float64), fs_hz, pulses) for name in FORCES]
    flat = np.stack([one.ravel() - one.mean() for one in turns])
    hann = np.hanning(flat.shape[1])
    spectra = fft.rfft(flat * hann, axis=1) * np.sqrt(2.0 / (flat.shape[1] * float(np.square(hann).sum())))
    return np.array([_group_energy(spectra, turns[0].shape[0], group) for group in groups])


def _group_energy(spectra: np.ndarray, revolutions: int, group: LineGroup) -> np.ndarray:
    total = np.zeros((len(FORCES), len(FORCES)))
    for order in group.orders:
        centre = round(order * revolutions)
        near = spectra[:, centre - LINE_BINS : centre + LINE_BINS + 1]
        total += (near @ near.conj().T).real
    return total / len(group.orders)
