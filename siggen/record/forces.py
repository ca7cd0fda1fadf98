"""The forces of one record that shake its housing: those of the bearings, with broadband noise on each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray
from siggen.config import Config, ForceNoise, at
from siggen.dynamics.time.response import Response
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen, draw_operating_point
from siggen.record.background_course import noise_levels
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensing.noise_spectrum import noise_spectrum
from siggen.sensing.spectral_filter import frequencies, record_spectrum
from siggen.specimen.gears import gear_pair
from siggen.specimen.instrument import Instrument
from siggen.specimen.measured_path import INPUTS


@dataclass(frozen=True, slots=True)
class RecordForces:
    """Spectra (k,) of the bearing forces `INPUTS`, noise included; none where no sensor has a path; and labels."""

    spectra: tuple[ComplexArray, ...]
    labels: dict[str, object]


def record_forces(
    config: Config, specimen: Specimen, record: PlannedRecord, response: Response, instrument: Instrument
) -> RecordForces:
    """Return the forces of one record; all sensors see the same ones."""
    owner = (record.specimen_id, record.state_id, record.operating_point_id, record.repeat)
    noise = None if config.housing is None else config.housing.force_noise
    level = _levels(config, record, owner)
    density = 0.0 if noise is None else _density(config, noise, specimen, owner, level)
    labels: dict[str, object] = {} if noise is None else {"force_noise_n_per_sqrt_hz": density}
    if not instrument.has_path:
        return RecordForces((), labels)
    rolled_off = _roll_off(config, noise, instrument, level)
    spectra = []
    for name in INPUTS:
        spectrum = record_spectrum(
            response.history.bearing_force_n[name], response.bearing_force_n[name], instrument.length
        )
        if density > 0.0:
            rng = named_generator(config.seed, Stage.FORCE_NOISE, *owner, name=name)
            spectrum += rolled_off * noise_spectrum(density, instrument.length, config.fs_hz, rng)
        spectra.append(spectrum)
    return RecordForces(tuple(spectra), labels)


def _levels(config: Config, record: PlannedRecord, owner: tuple[int, ...]) -> Callable[[str], float]:
    """Return key -> uniform of the noise's level: of the gearbox with `background`, else of the record."""
    of_gearbox = noise_levels(config, record)
    if of_gearbox is None:
        return named_uniforms(config.seed, Stage.FORCE_NOISE, *owner)
    return lambda key: of_gearbox(f"housing.force_noise.{key}")


def _roll_off(
    config: Config, noise: ForceNoise | None, instrument: Instrument, level: Callable[[str], float]
) -> NDArray[np.float64] | float:
    """Return the factor (k,) on the amplitude of the noise: first-order low-pass, 1 if it is white."""
    if noise is None or noise.corner_hz is None:
        return 1.0
    corner_hz = at(noise.corner_hz, level("corner_hz"))
    factor: NDArray[np.float64] = 1.0 / np.hypot(1.0, frequencies(instrument.length, config.fs_hz) / corner_hz)
    return factor


def _density(
    config: Config, noise: ForceNoise, specimen: Specimen, owner: tuple[int, ...], level: Callable[[str], float]
) -> float:
    """Return the density [N/√Hz] from torque and base radius, never from the record: no state may show in it."""
    torque_nm = draw_operating_point(config, owner[0], owner[2]).torque_nm
    mesh_force_n = torque_nm / gear_pair(specimen.gears).pinion.base_radius_m
    share = at(noise.share_per_sqrt_hz, level("share_per_sqrt_hz"))
    return hypot(at(noise.density_n_per_sqrt_hz, level("density_n_per_sqrt_hz")), share * mesh_force_n)
