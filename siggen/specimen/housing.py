"""The housing of one specimen: a box of plates from its geometry, its modes, and where it is pressed and seen.

The box follows from the gears, the shafts and `siggen.planning.housing_numbers`. x runs from gear to pinion and is
horizontal, y is vertical, z runs along the shafts. With `dynamics.shafts` the walls stand where the bearings are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, sin

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config, Shafts
from siggen.dynamics.housing.box import SIDES, Axis, Box, Material, plane_axes
from siggen.dynamics.housing.housing_modes import (
    ALL,
    BEYOND,
    WAVES,
    HousingModes,
    housing_modes,
    mixed_damping,
    resolved_hz,
)
from siggen.dynamics.housing.layout import Contents, Proportions, layout
from siggen.dynamics.housing.motion import Motion, Place, bolt_motions, motion_at, seat_motions
from siggen.dynamics.structure.body import ModalBody, Point
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, at, constant
from siggen.planning.housing_numbers import PlateNumbers
from siggen.planning.specimen import Specimen
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensors.sensor import Sensor
from siggen.specimen.gears import gear_pair

MODES_ON_BOLTS = 6
COUPLED_HZ, MOST = 1500.0, 9
"""Modes below this frequency move with the gears, at least the six on the bolts. With what all others give way in
series with the bearings k_b |R - R_0| stays below 0.5 nearly everywhere (`python -m benchmarks.housing limits`)."""
SETTLED_DECAYS = 7.0
"""Decay times after which a mode has forgotten how it was started: 1e-3 of it is left."""
LONGEST_S = 1.2
AXES = {"horizontal": Axis.X, "vertical": Axis.Y, "axial": Axis.Z}
IRON_PA, STEEL_PA = (90e9, 130e9), 206e9
IRON_KG_M3, STEEL_KG_M3 = (7100.0, 7300.0), 7850.0
IRON_WALL, STEEL_WALL = (1.1, 3.0), (1.5, 4.6)
"""Thickness over 3 mm + 2.5 % of the centre distance, a usual least wall of cast housings (memory)."""
SHAFT_SHARE = 0.26
"""Diameter of a shaft over the centre distance where no shafts are given (assumed)."""
ROOM_BETWEEN_BEARINGS = 0.95
ABOVE_SHARE = 1.0 / 3.0
"""Of the height that the gear leaves, where the height is given (assumed)."""
CLEARANCE_M = 2e-3
EDGE_M = 8e-3
"""Sensors stand at least so far from a plate's edge."""


@dataclass(frozen=True, slots=True)
class SpecimenHousing:
    """A box with its modes.

    Attributes
    ----------
    damping_ratio : (m,)
    coupled : number of modes that move with the gears
    seats, motions, entries : place/axis -> motion of bearings, of sensors, and of where other forces press
    """

    box: Box
    modes: HousingModes
    damping_ratio: FloatArray
    coupled: int
    seats: Mapping[str, Motion]
    motions: Mapping[str, Motion]
    entries: Mapping[str, Motion]

    @property
    def settle_s(self) -> float:
        """Time over which its modes settle [s]."""
        slowest = float((2.0 * pi * self.modes.frequency_hz * self.damping_ratio).min())
        return min(SETTLED_DECAYS / slowest, LONGEST_S)

    @property
    def pairs(self) -> list[tuple[float, float]]:
        """Natural frequencies [Hz] and damping ratios, ascending."""
        return list(zip(self.modes.frequency_hz.tolist(), self.damping_ratio.tolist(), strict=True))

    def seen(self, weights: Mapping[str, float]) -> Motion:
        """Return what a channel sees: motions times factors."""
        (name, weight), *others = weights.items()
        total = Motion(weight * self.motions[name].even, weight * self.motions[name].odd)
        for name, weight in others:
            total = total.plus(self.motions[name], weight)
        return total

    def accelerance(
        self, seen: Motion, inputs: tuple[str, ...], frequency_hz: FloatArray, which: slice = ALL
    ) -> ComplexArray:
        """Return the accelerance (inputs, k) [m/s² per N] from seats or entries, of some of the modes."""
        places = {**self.seats, **self.entries}
        motions = [places[name] for name in inputs]
        return np.asarray(self.modes.accelerance([seen], motions, frequency_hz, self.damping_ratio, which)[0])


