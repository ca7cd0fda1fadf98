"""A housing of plates: a box from its geometry, its modes, and where it is pressed and seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache, partial

from siggen.arrays import FloatArray
from siggen.dynamics.housing.box import SIDES, Axis, Box, Material, plane_axes
from siggen.dynamics.housing.housing_modes import (
    BEYOND,
    WAVES,
    BoxModes,
    HousingModes,
    housing_modes,
    mixed_damping,
    resolved_hz,
)
from siggen.dynamics.housing.layout import Contents, Proportions, layout
from siggen.dynamics.housing.loose_foot import loosened, springs
from siggen.dynamics.housing.motion import PlatePlace, WallMotion, motion_at, seat_motions
from siggen.dynamics.structure.gear_stage import Point
from siggen.gearbox.housing import Mount, Plates
from siggen.gears.geometry.gear_pair import GearPair
from siggen.names import Side
from siggen.specimen.specimen_housing import MODES_ON_BOLTS, BoltMotions, SpecimenHousing, second_stage

AXES = {"horizontal": Axis.X, "vertical": Axis.Y, "axial": Axis.Z}
EDGE_M = 8e-3
"""Sensors stand at least so far from a plate's edge."""


def plate_housing(plates: Plates, pair: GearPair, bearings: Sequence[str]) -> SpecimenHousing:
    """Return a box of plates with its modes; `bearings` are those of the pinion's and the gear's shaft."""
    box, modes, ratio = damped_modes(plates)
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


def damped_modes(plates: Plates) -> tuple[Box, BoxModes, FloatArray]:
    """Return box, modes and their damping ratios (m,)."""
    made = plates.contents, plates.proportions, plates.material
    box, modes = _box_modes(*made, plates.highest_hz, plates.loose_share)
    return box, modes, mixed_damping(modes, plates.plate_damping(modes.frequency_hz.size), plates.foot_damping_ratio)


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
