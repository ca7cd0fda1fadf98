"""A pair of spur or helical gears in mesh, and what makes a pair impossible.

Equations: reference, standard literature (involute gearing; ISO 21771). Positions s along the line of action count
from the pinion's base tangent point, so that the roll angles of the two flanks at the contact are s/R_b1 and (T -
s)/R_b2. The gears are those of the transverse plane; a helix turns their sections across the face (`helical`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import acos, atan, cos, isfinite, pi, radians, tan
from typing import Any

import numpy as np

from siggen.errors import UsageError, mm
from siggen.gears.involute import inverse_involute, involute_function
from siggen.gears.spur_gear import SpurGear, transverse_gear
from siggen.names import Side

__all__ = ["Gear", "GearPair", "GeometryProblem", "SpurGear", "geometry_problems"]

MIN_TEETH = 5
ADDENDUM, CLEARANCE = 1.0, 0.25
"""Of the basic rack, in modules (ISO 53, profile A)."""
STEEL_PA, STEEL_POISSON = 206e9, 0.3
"""Young's modulus (ISO 6336-1) and Poisson's ratio; 0.03 more or less of this moves contact and shear by 2 %."""
WIDTH_MODULES, BORE_SHARE = 8.0, 0.4
"""Of a pair of which a drawing says no more: face width in modules, bore over root circle (assumed)."""
REFERENCE_BAND = 1.0 / 40.0
"""Hertz half width over the relative radius of the flanks under the reference force: 1.4 GPa on steel."""
MAX_PRESSURE_ANGLE_RAD = radians(45.0)


@dataclass(frozen=True, slots=True)
class Gear:
    """One gear as a drawing states it.

    Attributes
    ----------
    teeth : int
    module_m, face_width_m : float
        Normal module and face width [m].
    pressure_angle_rad, helix_rad : float
        Of the normal section, and on the pitch cylinder, positive right-handed [rad].
    shift : float
        Of the profile, in modules.
    bore_radius_m : float
        [m].
    """

    teeth: int
    module_m: float
    face_width_m: float
    pressure_angle_rad: float
    helix_rad: float
    shift: float
    bore_radius_m: float

    @property
    def transverse(self) -> SpurGear:
        """The gear of the transverse plane, with its radii and flank."""
        normal = SpurGear(
            self.teeth, self.module_m, self.pressure_angle_rad, self.shift, ADDENDUM, CLEARANCE, self.bore_radius_m
        )
        return transverse_gear(normal, self.helix_rad)

    @property
    def base_radius_m(self) -> float:
        """Radius of the base circle [m]."""
        return self.transverse.base_radius_m

    @property
    def pitch_height_m(self) -> float:
        """Height of the pitch circle of the drawing above the base circle, along the tooth's axis [m]."""
        gear = self.transverse
        return float(gear.height_m(tan(gear.pressure_angle_rad)))


