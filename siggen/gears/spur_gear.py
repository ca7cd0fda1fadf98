"""One spur gear cut by a rack: its radii, tooth thickness, fillet and flank.

Equations: reference, standard literature (involute spur gears, ISO 21771 for profile shift), in the roll-angle form of
`siggen.gears.involute`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import atan, cos, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.gears import involute, trochoid

SOLID_BODY_RATIO = 3.0
"""Root radius over the radius at which a solid body counts as held (judgement)."""


@dataclass(frozen=True, slots=True)
class SpurGear:
    """A rack-cut involute spur gear.

    Parameters
    ----------
    teeth : int
        Number of teeth.
    module_m : float
        Module [m].
    pressure_angle_rad : float
        Generating pressure angle of the rack [rad].
    profile_shift : float
        Profile shift coefficient X (positive: rack moved outwards).
    addendum_coefficient, clearance_coefficient : float
        Tip height and tip clearance in modules (ha and c).
    bore_radius_m : float
        Radius of the bore [m].
    body_ratio : float
        Least ratio of the root radius to the radius at which the body is held; 1 of a ring that is held in its bore.
    """

    teeth: int
    module_m: float
    pressure_angle_rad: float
    profile_shift: float
    addendum_coefficient: float
    clearance_coefficient: float
    bore_radius_m: float
    body_ratio: float = SOLID_BODY_RATIO

    @property
    def pitch_radius_m(self) -> float:
        """Generating pitch radius r = m z / 2 [m]."""
        return 0.5 * self.module_m * self.teeth

    @property
    def base_radius_m(self) -> float:
        """Base radius R_b = r cos(alpha_0) [m]."""
        return self.pitch_radius_m * cos(self.pressure_angle_rad)

    @property
    def signed_base_radius_m(self) -> float:
        """Base radius as it counts along a line of action: that of a ring is negative [m]."""
        return self.base_radius_m

    @property
    def flank_rolls_rad(self) -> tuple[float, float]:
        """Roll angles of the ends of the flank, ascending: the start of the involute and the tip [rad]."""
        return self.involute_start_roll_rad, self.tip_roll_rad

    @property
    def last_roll_rad(self) -> float:
        """Roll angle of the end of the flank that is farther from the centre [rad]."""
        return self.tip_roll_rad

    @property
    def tip_radius_m(self) -> float:
        """Tip radius R_a = r + (ha + X) m [m]; no tip shortening."""
        return self.pitch_radius_m + (self.addendum_coefficient + self.profile_shift) * self.module_m

    @property
    def root_radius_m(self) -> float:
        """Root radius R_f = r - (ha + c - X) m [m]."""
        dedendum = self.addendum_coefficient + self.clearance_coefficient - self.profile_shift
        return self.pitch_radius_m - dedendum * self.module_m

    @property
    def held_radius_m(self) -> float:
        """Radius inside which the body counts as rigid, min(bore, root/3) [m].

        Derived: a gear and its shaft are one body. Held in its bore, a thin rim would be stiffer than a solid gear.
        """
        return min(self.bore_radius_m, self.root_radius_m / self.body_ratio)

    @property
    def base_half_angle_rad(self) -> float:
        """Half tooth angle on the base circle, alpha_2 = pi/(2z) + inv(alpha_0) + 2 X tan(alpha_0)/z [rad]."""
        shift = 2.0 * self.profile_shift * tan(self.pressure_angle_rad) / self.teeth
        return pi / (2.0 * self.teeth) + involute.involute_function(self.pressure_angle_rad) + shift

    @property
    def base_height_m(self) -> float:
        """Height of the base-circle point above the gear centre, R_b cos(alpha_2): where x = 0 [m]."""
        return self.base_radius_m * cos(self.base_half_angle_rad)

    @property
    def tip_roll_rad(self) -> float:
        """Roll angle of the tip [rad]."""
        return sqrt((self.tip_radius_m / self.base_radius_m) ** 2 - 1.0)

    @property
    def tip_half_thickness_m(self) -> float:
        """Half tooth thickness at the tip [m]; not positive when the tooth is pointed."""
        return float(involute.half_thickness(self.tip_roll_rad, self.base_radius_m, self.base_half_angle_rad))

    @property
    def root_roll_rad(self) -> float:
        """Roll angle of the involute on the root circle, 0 when the root circle lies inside the base circle [rad]."""
        return sqrt(max((self.root_radius_m / self.base_radius_m) ** 2 - 1.0, 0.0))

    @property
    def root_half_angle_rad(self) -> float:
        """Half angle of the idealised (straight or involute) root on the root circle [rad]."""
        if self.root_radius_m < self.base_radius_m:
            ratio = self.base_radius_m * sin(self.base_half_angle_rad) / self.root_radius_m
            return float(np.arcsin(ratio))
        return self.base_half_angle_rad - (self.root_roll_rad - atan(self.root_roll_rad))

    @property
    def rack_round_m(self) -> float:
        """Radius of the rack's tip round, rho m with rho = c/(1 - sin alpha_0) [m]."""
        return self.clearance_coefficient * self.module_m / (1.0 - sin(self.pressure_angle_rad))

    @property
    def rack_round_depth_m(self) -> float:
        """Depth a1 of the round's centre below the rolling line, (ha + c - X) m - rho m [m]."""
        dedendum = self.addendum_coefficient + self.clearance_coefficient - self.profile_shift
        return dedendum * self.module_m - self.rack_round_m

    @property
    def rack_round_offset_m(self) -> float:
        """Distance b1 of the round's centre from the tooth's centre line [m].

        b1 = pi m/4 + ha m tan(alpha_0) + rho m cos(alpha_0), whatever the profile shift.
        """
        flank = self.addendum_coefficient * self.module_m * tan(self.pressure_angle_rad)
        return 0.25 * pi * self.module_m + flank + self.rack_round_m * cos(self.pressure_angle_rad)

    @property
    def rack_root_half_angle_rad(self) -> float:
        """Half angle at which the trochoid touches the root circle, b1/r [rad]; for the fillet foundation."""
        return self.rack_round_offset_m / self.pitch_radius_m

    @property
    def undercut(self) -> bool:
        """Whether the rack's straight flank ends below the base tangent point, so that its round cuts the involute."""
        return self._rack_flank_end_roll < 0.0

    @property
    def _rack_flank_end_roll(self) -> float:
        depth = (self.addendum_coefficient - self.profile_shift) * self.module_m
        return tan(self.pressure_angle_rad) - depth / (self.base_radius_m * sin(self.pressure_angle_rad))

    @property
    def involute_start_roll_rad(self) -> float:
        """Roll angle where the rack-cut involute starts [rad]; on an undercut tooth where the trochoid crosses it."""
        return _handover(self)[1]

    @property
    def involute_start_gamma_rad(self) -> float:
        """Trochoid parameter gamma where the involute starts [rad]; alpha_0 unless the tooth is undercut."""
        return _handover(self)[0]

    def trochoid_point_m(self, gamma: float) -> tuple[float, float]:
        """Return height above the gear centre and half thickness of the rack-cut fillet at gamma [m]."""
        y, h = trochoid.trochoid_point(
            gamma, self.rack_round_depth_m, self.rack_round_offset_m, self.rack_round_m, self.pitch_radius_m
        )
        return float(y), float(h)

    def height_m(self, roll: ArrayLike) -> FloatArray:
        """Return the height x above the base-circle point along the tooth centre line, shape of `roll` [m]."""
        angles = np.asarray(roll, dtype=np.float64)
        flat = involute.heights(angles.ravel(), self.base_radius_m, self.base_half_angle_rad)
        return flat.reshape(angles.shape)[()]

    def half_thickness_m(self, roll: ArrayLike) -> FloatArray:
        """Return the half tooth thickness, shape of `roll` [m]."""
        angles = np.asarray(roll, dtype=np.float64)
        flat = involute.half_thicknesses(angles.ravel(), self.base_radius_m, self.base_half_angle_rad)
        return flat.reshape(angles.shape)[()]

    def radius_m(self, roll: ArrayLike) -> FloatArray:
        """Return the radius of the flank point, R_b sqrt(1 + psi^2), shape of `roll` [m]."""
        return self.base_radius_m * np.hypot(1.0, np.asarray(roll, dtype=np.float64))

    def roll_at_height(self, height_m: ArrayLike) -> FloatArray:
        """Return the roll angle at height x, shape of `height_m` [rad].

        Raises
        ------
        ValueError
            If a height is negative, not finite or above the height where the involute turns over.
        """
        x = np.asarray(height_m, dtype=np.float64)
        top = _turning_height_m(self)
        if not bool(np.all((x >= 0.0) & (x <= top))):
            raise ValueError(
                f"height_m {_span(x)} m is off the involute; allowed: 0 to {top:.6g} m above the base circle"
            )
        flat = involute.rolls_at_heights(x.ravel(), self.base_radius_m, self.base_half_angle_rad)
        return flat.reshape(x.shape)[()]

    def roll_at_radius(self, radius_m: ArrayLike) -> FloatArray:
        """Return the roll angle at a radius, sqrt((R/R_b)^2 - 1), shape of `radius_m` [rad].

        Raises
        ------
        ValueError
            If a radius is below the base radius or not finite.
        """
        radius = np.asarray(radius_m, dtype=np.float64)
        if not bool(np.all((radius >= self.base_radius_m) & np.isfinite(radius))):
            raise ValueError(
                f"radius_m {_span(radius)} m is off the involute; allowed: at least {self.base_radius_m:.6g} m"
            )
        excess = (radius - self.base_radius_m) * (radius + self.base_radius_m)
        return np.sqrt(excess) / self.base_radius_m


