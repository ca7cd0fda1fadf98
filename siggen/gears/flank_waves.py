"""FlankWaves: waves of grinding and generating that run over all teeth of a gear, and the form of every single tooth.

A wave of n periods per revolution at the roll angle ξ of tooth j is missing w cos(n (ξ ± 2πj/z) + φ): from pair to pair
it goes on, and shows as a line at n times the shaft unless n is a multiple of z (derived; the sign is that in which
teeth follow each other, + for the pinion, whose roll angle grows in mesh). A form of h cycles over the active flank has
an amplitude and phase common to all teeth, which adds to mesh lines, and one of each tooth, which makes sidebands.

The contact has a width 2b and does not follow short waves. A gap that varies by w cos(κx) over a plane Hertz contact
changes the approach by the mean of the gap weighted with the pressure of a flat punch, 1/(π √(b² - x²)): w J_0(κb)
(derived, by reciprocity; for waves that stay in full contact). On a flank of radius ρ, κ = n/ρ.

On helical teeth a wave of the machine's table lies along the contact lines: the section at w is cut when the table has
turned on by as much as the teeth are turned there. So the pair meets it at once, as it does eccentricity. The form
belongs to the tool's profile: every slice meets it at its own place (`face_shares`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, MissingTables, nearest_place_m
from siggen.names import Side

ORDERS = np.arange(1, 31)
"""Cycles of the form over the active flank: down to L/30, where the profile filter of ISO 1328-1 ends."""


@dataclass(frozen=True, slots=True)
class FlankWaves:
    """Waves of one gear: `waves` (k,) periods per revolution with amplitudes and phases (k,); the form of its teeth.

    `common_m` (ORDERS,) complex amplitudes of what all teeth have, `own_m` (z, ORDERS) of what each one has besides.
    """

    waves: FloatArray
    amplitude_m: FloatArray
    phase_rad: FloatArray
    common_m: ComplexArray
    own_m: ComplexArray


def missing_m(
    pair: GearPair, side: Side, waves: FlankWaves, position_m: FloatArray, half_width_m: FloatArray | float
) -> FloatArray:
    """Return what waves take from every tooth (z, k) at positions s (k,), seen by a contact of half-width b (k,)."""
    total = _of_table_m(pair, side, waves, position_m, position_m, half_width_m)
    return _with_form(total, pair, side, waves, position_m, half_width_m)


def _of_table_m(
    pair: GearPair,
    side: Side,
    waves: FlankWaves,
    position_m: FloatArray,
    place_m: FloatArray,
    half_width_m: FloatArray | float,
) -> FloatArray:
    """Return what waves over all teeth take (z, k), where flanks at `place_m` (k,) touch."""
    from scipy.special import j0

    gear, sense = pair.member(side), 1.0 if side == Side.DRIVER else -1.0
    roll = _radius_m(pair, side, position_m) / gear.base_radius_m
    seen = _seen(pair, side, place_m, half_width_m)
    tooth = sense * 2.0 * np.pi * np.arange(gear.teeth) / gear.teeth
    total = np.zeros((gear.teeth, position_m.size))
    for n, amplitude, phase in zip(waves.waves, waves.amplitude_m, waves.phase_rad, strict=True):
        total += amplitude * j0(n * seen) * np.cos(n * (roll + tooth[:, None]) + phase)
    return total


def _with_form(
    total: FloatArray,
    pair: GearPair,
    side: Side,
    waves: FlankWaves,
    position_m: FloatArray,
    half_width_m: FloatArray | float,
) -> FloatArray:
    """Return the form (z, k) of single teeth added to a total."""
    from scipy.special import j0

    roll = _radius_m(pair, side, position_m) / pair.member(side).base_radius_m
    seen = _seen(pair, side, position_m, half_width_m)
    per_cycle = 2.0 * np.pi * pair.member(side).base_radius_m / (pair.contact_end_m - pair.contact_start_m)
    together = waves.common_m + waves.own_m
    for h, amplitudes in zip(ORDERS, together.T, strict=True):
        n = h * per_cycle
        total += j0(n * seen) * (amplitudes[:, None] * np.exp(1j * n * roll)).real
    return total


def _radius_m(pair: GearPair, side: Side, position_m: FloatArray) -> FloatArray:
    """Return radii of curvature (k,) of a flank [m], below 0 below its base circle, where no flank is."""
    radius = position_m if side == Side.DRIVER else pair.line_of_action_m - position_m
    return radius if pair.member(side).signed_base_radius_m > 0.0 else -radius


def _seen(pair: GearPair, side: Side, place_m: FloatArray, half_width_m: FloatArray | float) -> FloatArray:
    """Return b over ρ (k,): κb per wave on the revolution; 0 below the base circle, where tables of few teeth begin."""
    radius = _radius_m(pair, side, place_m)
    return np.divide(half_width_m, radius, out=np.zeros_like(radius), where=radius > 0.0)


def with_waves(
    missing: MissingMaterial,
    pair: GearPair,
    pinion: FlankWaves,
    gear: FlankWaves,
    line_load_n_per_m: float,
    shares: FaceShares | None = None,
) -> MissingMaterial:
    """Return the missing material of the same teeth with waves, as a contact under a line load [N/m] sees them.

    Parameters
    ----------
    missing : MissingMaterial; tables of 2049 points have 70 for each of the shortest waves that gears show (15 z)
    shares : FaceShares or None, of helical teeth alone
    """
    position = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])

    def seen(side: Side, waves: FlankWaves) -> FloatArray:
        def along(place: FloatArray) -> FloatArray:
            return half_width_m(pair, place, line_load_n_per_m)

        if shares is None:
            return missing_m(pair, side, waves, position, along(position))
        place, teeth = nearest_place_m(pair, position), pair.member(side).teeth

        def form(met: FloatArray) -> FloatArray:
            return _with_form(np.zeros((teeth, met.size)), pair, side, waves, met, along(met))

        return _of_table_m(pair, side, waves, position, place, along(place)) + shares.mean(position, form)

    return replace(
        missing,
        pinion=_added(missing.pinion, seen(Side.DRIVER, pinion)),
        gear=_added(missing.gear, seen(Side.DRIVEN, gear)),
    )


def half_width_m(pair: GearPair, position_m: FloatArray, line_load_n_per_m: float) -> FloatArray:
    """Return the half-width (k,) of the Hertz contact at positions (k,), √(4 F_l R_e / (π E*)), both of one steel.

    Below either base circle, where no flank is, 0.
    """
    line = pair.line_of_action_m
    radius = np.maximum(position_m * (line - position_m) / line, 0.0)
    modulus = 0.5 * pair.youngs_modulus_pa / (1.0 - pair.poisson_ratio**2)
    return np.asarray(np.sqrt(4.0 * line_load_n_per_m * radius / (np.pi * modulus)))


def _added(teeth: MissingTables, profile: FloatArray) -> MissingTables:
    return MissingTables(
        profile_m=teeth.profile_m[teeth.kind_of_tooth] + profile,
        kind_of_tooth=np.arange(len(profile), dtype=np.int32),
        offset_m=teeth.offset_m,
    )
