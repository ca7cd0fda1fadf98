"""A planetary set in numbers of teeth: what turns how often, where its meshes stand, whether it can be put together.

Equations: standard literature (Willis; assembly of equally and unequally spaced planets); phases derived from where the
flanks stand. Everything here is exact: fractions of turns and of pitches. The ring stands still. Angles count in the
sense in which the carrier turns, from the first planet. Sun and carrier turn the same way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm, pi, sin

from siggen.gears.geometry.gear_pair import GeometryProblem

PLANETS = (3, 4, 5)
SMALLEST_TEETH = 8
UNEVEN_TEETH = 2
"""Teeth by which the ring may miss z_s + 2 z_p: profile shifts make good for no more (assumed)."""
AS_TYPED_DEG = 2e-3
"""Positions that a user rounded to three digits or so count as the exact ones."""


@dataclass(frozen=True, slots=True)
class PlanetarySet:
    """Teeth of sun, planets and ring, and where the planets stand, in turns from the first planet, ascending."""

    sun: int
    planet: int
    ring: int
    places: tuple[Fraction, ...]

    @property
    def slots(self) -> int:
        """Places per turn at which a planet fits between sun and ring, z_s + z_r."""
        return self.sun + self.ring

    @property
    def carrier_turns(self) -> Fraction:
        """Turns of the carrier per turn of the sun (Willis)."""
        return Fraction(self.sun, self.slots)

    @property
    def pitches_per_turn(self) -> float:
        """Base pitches of every mesh per turn of the sun (Willis)."""
        return self.sun * self.ring / self.slots

    @property
    def evenly_spaced(self) -> bool:
        """Whether all neighbours are equally far apart."""
        return len(set(self.gaps)) == 1

    @property
    def gaps(self) -> tuple[Fraction, ...]:
        """Turns from each planet to the next one."""
        ahead = (*self.places[1:], self.places[0] + 1)
        return tuple(after - before for before, after in zip(self.places, ahead, strict=True))

    @property
    def sun_begins(self) -> tuple[Fraction, ...]:
        """Base pitches that the sun's mesh with each planet has turned where that with the first has turned none.

        A tooth of the sun runs ahead of the carrier, so it comes to a planet at ψ by z_s ψ/2π pitches later. Whole
        pitches count: pair n of every mesh has the sun's tooth n.
        """
        return tuple(-self.sun * place for place in self.places)

    @property
    def ring_begins(self) -> tuple[Fraction, ...]:
        """The same of each planet's mesh with the ring, against the first planet's; pair n has the ring's tooth n.

        Seen from the carrier the ring runs back, so a tooth comes to a planet at ψ earlier.
        """
        return tuple(self.ring * place for place in self.places)

    @property
    def phases(self) -> tuple[Fraction, ...]:
        """Base pitches that both meshes of each planet are ahead of the first planet's, 0 to below 1.

        The same in both, since a planet fits where (z_s + z_r) ψ/2π is whole.
        """
        return tuple(begins % 1 for begins in self.sun_begins)

    @property
    def common_turns(self) -> int:
        """Turns of the carrier after which all teeth meet again as they did."""
        return lcm(Fraction(self.ring, self.sun).denominator, Fraction(self.ring, self.planet).denominator)

    def excited(self, harmonic: int) -> str:
        """Return what a harmonic of the mesh frequency moves in a set with equal planets at equal distances.

        `rotation`: forces on the centre cancel; `translation`: torques do; `planets`: both do.
        """
        count = len(self.places)
        step = harmonic * self.sun % count
        return "rotation" if step == 0 else "translation" if step in {1, count - 1} else "planets"


def typed_places(positions_deg: Sequence[float], slots: int) -> tuple[Fraction, ...]:
    """Return places in turns of positions as a user types them; the exact one where a planet fits that near."""
    found = []
    for degrees in positions_deg:
        near = Fraction(round(degrees / 360.0 * slots), slots)
        found.append(near if abs(float(near) * 360.0 - degrees) <= AS_TYPED_DEG else Fraction(degrees) / 360)
    return tuple(found)


def planetary_problems(teeth: PlanetarySet) -> tuple[GeometryProblem, ...]:
    """Return everything that keeps a planetary set from being put together; empty for one that can be."""
    for group in (_numbers, _centres, _places):
        problems = tuple(group(teeth))
        if problems:
            return problems
    return ()


def _numbers(teeth: PlanetarySet) -> Iterator[GeometryProblem]:
    for where in ("sun", "planet", "ring"):
        if getattr(teeth, where) < SMALLEST_TEETH:
            allowed = f"allowed: at least {SMALLEST_TEETH}"
            yield GeometryProblem("teeth", where, str(getattr(teeth, where)), allowed)
    if len(teeth.places) not in PLANETS:
        yield GeometryProblem("planets", "carrier", str(len(teeth.places)), f"allowed: {PLANETS[0]} to {PLANETS[-1]}")
    elif teeth.places[0] != 0 or any(gap <= 0 for gap in teeth.gaps):
        received = ", ".join(f"{float(place) * 360.0:.6g}" for place in teeth.places)
        yield GeometryProblem("positions", "carrier", f"{received} deg", "allowed: 0 first, then ascending below 360")


def _centres(teeth: PlanetarySet) -> Iterator[GeometryProblem]:
    fits = teeth.sun + 2 * teeth.planet
    if abs(teeth.ring - fits) > UNEVEN_TEETH:
        allowed = f"allowed: {fits} on one axis with the sun, or up to {UNEVEN_TEETH} more or less with profile shifts"
        yield GeometryProblem("ring and sun on one axis", "ring", f"{teeth.ring} teeth", allowed)


def _places(teeth: PlanetarySet) -> Iterator[GeometryProblem]:
    count = len(teeth.places)
    for number, place in enumerate(teeth.places, start=1):
        slot = place * teeth.slots
        if slot.denominator != 1:
            near = ", ".join(f"{360.0 * (slot.__floor__() + i) / teeth.slots:.4f}" for i in (0, 1))
            received = f"{float(place) * 360.0:.6g} deg with {teeth.sun} + {teeth.ring} teeth"
            allowed = f"allowed: whole multiples of 360/{teeth.slots} deg, next: {near}"
            if teeth.evenly_spaced:
                allowed += f"; equal distances need z_sun + z_ring divisible by {count}"
            yield GeometryProblem("planet does not fit", f"planet {number}", received, allowed)
            return
    nearest = min(teeth.gaps)
    apart, needed = (teeth.sun + teeth.planet) * sin(pi * float(nearest)), teeth.planet + 2
    if apart <= needed:
        received = (
            f"{apart:.4g} modules between centres and middle of neighbours {float(nearest) * 360.0:.4g} deg apart"
        )
        allowed = f"allowed: above {needed}, half the tip diameter twice; fewer or smaller planets, or further apart"
        yield GeometryProblem("neighbours touch", "planets", received, allowed)
