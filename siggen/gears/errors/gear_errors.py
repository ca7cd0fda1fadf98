"""GearErrors: the manufacturing errors of one gear, of which a measuring machine would find just what is allowed.

Derived. A gear whose teeth sit eccentrically by e on its shaft moves them along the line of action by e cos(Θ + φ) with
the shaft's angle Θ: continuously, within a tooth too, and all pairs in mesh alike. A machine that measures about the
shaft's axis finds it as a runout of 2 e, a cumulative pitch of 2 e/cos α on the arc and a slope of the profiles. So the
eccentricity is the first harmonic of the pitch deviations: it is never added to them a second time. (A radial runout
F_r = 2 e moves the line of action by ± F_r/2, not by F_r sin α: the tangential part of a turning eccentricity counts.)

Scaled in turn: eccentricity to a share of the runout allowed, the other pitch deviations until single or cumulative
pitch reaches its limit, slopes and waves until they reach theirs, both together until the whole profile does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.errors.error_shapes import FLANK_POINTS, ErrorShapes, slopes, without_line
from siggen.gears.errors.iso_1328 import FlankTolerances
from siggen.gears.geometry.gear_pair import GearPair
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class GearErrors:
    """What the teeth of one gear miss against perfect ones, per tooth and along the flank.

    Only differences between places matter to the teeth; 0 is the mean tooth in the middle of its active flank, where a
    machine touches it to measure the pitch.

    `eccentricity_m`, `phase_rad`: e and its angle at tooth 0 of the shaft's position in which a pair of tooth 0 enters;
    `pitch_m` (z,): place of the teeth on the reference circle's arc without what the eccentricity adds, of mean 0;
    `slope_m` (z,): change of the profile from the root end to the tip of the active flank; `form_m` (z, FLANK_POINTS).
    """

    eccentricity_m: float
    phase_rad: float
    pitch_m: FloatArray
    slope_m: FloatArray
    form_m: FloatArray


@dataclass(frozen=True, slots=True)
class FlankDeviations:
    """What a measuring machine finds about the shaft's axis, with the names of `FlankTolerances`.

    Per tooth (z,) [m]: `cumulative_pitch_m` from the mean tooth, `pitch_m` from the tooth before, `profile_slope_m`,
    `profile_form_m`, `profile_m`; `runout_m`: 2 e.
    """

    cumulative_pitch_m: FloatArray
    pitch_m: FloatArray
    profile_slope_m: FloatArray
    profile_form_m: FloatArray
    profile_m: FloatArray
    runout_m: float

    @property
    def largest(self) -> dict[str, float]:
        """Return the deviations that tolerances of the same name limit [m]."""
        return {
            "pitch_m": float(np.abs(self.pitch_m).max()),
            "cumulative_pitch_m": float(np.ptp(self.cumulative_pitch_m)),
            "runout_m": self.runout_m,
            "profile_slope_m": float(np.abs(self.profile_slope_m).max()),
            "profile_form_m": float(self.profile_form_m.max()),
            "profile_m": float(self.profile_m.max()),
        }


def gear_errors(
    pair: GearPair, side: Side, shapes: ErrorShapes, limits: FlankTolerances, runout_share: float
) -> GearErrors:
    """Return errors of these shapes that stay within the limits, and reach those that bind.

    Parameters
    ----------
    pair : GearPair
    side : Side
    shapes : ErrorShapes
    limits : FlankTolerances, largest deviations allowed, as a share of a class's tolerances
    runout_share : float
        Runout over its limit; less where eccentricity alone would already pass another limit (few teeth).

    Raises
    ------
    ValueError
        If the runout share is not from 0 to 1, or the shapes are not those of this gear's number of teeth.
    """
    teeth = pair.member(side).teeth
    if not 0.0 <= runout_share <= 1.0:
        raise ValueError(f"runout_share: received {runout_share}; allowed: 0 to 1")
    if shapes.pitch.size != teeth:
        raise ValueError(f"shapes: received those of {shapes.pitch.size} teeth; the {side} has {teeth}")
    eccentricity = _eccentricity(pair, side, shapes, limits, runout_share)
    alone = GearErrors(eccentricity, shapes.phase_rad, *_nothing(teeth))
    turned = deviations(pair, side, alone).cumulative_pitch_m
    pitch = shapes.pitch * min(
        _largest_factor(turned, shapes.pitch, lambda c: np.abs(_steps(c)).max(), limits.pitch_m),
        _largest_factor(turned, shapes.pitch, np.ptp, limits.cumulative_pitch_m),
    )
    slope, form = _profile(eccentric_profiles_m(pair, side, alone), shapes, limits)
    return GearErrors(eccentricity, shapes.phase_rad, pitch, slope, form)


def off_axis(errors: GearErrors, eccentricity_m: float, phase_rad: float) -> GearErrors:
    """Return the errors of the same gear with its axis off its shaft's: both eccentricities add as vectors (derived).

    Nothing else moves, whatever the tolerances; 0 changes no bit.
    """
    if eccentricity_m == 0.0:
        return errors
    total = errors.eccentricity_m * np.exp(1j * errors.phase_rad) + eccentricity_m * np.exp(1j * phase_rad)
    return replace(errors, eccentricity_m=float(abs(total)), phase_rad=float(np.angle(total)))


def deviations(pair: GearPair, side: Side, errors: GearErrors) -> FlankDeviations:
    """Return what a measuring machine finds of a gear."""
    cosine = float(np.cos(pair.member(side).pressure_angle_rad))
    middle = 0.5 * (pair.contact_start_m + pair.contact_end_m)
    cumulative = errors.pitch_m + eccentric_m(pair, side, errors, np.array([middle]))[:, 0] / cosine
    profiles = profiles_m(pair, side, errors)
    return FlankDeviations(
        cumulative_pitch_m=cumulative,
        pitch_m=_steps(cumulative),
        profile_slope_m=slopes(profiles),
        profile_form_m=np.ptp(without_line(profiles), axis=1),
        profile_m=np.ptp(profiles, axis=1),
        runout_m=2.0 * errors.eccentricity_m,
    )


def profiles_m(pair: GearPair, side: Side, errors: GearErrors) -> FloatArray:
    """Return what every tooth misses (z, FLANK_POINTS) from the root end to the tip, up to its place [m]."""
    return eccentric_profiles_m(pair, side, errors) + _lines(errors.slope_m) + errors.form_m


def eccentric_m(pair: GearPair, side: Side, errors: GearErrors, position_m: FloatArray) -> FloatArray:
    """Return what eccentricity takes from every tooth (z, k) at positions s (k,) of its pair [m]."""
    gear = pair.member(side)
    tooth = 2.0 * np.pi * np.arange(gear.teeth) / gear.teeth
    turned = (position_m - pair.contact_start_m) / gear.base_radius_m
    return np.asarray(errors.eccentricity_m * np.cos(tooth[:, None] + turned[None, :] + errors.phase_rad))


def eccentric_profiles_m(pair: GearPair, side: Side, errors: GearErrors) -> FloatArray:
    """Return the same (z, FLANK_POINTS) from the root end to the tip of the active flank."""
    ends = (pair.contact_start_m, pair.contact_end_m)
    first, last = ends if side == Side.DRIVER else ends[::-1]
    return eccentric_m(pair, side, errors, np.linspace(first, last, FLANK_POINTS))


def _eccentricity(
    pair: GearPair, side: Side, shapes: ErrorShapes, limits: FlankTolerances, runout_share: float
) -> float:
    """Return e: the wanted share of the runout, or what another limit leaves; everything measured is linear in e."""
    unit = GearErrors(1.0, shapes.phase_rad, *_nothing(pair.member(side).teeth))
    found = deviations(pair, side, unit).largest
    wanted = 0.5 * runout_share * limits.runout_m
    return float(min(wanted, *(getattr(limits, name) / found[name] for name in found)))


def _profile(turned: FloatArray, shapes: ErrorShapes, limits: FlankTolerances) -> tuple[FloatArray, FloatArray]:
    """Return slopes (z,) and forms (z, FLANK_POINTS) beside what eccentricity does to the profiles."""
    lines = _lines(shapes.slope)
    slope = _largest_factor(turned, lines, lambda p: np.abs(slopes(p)).max(), limits.profile_slope_m)
    form = _largest_factor(turned, shapes.form, lambda p: np.ptp(without_line(p), axis=1).max(), limits.profile_form_m)
    both = _largest_factor(
        turned, slope * lines + form * shapes.form, lambda p: np.ptp(p, axis=1).max(), limits.profile_m
    )
    both = min(both, 1.0)
    return both * slope * shapes.slope, both * form * shapes.form


def _largest_factor(
    fixed: FloatArray, varying: FloatArray, measure: Callable[[FloatArray], float], limit: float
) -> float:
    """Return the largest factor f from 0 with measure(fixed + f varying) <= limit; a norm, met by `fixed` alone."""
    size = float(measure(varying))
    if size == 0.0:
        return 0.0
    low, high = 0.0, (limit + float(measure(fixed))) / size
    # Convex in the factor, so the allowed ones are an interval; 60 halvings leave rounding alone.
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(measure(fixed + middle * varying)) <= limit else (low, middle)
    return low


def _steps(cumulative: FloatArray) -> FloatArray:
    return cumulative - np.roll(cumulative, 1)


def _lines(slope: FloatArray) -> FloatArray:
    return slope[:, None] * np.linspace(-0.5, 0.5, FLANK_POINTS)[None, :]


def _nothing(teeth: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    return np.zeros(teeth), np.zeros(teeth), np.zeros((teeth, FLANK_POINTS))
