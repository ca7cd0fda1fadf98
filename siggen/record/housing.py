"""The housing of one specimen that gives way: from its geometry, or from modes that its user gave."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import cos, pi, sin

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.drivetrain.box import SIDES, Axis, Box, Contents, Material, Proportions, layout, plane_axes
from siggen.drivetrain.drivetrain import Drivetrain, Modes
from siggen.drivetrain.gear_stage import Point
from siggen.drivetrain.housing_modes import (
    ALL,
    BEYOND,
    WAVES,
    BoxModes,
    HousingModes,
    NaturalModes,
    PlatePlace,
    TableModes,
    WallMotion,
    housing_modes,
    mixed_damping,
    motion_at,
    resolved_hz,
    seat_motions,
    table_motion,
)
from siggen.drivetrain.loose_foot import loosened, springs
from siggen.drivetrain.makers import (
    CENTRAL,
    GROUND,
    SEATS_OF_SET,
    Housing,
    housing_of_modes,
    planetary_train,
    rigid_housing,
)
from siggen.drivetrain.structure import matrices
from siggen.gearbox.housing import CASING_GYRATION, Block, Mount, PlateDamping, Plates
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable, seats_of
from siggen.gearbox.specimen import Specimen
from siggen.gearbox.train import ring_outer_radius_m
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import InternalPair
from siggen.names import Side

# SpecimenHousing: the housing of one specimen by its modes, and where it is pressed and seen.
#
# x runs from gear to pinion and is horizontal, y is vertical, z runs along the shafts.

MODES_ON_BOLTS = 6
COUPLED_HZ, MOST = 1500.0, 9
"""Modes below this frequency move with the gears, at least the six on the bolts. With what all others give way in
series with the bearings k_b |R - R_0| stays below 0.5 nearly everywhere (drawn boxes, November 2026)."""
SETTLED_DECAYS = 7.0
"""Decay times after which a mode has forgotten how it was started: 1e-3 of it is left."""
LONGEST_S = 1.2
BoltMotions = tuple[tuple[Point, str, float, WallMotion], ...]
"""Place from the middle between both shafts, axis, stiffness [N/m] and motion of what a base takes along."""


@dataclass(frozen=True, slots=True, eq=False)
class SpecimenHousing:
    """A housing with its modes.

    Attributes
    ----------
    damping_ratio : (m,)
    seats, motions, entries : place/axis -> motion of bearings, of sensors, and of where other forces press
    bolts : returns what a base under the housing moves
    box : what the modes were computed from; None where they were given
    """

    modes: NaturalModes
    damping_ratio: FloatArray
    seats: Mapping[str, WallMotion]
    motions: Mapping[str, WallMotion]
    entries: Mapping[str, WallMotion]
    bolts: Callable[[], BoltMotions]
    box: Box | None = None

    @property
    def coupled(self) -> int:
        """Number of modes that move with the gears."""
        least = min(MODES_ON_BOLTS, self.modes.vibrating)
        return min(max(least, int((self.modes.frequency_hz < COUPLED_HZ).sum())), MOST)

    @property
    def forces(self) -> tuple[str, ...]:
        """Bearing forces that press on it, as place/axis."""
        return tuple(self.seats)

    @property
    def pairs(self) -> list[tuple[float, float]]:
        """Natural frequencies [Hz] and damping ratios, ascending."""
        return list(zip(self.modes.frequency_hz.tolist(), self.damping_ratio.tolist(), strict=True))

    def accelerance(
        self, seen: WallMotion, inputs: tuple[str, ...], frequency_hz: FloatArray, which: slice = ALL
    ) -> ComplexArray:
        """Return the accelerance (inputs, k) [m/s² per N] from seats, entries or motions, of some of the modes."""
        places = {**self.motions, **self.seats, **self.entries}
        motions = [places[name] for name in inputs]
        return np.asarray(self.modes.accelerance([seen], motions, frequency_hz, self.damping_ratio, which)[0])

    def shown_accelerance(
        self, weights: Mapping[str, float], inputs: tuple[str, ...], frequency_hz: FloatArray, which: slice = ALL
    ) -> ComplexArray:
        """Return the accelerance (inputs, k) of what a channel sees: motions times factors."""
        (name, weight), *others = weights.items()
        total = WallMotion(weight * self.motions[name].even, weight * self.motions[name].odd)
        for name, weight in others:
            total = total.plus(self.motions[name], weight)
        return self.accelerance(total, inputs, frequency_hz, which)


def modes_settle_s(frequency_hz: FloatArray, damping_ratio: FloatArray) -> float:
    """Return the time over which modes settle [s]."""
    return settle_s(float((2.0 * pi * frequency_hz * damping_ratio).min()))


def settle_s(slowest_per_s: float) -> float:
    """Return the time over which what decays at a rate settles [s]."""
    return min(SETTLED_DECAYS / slowest_per_s, LONGEST_S) if slowest_per_s > 0.0 else LONGEST_S


@lru_cache(maxsize=4)  # every operating point asks for that of its gearbox
def moving_with_gears(housing: SpecimenHousing) -> Housing:
    """Return the lowest modes of a housing, those that move with the gears."""
    modes, n = housing.modes, housing.coupled
    seats = list(housing.seats.values())
    places = {**housing.seats, **housing.motions, **housing.entries}
    shapes = modes.shapes(list(places.values()))[:, :n]
    lowest = Modes(
        name="housing",
        frequency_hz=modes.frequency_hz[:n],
        damping_ratio=housing.damping_ratio[:n],
        shapes=dict(zip(places, shapes, strict=True)),
        seats=tuple(housing.seats),
        give_m_per_n=modes.flexibility_beyond(n, seats, seats),
        base=participation(housing)[:n],
    )
    return housing_of_modes(lowest, tuple(housing.motions), tuple(housing.entries))


def participation(housing: SpecimenHousing) -> FloatArray:
    """Return how far each mode moves (m, 3) at rest with a base: horizontally, vertically, rocking about the middle.

    Derived: g_r = φ_rᵀ K_b t/ω_r², t the base's motion at the bolts. A mode's spring acts between η_r and g_r, so that
    a base that moves slowly takes the whole box along.
    """
    bolts, omega = housing.bolts(), 2.0 * pi * housing.modes.frequency_hz
    taken = np.zeros((omega.size, 3))
    shapes = housing.modes.shapes([motion for *_, motion in bolts]) if bolts else ()
    for ((h, v), axis, stiffness, _), shape in zip(bolts, shapes, strict=True):
        moved = (1.0, 0.0, -v) if axis == "horizontal" else (0.0, 1.0, h)
        taken += np.outer(stiffness * shape / (omega * omega), moved)
    return taken


def second_stage(seats: Mapping[str, WallMotion], bearings: Sequence[str], pressure_angle_rad: float) -> WallMotion:
    """Return where a second mesh presses: opposed forces on the seats of both shafts.

    They lie along the line of action of the mesh that is simulated, which stands for its own. `bearings` are those of
    its driver and its driven gear.
    """
    driver, driven = (
        WallMotion(0.0 * seats[f"{bearing}/vertical"].even, 0.0 * seats[f"{bearing}/vertical"].odd)
        .plus(seats[f"{bearing}/vertical"], cos(pressure_angle_rad))
        .plus(seats[f"{bearing}/horizontal"], sin(pressure_angle_rad))
        for bearing in bearings
    )
    return driver.plus(driven, -1.0)


# A housing of plates: a box from its geometry, its modes, and where it is pressed and seen.

AXES = {"horizontal": Axis.X, "vertical": Axis.Y, "axial": Axis.Z}
EDGE_M = 8e-3
"""Sensors stand at least so far from a plate's edge."""