@dataclass(frozen=True, slots=True)
class GearPair:
    """Two gears of equal face width and material; `of` makes them from a drawing.

    Parameters
    ----------
    pinion, gear : SpurGear
    face_width_m : float
        Common face width L [m].
    youngs_modulus_pa : float
        Young's modulus of both gears [Pa].
    poisson_ratio : float
    centre_distance_m : float or None
        Working centre distance [m]; None for the one without backlash.
    helix_rad : float
        Helix angle on the generating pitch cylinder, positive where the pinion is right-handed [rad].
    """

    pinion: SpurGear
    gear: SpurGear
    face_width_m: float
    youngs_modulus_pa: float
    poisson_ratio: float
    centre_distance_m: float | None = None
    helix_rad: float = 0.0

    @staticmethod
    def of(
        teeth: tuple[int, int],
        module_mm: float,
        face_width_mm: float | None = None,
        *,
        pressure_angle_deg: float = 20.0,
        helix_deg: float = 0.0,
        shifts: tuple[float, float] = (0.0, 0.0),
        bores_mm: tuple[float, float] | None = None,
    ) -> GearPair:
        """Return the steel pair of a drawing, without backlash.

        Parameters
        ----------
        teeth : (int, int)
            Of the driving and the driven gear.
        module_mm, face_width_mm : float
            Normal module and face width; default 8 modules [mm].
        pressure_angle_deg, helix_deg : float
            Of the normal section, and on the pitch cylinder [degrees].
        shifts : (float, float)
            Of the profiles, in modules.
        bores_mm : (float, float)
            Diameters; default 0.4 of the root circles [mm].

        Raises
        ------
        UsageError
            If an argument is no number, or these teeth cannot be made or cannot mesh: says why.
        """
        whole, number = (int, np.integer), (int, float, np.number)
        _check("teeth", teeth, 2, whole, "2 whole numbers, such as (18, 47)")
        for name, value in (("module_mm", module_mm), ("face_width_mm", face_width_mm or 1.0),
                            ("pressure_angle_deg", pressure_angle_deg), ("helix_deg", helix_deg)):  # fmt: skip
            _check(name, (value,), 1, number, "a number")
        for name, values in (("shifts", shifts), ("bores_mm", bores_mm or (1.0, 1.0))):
            _check(name, values, 2, number, "2 numbers")
        width_m = 1e-3 * (WIDTH_MODULES * module_mm if face_width_mm is None else face_width_mm)
        alpha, beta, bores_m = radians(pressure_angle_deg), radians(helix_deg), []
        for i, count in enumerate(teeth):
            root_mm = module_mm * (count / cos(beta) - 2.0 * (ADDENDUM + CLEARANCE - shifts[i]))
            bores_m.append(0.5e-3 * (BORE_SHARE * root_mm if bores_mm is None else bores_mm[i]))
        gears = [
            Gear(count, 1e-3 * module_mm, width_m, alpha, beta, shift, bore_m).transverse
            for count, shift, bore_m in zip(teeth, shifts, bores_m, strict=True)
        ]
        pair = GearPair(gears[0], gears[1], width_m, STEEL_PA, STEEL_POISSON, None, beta)
        if problems := geometry_problems(pair):
            lines = (f"{one.where}: received {one.name}, {one.received}; {one.allowed}" for one in problems)
            raise UsageError(f"teeth={teeth} of module {module_mm} mm: " + "\n".join(lines))
        return pair

    @property
    def reference_force_n(self) -> float:
        """A large force for this pair alone [N]: in the middle of the path its band is `REFERENCE_BAND` wide.

        Derived from Hertz: a² = 4 F R/(π E* b).
        """
        middle = 0.5 * (self.contact_start_m + self.contact_end_m)
        radius = middle * (self.line_of_action_m - middle) / self.line_of_action_m
        modulus = 0.5 * self.youngs_modulus_pa / (1.0 - self.poisson_ratio**2)
        return 0.25 * pi * modulus * REFERENCE_BAND**2 * radius * self.face_width_m

    @property
    def driver(self) -> Gear:
        """The driving gear as a drawing states it."""
        return self._stated(self.pinion, self.helix_rad)

    @property
    def driven(self) -> Gear:
        """The driven gear as a drawing states it."""
        return self._stated(self.gear, -self.helix_rad)

    def _stated(self, gear: SpurGear, helix_rad: float) -> Gear:
        """Return a gear of the transverse plane by its normal section."""
        share, alpha = cos(helix_rad), atan(tan(gear.pressure_angle_rad) * cos(helix_rad))
        shift = gear.profile_shift / share
        return Gear(gear.teeth, gear.module_m * share, self.face_width_m, alpha, helix_rad, shift, gear.bore_radius_m)

    @property
    def tight_pressure_angle_rad(self) -> float:
        """Pressure angle of the mesh without backlash, inv = inv alpha_0 + 2 (X1 + X2) tan(alpha_0)/(z1 + z2) [rad]."""
        pinion, gear = self.pinion, self.gear
        shift = pinion.profile_shift + gear.profile_shift
        if shift == 0.0:
            return pinion.pressure_angle_rad
        teeth = pinion.teeth + gear.teeth
        angle = pinion.pressure_angle_rad
        return inverse_involute(involute_function(angle) + 2.0 * shift * tan(angle) / teeth)

    @property
    def working_pressure_angle_rad(self) -> float:
        """Working pressure angle alpha_w [rad]."""
        if self.centre_distance_m is None:
            return self.tight_pressure_angle_rad
        return acos(self._base_radii_m / self.centre_distance_m)

    @property
    def working_centre_distance_m(self) -> float:
        """Centre distance in mesh, (R_b1 + R_b2)/cos(alpha_w) [m]."""
        if self.centre_distance_m is None:
            return self._base_radii_m / cos(self.tight_pressure_angle_rad)
        return self.centre_distance_m

    @property
    def line_of_action_m(self) -> float:
        """Length T of the line of action between the base tangent points [m]."""
        return self._base_radii_m * tan(self.working_pressure_angle_rad)

    @property
    def contact_start_m(self) -> float:
        """Position s_A where the gear's tip enters contact [m]."""
        return self.line_of_action_m - self.gear.signed_base_radius_m * self.gear.tip_roll_rad

    @property
    def contact_end_m(self) -> float:
        """Position s_E where the pinion's tip leaves contact [m]."""
        return self.pinion.base_radius_m * self.pinion.tip_roll_rad

    @property
    def pitch_point_m(self) -> float:
        """Position s_P of the pitch point [m]."""
        return self.pinion.base_radius_m * tan(self.working_pressure_angle_rad)

    @property
    def base_pitch_m(self) -> float:
        """Base pitch p_b = 2 pi R_b1/z1 [m]."""
        return 2.0 * pi * self.pinion.base_radius_m / self.pinion.teeth

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio (s_E - s_A)/p_b."""
        return (self.contact_end_m - self.contact_start_m) / self.base_pitch_m

    @property
    def base_helix_rad(self) -> float:
        """Helix angle on the base cylinder, tan(beta_b) = tan(beta) cos(alpha_t) [rad]."""
        return atan(tan(self.helix_rad) * cos(self.pinion.pressure_angle_rad))

    @property
    def face_travel_m(self) -> float:
        """How far the contact of one end of the face is ahead of the other's, L |tan(beta_b)| [m]."""
        return self.face_width_m * abs(tan(self.base_helix_rad))

    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio, the part of the total contact ratio that the helix adds."""
        return self.face_travel_m / self.base_pitch_m

    @property
    def total_contact_ratio(self) -> float:
        """Base pitches from where a pair enters contact to where it leaves it, the overlap ratio among them."""
        return (self.engagement_end_m - self.engagement_start_m) / self.base_pitch_m

    @property
    def engagement_start_m(self) -> float:
        """Position of the middle of the face where the first end of the face enters contact; s_A of spur gears [m]."""
        return self.contact_start_m - 0.5 * self.face_travel_m

    @property
    def engagement_end_m(self) -> float:
        """Position of the middle of the face where the last end of the face leaves contact; s_E of spur gears [m]."""
        return self.contact_end_m + 0.5 * self.face_travel_m

    @property
    def active_flank(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Roll angles (first, last) of the flank that meets the mate: of the pinion, of the gear [rad]."""
        length = self.line_of_action_m
        pinion = (self.contact_start_m / self.pinion.base_radius_m, self.pinion.tip_roll_rad)
        gear = ((length - self.contact_end_m) / self.gear.base_radius_m, self.gear.tip_roll_rad)
        return pinion, gear

    @property
    def _base_radii_m(self) -> float:
        return self.pinion.base_radius_m + self.gear.signed_base_radius_m

    def member(self, side: Side) -> SpurGear:
        """Return one of its gears."""
        return self.pinion if Side(side) is Side.DRIVER else self.gear


