"""Compliance of one tooth under a load normal to its flank: bending, shear, axial compression and foundation.

Source: paper A, section 2.2 (potential energy method); equations: reference, standard literature (Yang-Lin, Tian), in
roll-angle form. With alpha_1 = psi_c - alpha_2 (signed: negative near the base circle), d = x(psi_c), h_c = h(psi_c):

    1/k_b = int [cos(alpha_1) (d - x) - sin(alpha_1) h_c]^2/(E I) dx
    1/k_s = 1.2 cos^2(alpha_1) int dx/(G A)        1/k_a = sin^2(alpha_1) int dx/(E A)

The calibrated tooth scales all four parts of the healthy rack-cut tooth by the finite-element factor of
`siggen.mesh.calibration`; what pits add to the beam is not scaled, since the factor was made on healthy
teeth.

Of helical teeth the beam bends in its normal section. The body beneath is none of that section: it takes the force of
the transverse plane as the body of a spur gear does, and the axial force, tan β_b of it, as a plate (`axial_body`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, tan

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.damage.flank_damage import pit_rows
from siggen.damage.kinks import section_kinks
from siggen.damage.part import Damage, ToothDamage, goes_through
from siggen.gears import involute
from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import normal_pair, normal_rolls
from siggen.gears.planetary import RingGear
from siggen.gears.quadrature import NODES_48, WEIGHTS_48
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.axial_body import axial_compliance
from siggen.mesh.beams import beam_integrals, first_roll
from siggen.mesh.calibration import calibration_factor
from siggen.mesh.pitted_beams import pit_integrals, pit_sums
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.names import Side

# Compliance of the gear body under the tooth root (fillet foundation), and where its fitted polynomials hold.
#
# Source: Sainsot, Velex and Duverger 2004, "Contribution of gear body to tooth deflections", with the half angle
# theta_f of the root in rad, the full root arc S_f = 2 R_f theta_f and the lever u_f = R_b/cos(alpha_1) - R_f. Damage
# never changes it (paper A).

# Rows L*, M*, P*, Q*; columns A to F of X* = A/theta^2 + B h^2 + C h/theta + D/theta + E h + F.
SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
SAINSOT.setflags(write=False)
FIT_RADIUS_RATIO = (1.4, 7.0)
FIT_ROOT_ANGLE_RAD = (0.01, 0.12)


def root_half_angle(gear: SpurGear, reading: str) -> float:
    """Return theta_f [rad]: 'profile' for the idealised root, 'rack' for the root a rack cuts."""
    return gear.rack_root_half_angle_rad if reading == "rack" else gear.root_half_angle_rad


def foundation_compliance(
    gear: SpurGear, roll: FloatArray, reading: str, youngs_modulus_pa: float, face_width_m: float
) -> FloatArray:
    """Return 1/k_f at the roll angles of the contact (k,) [m/N].

    Parameters
    ----------
    gear : SpurGear
    roll : (k,)
        Roll angle of the contact [rad].
    reading : str
        'profile' or 'rack': which tooth root theta_f belongs to.
    youngs_modulus_pa, face_width_m : float
        [Pa], [m].
    """
    angle = root_half_angle(gear, reading)
    ratio = gear.root_radius_m / gear.held_radius_m
    terms = np.array([angle**-2, ratio**2, ratio / angle, 1.0 / angle, ratio, 1.0])
    big_l, big_m, big_p, big_q = SAINSOT @ terms
    slant = roll - gear.base_half_angle_rad
    lever = gear.base_radius_m / np.cos(slant) - gear.root_radius_m
    share = lever / (2.0 * gear.root_radius_m * angle)
    bracket = big_l * share**2 + big_m * share + big_p * (1.0 + big_q * np.tan(slant) ** 2)
    return np.asarray(np.cos(slant) ** 2 * bracket / (youngs_modulus_pa * face_width_m))


def outside_foundation_fit(gear: SpurGear, reading: str) -> tuple[str, ...]:
    """Return what lies outside the published fit range, as sentences; empty inside it.

    Outside, the polynomials extrapolate; a rack-cut root of a small gear is the common case (18 teeth: theta_f 0.167
    rad).
    """
    found = []
    for name, value, (low, high) in (
        ("h_f = root radius / held radius", gear.root_radius_m / gear.held_radius_m, FIT_RADIUS_RATIO),
        ("theta_f [rad]", root_half_angle(gear, reading), FIT_ROOT_ANGLE_RAD),
    ):
        if not low <= value <= high:
            found.append(f"foundation fit: {name} is {value:.4g}; fitted range {low:g} to {high:g}")
    return tuple(found)


# Compliance of one tooth of a ring under a load normal to its flank.
#
# Equations: standard literature. Beam: potential energy as in `compliance`, over the ring's own profile, whose root is
# its thickest part. With the half angle tau and the pressure angle alpha at the contact the load is slanted by alpha +
# tau against the normal of the tooth's centre line, towards the root (derived). Foot: O'Donnell's flexible root in
# plane stress, coefficients as in Cornell 1981 (memory): the ring is held in a housing, so it has no thin rim. What
# notches take of the sections between contact and root is added as in other teeth (`compliance`).

ROTATION, SHIFT = 16.67 / pi, 1.534
"""Of a foot on a half plane: by a moment, by a shearing force."""
SHEAR_FACTOR = 1.2


def ring_tooth_parts(pair: GearPair, ring: RingGear, roll: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return bending, shear and axial compliance (3, k) and that of the foot (k,) of a tooth at roll angles [m/N].

    Parameters
    ----------
    pair : GearPair
        Of which face width and material are read.
    ring : RingGear
    roll : (k,)
        Roll angles of the contact on the ring's flank [rad].

    Source: module; exact to the quadrature of 48 nodes, which is exact to 1e-12 for these smooth profiles.
    """
    width = pair.face_width_m
    radius = ring.radius_m(roll)
    tau = ring.half_angle_rad(radius)
    slant = np.arctan(roll) + tau
    along, across, offset = np.sin(slant), np.cos(slant), radius * np.sin(tau)
    half = 0.5 * (ring.root_radius_m - radius)
    radii = radius + half * (1.0 + NODES_48[:, np.newaxis])
    half_angles = ring.half_angle_rad(radii)
    # height Y = R cos(tau) with d tau/dR = tan(alpha)/R
    rise = np.cos(half_angles) - np.sin(half_angles) * np.sqrt((radii / ring.base_radius_m) ** 2 - 1.0)
    weight = WEIGHTS_48[:, np.newaxis] * half * rise
    thickness = 2.0 * radii * np.sin(half_angles)
    lever = across * (radii * np.cos(half_angles) - radius * np.cos(tau)) - along * offset
    young, poisson = pair.youngs_modulus_pa, pair.poisson_ratio
    area = (weight / thickness).sum(axis=0) / (young * width)
    foot = float(ring.half_angle_rad(np.array([ring.root_radius_m]))[0])
    thick, root = 2.0 * ring.root_radius_m * np.sin(foot), ring.root_radius_m * np.cos(foot)
    # the force acts where its line crosses the centre line
    share = (root - radius * np.cos(tau) - offset * along / across) / thick
    bracket = ROTATION * share**2 + 2.0 * (1.0 - poisson) * share
    bracket = bracket + SHIFT * (1.0 + (along / across) ** 2 / (2.4 * (1.0 + poisson)))
    bending = (weight * lever**2 * 12.0 / thickness**3).sum(axis=0) / (young * width)
    beam = np.stack([bending, 2.0 * SHEAR_FACTOR * (1.0 + poisson) * across**2 * area, along**2 * area])
    return beam, across**2 * bracket / (young * width)