def transverse_gear(normal: SpurGear, helix_rad: float) -> SpurGear:
    """Return the transverse section of a gear whose module, angle and coefficients are those of the normal section."""
    if helix_rad == 0.0:
        return normal
    share = cos(helix_rad)
    return replace(
        normal,
        module_m=normal.module_m / share,
        pressure_angle_rad=atan(tan(normal.pressure_angle_rad) / share),
        profile_shift=normal.profile_shift * share,
        addendum_coefficient=normal.addendum_coefficient * share,
        clearance_coefficient=normal.clearance_coefficient * share,
    )


def _span(values: FloatArray) -> str:
    return f"{np.min(values):.6g} to {np.max(values):.6g}" if values.size else "(empty)"


def _turning_height_m(gear: SpurGear) -> float:
    """Return the height at which the involute turns over [m]."""
    return float(gear.height_m(0.5 * pi + gear.base_half_angle_rad))


def _handover(gear: SpurGear) -> tuple[float, float]:
    if not gear.undercut:
        return gear.pressure_angle_rad, gear._rack_flank_end_roll
    return trochoid.undercut_handover(
        gear.pressure_angle_rad,
        gear.rack_round_depth_m,
        gear.rack_round_offset_m,
        gear.rack_round_m,
        gear.pitch_radius_m,
        gear.base_half_angle_rad,
    )