@dataclass(frozen=True, slots=True)
class GeometryProblem:
    """One reason why a pair cannot be built or meshed: its name, where, what came, what is allowed."""

    name: str
    where: str
    received: str
    allowed: str

    def __str__(self) -> str:
        """One line: where, name, what was received, what is allowed."""
        return f"{self.where}: {self.name}: received {self.received}; {self.allowed}"


def _check(argument: str, values: Any, count: int, kinds: tuple[type, ...], allowed: str) -> None:
    """Refuse what are not so many numbers of these kinds."""
    listed: tuple[Any, ...] = tuple(values) if isinstance(values, (tuple, list)) else ()
    numbers = len(listed) == count and all(isinstance(one, kinds) for one in listed)
    if not (numbers and all(map(isfinite, listed))):
        raise UsageError(f"{argument}: received {values[0] if count == 1 else values!r}; allowed: {allowed}")


def geometry_problems(pair: GearPair) -> tuple[GeometryProblem, ...]:
    """Return everything that makes a pair impossible; empty for a usable one.

    Later groups of checks need the earlier ones to hold, so they are skipped once a group has failed. Undercut alone
    is no problem: only undercut that reaches the flank in contact is. Never raises.
    """
    for group in (_numbers, _teeth, _centres, _contact):
        problems = tuple(group(pair))
        if problems:
            return problems
    return ()