def specimen_housing(config: Config, specimen: Specimen) -> SpecimenHousing | None:
    """Return the housing of a specimen; the same for all of its states and records; None for one without plates."""
    numbers = specimen.housing
    if specimen.dynamics.model != "casing" or not isinstance(numbers, PlateNumbers):
        return None
    pair = gear_pair(specimen.gears)
    box, modes = _made(*specimen_layout(numbers, specimen.dynamics.shafts, pair), 0.5 * config.fs_hz)
    rng = named_generator(config.seed, Stage.PATH, specimen.specimen_id, name="housing.damping_ratio")
    plates = np.array([at(numbers.damping_ratio, float(u)) for u in rng.random(modes.frequency_hz.size)])
    below = int((modes.frequency_hz < COUPLED_HZ).sum())
    seats = _seats(box, modes, specimen.dynamics.shafts)
    uniform = named_uniforms(config.seed, Stage.PATH, specimen.specimen_id)
    return SpecimenHousing(
        box=box,
        modes=modes,
        damping_ratio=mixed_damping(modes, plates, constant(numbers.feet.damping_ratio)),
        coupled=min(max(MODES_ON_BOLTS, below), MOST),
        seats={name: motion for name, motion in seats.items() if not name.endswith("axial")},
        motions={**seats, **_sensors(box, modes, specimen.sensors, uniform)},
        entries=_entries(box, modes, seats, pair, uniform),
    )


def coupled_modes(housing: SpecimenHousing) -> ModalBody:
    """Return the modes that move with the gears."""
    modes, n = housing.modes, housing.coupled
    seats = list(housing.seats.values())

    def shapes(motions: Mapping[str, Motion]) -> dict[str, FloatArray]:
        return dict(zip(motions, modes.shapes(list(motions.values()))[:, :n], strict=True)) if motions else {}

    bolts = []
    for bolt in housing.box.bolts:
        place = _from_middle(housing.box, bolt.x_m)
        of_bolt = shapes(bolt_motions(modes.halves, bolt))
        for axis, number in (("horizontal", Axis.X), ("vertical", Axis.Y)):
            for wall in ("front", "back"):
                shape = of_bolt[f"{wall}/{number.name.lower()}"]
                bolts.append((place, axis, bolt.stiffness_n_per_m[number], shape))
    return ModalBody(
        frequency_hz=modes.frequency_hz[:n],
        damping_ratio=housing.damping_ratio[:n],
        seats=shapes(housing.seats),
        motions=shapes(housing.motions),
        entries=shapes(housing.entries),
        bolts=tuple(bolts),
        flexibility_m_per_n=modes.flexibility_beyond(n, seats, seats),
    )


@lru_cache(maxsize=4)  # states and records of a gearbox share them
def _made(
    contents: Contents, proportions: Proportions, material: Material, highest_hz: float
) -> tuple[Box, HousingModes]:
    box = layout(contents, proportions, material)
    return box, housing_modes(box, min(highest_hz, BEYOND * resolved_hz(box)), WAVES)


def specimen_layout(
    numbers: PlateNumbers, shafts: Shafts | None, pair: GearPair
) -> tuple[Contents, Proportions, Material]:
    """Return what the box of a drawn housing is made from."""
    contents = housing_contents(numbers, shafts, pair)
    return contents, _proportions(numbers, shafts, contents), _material(numbers)


def _material(numbers: PlateNumbers) -> Material:
    if numbers.material == "steel":
        return Material(STEEL_PA, 0.3, STEEL_KG_M3)
    return Material(_within(IRON_PA, numbers.modulus), 0.26, _within(IRON_KG_M3, numbers.density))