# RootChord: where the root of a rack-cut tooth is stressed most, by the tangent of 30 degrees (ISO 6336-3).

TANGENT_RAD = pi / 6.0
"""Between the fillet's tangent and the tooth's centre line."""


class RootChord(NamedTuple):
    """Height above the gear centre and length of the chord between the two points of the fillets [m]."""

    height_m: float
    length_m: float


@lru_cache(maxsize=256)
def root_chord(gear: SpurGear) -> RootChord:
    """Return the chord between the points of both fillets whose tangent makes 30 degrees with the centre line.

    Raises
    ------
    ValueError
        If the fillet has no such tangent.

    Source: ISO 6336-3 (memory); derived: at gamma the common normal has the slope gamma - turn, so the tangent makes
    this angle with the centre line. It falls from the root circle to the involute.
    """
    from scipy.optimize import brentq

    def over(gamma: float) -> float:
        turn = (gear.rack_round_depth_m / tan(gamma) + gear.rack_round_offset_m) / gear.pitch_radius_m
        return gamma - turn - TANGENT_RAD

    first, last = gear.involute_start_gamma_rad, 0.5 * pi
    if not over(first) < 0.0 < over(last):
        raise ValueError("the fillet has no tangent at 30 degrees to the tooth's centre line")
    height, half = gear.trochoid_point_m(brentq(over, first, last, xtol=1e-14))
    return RootChord(height, 2.0 * half)