@lru_cache(maxsize=4)  # states, operating points and records of a gearbox share them
def plate_housing(
    plates: Plates, plate_damping: PlateDamping, pair: GearPair, bearings: tuple[str, ...]
) -> SpecimenHousing:
    """Return a box of plates with its modes.

    `plate_damping` is that of the plates, which are equal without it; `bearings` are those of the pinion's and the
    gear's shaft.
    """
    box, modes = _box_of(plates)
    ratio = _damping_ratio(modes, plates, plate_damping)
    pushed = pair.helix_rad != 0.0
    seats = _seats(box, modes, plates.front_share, dict(zip(Side, bearings, strict=True)), located=pushed)
    return SpecimenHousing(
        modes=modes,
        damping_ratio=ratio,
        seats={name: motion for name, motion in seats.items() if pushed or not name.endswith("axial")},
        motions={**seats, **_sensors(box, modes, plates.mounts)},
        entries={
            "second_stage": second_stage(seats, bearings, pair.working_pressure_angle_rad),
            **_drive(box, modes, plates.drive_share),
        },
        bolts=partial(_bolts, box, modes, plates.loose_share),
        box=box,
    )


def _box_of(plates: Plates) -> tuple[Box, BoxModes]:
    made = plates.contents, plates.proportions, plates.material
    return _box_modes(*made, plates.highest_hz, plates.loose_share)


def _damping_ratio(modes: BoxModes, plates: Plates, plate_damping: PlateDamping) -> FloatArray:
    """Return the damping ratios (m,) of modes."""
    return mixed_damping(modes, plate_damping(modes.frequency_hz.size), plates.foot_damping_ratio)