def housing_contents(numbers: PlateNumbers, shafts: Shafts | None, pair: GearPair) -> Contents:
    """Return what a housing holds; bearings are as large as fit beside each other."""
    centre = pair.working_centre_distance_m
    diameters = [SHAFT_SHARE * centre] * 2
    if shafts is not None:
        diameters = [1e-3 * constant(shaft.diameter_mm) for shaft in (shafts.gear, shafts.pinion)]
    outer = [constant(numbers.bearing) * diameter for diameter in diameters]
    room = min(1.0, 2.0 * ROOM_BETWEEN_BEARINGS * centre / sum(outer))
    return Contents(
        centre_distance_m=centre,
        tip_radius_m=(pair.gear.tip_radius_m, pair.pinion.tip_radius_m),
        face_width_m=pair.face_width_m,
        bearing_outer_m=(room * outer[0], room * outer[1]),
    )


def _proportions(numbers: PlateNumbers, shafts: Shafts | None, contents: Contents) -> Proportions:
    centre, n = contents.centre_distance_m, numbers
    wall, overhang = _wall_m(numbers, centre), constant(numbers.overhang) * centre
    end = max(constant(n.end) * centre, end_for_bearings_m(contents, wall))
    side = constant(n.side) * centre
    above, sump = constant(n.above) * centre, constant(n.sump) * centre
    if shafts is not None:
        spans = [1e-3 * constant(shaft.bearing_span_mm) for shaft in (shafts.gear, shafts.pinion)]
        side = max(0.5 * (sum(spans) / 2.0 - wall - contents.face_width_m) - overhang, CLEARANCE_M)
    if n.length_mm is not None:
        end = 0.5 * (1e-3 * constant(n.length_mm) - centre - sum(contents.tip_radius_m))
    if n.width_mm is not None:
        side = 0.5 * (1e-3 * constant(n.width_mm) - contents.face_width_m)
    if n.height_mm is not None:
        left = 1e-3 * constant(n.height_mm) - 2.0 * max(contents.tip_radius_m)
        above, sump = ABOVE_SHARE * left, (1.0 - ABOVE_SHARE) * left
    return Proportions(
        end_m=end,
        above_m=above,
        sump_m=sump,
        side_m=side,
        wall_m=wall,
        lid=constant(n.lid),
        floor=constant(n.floor),
        boss=constant(n.boss),
        boss_thickness=constant(n.boss_thickness),
        overhang_m=overhang,
        bolt_inset=constant(n.bolt_inset),
        bolt_n_per_m=_bolt_n_per_m(numbers, centre),
        rib_height=constant(n.rib_height) if constant(n.ribbed) < RIBBED_SHARE else 0.0,
    )


RIBBED_SHARE = 0.3
LEAST_BOSS = 1.2
"""Of a boss over its bearing, where the ends are near (assumed)."""


def end_for_bearings_m(contents: Contents, wall_m: float) -> float:
    """Return the least distance of the teeth from the ends, so that bosses end a wall's thickness before them."""
    pairs = zip(contents.bearing_outer_m, contents.tip_radius_m, strict=True)
    return max(0.5 * LEAST_BOSS * outer + 0.5 * wall_m - tip for outer, tip in pairs)


def _bolt_n_per_m(numbers: PlateNumbers, centre_m: float) -> tuple[float, float]:
    feet = numbers.feet
    shear, axial = (
        constant(own) * centre_m if given is None else constant(given)
        for given, own in ((feet.shear_stiffness_n_per_m, numbers.shear), (feet.axial_stiffness_n_per_m, numbers.axial))
    )
    return shear, axial


def _wall_m(numbers: PlateNumbers, centre_m: float) -> float:
    if numbers.wall_mm is not None:
        return 1e-3 * constant(numbers.wall_mm)
    return least_wall_m(centre_m) * _within(STEEL_WALL if numbers.material == "steel" else IRON_WALL, numbers.wall)


def least_wall_m(centre_m: float) -> float:
    """Return what walls are multiples of [m]."""
    return 3e-3 + 0.025 * centre_m


def _within(limits: tuple[float, float], share: Number) -> float:
    return limits[0] + constant(share) * (limits[1] - limits[0])