ROLL_TOLERANCE = 1e-9
"""Contacts this far (relative to the tip's roll) outside the flank count as its end: rounding of positions, no more."""
PIECE_RAD = 0.02
"""Longest piece of the pits' integrals: short enough for 16 nodes when a contact stops just below a kink."""


@dataclass(frozen=True, slots=True)
class ToothCompliance:
    """Compliances of one tooth at each contact, (k,) [m/N]; the last one with what damage adds beside its rows."""

    bending: FloatArray
    shear: FloatArray
    axial: FloatArray
    foundation: FloatArray

    @property
    def total(self) -> FloatArray:
        """Sum of the four, (k,) [m/N]."""
        return self.bending + self.shear + self.axial + self.foundation


def tooth_compliance(
    pair: GearPair, side: Side, roll: ArrayLike, options: StiffnessOptions, pits: Iterable[ToothDamage] = ()
) -> ToothCompliance:
    """Return the compliances of one tooth loaded at roll angles (k,).

    Parameters
    ----------
    pair : GearPair
    side : Side
        Of which it is.
    roll : (k,)
        Roll angles of the contact, in any order [rad].
    options : StiffnessOptions
    pits : iterable of ToothDamage
        Pits of this tooth; their `gear` and `tooth` are not read.

    Raises
    ------
    ValueError
        If a roll angle is off the involute of the beam, or a pit leaves no section.

    Source: paper A, section 2.2; with 'calibrated' derived (finite elements, healthy tooth).
    """
    return tooth_compliances(pair, side, roll, options, (pits,))[0]