def _bolts(box: Box, modes: BoxModes, share: float) -> BoltMotions:
    axes = {Axis.X: "horizontal", Axis.Y: "vertical"}
    return tuple(
        (_from_middle(box, one.bolt.x_m), axes[one.axis], one.stiffness_n_per_m, one.motion)
        for one in springs(box, modes.halves, share)
        if one.axis in axes
    )


@lru_cache(maxsize=4)  # states and records of a gearbox share them
def _box_modes(
    contents: Contents, proportions: Proportions, material: Material, highest_hz: float, loose_share: float
) -> tuple[Box, BoxModes]:
    """Return a box and its modes; one foot has a share of its stiffness left."""
    if loose_share != 1.0:
        box, sound = _box_modes(contents, proportions, material, highest_hz, 1.0)
        assert isinstance(sound, HousingModes)
        return box, loosened(sound, box, loose_share)
    box = layout(contents, proportions, material)
    highest_hz = min(highest_hz, BEYOND * resolved_hz(box))
    modes = housing_modes(box, highest_hz, WAVES)
    while modes.vibrating <= MODES_ON_BOLTS:  # a small box with thick walls bends above the band: a label tells where
        highest_hz *= 2.0
        modes = housing_modes(box, highest_hz, WAVES)
    return box, modes


def _seats(
    box: Box, modes: BoxModes, front_share: Mapping[str, float], bearings: Mapping[str, str], *, located: bool
) -> dict[str, WallMotion]:
    """Return the motion of both seats of every shaft, weighted with what each of them bears of a force on the gear.

    Along the axis one bearing of a `located` shaft bears all of it, that in the front wall.
    """
    found = {}
    for shaft, bearing in bearings.items():
        front = front_share[shaft]
        of_walls = [seat_motions(modes.halves, box.seats[shaft], wall) for wall in ("front", "back")]
        for axis, number in (("vertical", "y"), ("horizontal", "x"), ("axial", "z")):
            first, second = (motions[number] for motions in of_walls)
            if located and axis == "axial":
                found[f"{bearing}/{axis}"] = first
                continue
            none = WallMotion(0.0 * first.even, 0.0 * first.odd)
            found[f"{bearing}/{axis}"] = none.plus(first, front).plus(second, 1.0 - front)
    return found


def _sensors(box: Box, modes: BoxModes, mounts: Mapping[str, Mount]) -> dict[str, WallMotion]:
    """Return the motions of all sensors on plates, along all axes."""
    return {
        f"casing_{name}/{axis}": motion_at(modes.halves, PlatePlace(*sensor_place(box, mount), number))
        for name, mount in mounts.items()
        for axis, number in AXES.items()
    }


def sensor_place(box: Box, mount: Mount) -> tuple[str, float, float]:
    """Return the plate and where on it a sensor stands: not too near its edges, or beside a bolt."""
    if mount.plate == "floor":
        bolt = box.bolts[-1]
        return "floor", bolt.x_m, bolt.z_m
    sizes = [box.size_m[axis] for axis in plane_axes(SIDES[mount.plate][0])]
    first, second = (
        min(max(0.5 * size + away, EDGE_M), size - EDGE_M) for size, away in zip(sizes, mount.away_m, strict=True)
    )
    return mount.plate, first, second


def _drive(box: Box, modes: BoxModes, shares: tuple[float, float]) -> dict[str, WallMotion]:
    """Return where another drive presses: by the radial forces of its own bearings, in the plane of the front wall."""
    length, height, _ = box.size_m
    return {
        f"auxiliary_drive/{axis}": motion_at(
            modes.halves, PlatePlace("front", shares[0] * length, shares[1] * height, AXES[axis])
        )
        for axis in ("horizontal", "vertical")
    }


def _from_middle(box: Box, x_m: float) -> Point:
    """Return where a place of the floor lies from the middle between both shafts."""
    first, second = box.seats[Side.DRIVEN], box.seats[Side.DRIVER]
    return x_m - 0.5 * (first.x_m + second.x_m), -0.5 * (first.y_m + second.y_m)


# What carries sun, carrier and ring of a planetary set, and the set on it as small forces see it.
#
# Teeth push as on the ground, and what the bodies then press with acts on seats of the whole linear machine (derived:
# with the forces F_0 on seats that are held, a linear machine moves beyond its motion with held seats as F_0 on the
# free seats moves it). So housing and bodies answer each other, bolts included; what the housing's motion does to the
# mesh stiffness and to contact alone is left out. The carrier's turning is slow beside both, and planets that stand
# evenly make the machine alike in all directions: it is the same at every angle of the frame. Those that do not stand
# evenly count as if they did.

AXIS = (0.0, 0.0)
"""Of all bodies: the middle of the housing."""