def _numbers(pair: GearPair) -> Iterator[GeometryProblem]:
    for side, gear in ((Side.DRIVER, pair.pinion), (Side.DRIVEN, pair.gear)):
        if not (isinstance(gear.teeth, int) and gear.teeth >= MIN_TEETH):
            yield GeometryProblem("teeth", side, repr(gear.teeth), f"allowed: a whole number of at least {MIN_TEETH}")
        yield from _positive(side, "module_m", gear.module_m)
        yield from _positive(side, "addendum_coefficient", gear.addendum_coefficient)
        yield from _positive(side, "clearance_coefficient", gear.clearance_coefficient)
        yield from _positive(side, "bore_radius_m", gear.bore_radius_m)
        if not 0.0 < gear.pressure_angle_rad < MAX_PRESSURE_ANGLE_RAD:
            received = f"{gear.pressure_angle_rad!r} rad"
            yield GeometryProblem("pressure_angle_rad", side, received, "allowed: above 0 and below 45 degrees")
        if not abs(gear.profile_shift) <= 2.0:
            yield GeometryProblem("profile_shift", side, repr(gear.profile_shift), "allowed: -2 to 2")
    yield from _positive("pair", "face_width_m", pair.face_width_m)
    yield from _positive("pair", "youngs_modulus_pa", pair.youngs_modulus_pa)
    if not 0.0 <= pair.poisson_ratio < 0.5:
        yield GeometryProblem("poisson_ratio", "pair", repr(pair.poisson_ratio), "allowed: at least 0 and below 0.5")
    if pair.centre_distance_m is not None:
        yield from _positive("pair", "centre_distance_m", pair.centre_distance_m)
    for name in ("module_m", "pressure_angle_rad"):
        first, second = getattr(pair.pinion, name), getattr(pair.gear, name)
        if first != second:
            yield GeometryProblem(name, "pair", f"{first!r} and {second!r}", "allowed: the same on pinion and gear")


def _positive(where: str, name: str, value: float) -> Iterator[GeometryProblem]:
    if not (isfinite(value) and value > 0.0):
        yield GeometryProblem(name, where, repr(value), "allowed: finite and above 0")


