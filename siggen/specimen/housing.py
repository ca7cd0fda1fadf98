"""The housing of one specimen: its flexible modes, and their shapes at bearings and sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Housing
from siggen.keys.number import at
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensing.modal_path import HousingModes, housing_modes, mode_shape
from siggen.sensors.sensor import Sensor


@dataclass(frozen=True, slots=True)
class SpecimenHousing:
    """Modes of one housing and their shapes (modes,) at the places where forces act or sensors stand."""

    seed: int
    specimen_id: int
    modes: HousingModes

    def shape_at(self, place: str) -> FloatArray:
        """Return the shapes of all modes at a named place and direction; other places never shift them."""
        rng = named_generator(self.seed, Stage.PATH, self.specimen_id, name=f"shape {place}")
        return mode_shape(self.modes.frequency_hz.size, rng)

    def at_bearings(self, inputs: Sequence[str]) -> FloatArray:
        """Return the shapes (inputs, modes) where the bearing forces `inputs` (place/direction) act."""
        return np.array([self.shape_at(place) for place in inputs])

    def at_sensor(self, sensor: Sensor, direction: str) -> FloatArray:
        """Return the shapes (modes,) at a sensor along a direction."""
        return self.shape_at(f"sensors.{sensor.name}/{direction}")


def specimen_housing(config: Config, specimen_id: int) -> SpecimenHousing | None:
    """Return the housing of one specimen; the same for all its states, operating points and sensors."""
    section = config.housing
    if section is None:
        return None
    return SpecimenHousing(
        config.seed, specimen_id, _modes(config.seed, section, specimen_id, _casing_kg(config, specimen_id))
    )


def _casing_kg(config: Config, specimen_id: int) -> float:
    """Return the drawn mass of the casing, the same as that of the moving one."""
    key = "dynamics.casing.mass_kg"
    return at(config.dynamics.casing.mass_kg, named_uniforms(config.seed, Stage.SUPPORTS, specimen_id)(key))


def _modes(seed: int, section: Housing, specimen_id: int, casing_kg: float) -> HousingModes:
    def uniforms(name: str, count: int) -> FloatArray:
        return named_generator(seed, Stage.PATH, specimen_id, name=f"housing.{name}").random(count)

    count = max(1, round(at(section.modes, uniforms("modes", 1)[0])))
    # One mode per equal share of the distribution: natural frequencies of one body repel each other.
    shares = (np.arange(count) + uniforms("frequency_hz", count)) / count
    own = float(uniforms("modal_mass_kg", 1)[0])
    return housing_modes(
        np.sort([at(section.frequency_hz, float(u)) for u in shares]),
        np.array([at(section.damping_ratio, float(u)) for u in uniforms("damping_ratio", count)]),
        lowest_mass_kg=casing_kg if section.modal_mass_kg is None else at(section.modal_mass_kg, own),
        exponent=section.residue_exponent,
    )