def tooth_compliances(
    pair: GearPair, side: Side, roll: ArrayLike, options: StiffnessOptions, teeth: Iterable[Iterable[ToothDamage]]
) -> list[ToothCompliance]:
    """Return `tooth_compliance` of several teeth of one gear by their pits: what all share is computed once."""
    if pair.helix_rad != 0.0:
        return _in_normal_section(pair, side, roll, options, teeth)
    gear = pair.member(side)
    damages = [tuple(pits) for pits in teeth]
    if isinstance(gear, RingGear):
        return _of_ring(pair, gear, np.atleast_1d(np.asarray(roll, dtype=np.float64)), options, damages)
    angles = _on_flank(gear, options.shape, np.atleast_1d(np.asarray(roll, dtype=np.float64)), side)
    arms = _arms(gear, angles)
    healthy = _healthy(pair, gear, angles, arms, options)
    return [_damaged(pair, gear, angles, arms, options, pits, healthy) for pits in damages]


def _of_ring(
    pair: GearPair, ring: RingGear, roll: FloatArray, options: StiffnessOptions, teeth: Sequence[Damage]
) -> list[ToothCompliance]:
    """Return the compliances of teeth of a ring: notches take of the sections between the contact and the root."""
    beam, foot = ring_tooth_parts(pair, ring, roll)
    if options.foundation == "none":
        foot = np.zeros_like(foot)
    found = []
    for pits in teeth:
        notches = tuple(one for one in pits if not goes_through(one))
        own = beam
        if pit_rows(notches).size:
            ends = ring.tip_roll_rad, ring.root_roll_rad
            below, whole = (_pit_gain(pair, ring, ends, at, notches) for at in (roll, np.array(ends[1:])))
            own = beam + _beam_compliances(pair, _arms(ring, roll, towards_root=1.0), whole - below)
        own.setflags(write=False)
        found.append(ToothCompliance(own[0], own[1], own[2], foot))
    return found


def _in_normal_section(
    pair: GearPair, side: Side, roll: ArrayLike, options: StiffnessOptions, teeth: Iterable[Iterable[ToothDamage]]
) -> list[ToothCompliance]:
    """Return the compliances of helical teeth in the transverse plane: beams of the normal section on their bodies."""
    normal, share = normal_pair(pair), cos(pair.base_helix_rad) ** 2
    section, across = normal.member(side), np.atleast_1d(np.asarray(roll, dtype=np.float64))
    rolls = np.maximum(normal_rolls(pair, side, across), first_roll(section, options.shape))
    found = tooth_compliances(normal, side, rolls, options, teeth)
    factor = calibration_factor(section, rolls) if options.beam == "calibrated" else 1.0
    alone = factor * _foundation(normal, section, rolls, options)
    body = factor * _foundation(pair, pair.member(side), across, options) + axial_part(pair, side, across, options)
    return [
        ToothCompliance(
            one.bending / share, one.shear / share, one.axial / share, (one.foundation - alone) / share + body
        )
        for one in found
    ]


def axial_part(pair: GearPair, side: Side, roll_rad: FloatArray, options: StiffnessOptions) -> FloatArray:
    """Return what a gear's body adds to a helical tooth's compliance by giving way along the axis (k,) [m/N]."""
    gear = pair.member(side)
    if options.foundation == "none":
        return np.zeros(roll_rad.size)
    angle = root_half_angle(gear, options.root_reading)
    bends = axial_compliance(gear, pair.face_width_m, pair.poisson_ratio, angle, roll_rad)
    return np.asarray(tan(pair.base_helix_rad) ** 2 * bends / (pair.youngs_modulus_pa * pair.face_width_m))


def _healthy(
    pair: GearPair, gear: SpurGear, angles: FloatArray, arms: FloatArray, options: StiffnessOptions
) -> tuple[FloatArray, FloatArray]:
    """Return bending, shear and axial compliance (3, k) and foundation (k,) [m/N]."""
    beam = _beam_compliances(pair, arms, beam_integrals(gear, options.shape, angles, pair.face_width_m))
    foundation = _foundation(pair, gear, angles, options)
    if options.beam == "calibrated":
        factor = calibration_factor(gear, angles)
        beam, foundation = factor * beam, factor * foundation
    return beam, foundation


def _foundation(pair: GearPair, gear: SpurGear, angles: FloatArray, options: StiffnessOptions) -> FloatArray:
    if options.foundation == "none":
        return np.zeros(angles.size)
    return foundation_compliance(gear, angles, options.root_reading, pair.youngs_modulus_pa, pair.face_width_m)


