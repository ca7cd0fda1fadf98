"""What the masses of sensors do to the motions that they measure.

The accelerance of a place is that of the gearbox linearised about its mean mesh, bearings and gears included: what a
force on it moves there, through the modes that move with the gears and those beyond, as for other forces on a housing
(`siggen.specimen.background`). Directions are those along which the model moves there. A sensor loads its own place
alone; bearing forces and other sensors do not feel it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config
from siggen.dynamics.structure.forced_motion import forced_motion
from siggen.dynamics.structure.structure import Structure
from siggen.keys.number import at
from siggen.planning.specimen import Specimen
from siggen.seeding import Stage, named_uniforms
from siggen.sensing.inputs import MOTION, Input, Weight
from siggen.sensing.mass_loading import mass_loading
from siggen.sensors.sensor import Sensor
from siggen.specimen.background import mean_meshes
from siggen.specimen.forced_ways import BLOCK
from siggen.specimen.specimen_housing import SpecimenHousing
from siggen.specimen.structure import linear_structure


@dataclass(frozen=True, slots=True)
class Loading:
    """Motions (d,) of the place of a sensor, and what they are with its mass over those without, (d, d, k)."""

    names: tuple[str, ...]
    factors: ComplexArray

    def weights(self, shown: Mapping[Input, float]) -> dict[Input, Weight]:
        """Return what shows these motions with the mass by those without; what the model has not stays away."""
        total = np.zeros_like(self.factors[0])
        for one, weight in shown.items():
            if one.name in self.names:
                total += weight * self.factors[self.names.index(one.name)]
        return {Input(MOTION, name): row for name, row in zip(self.names, total, strict=True)}


def sensor_loading(
    config: Config,
    specimen: Specimen,
    housing: SpecimenHousing | None,
    sensor: Sensor,
    frequency_hz: FloatArray,
) -> Loading | None:
    """Return what the mass of a sensor does to its place at frequencies (k,); None for a sensor without one."""
    uniform = named_uniforms(config.seed, Stage.SENSOR, specimen.specimen_id)
    mass_kg = 1e-3 * at(sensor.added_mass_g, uniform(f"sensors.{sensor.name}.mass_g"))
    if mass_kg == 0.0:
        return None
    assembled, _ = linear_structure(config, specimen)
    (place,) = {_place(one.name) for one in sensor.shown_inputs}
    names = tuple(name for name in (assembled if housing is None else housing).motions if _place(name) == place)
    return Loading(names, mass_loading(_accelerance(specimen, assembled, housing, names, frequency_hz), mass_kg))


def _place(motion: str) -> str:
    return motion.rpartition("/")[0]


def _accelerance(
    specimen: Specimen,
    assembled: Structure,
    housing: SpecimenHousing | None,
    names: tuple[str, ...],
    frequency_hz: FloatArray,
) -> ComplexArray:
    """Return the accelerance (d, d, k) of a place, from forces to motions along its directions."""
    meshes = mean_meshes(specimen, assembled)
    rows = np.array([assembled.motions[name] for name in names])
    result = np.empty((len(names), len(names), frequency_hz.size), dtype=np.complex128)
    for first in range(0, frequency_hz.size, BLOCK):
        block = slice(first, first + BLOCK)
        forced = forced_motion(assembled, meshes, rows, names, frequency_hz[block])
        for i, name in enumerate(names):
            result[i, :, block] = forced.acceleration[name]
            if housing is not None:
                beyond = slice(housing.coupled, None)
                direct = housing.accelerance(
                    housing.motions[name], (*housing.forces, *names), frequency_hz[block], beyond
                )
                result[i, :, block] += direct[len(housing.forces) :]
                for seat, row in zip(housing.forces, direct, strict=False):
                    result[i, :, block] += row * forced.bearing_force[seat]
    return result
