"""A planet inside a ring: radii of the ring's teeth, path of contact, where the ring's mesh stands after the sun's.

Equations: standard literature (internal involute gearing); the phase between both meshes of a planet is derived. The
planet drives. Positions s along the line of action count from the planet's base tangent point; the ring's lies at -T,
so that the flanks' radii of curvature are s and s + T, the ring's being hollow.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import acos, cos, pi, sqrt, tan

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair, GeometryProblem
from siggen.gears.geometry.involute import inverse_involute, involute_function
from siggen.gears.geometry.spur_gear import SpurGear

LEAST_APART = 10
"""Teeth that a ring has more than a planet, so that tips do not meet beside the path (standard literature)."""


@dataclass(frozen=True, slots=True)
class RingGear:
    """Teeth that point inwards; the spaces between them are the teeth of an outer gear of the same numbers.

    Parameters
    ----------
    teeth : int
    module_m, pressure_angle_rad : float
        [m], [rad].
    profile_shift : float
        Positive: spaces wider, teeth thinner and farther out.
    addendum_coefficient, clearance_coefficient : float
        Tip height and tip clearance in modules.
    cut_back_m : float
        By how much the tips are shortened [m].
    """

    teeth: int
    module_m: float
    pressure_angle_rad: float
    profile_shift: float
    addendum_coefficient: float
    clearance_coefficient: float
    cut_back_m: float = 0.0

    @property
    def pitch_radius_m(self) -> float:
        """Generating pitch radius [m]."""
        return 0.5 * self.module_m * self.teeth

    @property
    def base_radius_m(self) -> float:
        """Base radius [m]."""
        return self.pitch_radius_m * cos(self.pressure_angle_rad)

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
    def space_half_angle_rad(self) -> float:
        """Half angle of a space on the base circle, as of the tooth of an outer gear [rad]."""
        shift = 2.0 * self.profile_shift * tan(self.pressure_angle_rad) / self.teeth
        return pi / (2.0 * self.teeth) + involute_function(self.pressure_angle_rad) + shift

    def half_angle_rad(self, radius_m: FloatArray) -> FloatArray:
        """Return half the angle that a tooth fills at radii (k,) from the base circle outwards [rad]."""
        slant = np.arccos(np.minimum(self.base_radius_m / radius_m, 1.0))
        return np.asarray(pi / self.teeth - self.space_half_angle_rad + np.tan(slant) - slant)


@dataclass(frozen=True, slots=True)
class InternalPair:
    """A driving planet in a ring, without backlash: the centre distance says how the ring must be shifted."""

    planet: SpurGear
    ring: RingGear
    face_width_m: float
    youngs_modulus_pa: float
    poisson_ratio: float

    @property
    def working_pressure_angle_rad(self) -> float:
        """Working pressure angle, inv = inv alpha_0 + 2 (X_r - X_p) tan(alpha_0)/(z_r - z_p) [rad]."""
        angle = self.planet.pressure_angle_rad
        shift = self.ring.profile_shift - self.planet.profile_shift
        teeth = self.ring.teeth - self.planet.teeth
        return angle if shift == 0.0 else inverse_involute(involute_function(angle) + 2.0 * shift * tan(angle) / teeth)

    @property
    def working_centre_distance_m(self) -> float:
        """Centre distance (R_br - R_bp)/cos(alpha_w) [m]."""
        return self._base_radii_m / cos(self.working_pressure_angle_rad)

    @property
    def line_of_action_m(self) -> float:
        """Distance T of the base tangent points, both on one side of the contact [m]."""
        return self._base_radii_m * tan(self.working_pressure_angle_rad)

    @property
    def contact_start_m(self) -> float:
        """Position where the ring's tip enters contact [m]; -T where the tip lies inside of the base circle."""
        ring = self.ring
        return sqrt(max(ring.tip_radius_m**2 - ring.base_radius_m**2, 0.0)) - self.line_of_action_m

    @property
    def contact_end_m(self) -> float:
        """Position where the planet's tip leaves contact [m]."""
        return self.planet.base_radius_m * self.planet.tip_roll_rad

    @property
    def pitch_point_m(self) -> float:
        """Position of the pitch point [m]."""
        return self.planet.base_radius_m * tan(self.working_pressure_angle_rad)

    @property
    def base_pitch_m(self) -> float:
        """Base pitch [m]."""
        return 2.0 * pi * self.planet.base_radius_m / self.planet.teeth

    @property
    def contact_ratio(self) -> float:
        """Mean number of pairs in contact."""
        return (self.contact_end_m - self.contact_start_m) / self.base_pitch_m

    @property
    def _base_radii_m(self) -> float:
        return self.ring.base_radius_m - self.planet.base_radius_m

    def ring_radius_m(self, position_m: FloatArray) -> FloatArray:
        """Return the radius on the ring of contacts at positions (k,) [m]."""
        return np.hypot(self.ring.base_radius_m, position_m + self.line_of_action_m)


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
    ring = RingGear(teeth, planet.module_m, angle, shift, height, clearance)
    pair = InternalPair(planet, ring, sun_pair.face_width_m, sun_pair.youngs_modulus_pa, sun_pair.poisson_ratio)
    return replace(pair, ring=replace(ring, cut_back_m=max(_clear_radius_m(pair) - ring.tip_radius_m, 0.0)))


def _clear_radius_m(pair: InternalPair) -> float:
    """Return the least radius of the ring's tips that does not reach the planet's fillet [m]."""
    first = pair.planet.involute_start_roll_rad * pair.planet.base_radius_m
    return float(pair.ring_radius_m(np.array([first]))[0])


def internal_problems(pair: InternalPair) -> tuple[GeometryProblem, ...]:
    """Return everything that keeps a planet from meshing with its ring; empty for a usable pair."""
    return tuple(_internal(pair))


def _internal(pair: InternalPair) -> Iterator[GeometryProblem]:
    ring, planet = pair.ring, pair.planet
    if ring.teeth - planet.teeth < LEAST_APART:
        received, allowed = f"{ring.teeth} teeth round {planet.teeth}", f"allowed: at least {LEAST_APART} teeth more"
        yield GeometryProblem("tips touch", "ring", received, allowed)
    first = planet.involute_start_roll_rad * planet.base_radius_m
    if pair.contact_start_m < first * (1.0 - 1e-9):
        received = f"contact from {pair.contact_start_m:.6g} m along the line of action"
        allowed = f"allowed: from {first:.6g} m, where the planet's flank starts; shorter tips of the ring"
        yield GeometryProblem("interference", "ring and planet", received, allowed)
    if float(ring.half_angle_rad(np.array([ring.tip_radius_m]))[0]) <= 0.0:
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
    planet = ring_pair.planet
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