def _damaged(
    pair: GearPair,
    gear: SpurGear,
    angles: FloatArray,
    arms: FloatArray,
    options: StiffnessOptions,
    pits: Damage,
    healthy: tuple[FloatArray, FloatArray],
) -> ToothCompliance:
    beam, foundation = healthy
    notches = tuple(one for one in pits if not goes_through(one))
    if pit_rows(notches).size:
        ends = first_roll(gear, options.shape), gear.tip_roll_rad
        beam = beam + _beam_compliances(pair, arms, _pit_gain(pair, gear, ends, angles, notches))
    sound = healthy[0].sum(axis=0) + healthy[1]
    for one in pits:
        foundation = foundation + one.tooth_compliance_m_per_n(pair, angles, sound)
    for array in (beam, foundation):
        array.setflags(write=False)
    return ToothCompliance(beam[0], beam[1], beam[2], foundation)


def _on_flank(gear: SpurGear, beam: str, roll: FloatArray, side: Side) -> FloatArray:
    first, last = first_roll(gear, beam), gear.tip_roll_rad
    slack = ROLL_TOLERANCE * last
    if not bool(np.all((roll >= first - slack) & (roll <= last + slack))):
        span = f"{np.min(roll):.6g} to {np.max(roll):.6g}"
        raise ValueError(
            f"contact at roll {span} rad is off the {side}'s flank; allowed: {first:.6g} to {last:.6g} rad"
        )
    return np.clip(roll, first, last)


def _pit_gain(pair: GearPair, gear: SpurGear, ends: tuple[float, float], roll: FloatArray, pits: Damage) -> FloatArray:
    """Return what pits add to the integrals (4, k) from the first end of a beam to rolls (k,)."""
    breaks, cuts, sums = _pit_pieces(gear, ends, pits, pair.face_width_m)
    flank = (pit_rows(pits), gear.base_radius_m, gear.base_half_angle_rad, pair.face_width_m)
    gain = pit_integrals(roll, breaks, cuts, sums, *flank)
    if not np.all(np.isfinite(gain)):
        raise ValueError(
            "pits consume a whole section of the tooth; allowed: depth below the local half tooth thickness"
        )
    return gain


@lru_cache(maxsize=64)  # tables and labels ask at many positions
def _pit_pieces(
    gear: SpurGear, ends: tuple[float, float], pits: Damage, face_width_m: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return breaks, cuts and sums of `pit_sums`."""
    rows = pit_rows(pits)
    breaks = section_breaks(gear, rows, face_width_m, ends)
    return breaks, *pit_sums(breaks, rows, gear.base_radius_m, gear.base_half_angle_rad, face_width_m)


def section_breaks(gear: SpurGear, rows: FloatArray, face_width_m: float, ends: tuple[float, float]) -> FloatArray:
    """Return the ascending rolls between the ends of a beam that split integrals over pit rows (n, 14), (k,) [rad]."""
    start, end = ends
    kinks = involute.rolls_at_heights(section_kinks(rows, face_width_m), gear.base_radius_m, gear.base_half_angle_rad)
    inside = kinks[(kinks > start) & (kinks < end)]
    return np.unique(np.concatenate([np.arange(start, end, PIECE_RAD), inside]))


def _arms(gear: SpurGear, roll: FloatArray, towards_root: float = -1.0) -> FloatArray:
    """Return the lever of a unit load about the base-circle point [m], and its parts along and across the tooth.

    Heights of a ring grow towards the root, where its load leans.
    """
    slant = roll - gear.base_half_angle_rad
    along, across = np.sin(slant), np.cos(slant)
    lever = across * gear.height_m(roll) + towards_root * along * gear.half_thickness_m(roll)
    return np.stack([lever, along, across])


def _beam_compliances(pair: GearPair, arms: FloatArray, integrals: FloatArray) -> FloatArray:
    """Return bending, shear and axial compliance (3, k) [m/N] of integrals (J0, J1, J2, JA), (4, k)."""
    lever, along, across = arms
    young = pair.youngs_modulus_pa
    shear_modulus = young / (2.0 * (1.0 + pair.poisson_ratio))
    j0, j1, j2, ja = integrals
    bending = (lever * lever * j0 - 2.0 * lever * across * j1 + across * across * j2) / young
    # Differences of large terms: a square's integral is never negative, rounding can be.
    bending = np.maximum(bending, 0.0)
    return np.stack([bending, SHEAR_FACTOR * across**2 * ja / shear_modulus, along**2 * ja / young])
