"""A planet inside a ring: radii of the ring's teeth, path of contact, where the ring's mesh stands after the sun's.

Equations: standard literature (internal involute gearing); the phase between both meshes of a planet is derived. The
planet drives. Positions s along the line of action count from the planet's base tangent point; the ring's lies on the
same side of the contact, at T < 0, so that the flanks' radii of curvature are s and s - T, the ring's being hollow.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import acos, cos, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.geometry.gear_pair import GearPair, GeometryProblem
from siggen.gears.geometry.involute import inverse_involute, involute_function
from siggen.gears.geometry.spur_gear import SpurGear

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
