"""Sump: what the temperature of a gearbox's oil follows from at an operating point, where its file gives none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

from siggen.gearbox.specimen import OperatingPoint, PlanetaryGears, Specimen
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import Uniforms, draw
from siggen.keys.number import Number, Within, constant
from siggen.keys.section import Section
from siggen.mesh.oil import MINERAL_OILS
from siggen.mesh.oil_temperature import MeshAtWork, ShaftAtWork, loss_w, sump_c
from siggen.names import Side


class SumpNumbers(Section):
    """What no file sets of it, drawn for every gearbox (assumed): the air of a hall, and how long it has run.

    Oil warms for an hour or more, so that a record has one temperature.
    """

    air_temperature_c: Annotated[Number, Within()] = Uniform(low=15.0, high=30.0)
    warm_share: Annotated[Number, Within()] = Uniform(low=0.3, high=1.0)


@dataclass(frozen=True, slots=True)
class Sump:
    """Oil of a gearbox whose losses leave through its walls.

    Attributes
    ----------
    gearbox : with oil of any temperature
    air_c : of the air around [°C]
    warm_share : of the rise that is there since the start
    area_m2 : of the walls
    """

    gearbox: Specimen
    air_c: float
    warm_share: float
    area_m2: float

    @classmethod
    def drawn(cls, gearbox: Specimen, area_m2: float, uniform: Uniforms) -> Sump:
        """Return that of a gearbox by the uniforms of its supports."""
        numbers = draw(SumpNumbers(), uniform, "dynamics.friction")
        return cls(gearbox, constant(numbers.air_temperature_c), constant(numbers.warm_share), area_m2)

    def __call__(self, point: OperatingPoint) -> float:
        """Return the temperature of the oil at an operating point [°C]."""
        oil = MINERAL_OILS[self.gearbox.law.friction.oil]
        meshes, shafts = at_work(self.gearbox, point)
        return sump_c(lambda at_c: loss_w(meshes, shafts, oil, at_c), self.air_c, self.area_m2, self.warm_share)


def at_work(specimen: Specimen, point: OperatingPoint) -> tuple[Sequence[MeshAtWork], Sequence[ShaftAtWork]]:
    """Return all meshes and shafts of a gearbox at an operating point."""
    roughness_m = specimen.law.friction.roughness_m
    if specimen.planets is not None:
        return _of_set(specimen.planets, point, roughness_m)
    turns = [float(one) for one in specimen.shaft_turns]
    force_n = [
        abs(point.torque_nm / turning) / mesh.pair.pinion.base_radius_m
        for turning, mesh in zip(turns, specimen.meshes, strict=False)
    ]
    meshes = [
        MeshAtWork(mesh.pair, point.speed_hz * turning, force, roughness_m)
        for turning, mesh, force in zip(turns, specimen.meshes, force_n, strict=False)
    ]
    diameters_m, bearings_m = _shafts_m(specimen)
    ends = {0, len(turns) - 1}
    on_shafts = [first + second for first, second in pairwise((0.0, *force_n, 0.0))]
    shafts = [
        ShaftAtWork(point.speed_hz * turning, bearing, force, diameter if number in ends else 0.0)
        for number, (turning, bearing, force, diameter) in enumerate(
            zip(turns, bearings_m, on_shafts, diameters_m, strict=True)
        )
    ]
    return meshes, shafts


def _shafts_m(specimen: Specimen) -> tuple[list[float], list[float]]:
    """Return the diameters of all shafts of a train, and of the circles in their bearings [m]."""
    train = specimen.train
    assert train is not None
    pairs = [mesh.pair for mesh in specimen.meshes]
    inner = [min(front.gear.bore_radius_m, behind.pinion.bore_radius_m) for front, behind in pairwise(pairs)]
    diameters = [2.0 * bore for bore in (pairs[0].pinion.bore_radius_m, *inner, pairs[-1].gear.bore_radius_m)]
    for number, shaft in enumerate(train.bending or ()):
        diameters[number] = shaft.diameter_m
    bearings = [mean_bearing_m(diameter) for diameter in diameters]
    for side, ball in train.balls:
        bearings[[*Side].index(side)] = ball.pitch_diameter_m
    return diameters, bearings


def mean_bearing_m(bore_m: float) -> float:
    """Return the mean diameter of a ball bearing of series 62 with a bore [m]: outer ring 1.6 d + 12 mm."""
    return 1.3 * bore_m + 6e-3


def _of_set(
    planets: PlanetaryGears, point: OperatingPoint, roughness_m: float
) -> tuple[Sequence[MeshAtWork], Sequence[ShaftAtWork]]:
    """Return the meshes of a planetary set, its sun's shaft and its pins; the carrier turns slowly and is left out."""
    count, one = len(planets.pin_errors_m), planets.of_one_mesh(point)
    force_n = abs(one.torque_nm) / planets.pair.pinion.base_radius_m
    planet_hz = one.speed_hz * planets.teeth.sun / planets.teeth.planet
    sun = MeshAtWork(planets.pair, one.speed_hz, force_n, roughness_m)
    ring = MeshAtWork(planets.ring, planet_hz, force_n, roughness_m)
    sun_m, pin_m = 2.0 * planets.pair.pinion.bore_radius_m, 2.0 * planets.pair.gear.bore_radius_m
    pin = ShaftAtWork(planet_hz, mean_bearing_m(pin_m), 2.0 * force_n, 0.0)
    return [sun, ring] * count, [ShaftAtWork(point.speed_hz, mean_bearing_m(sun_m), 0.0, sun_m), *[pin] * count]
