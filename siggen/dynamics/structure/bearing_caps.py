"""Bearing caps, or outer rings, as bodies of their own between the shafts and the casing: two on each shaft.

Derived: the spring between a gear and its seat becomes, at each of the shaft's two bearings, half of it between gear
and cap, and the cap's own seat in the casing behind it. Caps that sit rigidly leave the casing as it was.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from siggen.dynamics.structure.structure import Element

SIDES = ("a", "b")
"""Ends of a shaft; without tilting shafts both caps of a shaft move alike."""

GEAR_MOTIONS = ("x_1", "y_1", "x_2", "y_2")


@dataclass(frozen=True, slots=True)
class Caps:
    """All caps alike; the stiffness is that of one cap's seat in the casing, c = 2 ζ √(k m)."""

    mass_kg: float
    horizontal_stiffness_n_per_m: float
    vertical_stiffness_n_per_m: float
    damping_ratio: float


@dataclass(frozen=True, slots=True)
class CappedBearings:
    """What caps bring in.

    Attributes
    ----------
    masses : coordinate -> mass [kg] of the caps
    elements : bearings and seats
    seats : place/axis -> the two seats that press on the casing there
    motions : place/axis -> direction of a cap's displacement
    """

    masses: Mapping[str, float]
    elements: tuple[Element, ...]
    seats: Mapping[str, tuple[Element, ...]]
    motions: Mapping[str, Mapping[str, float]]


def capped(ends: Mapping[str, Mapping[str, Element]], caps: Caps) -> CappedBearings:
    """Return caps between gears and casing; `ends`: what lies between them, by place/axis and end of the shaft."""
    inner: list[Element] = []
    seats: dict[str, tuple[Element, ...]] = {}
    motions: dict[str, Mapping[str, float]] = {}
    for name, bearings in ends.items():
        place, axis = name.split("/")
        parted = [_parted(bearing, side, axis, caps) for side, bearing in bearings.items()]
        inner += [spring for spring, _ in parted]
        seats[name] = tuple(seat for _, seat in parted)
        motions[f"{place.removesuffix('bearing')}cap/{axis}"] = _on_cap(bearings[SIDES[0]], SIDES[0])
    masses = {f"{axis}_{gear}{side}": caps.mass_kg for gear in "12" for side in SIDES for axis in "xy"}
    outer = [seat for pair in seats.values() for seat in pair]
    return CappedBearings(masses, (*inner, *outer), seats, motions)


def uncapped(ends: Mapping[str, Mapping[str, Element]]) -> CappedBearings:
    """Return bearings that sit in the casing itself."""
    seats = {name: tuple(bearings.values()) for name, bearings in ends.items()}
    return CappedBearings({}, tuple(e for bearings in seats.values() for e in bearings), seats, {})


def halves(bearing: Element) -> dict[str, Element]:
    """Return the two bearings of a shaft that does not tilt."""
    return {side: Element(bearing.direction, 0.5 * bearing.stiffness, 0.5 * bearing.damping) for side in SIDES}


def _parted(bearing: Element, side: str, axis: str, caps: Caps) -> tuple[Element, Element]:
    """Return the spring between gear and cap, and the seat of the cap."""
    stiffness = caps.horizontal_stiffness_n_per_m if axis == "horizontal" else caps.vertical_stiffness_n_per_m
    damping = 2.0 * caps.damping_ratio * sqrt(stiffness * caps.mass_kg)
    gear = {name: share for name, share in bearing.direction.items() if _is_gear(name)}
    casing = {name: share for name, share in bearing.direction.items() if not _is_gear(name)}
    cap = _on_cap(bearing, side)
    away = {name: -share for name, share in cap.items()}
    spring = Element({**gear, **away}, bearing.stiffness, bearing.damping)
    return spring, Element({**cap, **casing}, stiffness, damping)


def _on_cap(bearing: Element, side: str) -> dict[str, float]:
    moved = {name: share for name, share in bearing.direction.items() if name in GEAR_MOTIONS}
    return {f"{name}{side}": share for name, share in moved.items()}


def _is_gear(name: str) -> bool:
    return name.endswith(("_1", "_2"))