def set_in_housing(specimen: Specimen, housing: Housing | None) -> Drivetrain:
    """Return a set with evenly spread planets in a housing, or on the ground."""
    assert specimen.planets is not None
    stage = specimen.planets.stage
    count = len(stage.places_turns)
    return planetary_train(replace(stage, places_turns=tuple(i / count for i in range(count))), housing)


def rigid_housing_of_set(block: Block, ring: InternalPair) -> Housing:
    """Return a block on bolts round a set, whose axis lies in its middle.

    Raises
    ------
    ValueError
        If the bolts leave it free to move.
    """
    casing = replace(block.casing(ring_outer_radius_m(ring) / CASING_GYRATION), pinion_place_m=AXIS)
    return rigid_housing(casing, dict.fromkeys(CENTRAL, AXIS))


def slowest_decay_per_s(housing: Housing) -> float:
    """Return the smallest decay rate of a rigid body on its supports [1/s]."""
    mass, damping, stiffness = matrices(Drivetrain((housing.body, GROUND), housing.bolts))
    inverse = np.diag(1.0 / np.diag(mass))
    still, unit = np.zeros_like(stiffness), np.eye(len(mass))
    state = np.block([[still, unit], [-inverse @ stiffness, -inverse @ damping]])
    return float((-np.linalg.eigvals(state).real).min())


def specimen_housing(specimen: Specimen) -> SpecimenHousing | None:
    """Return the housing of a specimen; the same for all of its states and records; None for one without modes."""
    match specimen.housing:
        case Plates() as plates:
            bearings = tuple(shaft.bearing for shaft in specimen.names.shafts)
            return plate_housing(plates, plates.plate_damping, specimen.pair, bearings)
        case ModeTable() as table:
            return _modal_housing(table, specimen)
    return None


def housing_settle_s(specimen: Specimen) -> float:
    """Return the time over which the modes settle [s], which every record asks for; 0 without any."""
    match specimen.housing:
        case Plates() as plates:
            _, modes = _box_of(plates)
            return modes_settle_s(modes.frequency_hz, _damping_ratio(modes, plates, plates.plate_damping))
        case ModeTable() as table:
            return modes_settle_s(table.frequency_hz, table.damping_ratio)
        case Block() as block if specimen.planets is not None:  # others move with the gears
            return settle_s(slowest_decay_per_s(rigid_housing_of_set(block, specimen.planets.ring)))
    return 0.0


def _modal_housing(table: ModeTable, specimen: Specimen) -> SpecimenHousing:
    places = {place: table_motion(shape) for place, shape in table.shapes.items()}
    names = SEATS_OF_SET if specimen.planets is not None else seats_of(specimen.names)
    seats = {place: places[place] for place in names}
    still = table_motion(np.zeros_like(table.frequency_hz))
    drive = {place: places.get(place, still) for place in DRIVE}
    stage = still  # a planetary set has no second one
    if specimen.planets is None:
        bearings = [shaft.bearing for shaft in specimen.names.shafts[:2]]
        stage = second_stage(seats, bearings, specimen.pair.working_pressure_angle_rad)
    return SpecimenHousing(
        modes=TableModes(table.frequency_hz),
        damping_ratio=table.damping_ratio,
        seats=seats,
        motions=_seen(places, {seat.split("/")[0] for seat in seats}),
        entries={"second_stage": stage, **drive},
        bolts=lambda: _followed(table.frequency_hz, table.base),
    )


def _seen(places: Mapping[str, WallMotion], held: Collection[str]) -> dict[str, WallMotion]:
    """Return the motions of a table's places as sensors call them: at what is `held`, or on the casing by their name.

    A sensor on the casing may bear the name of a ring, too.
    """
    found = {p if p.split("/")[0] in held else f"casing_{p}": motion for p, motion in places.items()}
    return found | ({f"casing_{p}": motion for p, motion in places.items()} if "ring" in held else {})


def _followed(frequency_hz: FloatArray, base: Mapping[str, FloatArray]) -> BoltMotions:
    """Return what a base takes along, as bolts of 1 N/m that do just that.

    Derived. A body on bolts follows its base at rest by g_r = φ_rᵀ K_b t/ω_r² = φ_rᵀ M t, since K moves no force where
    the body goes with the base: these are the participation factors. Rocking is that of a bolt 1 m below the middle
    less that of one in it.
    """
    if len(base) < len(BASE):
        return ()
    horizontal, vertical, rocking = (base[name] * (2.0 * pi * frequency_hz) ** 2 for name in BASE)
    return (
        ((0.0, 0.0), "horizontal", 1.0, table_motion(horizontal - rocking)),
        ((0.0, 0.0), "vertical", 1.0, table_motion(vertical)),
        ((0.0, -1.0), "horizontal", 1.0, table_motion(rocking)),
    )
