"""Housings that the tests share."""

from __future__ import annotations

from dataclasses import replace

from siggen.drivetrain.box import Bolt, Box, Material, Seat, Thicknesses
from siggen.drivetrain.box_functions import HalfFunctions
from siggen.drivetrain.housing_modes import WallMotion, degrees, seat_motions

IRON = Material(1.1e11, 0.26, 7200.0)
STEEL = Material(2.06e11, 0.3, 7850.0)
BOLTS = tuple(Bolt(x, 0.03, (8e7, 1.5e8, 8e7), 0.03) for x in (0.05, 0.27))


def iron_box(**changes) -> Box:
    """A cast housing for a centre distance of 100 mm, walls of 8 mm."""
    seats = {"gear": Seat(0.11, 0.12, 0.031, 0.046, 0.02, 0.004), "pinion": Seat(0.21, 0.12, 0.026, 0.04, 0.02, 0.004)}
    thickness = Thicknesses(floor_m=0.012, lid_m=0.007, walls_m=0.008, ends_m=0.008)
    return replace(Box((0.32, 0.24, 0.14), IRON, thickness, seats, BOLTS), **changes)


def halves_of(box: Box) -> tuple[HalfFunctions, HalfFunctions]:
    own = degrees(box)
    return HalfFunctions(box.size_m, own, False), HalfFunctions(box.size_m, own, True)


def box_motions(box: Box, halves: tuple[HalfFunctions, HalfFunctions]) -> dict[str, WallMotion]:
    """Return the motions of all seats as shaft/wall/direction."""
    return {
        f"{shaft}/{wall}/{name}": motion
        for shaft, seat in box.seats.items()
        for wall in ("front", "back")
        for name, motion in seat_motions(halves, seat, wall).items()
    }
