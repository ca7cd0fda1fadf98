"""A planetary set in numbers of teeth: what turns how often, where its meshes stand, whether it can be put together.

Equations: standard literature (Willis; assembly of equally and unequally spaced planets); phases derived from where the
flanks stand. Everything here is exact: fractions of turns and of pitches. The ring stands still. Angles count in the
sense in which the carrier turns, from the first planet. Sun and carrier turn the same way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import acos, cos, lcm, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.gear_pair import GearPair, GeometryProblem
from siggen.gears.involute import inverse_involute, involute_function
from siggen.gears.spur_gear import SpurGear

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


# A planet inside a ring: radii of the ring's teeth, path of contact, where the ring's mesh stands after the sun's.
#
# Equations: standard literature (internal involute gearing); the phase between both meshes of a planet is derived. The
# planet drives. Positions s along the line of action count from the planet's base tangent point; the ring's lies on
# the same side of the contact, at T < 0, so that the flanks' radii of curvature are s and s - T, the ring's being
# hollow.

LEAST_APART = 10
"""Teeth that a ring has more than a planet, so that tips do not meet beside the path (standard literature)."""


@dataclass(frozen=True, slots=True)
class RingGear(SpurGear):
    """Teeth that point inwards; the spaces between them are the teeth of an outer gear of the same numbers.

    Heights, rolls and radii of a flank grow outwards from the base circle, from the tip to the root. Its profile shift
    is positive where spaces are wider, teeth thinner and farther out.

    Parameters
    ----------
    bore_radius_m : float
        Not read: the ring is held round its rim.
    cut_back_m : float
        By how much the tips are shortened [m].
    """

    cut_back_m: float = 0.0

    @property
    def signed_base_radius_m(self) -> float:
        """Base radius as it counts along a line of action, negative [m]."""
        return -self.base_radius_m

    @property
    def tip_radius_m(self) -> float:
        """Radius of the tips, inside of the pitch circle [m]."""
        height = self.addendum_coefficient - self.profile_shift
        return self.pitch_radius_m - height * self.module_m + self.cut_back_m

    @property
    def root_radius_m(self) -> float:
        """Radius of the roots, outside of the pitch circle [m]."""
        height = self.addendum_coefficient + self.clearance_coefficient + self.profile_shift
        return self.pitch_radius_m + height * self.module_m

    @property
    def base_half_angle_rad(self) -> float:
        """Half angle of a tooth on the base circle; negative where it has come to a point farther out [rad].

        As that of an outer gear it counts for a flank whose tooth grows thinner outwards, hence with its sign turned.
        """
        shift = 2.0 * self.profile_shift * tan(self.pressure_angle_rad) / self.teeth
        space = pi / (2.0 * self.teeth) + involute_function(self.pressure_angle_rad) + shift
        return space - pi / self.teeth

    @property
    def tip_roll_rad(self) -> float:
        """Roll angle of the tip; 0 where it lies inside of the base circle [rad]."""
        return sqrt(max((self.tip_radius_m / self.base_radius_m) ** 2 - 1.0, 0.0))

    @property
    def tip_half_thickness_m(self) -> float:
        """Half tooth thickness at the tip [m]; not positive when the tooth is pointed."""
        return float(self.half_thickness_m(self.tip_roll_rad))

    @property
    def flank_rolls_rad(self) -> tuple[float, float]:
        """Roll angles of the ends of the flank, ascending: the tip and the end before the root [rad]."""
        return self.tip_roll_rad, self.last_roll_rad

    @property
    def root_roll_rad(self) -> float:
        """Roll angle of the involute carried on to the root, where the tooth as a beam stands [rad]."""
        return sqrt((self.root_radius_m / self.base_radius_m) ** 2 - 1.0)

    @property
    def last_roll_rad(self) -> float:
        """Roll angle where the involute ends: a clearance before the root (assumed: cut by a tool with round tips)."""
        radius = self.root_radius_m - self.clearance_coefficient * self.module_m
        return sqrt((radius / self.base_radius_m) ** 2 - 1.0)

    def half_thickness_m(self, roll: ArrayLike) -> FloatArray:
        """Return the half tooth thickness, shape of `roll` [m]."""
        return -SpurGear.half_thickness_m(self, roll)

    def half_angle_rad(self, radius_m: FloatArray) -> FloatArray:
        """Return half the angle that a tooth fills at radii (k,) from the base circle outwards [rad]."""
        slant = np.arccos(np.minimum(self.base_radius_m / radius_m, 1.0))
        return np.asarray(np.tan(slant) - slant - self.base_half_angle_rad)


@dataclass(frozen=True, slots=True)
class InternalPair(GearPair):
    """A driving planet (`pinion`) in a ring (`gear`), without backlash: the centre distance says how it is shifted.

    Its line of action T is negative, as the ring's base radius counts: so rolls of the ring (T - s)/R, the relative
    radius of the flanks s (T - s)/T and the ends of the path are those of any pair (derived).
    """

    gear: RingGear

    @property
    def tight_pressure_angle_rad(self) -> float:
        """Working pressure angle, inv = inv alpha_0 + 2 (X_r - X_p) tan(alpha_0)/(z_r - z_p) [rad]."""
        angle = self.pinion.pressure_angle_rad
        shift = self.gear.profile_shift - self.pinion.profile_shift
        teeth = self.gear.teeth - self.pinion.teeth
        return angle if shift == 0.0 else inverse_involute(involute_function(angle) + 2.0 * shift * tan(angle) / teeth)

    @property
    def working_centre_distance_m(self) -> float:
        """Centre distance (R_br - R_bp)/cos(alpha_w) [m]."""
        return abs(self.line_of_action_m) / sin(self.working_pressure_angle_rad)

    def ring_radius_m(self, position_m: FloatArray) -> FloatArray:
        """Return the radius on the ring of contacts at positions (k,) [m]."""
        return np.hypot(self.gear.base_radius_m, self.line_of_action_m - position_m)


def ring_round(sun_pair: GearPair, teeth: int) -> InternalPair:
    """Return the planet of a pair of sun and planet in a ring of some teeth on the sun's axis.

    The ring is shifted so that it meshes without backlash at the centre distance of sun and planet. Its teeth are as
    high as the planet's, and cut back where they would reach the planet's fillet, as usual.

    Raises
    ------
    ValueError
        If the ring's and the planet's base circles are farther apart than their centres.
    """
    planet = sun_pair.gear
    angle, apart = planet.pressure_angle_rad, teeth - planet.teeth
    cosine = 0.5 * planet.module_m * apart * cos(angle) / sun_pair.working_centre_distance_m
    if not 0.0 < cosine < 1.0:
        raise ValueError(
            f"ring: received {teeth} teeth round planets of {planet.teeth}; allowed: teeth whose line of action "
            "exists at the centre distance of sun and planet. Take a ring nearer to z_sun + 2 z_planet"
        )
    more = involute_function(acos(cosine)) - involute_function(angle)
    even = teeth == sun_pair.pinion.teeth + 2 * planet.teeth and sun_pair.centre_distance_m is None
    unshifted = even and sun_pair.pinion.profile_shift + planet.profile_shift == 0.0
    shift = planet.profile_shift + (0.0 if unshifted else 0.5 * more * apart / tan(angle))
    height, clearance = planet.addendum_coefficient, planet.clearance_coefficient
    ring = RingGear(teeth, planet.module_m, angle, shift, height, clearance, planet.bore_radius_m)
    pair = InternalPair(planet, ring, sun_pair.face_width_m, sun_pair.youngs_modulus_pa, sun_pair.poisson_ratio)
    return replace(pair, gear=replace(ring, cut_back_m=max(_clear_radius_m(pair) - ring.tip_radius_m, 0.0)))


def _clear_radius_m(pair: InternalPair) -> float:
    """Return the least radius of the ring's tips that does not reach the planet's fillet [m]."""
    first = pair.pinion.involute_start_roll_rad * pair.pinion.base_radius_m
    return float(pair.ring_radius_m(np.array([first]))[0])


def internal_problems(pair: InternalPair) -> tuple[GeometryProblem, ...]:
    """Return everything that keeps a planet from meshing with its ring; empty for a usable pair."""
    return tuple(_internal(pair))


def _internal(pair: InternalPair) -> Iterator[GeometryProblem]:
    ring, planet = pair.gear, pair.pinion
    if ring.teeth - planet.teeth < LEAST_APART:
        received, allowed = f"{ring.teeth} teeth round {planet.teeth}", f"allowed: at least {LEAST_APART} teeth more"
        yield GeometryProblem("tips touch", "ring", received, allowed)
    first = planet.involute_start_roll_rad * planet.base_radius_m
    if pair.contact_start_m < first * (1.0 - 1e-9):
        received = f"contact from {mm(pair.contact_start_m)} along the line of action"
        allowed = f"allowed: from {mm(first)}, where the planet's flank starts; shorter tips of the ring"
        yield GeometryProblem("interference", "ring and planet", received, allowed)
    if ring.tip_half_thickness_m <= 0.0:
        allowed = "allowed: a tooth of some thickness there"
        yield GeometryProblem("pointed tip", "ring", f"profile shift {ring.profile_shift:.6g}", allowed)
    if pair.contact_ratio < 1.0:
        yield GeometryProblem("contact ratio", "ring and planet", f"{pair.contact_ratio:.6g}", "allowed: at least 1")


def ring_ahead_pitches(sun_pair: GearPair, ring_pair: InternalPair) -> float:
    """Return the pitches by which a planet's contact with the ring is past its pitch point, 0 to below 1.

    At the moment when its contact with the sun, which drives, stands at theirs; the same for all planets. The sun
    loads the flanks behind in the planet's sense of turning, the ring those in front; half a turn lies between both
    pitch points, less half a tooth at each (derived). Without shift: 0 for odd, 1/2 for even teeth of the planet.
    """
    planet = ring_pair.pinion
    half_teeth_rad = sum(
        planet.base_half_angle_rad - involute_function(angle)
        for angle in (sun_pair.working_pressure_angle_rad, ring_pair.working_pressure_angle_rad)
    )
    past = 0.5 * planet.teeth * (half_teeth_rad / pi - 1.0) % 1.0
    return 0.0 if 1.0 - past < 1e-12 or past < 1e-12 else past


def ring_begins_pitches(sun_pair: GearPair, ring_pair: InternalPair) -> float:
    """Return the base pitches that a planet's mesh with the ring has turned where its mesh with the sun has none.

    Both count from the moment when a pair enters contact.
    """
    paths = sun_pair, ring_pair
    to_sun, to_ring = ((path.pitch_point_m - path.contact_start_m) / path.base_pitch_m for path in paths)
    return to_ring + ring_ahead_pitches(sun_pair, ring_pair) - to_sun
