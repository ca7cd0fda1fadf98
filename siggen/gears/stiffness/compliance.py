"""Compliance of one tooth under a load normal to its flank: bending, shear, axial compression and foundation.

Source: paper A, section 2.2 (potential energy method); equations: reference, standard literature (Yang-Lin, Tian), in
roll-angle form. With alpha_1 = psi_c - alpha_2 (signed: negative near the base circle), d = x(psi_c), h_c = h(psi_c):

    1/k_b = int [cos(alpha_1) (d - x) - sin(alpha_1) h_c]^2/(E I) dx
    1/k_s = 1.2 cos^2(alpha_1) int dx/(G A)        1/k_a = sin^2(alpha_1) int dx/(E A)

The calibrated tooth scales all four parts of the healthy rack-cut tooth by the finite-element factor of
`siggen.gears.stiffness.calibration`; what pits add to the beam is not scaled, since the factor was made on healthy
teeth.

Of helical teeth the beam bends in its normal section. The body beneath is none of that section: it takes the force of
the transverse plane as the body of a spur gear does, and the axial force, tan β_b of it, as a plate (`axial_body`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import cos, tan

import numpy as np
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.gears.damage.flank_damage import pit_rows
from siggen.gears.damage.kinks import section_kinks
from siggen.gears.damage.tooth_damage import Damage, ToothDamage, goes_through
from siggen.gears.geometry import involute
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import normal_pair, normal_rolls
from siggen.gears.geometry.internal_pair import RingGear
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.gears.stiffness.axial_body import axial_compliance
from siggen.gears.stiffness.beams import beam_integrals, first_roll
from siggen.gears.stiffness.calibration import calibration_factor
from siggen.gears.stiffness.foundation import foundation_compliance, root_half_angle
from siggen.gears.stiffness.pitted_beams import pit_integrals, pit_sums
from siggen.gears.stiffness.ring_tooth import SHEAR_FACTOR, ring_tooth_parts
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.names import Side

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
