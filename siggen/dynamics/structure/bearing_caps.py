"""Bearing caps, or outer rings, as bodies of their own between the shafts and the casing: two on each shaft.

Derived: the spring between a gear and its seat becomes, at each of the shaft's two bearings, half of it between gear
and cap, and the cap's own seat in the casing behind it. Caps that sit rigidly leave the casing as it was.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import sqrt

from siggen.dynamics.structure.structure import Element

SIDES = ("a", "b")
"""Ends of a shaft; without tilting shafts both caps of a shaft move alike."""


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


def capped(bearings: Mapping[str, Element], caps: Caps) -> CappedBearings:
    """Return caps between the ends of bearing elements, which are named place/axis and begin at a gear's x and y."""
    inner: list[Element] = []
    seats: dict[str, tuple[Element, ...]] = {}
    motions: dict[str, Mapping[str, float]] = {}
    for name, bearing in bearings.items():
        place, axis = name.split("/")
        halves = list(_halves(bearing, axis, caps))
        inner += [half for half, _ in halves]
        seats[name] = tuple(seat for _, seat in halves)
        motions[f"{place.removesuffix('bearing')}cap/{axis}"] = _on_cap(bearing, SIDES[0])
    masses = {f"{axis}_{gear}{side}": caps.mass_kg for gear in "12" for side in SIDES for axis in "xy"}
    outer = [seat for pair in seats.values() for seat in pair]
    return CappedBearings(masses, (*inner, *outer), seats, motions)


def uncapped(bearings: Mapping[str, Element]) -> CappedBearings:
    """Return bearings that sit in the casing itself."""
    return CappedBearings({}, tuple(bearings.values()), {name: (e,) for name, e in bearings.items()}, {})


def _halves(bearing: Element, axis: str, caps: Caps) -> Iterator[tuple[Element, Element]]:
    """Yield spring between gear and cap, and seat of the cap, at both ends of the shaft."""
    stiffness = caps.horizontal_stiffness_n_per_m if axis == "horizontal" else caps.vertical_stiffness_n_per_m
    damping = 2.0 * caps.damping_ratio * sqrt(stiffness * caps.mass_kg)
    gear = {name: share for name, share in bearing.direction.items() if _is_gear(name)}
    casing = {name: share for name, share in bearing.direction.items() if not _is_gear(name)}
    for side in SIDES:
        cap = _on_cap(bearing, side)
        away = {name: -share for name, share in cap.items()}
        yield (
            Element({**gear, **away}, 0.5 * bearing.stiffness, 0.5 * bearing.damping),
            Element({**cap, **casing}, stiffness, damping),
        )


def _on_cap(bearing: Element, side: str) -> dict[str, float]:
    return {f"{name}{side}": share for name, share in bearing.direction.items() if _is_gear(name)}


def _is_gear(name: str) -> bool:
    return name.endswith(("_1", "_2"))
