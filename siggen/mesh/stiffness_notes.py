"""Where a stiffness model is asked about gears that it was not made for, in sentences for the user.

Limits: fit range of Sainsot 2004, range of the finite-element calibration, and derived ones (tooth that a beam leaves
out or invents; contact width against tooth thickness).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import tan

import numpy as np

from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import normal_gear
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.body_coupling import outside_coupling
from siggen.mesh.calibration import outside_calibration
from siggen.mesh.hertz import centre_line_depth, contact_half_width
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import outside_foundation_fit
from siggen.names import Side

POISSON_RANGE = (0.25, 0.35)
"""Around 0.3, for which the foundation's fit and the finite elements were made."""
WIDE_CONTACT = 0.25
"""Half width over depth to the centre line at which the Weber-Banaschek contact is 1 % off (measured)."""


def stiffness_notes(
    pair: GearPair, options: StiffnessOptions, gears: Sequence[str] = (Side.DRIVER, Side.DRIVEN)
) -> tuple[str, ...]:
    """Return what to know about a pair's stiffness model, one sentence each; empty where the models hold.

    Parameters
    ----------
    pair : GearPair
        A pair without geometry problems.
    options : StiffnessOptions
    gears : names of both gears

    Returns
    -------
    tuple of str
        Each names the gear, the quantity and the limits. Outside them the numbers are extrapolations, not errors.

    Source: derived; limits of the sources named in this module's docstring.
    """
    return (
        *_gear_notes(gears[0], normal_gear(pair, Side.DRIVER), options),
        *_gear_notes(gears[1], normal_gear(pair, Side.DRIVEN), options),
        *_pair(pair, options),
        *_helix(pair),
    )


def _gear_notes(called: str, gear: SpurGear, options: StiffnessOptions) -> Iterator[str]:
    name = f"{called} ({gear.teeth:.4g} teeth)"
    if options.beam == "calibrated":
        # The factor was made against the extrapolated foundation, so the fit range is no limit of the product.
        for sentence in outside_calibration(gear):
            yield f"{name}: {sentence}; the factor of the nearest calibrated gear is used"
    elif options.foundation == "sainsot":
        for sentence in outside_foundation_fit(gear, options.root_reading):
            yield f"{name}: {sentence}; the stiffness of the gear body is extrapolated"
    if options.coupling == "body" and options.beam != "calibrated":
        for sentence in outside_coupling(gear):
            yield f"{name}: {sentence}; the local part of the nearest gear inside these limits is used"
    if options.shape != "rack_trochoid":
        yield from (f"{name}: {sentence}" for sentence in _misplaced_root(gear, options))


def _misplaced_root(gear: SpurGear, options: StiffnessOptions) -> Iterator[str]:
    gap_mm = 1e3 * (gear.root_radius_m - gear.base_radius_m)
    if options.beam == "base_circle" and gap_mm > 0.0:
        yield (
            f"beam: base_circle starts {gap_mm:.3g} mm below the root circle; this part of the tooth does not exist, "
            f"so the tooth is too soft; root_circle, rack_trochoid and calibrated avoid this"
        )
    if gear.undercut:
        yield f"beam: {options.beam} ignores the undercut of this tooth; rack_trochoid includes it"


def _pair(pair: GearPair, options: StiffnessOptions) -> Iterator[str]:
    low, high = POISSON_RANGE
    if options.foundation == "sainsot" and not low <= pair.poisson_ratio <= high:
        yield (
            f"pair: Poisson's ratio is {pair.poisson_ratio:g}; the gear body's compliance is that of 0.3 "
            f"(good for {low:g} to {high:g})"
        )
    if options.hertz == "weber_banaschek" and options.hertz_force_n is not None:
        ratio = _widest_contact(pair, options.hertz_force_n)
        if ratio > WIDE_CONTACT:
            yield (
                f"pair: at {options.hertz_force_n:g} N the contact is {ratio:.2g} of the tooth's half thickness wide "
                f"(half width); weber_banaschek holds up to {WIDE_CONTACT:g}"
            )


def _helix(pair: GearPair) -> Iterator[str]:
    if pair.helix_rad != 0.0:
        yield (
            f"pair: helical teeth of overlap ratio {pair.overlap_ratio:.3g}, total contact ratio "
            f"{pair.total_contact_ratio:.3g}; the axial force is {abs(tan(pair.helix_rad)):.3g} of the tangential one "
            "on the pitch circle"
        )


def _widest_contact(pair: GearPair, force_n: float) -> float:
    """Return the largest a_H/h_i over the path of contact of healthy flanks."""
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, 65)
    rolls = {
        Side.DRIVER: position / pair.pinion.base_radius_m,
        "gear": (pair.line_of_action_m - position) / pair.gear.base_radius_m,
    }
    width = contact_half_width(pair, rolls[Side.DRIVER], rolls[Side.DRIVEN], np.full(65, pair.face_width_m), force_n)
    depth = np.minimum(*(centre_line_depth(pair, side, rolls[side]) for side in Side))
    return float(np.max(width / depth))