def _seats(box: Box, modes: HousingModes, shafts: Shafts | None) -> dict[str, Motion]:
    """Return the motion of both seats of every shaft, weighted with what each of them bears of a force on the gear."""
    found = {}
    for shaft in ("pinion", "gear"):
        front = 0.5 if shafts is None else 1.0 - constant(getattr(shafts, shaft).gear_position)
        of_walls = [seat_motions(modes.halves, box.seats[shaft], wall) for wall in ("front", "back")]
        for axis, number in (("vertical", "y"), ("horizontal", "x"), ("axial", "z")):
            first, second = (motions[number] for motions in of_walls)
            none = Motion(0.0 * first.even, 0.0 * first.odd)
            found[f"{shaft}_bearing/{axis}"] = none.plus(first, front).plus(second, 1.0 - front)
    return found


def _sensors(
    box: Box, modes: HousingModes, sensors: tuple[Sensor, ...], uniform: Callable[[str], float]
) -> dict[str, Motion]:
    """Return the motions of all sensors on plates, along all axes."""
    found = {}
    for sensor in sensors:
        if sensor.plate is not None:
            plate, first, second = sensor_place(box, sensor, uniform)
            for axis, number in AXES.items():
                found[f"casing_{sensor.name}/{axis}"] = motion_at(modes.halves, Place(plate, first, second, number))
    return found


def sensor_place(box: Box, sensor: Sensor, uniform: Callable[[str], float]) -> tuple[str, float, float]:
    """Return the plate and where on it a sensor stands: about its middle, or about a bolt."""
    if sensor.plate == "floor":
        bolt = box.bolts[-1]
        return "floor", bolt.x_m, bolt.z_m
    assert sensor.plate is not None
    sizes = [box.size_m[axis] for axis in plane_axes(SIDES[sensor.plate][0])]
    given = sensor.place_on_casing_mm
    found = []
    for i, size in enumerate(sizes):
        away_mm = (
            constant(given[i]) if given else SCATTER_MM * (2.0 * uniform(f"sensors.{sensor.name}.place.{i}") - 1.0)
        )
        found.append(min(max(0.5 * size + 1e-3 * away_mm, EDGE_M), size - EDGE_M))
    return sensor.plate, found[0], found[1]


SCATTER_MM = 15.0
"""Largest distance of a sensor from the middle of its plate along either axis, where no place is given (assumed)."""


def _entries(
    box: Box, modes: HousingModes, seats: Mapping[str, Motion], pair: GearPair, uniform: Callable[[str], float]
) -> dict[str, Motion]:
    """Return where other machines press: a second mesh as opposed forces on the seats, another drive in the front wall.

    Both forces of the second mesh lie along the line of action of the one that is simulated, which stands for its own.
    The other drive has bearings of its own, whose radial forces act in the plane of the wall.
    """
    angle = pair.working_pressure_angle_rad
    along = [
        Motion(0.0 * seats[f"{s}_bearing/vertical"].even, 0.0 * seats[f"{s}_bearing/vertical"].odd)
        .plus(seats[f"{s}_bearing/vertical"], cos(angle))
        .plus(seats[f"{s}_bearing/horizontal"], sin(angle))
        for s in ("pinion", "gear")
    ]
    length, height, _ = box.size_m
    shares = [0.2 + 0.6 * uniform(f"housing.auxiliary_drive.{i}") for i in range(2)]
    drive = {
        f"auxiliary_drive/{axis}": motion_at(
            modes.halves, Place("front", shares[0] * length, shares[1] * height, AXES[axis])
        )
        for axis in ("horizontal", "vertical")
    }
    return {"second_stage": along[0].plus(along[1], -1.0), **drive}


def _from_middle(box: Box, x_m: float) -> Point:
    """Return where a place of the floor lies from the middle between both shafts."""
    first, second = box.seats["gear"], box.seats["pinion"]
    return x_m - 0.5 * (first.x_m + second.x_m), -0.5 * (first.y_m + second.y_m)
