"""Broadband noise on the bearing forces of one record, which shake its housing."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, ForceNoise
from siggen.keys.number import at
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen, draw_operating_point
from siggen.record.background_course import noise_levels
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.specimen.drive import record_owner
from siggen.specimen.gears import gear_pair


class DrawnForceNoise(NamedTuple):
    """Density [N/√Hz] of the noise of every bearing force, corner of its roll-off (None: white), and labels."""

    density: float
    corner_hz: float | None
    labels: dict[str, object]

    def roll_off(self, frequency_hz: FloatArray) -> FloatArray:
        """Return the factor (k,) on the amplitude: first-order low-pass, 1 if it is white."""
        over = 0.0 if self.corner_hz is None else frequency_hz / self.corner_hz
        return np.asarray(1.0 / np.hypot(1.0, over))


def force_noise(config: Config, specimen: Specimen, record: PlannedRecord) -> DrawnForceNoise:
    """Return the noise of one record's bearing forces; of density 0 without the section."""
    noise = None if config.housing is None else config.housing.force_noise
    if noise is None:
        return DrawnForceNoise(0.0, None, {})
    owner = record_owner(record)
    level = _levels(config, record, owner)
    density = _density(config, noise, specimen, owner, level)
    corner_hz = None if noise.corner_hz is None else at(noise.corner_hz, level("corner_hz"))
    return DrawnForceNoise(density, corner_hz, {"force_noise_n_per_sqrt_hz": density})


def force_generator(config: Config, record: PlannedRecord, name: str) -> np.random.Generator:
    """Return the generator of the noise of one force."""
    return named_generator(config.seed, Stage.FORCE_NOISE, *record_owner(record), name=name)


def _levels(config: Config, record: PlannedRecord, owner: tuple[int, ...]) -> Callable[[str], float]:
    """Return key -> uniform of the noise's level: of the gearbox with `background`, else of the record."""
    of_gearbox = noise_levels(config, record)
    if of_gearbox is None:
        return named_uniforms(config.seed, Stage.FORCE_NOISE, *owner)
    return lambda key: of_gearbox(f"housing.force_noise.{key}")


def _density(
    config: Config, noise: ForceNoise, specimen: Specimen, owner: tuple[int, ...], level: Callable[[str], float]
) -> float:
    """Return the density [N/√Hz] from torque and base radius, never from the record: no state may show in it."""
    torque_nm = draw_operating_point(config, owner[0], owner[2]).torque_nm
    mesh_force_n = torque_nm / gear_pair(specimen.gears).pinion.base_radius_m
    share = at(noise.share_per_sqrt_hz, level("share_per_sqrt_hz"))
    return hypot(at(noise.density_n_per_sqrt_hz, level("density_n_per_sqrt_hz")), share * mesh_force_n)