def _teeth(pair: GearPair) -> Iterator[GeometryProblem]:
    for side, gear in ((Side.DRIVER, pair.pinion), (Side.DRIVEN, pair.gear)):
        if gear.bore_radius_m >= gear.root_radius_m:
            allowed = f"allowed: below the root radius {mm(gear.root_radius_m)}"
            yield GeometryProblem("bore_radius_m", side, mm(gear.bore_radius_m), allowed)
        if gear.base_half_angle_rad <= 0.0 or gear.tip_radius_m <= max(gear.base_radius_m, gear.root_radius_m):
            allowed = (
                f"allowed: a tip above the base radius {mm(gear.base_radius_m)} and a tooth of some thickness there"
            )
            yield GeometryProblem("no involute flank", side, f"profile_shift {gear.profile_shift!r}", allowed)
        elif gear.tip_half_thickness_m <= 0.0:
            received = f"half tip thickness {mm(gear.tip_half_thickness_m)} with profile_shift {gear.profile_shift!r}"
            yield GeometryProblem(
                "pointed tip", side, received, "allowed: above 0; lower the profile shift or the addendum"
            )
        elif gear.base_radius_m * gear.base_half_angle_rad >= gear.root_radius_m > 0.0:
            received = f"root radius {mm(gear.root_radius_m)}"
            allowed = f"allowed: above the half tooth thickness {mm(gear.base_radius_m * gear.base_half_angle_rad)}"
            yield GeometryProblem("root radius", side, received, allowed)
        room = 0.5 * pi * gear.module_m
        if gear.rack_round_offset_m > room:
            received = f"clearance_coefficient {gear.clearance_coefficient!r}, round at {mm(gear.rack_round_offset_m)}"
            allowed = f"allowed: a rack tip round centred within half a pitch, {mm(room)}; lower it or the addendum"
            yield GeometryProblem("rack tip", side, received, allowed)


def _centres(pair: GearPair) -> Iterator[GeometryProblem]:
    shift = pair.pinion.profile_shift + pair.gear.profile_shift
    angle = pair.pinion.pressure_angle_rad
    room = involute_function(angle) + 2.0 * shift * tan(angle) / (pair.pinion.teeth + pair.gear.teeth)
    if room <= 0.0:
        yield GeometryProblem(
            "profile_shift", "pair", f"sum {shift:.6g}", "allowed: a sum that leaves a positive working pressure angle"
        )
        return
    base = pair.pinion.base_radius_m + pair.gear.base_radius_m
    tight = base / cos(pair.tight_pressure_angle_rad)
    given = pair.centre_distance_m
    # Rounding of a centre distance that a user typed from the formula must not count as jamming.
    if given is not None and given < tight * (1.0 - 1e-9):
        yield GeometryProblem("centre_distance_m", "pair", mm(given), f"allowed: at least {mm(tight)} (no backlash)")
        return
    distance = pair.working_centre_distance_m
    for side, own, mate in ((Side.DRIVER, pair.pinion, pair.gear), (Side.DRIVEN, pair.gear, pair.pinion)):
        clearance = distance - own.tip_radius_m - mate.root_radius_m
        if clearance <= 0.0:
            received = f"tip clearance {mm(clearance)}"
            yield GeometryProblem(
                "tip touches root", side, received, "allowed: above 0; lower the profile shift or the addendum"
            )


def _contact(pair: GearPair) -> Iterator[GeometryProblem]:
    if pair.contact_ratio < 1.0:
        yield GeometryProblem("contact ratio", "pair", f"{pair.contact_ratio:.6g}", "allowed: at least 1")
    for side, gear, active in zip(Side, (pair.pinion, pair.gear), pair.active_flank, strict=True):
        first = active[0]
        if first <= 0.0:
            received = f"contact {mm(-first * gear.base_radius_m)} below the base circle"
            allowed = "allowed: contact above the base circle only; more teeth or shift"
            yield GeometryProblem("interference", side, received, allowed)
        if first > 0.0 or gear.undercut:
            yield from _flank_start(side, gear, first)


def _flank_start(side: Side, gear: SpurGear, first: float) -> Iterator[GeometryProblem]:
    try:
        start = gear.involute_start_roll_rad
    except ValueError as error:
        yield GeometryProblem(
            "undercut", side, f"{gear.teeth} teeth, profile_shift {gear.profile_shift!r}", f"allowed: {error}"
        )
        return
    if first < start:
        name = "undercut" if gear.undercut else "interference"
        received = f"contact from {mm(first * gear.base_radius_m)} along the line of action"
        allowed = f"allowed: from the start of the involute, {mm(start * gear.base_radius_m)}, onwards"
        yield GeometryProblem(name, side, received, allowed)


# The path of contact in stretches of equal numbers of tooth pairs.
#
# Equations: reference, standard literature (involute gearing): a pair at s has its neighbours at s plus and minus
# whole base pitches, so the number changes where s is a whole number of base pitches away from s_A or s_E.


@dataclass(frozen=True, slots=True)
class ContactZone:
    """A stretch of the line of action, from `start_m` to `end_m` [m], and how many pairs carry the load there."""

    start_m: float
    end_m: float
    pairs: int


def contact_zones(pair: GearPair) -> tuple[ContactZone, ...]:
    """Return the zones from s_A to s_E in order; double, single, double for a contact ratio between 1 and 2.

    Source: derived.
    """
    start, end, pitch = pair.contact_start_m, pair.contact_end_m, pair.base_pitch_m
    shifts = pitch * np.arange(int(pair.contact_ratio) + 2)
    marks = np.concatenate([start + shifts, end - shifts])
    edges = np.unique(marks[(marks >= start) & (marks <= end)])
    # A contact ratio within rounding of a whole number has zones of no length.
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-9 * pitch])]
    middle = 0.5 * (edges[1:] + edges[:-1])
    others = middle[:, np.newaxis] + np.concatenate([-shifts[:0:-1], shifts])
    pairs = np.sum((others > start) & (others < end), axis=1)
    rows = zip(edges[:-1].tolist(), edges[1:].tolist(), pairs.tolist(), strict=True)
    return tuple(ContactZone(low, high, count) for low, high, count in rows)


# An idler, one gear in two meshes: how far the second one has turned where the first has none.
#
# All derived. Angles ψ about the idler count in its own sense of turning. The gear in front, at ψ_a, pushes its hinder
# flanks: contact at ρ = T - s before the base tangent point ψ_a + α_1, so that flank begins on the base circle at ψ_a
# + α_1 - ρ/R_b. Its fore flanks push the gear behind, at ψ_c: contact at s after the base tangent point ψ_c - α_2, so
# that flank begins at ψ_c - α_2 + s/R_b. Between both lies the tooth on the base circle.


def idler_ahead_pitches(front: GearPair, behind: GearPair, between_rad: float) -> float:
    """Return the base pitches that the mesh behind an idler has turned where that in front has turned none.

    Both count from the moment when a pair of the idler's tooth 0 enters, from 0 to below the idler's teeth.

    Parameters
    ----------
    front, behind : GearPair
        The idler is the gear of the first and the pinion of the second.
    between_rad : float
        Angle about the idler from the gear behind to the gear in front, in the sense in which the idler turns [rad].
    """
    idler = behind.pinion
    turned = between_rad + front.working_pressure_angle_rad + behind.working_pressure_angle_rad
    pitches = idler.teeth / (2.0 * pi) * (turned + 2.0 * idler.base_half_angle_rad)
    return (pitches - _flank_pitches(front, behind)) % idler.teeth


def idler_later_rad(front: GearPair, behind: GearPair) -> float:
    """Return by how much the phase of an idler's eccentricity is later in the mesh behind than in that in front.

    Moved by e the idler stands back from the gear in front by e cos β, with β its angle against the push, and from the
    gear behind by -e cos β; where both gears stand cancels against `idler_ahead_pitches`.
    """
    idler = behind.pinion
    flanks_rad = 2.0 * pi / idler.teeth * _flank_pitches(front, behind)
    return flanks_rad - pi - 2.0 * idler.base_half_angle_rad


def _flank_pitches(front: GearPair, behind: GearPair) -> float:
    """Return the base pitches along both flanks of a tooth from the base circle to where it enters."""
    return (front.line_of_action_m - front.contact_start_m + behind.contact_start_m) / behind.base_pitch_m
